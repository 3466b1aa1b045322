// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The Cells element of one Piece of an UnstructuredGrid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <pugixml.hpp>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/pieces/cell_places.hpp"
#include "io/vtk_xml/document.hpp"
#include "io/vtk_xml/stored_array.hpp"

namespace isotet::io::vtk_xml {

struct CellsElement {
    pugi::xml_node piece;
    std::uint64_t count = 0;
    std::size_t step = 0;
};

struct CellsRead {
    Cells cells = {};         ///< offsets and types are empty where all cells are of one kind, one after another
    std::optional<StoredArray> corners = {}; ///< where they were left: StoredArray::each_block() can be called
    std::optional<CellPlaces> places = {};   ///< of these, which borrow the types of `cells`
};

/// `corners_later`   those of linear cells may be left where they are
/// Errors   invalid_data: arrays that are missing, too short, of other types; as StoredArray
Result<CellsRead> read_cells(Document& document, const CellsElement& element, bool corners_later,
                             const Progress& progress);

/// Corners as Cells::connectivity, of 32 bits where all fit.
Result<Array> read_corners(const StoredArray& stored);

} // namespace isotet::io::vtk_xml
