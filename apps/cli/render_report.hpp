// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet render` tells: the table for people, and the JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <isotet/render.hpp>

#include "json_output.hpp"
#include "options.hpp"
#include "render_input.hpp"
#include "render_scene.hpp"

namespace isotet::cli {

/// Pictures that were drawn and written: one, or many by --sweep or --orbit.
struct PictureNumbers {
    std::string file;         ///< OUT
    std::size_t pictures = 1;
    std::uint64_t bytes = 0;  ///< of all
    double draw_seconds = 0, write_seconds = 0; ///< for all
    DeviceWork drawing;       ///< of the last one
    std::optional<double> differs; ///< share of the pixels, with --reference
};

/// "0.25 %".
std::string percent_text(double share);

std::string render_table(const RenderCommand& command, const RenderInput& input, const RenderScene& scene,
                         const Device& device, const PictureNumbers& picture);
Json render_json(const RenderCommand& command, const RenderInput& input, const RenderScene& scene, const Device& device,
                 const PictureNumbers& picture);

} // namespace isotet::cli
