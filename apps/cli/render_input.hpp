// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet render` draws: surfaces from a file, or extracted from a grid.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <isotet/camera.hpp>
#include <isotet/extract.hpp>
#include <isotet/grid.hpp>
#include <isotet/pack.hpp>

#include "console.hpp"
#include "options.hpp"

namespace isotet::cli {

struct RenderInput {
    std::string format;
    bool from_grid = false;
    std::string field;              ///< that was contoured; empty for a surface file
    double lower = 0, upper = 0;    ///< its range
    std::vector<double> isovalues;  ///< one a surface; none for a surface file
    std::vector<Surface> surfaces;
    Box bounds;                     ///< of the grid, or of the surface
    std::uint64_t cells = 0, tets = 0;
    double read_seconds = 0, pack_seconds = 0, extract_seconds = 0;
};

/// Reads the file, and of a grid extracts what is asked for.
/// Errors   as of reading, packing and extracting; invalid_argument where options are for grids, but the file is a surface
Result<RenderInput> read_render_input(const RenderCommand& command, Console& console);

} // namespace isotet::cli
