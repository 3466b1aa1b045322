// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/pictures/drawer.hpp"

#include <isotet/render.hpp>
#include <isotet/jobs/device_choice.hpp>

namespace isotet::jobs {

Result<Drawer> Drawer::open(const DrawJob& job, Caller& caller) {
    Drawer drawer;
    drawer.caller_ = &caller;
    const std::string& name = job.device.name;
    const bool volume = draws_volume(job);
    const bool wanted = (!name.empty() && name != "none") || job.engine == EngineChoice::vulkan || job.method.draw;
    if (!wanted) return drawer;
    if (job.occlusion.value_or(0) > 0 && !volume)
        return Error{ErrorCode::invalid_argument, "`occlusion` and a device, but only the CPU darkens folds"};
    if (job.engine == EngineChoice::vulkan && volume) caller.note("the CPU extracts what is drawn with a volume");
    Result<Device> device = open_drawing_device(job.device, caller);
    if (!device) return device.error();
    Result<Renderer> renderer = Renderer::create(*device);
    if (!renderer) return renderer.error();
    (volume ? drawer.ray_device_ : drawer.device_) = *std::move(device);
    drawer.renderer_ = *std::move(renderer);
    return drawer;
}

std::optional<DeviceInfo> Drawer::info() const {
    if (device_) return device_->info();
    if (ray_device_) return ray_device_->info();
    return {};
}

Result<Picture> Drawer::draw(const Scene& scene, const PictureOptions& options, const Run& run) {
    if (device_) return renderer_->draw(scene, options, run);
    if (ray_device_ && !scene.volumes.empty()) return draw_volumes(scene, options, run);
    return isotet::draw(scene, options, run, volume_work_);
}

Result<Picture> Drawer::draw_volumes(const Scene& scene, const PictureOptions& options, const Run& run) {
    Result<Picture> picture = renderer_->draw(scene, options, run);
    if (picture) volume_work_ = renderer_->volume_work();
    if (picture || !(is_of_device(picture.error().code) || picture.error().code == ErrorCode::out_of_memory))
        return picture;
    caller_->note("the CPU draws the volume: " + picture.error().message);
    renderer_.reset();
    ray_device_.reset();
    return isotet::draw(scene, options, run, volume_work_);
}

} // namespace isotet::jobs
