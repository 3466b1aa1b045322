// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/device.hpp>

#include <utility>

#include "base/errors.hpp"
#include "base/guard.hpp"
#include "device/kernel_test.hpp"
#include "vulkan/context.hpp"
#include "vulkan/devices/choice.hpp"
#include "vulkan/devices/found_devices.hpp"

namespace isotet {

Result<DeviceList> list_devices() {
    return core::guarded("listing the devices", []() -> Result<DeviceList> {
        Result<vulkan::FoundDevices> found = vulkan::find_devices({}, vulkan::whole_version, {});
        DeviceList list;
        if (found) {
            if (const Result<std::size_t> best = vulkan::choose(found->infos, "")) list.best = *best;
            list.devices = std::move(found->infos);
            return list;
        }
        if (found.error().code != ErrorCode::no_device) return found.error();
        list.unavailable = found.error().message;
        return list;
    });
}

Result<Device> Device::open(const DeviceOptions& options) {
    Result<std::shared_ptr<vulkan::Context>> context = vulkan::Context::open(options);
    if (!context) return context.error();
    Device device(*std::move(context));
    if (Result<void> tested = test_kernels_once(device); !tested) return tested.error();
    return device;
}

Result<Device> Device::adopt(const VulkanHandles& handles, const DeviceOptions& options) {
    if (!options.choice.empty())
        return invalid_argument("a device that is adopted is not chosen: the choice must be empty");
    Result<std::shared_ptr<vulkan::Context>> context = vulkan::Context::adopt(handles, options);
    if (!context) return context.error();
    Device device(*std::move(context));
    if (Result<void> tested = test_kernels_once(device); !tested) return tested.error();
    return device;
}

const DeviceInfo& Device::info() const noexcept { return context_->info(); }
const std::vector<std::string>& Device::notices() const noexcept { return context_->notices(); }
std::uint64_t Device::memory_used() const { return context_->memory().used(); }
std::uint64_t Device::memory_free() const { return context_->memory().free(); }

} // namespace isotet
