// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/drawer.hpp"

#include <isotet/render.hpp>
#include <isotet/jobs/device_choice.hpp>

namespace isotet::jobs {

Result<Drawer> Drawer::open(const DrawJob& job, Caller& caller) {
    Drawer drawer;
    const std::string& name = job.device.name;
    const bool wanted = (!name.empty() && name != "none") || job.engine == EngineChoice::vulkan || job.method.draw;
    if (wanted && draws_volume(job))
        caller.note("the CPU draws volumes, and extracts what is drawn with them: no device is used");
    if (!wanted || draws_volume(job)) return drawer;
    if (job.occlusion.value_or(0) > 0)
        return Error{ErrorCode::invalid_argument, "`occlusion` and a device, but only the CPU darkens folds"};
    Result<Device> device = open_drawing_device(job.device, caller);
    if (!device) return device.error();
    Result<Renderer> renderer = Renderer::create(*device);
    if (!renderer) return renderer.error();
    drawer.device_ = *std::move(device);
    drawer.renderer_ = *std::move(renderer);
    return drawer;
}

Result<Picture> Drawer::draw(const Scene& scene, const PictureOptions& options, const Run& run) {
    return renderer_ ? renderer_->draw(scene, options, run) : isotet::draw(scene, options, run, volume_work_);
}

} // namespace isotet::jobs
