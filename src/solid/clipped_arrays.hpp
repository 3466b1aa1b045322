// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The arrays of a grid between two isovalues, from the places that its cells use.
#pragma once

#include <cstdint>
#include <span>

#include <isotet/contour.hpp>

#include "base/buffer.hpp"
#include "solid/cut_cells.hpp"

namespace isotet::solid {

/// The places that are used: points of the new grid in their order.
struct NewPoints {
    core::Buffer<std::uint32_t> numbers; ///< of each place that is used
    core::Buffer<std::uint32_t> places;  ///< of each new point, ascending
};

/// Tied points get the number of their isosurface's vertex.
NewPoints number_points(const CutInput& input, const core::Buffer<std::uint8_t>& used);

struct NewCells {
    Cells cells;
    core::Buffer<std::uint64_t> origin; ///< of each new cell: ascending
};

/// How much the arrays of the cells take.
std::uint64_t bytes_of_cells(const CutCells& cut);

NewCells make_cells(const CutInput& input, const CutCells& cut, const NewPoints& points);

/// Where new points have their values from: an array of the grid's points, and those of both isosurfaces.
struct PointSource {
    const Array& grid;
    const Array *lower = nullptr, *upper = nullptr; ///< null where there is none
};

/// As surfaces carry arrays of points: float32 where the grid's array and the precision are, else float64. Inside faces: the
/// mean of the vertices around.
Array new_values(const PointSource& source, const CutInput& input, const NewPoints& points, Precision precision);

/// The same for positions: inside faces those of the cap.
Array new_positions(const PointSource& source, const CutInput& input, const NewPoints& points, Precision precision);

/// Both ends of the edge of each point of the new grid, the one below first, and where it lies between them; a point of the
/// grid is both, inside faces both are -1.
struct EdgesOfPoints {
    Array ends, weights;
};
EdgesOfPoints new_edges(const Surface& lower, const Surface& upper, const CutInput& input, const NewPoints& points,
                        Precision precision);

/// An array of cells in its own type.
Array new_cell_values(const Array& values, const core::Buffer<std::uint64_t>& origin);

} // namespace isotet::solid
