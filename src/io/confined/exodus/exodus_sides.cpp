// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/exodus/exodus_sides.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "grid/patches.hpp"

namespace isotet::io::confined {
namespace {

using Corners = std::vector<std::uint8_t>;

/// An element of VTK's: the corners of its sides in Exodus's order, those of its edges in the order of the nodes there, and
/// those of its faces in the order of the nodes there.
struct Shape {
    std::vector<Corners> sides, edges, faces;
    std::uint64_t corners = 0;
};

const Shape& tetrahedron() {
    static const Shape shape{
        {{0, 1, 3}, {1, 2, 3}, {0, 2, 3}, {0, 1, 2}}, {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}, {}, 4};
    return shape;
}

const Shape& hexahedron() {
    static const Shape shape{
        {{0, 1, 4, 5}, {1, 2, 5, 6}, {2, 3, 6, 7}, {0, 3, 4, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}},
        {{0, 1}, {1, 2}, {2, 3}, {0, 3}, {4, 5}, {5, 6}, {6, 7}, {4, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}},
        {{0, 3, 4, 7}, {1, 2, 5, 6}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}},
        8};
    return shape;
}

const Shape& wedge() {
    static const Shape shape{{{0, 1, 3, 4}, {1, 2, 4, 5}, {0, 2, 3, 5}, {0, 1, 2}, {3, 4, 5}},
                             {{0, 1}, {1, 2}, {0, 2}, {3, 4}, {4, 5}, {3, 5}, {0, 3}, {1, 4}, {2, 5}},
                             {{0, 1, 3, 4}, {1, 2, 4, 5}, {0, 2, 3, 5}},
                             6};
    return shape;
}

const Shape& pyramid() {
    static const Shape shape{{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {0, 3, 4}, {0, 1, 2, 3}},
                             {{0, 1}, {1, 2}, {2, 3}, {0, 3}, {0, 4}, {1, 4}, {2, 4}, {3, 4}},
                             {{0, 1, 2, 3}},
                             5};
    return shape;
}

/// Null where a cell has no volume, or its faces are not known by its type.
const Shape* shape_of(std::uint8_t vtk_type) {
    switch (vtk_type) {
    case 10:
    case 24: return &tetrahedron();
    case 12:
    case 25:
    case 29: return &hexahedron();
    case 13:
    case 26:
    case 32: return &wedge();
    case 14:
    case 27:
    case 74: return &pyramid();
    default: return nullptr;
    }
}

class SideReader {
public:
    SideReader(const core::CellReader& cells, const core::FaceReader& faces) : cells_(cells), faces_(faces) {}

    /// False: there is no such side. `side` is from 1.
    bool add(std::size_t cell, std::int64_t side, core::PatchList& list) const {
        if (cells_.type(cell) == core::polyhedron_type) return add_of_polyhedron(cell, side, list);
        const Shape* const shape = shape_of(cells_.type(cell));
        if (!shape) return true;
        if (side < 1 || static_cast<std::size_t>(side) > shape->sides.size()) return false;
        const Corners& corners = shape->sides[static_cast<std::size_t>(side) - 1];
        for (const std::uint8_t corner : corners) add_node(cell, corner, list);
        add_between(cell, shape->corners, shape->edges, corners, list);
        add_between(cell, shape->corners + shape->edges.size(), shape->faces, corners, list);
        return true;
    }

private:
    /// The nodes from `first` on that are between some of the corners.
    void add_between(std::size_t cell, std::size_t first, const std::vector<Corners>& places, const Corners& corners,
                     core::PatchList& list) const {
        for (std::size_t i = 0; i < places.size(); ++i)
            if (std::ranges::includes(corners, places[i])) add_node(cell, first + i, list);
    }

    void add_node(std::size_t cell, std::size_t node, core::PatchList& list) const {
        if (node < cells_.corners(cell))
            list.point(static_cast<std::int64_t>(cells_.corner(cells_.first(cell) + node)));
    }

    bool add_of_polyhedron(std::size_t cell, std::int64_t side, core::PatchList& list) const {
        std::int64_t number = 0;
        for (std::uint64_t at = faces_.begin(cell) + 1; at < faces_.end(cell); at += 1 + faces_.at(at)) {
            if (++number != side) continue;
            for (std::uint64_t i = 0; i < faces_.at(at); ++i)
                list.point(static_cast<std::int64_t>(faces_.at(at + 1 + i)));
            return true;
        }
        return false;
    }

    const core::CellReader& cells_;
    const core::FaceReader& faces_;
};

} // namespace

Result<BoundaryPatches> exodus_side_sets(const ExodusFile& file, const Grid& grid) {
    const auto sets = file.side_sets();
    if (!sets) return sets.error();
    if (sets->empty()) return BoundaryPatches{};
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto sound = core::check_faces(grid, *cells, {}); !sound) return sound.error();
    const auto faces = core::FaceReader::open(grid.cells);
    if (!faces) return faces.error();
    const SideReader reader(*cells, *faces);
    core::PatchList list;
    for (const ExodusFile::SideSet& set : *sets) {
        list.name(set.id, set.name);
        for (std::size_t i = 0; i < set.cells.size(); ++i) {
            const auto cell = file.place_of(set.cells[i]);
            if (!cell)
                return Error{ErrorCode::invalid_data,
                             fmt::format("side set {} has element {}, which is not there", set.id, set.cells[i])};
            if (*cell == ExodusFile::not_read) continue;
            if (!reader.add(*cell, set.sides[i], list))
                return Error{ErrorCode::invalid_data,
                             fmt::format("side set {} has side {} of element {}, which is not there", set.id,
                                         set.sides[i], set.cells[i])};
            list.end_face(set.id);
        }
    }
    return list.finish();
}

} // namespace isotet::io::confined
