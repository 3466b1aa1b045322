// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Compiled pipelines, kept on disk between runs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "vulkan/devices/capabilities.hpp"
#include "vulkan/devices/logical_device.hpp"

namespace isotet::vulkan {

/// One file a device, driver version and build of isotet: another driver or another build does not read it. It begins
/// with a checksum, so that a broken file is never shown to the driver. Whatever goes wrong with the file costs time
/// only, and is not an error: two processes may write at the same time, the disk may be full, the folder may be
/// missing. Whoever writes also tidies up: of all devices, drivers and builds together the `max_files` files written
/// last stay.
class PipelineCache {
public:
    static constexpr std::size_t max_files = 8;
    /// Behind the name of its file: a note on the kernels with this driver, which goes with the file.
    static constexpr std::string_view tested_suffix = ".tested";

    /// `folder`   empty: nothing is read or written
    PipelineCache(LogicalDevice& device, const Capabilities& capabilities, const std::filesystem::path& folder);
    ~PipelineCache();

    VkPipelineCache handle() const noexcept { return handle_; } ///< null where the driver would not make one
    const std::filesystem::path& file() const noexcept { return file_; }
    std::size_t bytes_read() const noexcept { return bytes_read_; } ///< 0 when the file was missing or broken

    /// Says that a pipeline was made; the file is written when the cache goes and any was.
    void note_new_pipeline() noexcept { changed_ = true; }

private:
    void save() const;

    LogicalDevice& device_;
    std::filesystem::path file_;
    VkPipelineCache handle_ = VK_NULL_HANDLE;
    std::size_t bytes_read_ = 0;
    bool changed_ = false;
};

} // namespace isotet::vulkan
