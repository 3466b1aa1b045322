// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// An opened device with everything that works on it: what isotet::Device stands for inside.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <isotet/device.hpp>
#include <isotet/export.hpp>
#include <isotet/result.hpp>

#include "vulkan/devices/capabilities.hpp"
#include "vulkan/devices/instance.hpp"
#include "vulkan/devices/logical_device.hpp"
#include "vulkan/kernels.hpp"
#include "vulkan/memory.hpp"
#include "vulkan/pipeline_cache.hpp"
#include "vulkan/staging.hpp"

namespace isotet::vulkan {

/// What tests force upon a device; the public options stay apart. Nothing here changes a byte of any result.
struct Settings {
    Watch watch;
    std::uint32_t vulkan_version = whole_version;          ///< the newest that is used
    bool force_staging = false;                            ///< as if the processor did not reach the device's memory
    std::uint64_t max_items = std::uint64_t{0xffffffff};   ///< vertices of a surface, and triangles: what 32 bits can
                                                           ///< number
    std::uint32_t groups_per_axis = 0;                     ///< most workgroups an axis; 0: the device's own limit
    std::uint64_t staging_bytes = std::uint64_t{16} << 20; ///< of each of the two staging buffers
    std::chrono::milliseconds wait_limit = std::chrono::seconds(60);
    std::optional<std::filesystem::path> cache_folder;     ///< of compiled pipelines; empty path: none
    std::function<void(Capabilities&)> alter_capabilities; ///< before they are judged
    std::function<void(DeviceFunctions&)> alter_functions; ///< so that calls can fail
};

/// Opening it runs the self-test: notices() says when it failed.
///
/// Threads   one operation at a time
class ISOTET_API Context {
public:
    static Result<std::shared_ptr<Context>> open(const DeviceOptions& options, const Settings& settings = {});
    /// On a device of the caller's.
    static Result<std::shared_ptr<Context>> adopt(const VulkanHandles& handles, const DeviceOptions& options,
                                                  const Settings& settings = {});
    ~Context();

    const DeviceInfo& info() const noexcept { return info_; }
    const Capabilities& capabilities() const noexcept { return capabilities_; }
    const Settings& settings() const noexcept { return settings_; }
    const std::vector<std::string>& notices() const noexcept { return notices_; }

    /// Most workgroups of a dispatch in each of the three axes.
    std::uint32_t groups_per_axis() const noexcept { return groups_per_axis_; }

    LogicalDevice& device() noexcept { return *device_; }
    Memory& memory() noexcept { return *memory_; }
    Kernels& kernels() noexcept { return *kernels_; }
    Staging& staging() noexcept { return *staging_; }
    const PipelineCache& pipeline_cache() const noexcept { return *cache_; }

private:
    Context() = default;
    static Result<std::shared_ptr<Context>> open_unguarded(const DeviceOptions& options, const Settings& settings);
    static Result<std::shared_ptr<Context>> adopt_unguarded(const VulkanHandles& handles, const DeviceOptions& options,
                                                            const Settings& settings);
    Result<void> set_up(const DeviceOptions& options);

    DeviceInfo info_;
    Capabilities capabilities_;
    Settings settings_;
    std::vector<std::string> notices_;
    std::uint32_t groups_per_axis_ = 0;
    // In the order of dependence: the last goes first.
    std::unique_ptr<Instance> instance_;
    std::unique_ptr<LogicalDevice> device_;
    std::unique_ptr<Memory> memory_;
    std::unique_ptr<PipelineCache> cache_;
    std::unique_ptr<Kernels> kernels_;
    std::unique_ptr<Staging> staging_;
};

} // namespace isotet::vulkan
