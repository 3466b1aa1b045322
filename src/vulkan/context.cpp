// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/context.hpp"

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/system/cache_folder.hpp"
#include "base/errors.hpp"
#include "base/guard.hpp"
#include "vulkan/devices/choice.hpp"
#include "vulkan/devices/found_devices.hpp"
#include "vulkan/self_test.hpp"

namespace isotet::vulkan {

namespace {

/// Keeps a device on which work still goes on, and the instance that it needs, to the end of the process and beyond the
/// end of static objects.
void leave_behind(std::unique_ptr<Instance> instance, std::unique_ptr<LogicalDevice> device) {
    using Left = std::pair<std::unique_ptr<Instance>, std::unique_ptr<LogicalDevice>>;
    static std::mutex mutex;
    static auto* all = new std::vector<Left>;
    const std::lock_guard lock(mutex);
    all->emplace_back(std::move(instance), std::move(device));
}

} // namespace

Result<std::shared_ptr<Context>> Context::open(const DeviceOptions& options, const Settings& settings) {
    return core::guarded("opening the device", [&] { return open_unguarded(options, settings); });
}

Result<std::shared_ptr<Context>> Context::open_unguarded(const DeviceOptions& options, const Settings& settings) {
    Result<FoundDevices> found = find_devices(settings.watch, settings.vulkan_version, settings.alter_capabilities);
    if (!found) return found.error();
    const Result<std::size_t> chosen = choose(found->infos, options.choice);
    if (!chosen) return chosen.error();

    std::shared_ptr<Context> context(new Context);
    context->settings_ = settings;
    context->info_ = found->infos[*chosen];
    context->capabilities_ = found->capabilities[*chosen];
    context->instance_ = std::move(found->instance);
    if (options.share_memory && context->capabilities_.external_memory)
        context->capabilities_.extensions.push_back(VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME);
    auto device = LogicalDevice::open(*context->instance_, found->handles[*chosen], context->capabilities_,
                                      settings.alter_functions);
    if (!device) return device.error();
    context->device_ = *std::move(device);
    if (Result<void> ready = context->set_up(options); !ready) return ready.error();
    return context;
}

Result<std::shared_ptr<Context>> Context::adopt(const VulkanHandles& handles, const DeviceOptions& options,
                                                const Settings& settings) {
    return core::guarded("adopting the device", [&] { return adopt_unguarded(handles, options, settings); });
}

Result<std::shared_ptr<Context>> Context::adopt_unguarded(const VulkanHandles& handles, const DeviceOptions& options,
                                                          const Settings& settings) {
    if (!handles.instance || !handles.physical_device || !handles.device || !handles.queue)
        return invalid_argument("a device is adopted by its instance, physical device, device and queue; one is null");
    Result<std::unique_ptr<Instance>> instance = Instance::adopt(handles);
    if (!instance) return instance.error();
    Capabilities capabilities =
        ask((*instance)->call(), static_cast<VkPhysicalDevice>(handles.physical_device), whole_version);
    if (std::string why = why_unusable(capabilities); !why.empty())
        return Error{ErrorCode::no_device,
                     fmt::format("the device {} cannot be used: {}", capabilities.properties.deviceName, why)};
    if (handles.queue_family >= capabilities.queues.size() ||
        !(capabilities.queues[handles.queue_family].flags & VK_QUEUE_COMPUTE_BIT))
        return invalid_argument(fmt::format("the queue family {} of the device {} does not compute",
                                            handles.queue_family, capabilities.properties.deviceName));
    // What the caller did not turn on is not there.
    capabilities.compute_family = capabilities.transfer_family = handles.queue_family;
    capabilities.features.fragmentStoresAndAtomics = handles.fragment_stores;
    capabilities.external_memory = handles.external_memory;
    capabilities.features.shaderFloat64 = VK_FALSE;
    capabilities.mesh_shaders = false;

    std::shared_ptr<Context> context(new Context);
    context->settings_ = settings;
    context->info_ = describe(capabilities, 0);
    context->capabilities_ = std::move(capabilities);
    context->instance_ = *std::move(instance);
    auto device = LogicalDevice::adopt(*context->instance_, handles, context->capabilities_);
    if (!device) return device.error();
    context->device_ = *std::move(device);
    if (Result<void> ready = context->set_up(options); !ready) return ready.error();
    return context;
}

/// All that stands on the opened device.
Result<void> Context::set_up(const DeviceOptions& options) {
    const auto& limits = capabilities_.properties.limits.maxComputeWorkGroupCount;
    groups_per_axis_ = *std::min_element(std::begin(limits), std::end(limits));
    if (settings_.groups_per_axis) groups_per_axis_ = std::min(groups_per_axis_, settings_.groups_per_axis);

    if (options.share_memory) {
        if (std::string why = device_->why_unable_to_share(); !why.empty())
            return Error{ErrorCode::no_device,
                         fmt::format("the device {} cannot share its memory: {}", info_.name, why)};
    }
    auto memory =
        Memory::open(*device_, capabilities_, {options.memory_limit, settings_.force_staging, options.share_memory});
    if (!memory) return memory.error();
    memory_ = *std::move(memory);
    cache_ =
        std::make_unique<PipelineCache>(*device_, capabilities_, settings_.cache_folder.value_or(core::cache_folder()));
    kernels_ = std::make_unique<Kernels>(*device_, capabilities_, *cache_);
    staging_ = std::make_unique<Staging>(*this, settings_.staging_bytes);

    Result<std::string> notice = self_test(*this);
    if (!notice) return notice.error();
    if (!notice->empty()) notices_.push_back(*std::move(notice));
    return {};
}

Context::~Context() {
    staging_.reset();
    kernels_.reset();
    cache_.reset();
    memory_.reset();
    if (device_ && device_->hung()) leave_behind(std::move(instance_), std::move(device_));
}

} // namespace isotet::vulkan
