// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"

namespace isotet::linear {

/// The cells of a checked grid.
struct CheckedCells {
    core::CellReader cells;
    core::FaceReader faces;
};

inline Result<CheckedCells> checked_cells(const Grid& grid, const Progress& progress) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto sound = core::check_cells(grid, *cells, progress); !sound) return sound.error();
    if (auto sound = core::check_faces(grid, *cells, progress); !sound) return sound.error();
    const auto faces = core::FaceReader::open(grid.cells);
    if (!faces) return faces.error();
    return CheckedCells{*cells, *faces};
}

} // namespace isotet::linear
