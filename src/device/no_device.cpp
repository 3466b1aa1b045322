// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What stands for device.cpp in a build without Vulkan: there is no device, and none can be opened.
#include <isotet/device.hpp>

namespace isotet {

namespace {

constexpr const char* built_without = "isotet was built without Vulkan (ISOTET_VULKAN=OFF)";

} // namespace

Result<DeviceList> list_devices() { return DeviceList{{}, {}, built_without}; }

Result<Device> Device::open(const DeviceOptions&) { return Error{ErrorCode::no_device, built_without}; }

Result<Device> Device::adopt(const VulkanHandles&, const DeviceOptions&) {
    return Error{ErrorCode::no_device, built_without};
}

const DeviceInfo& Device::info() const noexcept {
    static const DeviceInfo none;
    return none;
}

const std::vector<std::string>& Device::notices() const noexcept {
    static const std::vector<std::string> none;
    return none;
}

std::uint64_t Device::memory_used() const { return 0; }
std::uint64_t Device::memory_free() const { return 0; }

} // namespace isotet
