// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet render` draws, before any isovalue: a surface from a file, or a session on a grid; and what it is
// coloured by.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <isotet/camera.hpp>
#include <isotet/contour.hpp>
#include <isotet/grid.hpp>
#include <isotet/read.hpp>
#include <isotet/render.hpp>

#include "console.hpp"
#include "options.hpp"

namespace isotet::cli {

/// The field that colours: a scalar a point or a cell of the grid, or a vertex or a triangle of the surface.
struct ColorField {
    std::string name;
    Array values;
    Association association = Association::point;
    ColorScale scale;
    bool has_no_data = false;
};

struct RenderInput {
    std::string format;
    std::optional<Surface> surface; ///< of a surface file; else there is
    std::optional<Contour> contour; ///< with gradient normals
    ContourInput source;            ///< of the session, if it has a device: to go on without it
    std::string field;              ///< that is contoured; empty for a surface file
    double lower = 0, upper = 0;    ///< its range; of a grid from the first extraction on
    std::optional<double> time;     ///< of the step
    std::vector<double> isovalues;
    std::optional<Surface> boundary; ///< of the grid, if it is wanted
    std::optional<ColorField> colors;
    Box bounds;                      ///< of the grid, or of the surface
    std::uint64_t cells = 0;         ///< of the grid
    double read_seconds = 0, pack_seconds = 0, boundary_seconds = 0;
};

/// Reads the file, chooses field and isovalues, and starts the session; packs where the session does.
///
/// `device`   draws; extracts too if it is a graphics card, or if --engine vulkan asks for it
/// Errors     as of reading and packing; invalid_argument where options are for grids, but the file is a surface, or a
///            field to colour by is none
Result<RenderInput> read_render_input(const RenderCommand& command, const Device& device, Console& console);

} // namespace isotet::cli
