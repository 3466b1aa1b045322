// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells between pillars become hexahedra: corners that are the same place of one pillar are one point.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::io::grdecl {

/// Where the grid's own axes lie on the map: an origin and two directions of length 1.
struct MapAxes {
    std::array<double, 2> origin{}, x{1, 0}, y{0, 1};
};

/// A corner-point grid. Cells: the first index runs fastest, the third last and downwards.
struct CornerPoints {
    std::array<std::uint64_t, 3> cells{};
    std::vector<double> pillars; ///< COORD: x, y, depth of two places on each of (nx + 1) (ny + 1) pillars
    std::vector<double> depths;  ///< ZCORN: of 8 corners a cell, as rows of 2 nx, planes of 2 ny of them, 2 nz planes
    std::vector<std::uint8_t> active; ///< one a cell
    std::optional<MapAxes> axes;
};

struct Hexahedra {
    std::vector<double> points;         ///< x, y, z; z is minus the depth
    std::vector<std::uint32_t> corners; ///< 8 a cell, in VTK's order
    std::vector<std::uint64_t> cells;   ///< the cell that each comes from, ascending
    std::uint64_t flat = 0;             ///< active cells without height on all four pillars, left out
};

/// Makes hexahedra of the active cells. Corners are one point where their depths on a pillar are equal, and only there: so
/// cells on both sides of a fault share no points unless their corners meet.
///
/// Guarantees   the same for any thread count; points are numbered pillar by pillar, from below
/// Errors       invalid_data: a depth or pillar that is not finite, more than 2^32 - 1 points; out_of_memory; cancelled
/// Cost         O(n log nz) for n cells; 64 bytes a cell are there already, 32 and 24 a point are made
ISOTET_API Result<Hexahedra> make_hexahedra(CornerPoints grid, const Progress& progress);

} // namespace isotet::io::grdecl
