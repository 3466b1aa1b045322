// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Direct extraction, the contract that every engine meets: from the user's arrays and isovalues to the bytes of surfaces.
//
// Cells: native ones (native_cells.hpp), or the tets of all cells (CellReader::tets), turned as packing stores them
// (orientation.hpp, bucket_sorter.cpp), but repeated ones stay. Values, coordinates and isovalues: stored by the same rules (storage.hpp),
// over the points that these use. Which of them give triangles, and which vertices there are: as in extraction.hpp.
// Triangles: cells ascending, the parts of a cell in their order, then the case tables. Vertices: by (lower, higher)
// user's number of the two ends, which at a tied point (Ties::merge) are the same.
// Gradient normals: at each end the sum over its valid tets, by cell, of six volumes times gradient
// (tet_gradient.hpp) in double, as a code (normal_code.hpp); between the ends core::vertex_normal().
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <isotet/frame.hpp>
#include <isotet/grid.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "grid/cells.hpp"
#include "ops/extraction.hpp"
#include "packed/packed.hpp"

namespace isotet::ops {

/// The user's arrays. Their types and lengths have been checked, their contents have not: that is part of the work.
struct DirectInput {
    const Grid& grid;
    const core::CellReader& cells;
    const PointField& field;
    std::span<const Field> carried; ///< point fields whose storage is to be told
    const Frame* frame = nullptr;   ///< how the grid is stored of which this is a piece; it knows the field
};

struct DirectRequest {
    std::span<const double> isovalues; ///< as the user gave them
    Ties ties = Ties::merge;
    bool split_cells = false; ///< all cells as tets
    bool ends = false;        ///< edge ends and weights
    bool normals = false;
    bool source_cells = false;
    bool active_cells_only = false; ///< others were left out by an active filter
    core::ArraySlots slots = {};    ///< as Request::slots
};

struct DirectSurface {
    RawSurface raw;
    double isovalue_stored = 0;   ///< in the unit of the field
    std::uint64_t false_ties = 0; ///< as in ExtractReport
    bool near_tie = false;
    std::uint64_t coarse_tets =
        0; ///< tets and other cells with triangles where rounding moves a corner by over a thousandth of the
           ///< shortest edge
};

struct DirectResult {
    std::array<double, 3> origin{};
    FieldReport field;
    std::vector<core::Storage> carried;
    std::uint64_t cells_left_out = 0;
    std::vector<DirectSurface> surfaces; ///< one an isovalue
    std::uint64_t transient_bytes = 0;   ///< beyond the surfaces, at the peak
    bool needs_all_cells = false;        ///< with active_cells_only; then nothing else counts
    std::uint64_t predicted_bytes = 0;   ///< of the largest surface, itself included, as known when its cells had been
                                         ///< looked at
};

} // namespace isotet::ops
