// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Extraction, the contract that every engine meets: from a packed grid and stored isovalues to the bytes of surfaces,
// each the same as if it were the only one.
//
// Vertices: clusters ascending; within the owner first tied own points (Ties::merge), then own seam edges in stored
// order, then inner edges by (lower, higher local index). Triangles: clusters ascending, stored cells ascending (tets,
// pyramids, wedges, hexahedra), then the case tables (case_table.hpp, cell_cases.hpp), a tied corner as one above. A cell
// counts when no corner is without data.
//   Ties::keep    all triangles
//   Ties::merge   vertices on edges to a tied corner are that corner; triangles with two equal corners fall away. A tet
//                 with B corners below, T tied and A strictly above has some when B > 0 and (A > 0 or T = 3)
// A vertex is there when a triangle has it. That is so for every edge from below to strictly above of a cell that counts:
// no two faces of a cell share more than an edge, so no polygon passes twice through one tied corner with only one vertex
// between.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <isotet/extract.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "base/array_slot.hpp"
#include "numbers/storage.hpp"
#include "packed/packed.hpp"

namespace isotet::ops {

/// A point field that is carried onto surfaces: values of the user's points, and how they are stored.
struct CarriedField {
    Array values;
    core::Storage storage;
    /// Not null: `values` are the stored ones of this grid, which has the same cells, by packed points; the storage is then
    /// that of numbers that stay as they are.
    std::shared_ptr<const core::Packed> packed = {};
};

/// The field of a grid that has the same cells.
template <class Real>
CarriedField carried_field(std::shared_ptr<const core::Packed> packed) {
    const auto& values = packed->as<Real>().values;
    Array stored(scalar_type_of<Real>(), values.data(), values.size(), 1, nullptr);
    return {stored, {}, std::move(packed)};
}

/// What to extract.
template <class Real>
struct Request {
    std::vector<core::StoredIsovalue<Real>> isovalues; ///< in any order; one surface each
    Ties ties = Ties::merge;
    bool ends = false;         ///< edge ends and weights
    bool normals = false;      ///< gradient normals (packed.gradients is there)
    bool source_cells = false; ///< packed cell ids are there
    /// For engines that interpolate point fields themselves; of others the caller asks for ends.
    std::vector<CarriedField> fields;
    /// Bytes that the caller will add to each vertex and triangle: engines reckon with them when they predict memory.
    std::size_t more_vertex_bytes = 0, more_triangle_bytes = 0;
    core::ArraySlots slots = {}; ///< of arrays that go out as the engine makes them; it may make them elsewhere
};

/// The surface of one isovalue; V vertices, F triangles. Parts that were not asked for are empty.
struct RawSurface {
    Array positions;           ///< Real x 3, V
    Array triangles;           ///< uint32 or uint64 x 3, F
    Array normals;             ///< float32 x 3, V; zero where the face normal stands in
    Array ends;                ///< int64 x 2, V: user's points, the one below first
    Array weights;             ///< Real, V
    Array source_cells;        ///< int64, F: user's cells
    std::vector<Array> fields; ///< Real x components, V
    std::uint64_t selected_clusters = 0;
    std::uint64_t tied_points = 0; ///< points whose stored value equals the isovalue, in tets that count or not
};

/// What comes out.
struct RawSurfaces {
    std::vector<RawSurface> surfaces;  ///< in the order of the isovalues
    std::uint64_t transient_bytes = 0; ///< beyond the surfaces, at the peak
    std::uint64_t predicted_bytes = 0; ///< needed at most, with surfaces and what the caller adds, as known before the
                                       ///< start
};

} // namespace isotet::ops
