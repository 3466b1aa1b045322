// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet render` draws: a scene of a surface from a file, or of isosurfaces of a grid.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <isotet/isosurface_scene.hpp>

#include "console.hpp"
#include "options.hpp"

namespace isotet::cli {

struct RenderInput {
    std::string format;
    bool is_surface = false;
    std::string field;          ///< that is contoured; empty for a surface file
    std::optional<double> time; ///< of the step
    std::vector<double> isovalues;
    std::optional<ColorField> colors;
    std::uint64_t cells = 0; ///< of the grid
    double read_seconds = 0;
    std::optional<IsosurfaceScene> scene; ///< always there
};

/// Reads the file, chooses field and isovalues, and starts the scene.
///
/// `device`   draws; extracts too if it is a graphics card, or if --engine vulkan asks for it
/// Errors     as of reading and packing; invalid_argument where options are for grids, but the file is a surface, or a
///            field to colour by is none
Result<RenderInput> read_render_input(const RenderCommand& command, const Device& device, Console& console);

} // namespace isotet::cli
