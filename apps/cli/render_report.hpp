// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet render` tells: in the picture, in the table for people, and in the JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <isotet/annotation.hpp>

#include "json_output.hpp"
#include "options.hpp"
#include "render_input.hpp"

namespace isotet::cli {

/// Pictures that were drawn and written: one, or many by --sweep or --orbit.
struct PictureNumbers {
    std::string file;         ///< OUT
    std::size_t pictures = 1;
    std::uint64_t bytes = 0;  ///< of all
    double draw_seconds = 0, write_seconds = 0; ///< for all
    DeviceWork drawing;       ///< of the last one
    std::string camera;       ///< of the last one, as --camera takes it
    std::optional<double> differs; ///< share of the pixels, with --reference
};

/// "0.25 %".
std::string percent_text(double share);

/// Isovalues of the surfaces that are shown, each different.
std::vector<std::string> isovalue_texts(const IsosurfaceScene& scene);

/// Notes the isovalues that give no surface.
void note_empty_surfaces(const RenderInput& input, Console& console);

/// Scale, legend and caption; empty with --plain.
Annotation annotation_of(const RenderCommand& command, const RenderInput& input);

std::string render_table(const RenderCommand& command, const RenderInput& input, const std::optional<Device>& device,
                         const PictureNumbers& picture);
Json render_json(const RenderCommand& command, const RenderInput& input, const std::optional<Device>& device,
                 const PictureNumbers& picture);

} // namespace isotet::cli
