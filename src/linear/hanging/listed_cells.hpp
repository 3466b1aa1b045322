// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells with hanging points as polyhedra that list them.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "linear/hanging/covers.hpp"

namespace isotet::linear {

/// A cell by its faces: as Cells::faces have them.
struct ListedCell {
    std::uint64_t cell;
    std::vector<std::uint64_t> faces;
    std::vector<std::uint64_t> points; ///< ascending, each once
};

/// Begins a face behind those that are there; end_face() takes the place that it returns.
std::size_t begin_face(ListedCell& cell);

/// Ends a face whose points were appended. A triangle with one point on an edge becomes two triangles: as a quadrilateral
/// it would have three corners on a line.
///
/// `loop`   the face without points on its edges
void end_face(std::size_t at, std::span<const std::uint64_t> loop, ListedCell& cell);

/// Edges of faces, with memory to be used again.
class FaceEdges {
public:
    /// Sets the points of a cell to those of its faces. False: some edge is not in two of them.
    bool find_points(ListedCell& cell);

private:
    struct Edge {
        std::uint64_t low, high;
        friend auto operator<=>(const Edge&, const Edge&) = default;
    };
    std::vector<Edge> edges_;
};

/// Cells with a covered face or an edge with points on it: covered faces are those that cover them, with the points on
/// their edges. A cell whose faces would not close is none of these.
///
/// Guarantees   ascending; the same for any thread count
/// Cost         a pass over the cells, a byte a point
std::vector<ListedCell> list_cells(const core::CellReader& cells, const core::FaceReader& faces,
                                   const OpenFaces& open, const Covers& covers, const Progress& progress);

/// The cells with some of them as polyhedra.
/// Errors   out_of_memory; cancelled
Result<Cells> with_listed_cells(const core::CellReader& cells, const core::FaceReader& faces,
                                const std::vector<ListedCell>& listed, const Progress& progress);

} // namespace isotet::linear
