// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What draws the pictures of draw_files(): the CPU, or the device that was asked for.
#pragma once

#include <optional>

#include <isotet/jobs/draw_files.hpp>

namespace isotet::jobs {

class Drawer {
public:
    /// The CPU, unless a device, `engine` vulkan or a method that draws tets asks for a device. Of scenes with volumes it
    /// follows the rays, if it can; the CPU draws and extracts the rest. `caller` lives as long.
    /// Errors   no_device when one is asked for and there is none
    static Result<Drawer> open(const DrawJob& job, Caller& caller);

    /// That draws surfaces from where it extracted them; nothing: the CPU draws.
    const std::optional<Device>& device() const noexcept { return device_; }
    std::optional<DeviceInfo> info() const; ///< of the device that draws or follows rays
    DeviceWork work() const { return renderer_ ? renderer_->work() : DeviceWork(); }
    const VolumeWork& volume_work() const noexcept { return volume_work_; } ///< of the last picture

    Result<Picture> draw(const Scene& scene, const PictureOptions& options, const Run& run);

private:
    Result<Picture> draw_volumes(const Scene& scene, const PictureOptions& options, const Run& run);

    Caller* caller_ = nullptr;
    std::optional<Device> device_, ray_device_;
    std::optional<Renderer> renderer_;
    VolumeWork volume_work_;
};

} // namespace isotet::jobs
