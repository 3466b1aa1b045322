// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/context.hpp"

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include "base/cache_folder.hpp"
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
    const Capabilities& capabilities = context->capabilities_;
    const auto& limits = capabilities.properties.limits.maxComputeWorkGroupCount;
    context->groups_per_axis_ = *std::min_element(std::begin(limits), std::end(limits));
    if (settings.groups_per_axis)
        context->groups_per_axis_ = std::min(context->groups_per_axis_, settings.groups_per_axis);

    auto device =
        LogicalDevice::open(*context->instance_, found->handles[*chosen], capabilities, settings.alter_functions);
    if (!device) return device.error();
    context->device_ = *std::move(device);
    auto memory = Memory::open(*context->device_, capabilities, {options.memory_limit, settings.force_staging});
    if (!memory) return memory.error();
    context->memory_ = *std::move(memory);
    context->cache_ = std::make_unique<PipelineCache>(*context->device_, capabilities,
                                                      settings.cache_folder.value_or(core::cache_folder()));
    context->kernels_ = std::make_unique<Kernels>(*context->device_, capabilities, *context->cache_);
    context->staging_ = std::make_unique<Staging>(*context, settings.staging_bytes);

    Result<std::string> notice = self_test(*context);
    if (!notice) return notice.error();
    if (!notice->empty()) context->notices_.push_back(*std::move(notice));
    return context;
}

Context::~Context() {
    staging_.reset();
    kernels_.reset();
    cache_.reset();
    memory_.reset();
    if (device_ && device_->hung()) leave_behind(std::move(instance_), std::move(device_));
}

} // namespace isotet::vulkan
