// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The Cells element of one Piece of an UnstructuredGrid.
#pragma once

#include <cstddef>
#include <cstdint>

#include <pugixml.hpp>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/vtk_xml/document.hpp"

namespace isotet::io::vtk_xml {

struct CellsElement {
    pugi::xml_node piece;
    std::uint64_t count = 0;
    std::size_t step = 0;
};

/// The grid but for its cells, where active cells do (ReadOptions::active_cells).
struct ActiveWish {
    const Grid& grid;
    const ReadOptions& options;
};

struct CellsRead {
    Cells cells;              ///< offsets and types are empty where all cells are of one kind, one after another
    bool only_active = false; ///< others were left out
};

/// `active`   null: all cells are wanted
/// Errors     invalid_data: arrays that are missing, too short, of other types; as StoredArray
Result<CellsRead> read_cells(Document& document, const CellsElement& element, const ActiveWish* active,
                             const Progress& progress);

} // namespace isotet::io::vtk_xml
