// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "drawer.hpp"

#include <isotet/draw.hpp>

#include "device_choice.hpp"

namespace isotet::cli {

Result<Drawer> Drawer::open(const RenderCommand& command, Console& console) {
    Drawer drawer;
    const std::string& name = command.device.name;
    const bool wanted =
        (!name.empty() && name != "none") || command.engine == EngineChoice::vulkan || command.method.draw;
    if (!wanted) return drawer;
    Result<Device> device = open_drawing_device(command.device, console);
    if (!device) return device.error();
    Result<Renderer> renderer = Renderer::create(*device);
    if (!renderer) return renderer.error();
    drawer.device_ = *std::move(device);
    drawer.renderer_ = *std::move(renderer);
    return drawer;
}

Result<Picture> Drawer::draw(const Scene& scene, const PictureOptions& options, const Run& run) {
    return renderer_ ? renderer_->draw(scene, options, run) : isotet::draw(scene, options, run);
}

} // namespace isotet::cli
