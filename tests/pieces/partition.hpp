// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids cut into pieces with points and cells in any order, and surfaces as sets of triangles, by the bits of their
// corners.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <random>
#include <vector>

#include <isotet/frame.hpp>
#include <isotet/grid.hpp>
#include <isotet/surface.hpp>

#include "grid/cells.hpp"

namespace isotet::test {

struct GridPiece {
    Grid grid;
    PointField field;
    std::vector<std::uint64_t> points, cells; ///< in the whole grid
};

/// The tuples of an array, some of them, in another order.
inline Array taken(const Array& values, const std::vector<std::uint64_t>& tuples) {
    return values.visit([&]<class T>(std::span<const T> typed) {
        std::vector<T> out;
        for (const std::uint64_t tuple : tuples)
            for (std::size_t k = 0; k < values.components(); ++k) out.push_back(typed[tuple * values.components() + k]);
        return Array::own(std::move(out), values.components());
    });
}

/// These cells of a grid, in this order, with shuffled points. Point numbers are those of the whole.
inline GridPiece piece_of(const Grid& whole, const PointField& field, std::vector<std::uint64_t> cells,
                          std::mt19937& random) {
    const core::CellReader reader = core::CellReader::open(whole).value();
    GridPiece out;
    std::vector<std::int64_t> place(whole.points.tuples(), -1);
    for (const std::uint64_t cell : cells)
        for (std::uint64_t i = 0; i < reader.corners(cell); ++i) {
            const std::uint64_t point = reader.corner(reader.first(cell) + i);
            if (place[point] < 0) out.points.push_back(point);
            place[point] = 0;
        }
    std::shuffle(out.points.begin(), out.points.end(), random);
    for (std::size_t i = 0; i < out.points.size(); ++i) place[out.points[i]] = static_cast<std::int64_t>(i);
    std::vector<std::int64_t> connectivity, offsets{0};
    std::vector<std::uint8_t> types;
    for (const std::uint64_t cell : cells) {
        for (std::uint64_t i = 0; i < reader.corners(cell); ++i)
            connectivity.push_back(place[reader.corner(reader.first(cell) + i)]);
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        types.push_back(reader.type(cell));
    }
    out.grid.points = taken(whole.points, out.points);
    out.grid.cells.connectivity = Array::own(std::move(connectivity));
    if (!reader.only_tets() || random() % 2) {
        out.grid.cells.offsets = Array::own(std::move(offsets));
        out.grid.cells.types = Array::own(std::move(types));
    }
    out.grid.point_numbers = Array::own(out.points);
    out.field = field;
    out.field.values = taken(field.values, out.points);
    out.cells = std::move(cells);
    return out;
}

/// Pieces of a grid: slabs of cells by their first corners, or cells at random.
inline std::vector<GridPiece> partition(const Grid& whole, const PointField& field, std::size_t pieces,
                                        std::uint32_t seed) {
    std::mt19937 random(seed);
    const core::CellReader reader = core::CellReader::open(whole).value();
    const bool slabs = random() % 2;
    const std::size_t axis = random() % 3;
    std::vector<std::vector<std::uint64_t>> cells(pieces);
    for (std::uint64_t cell = 0; cell < reader.count(); ++cell) {
        const double x = whole.points.at(reader.corner(reader.first(cell)), axis);
        const double fraction = x - std::floor(x);
        cells[slabs ? static_cast<std::size_t>(fraction * static_cast<double>(pieces)) : random() % pieces].push_back(
            cell);
    }
    std::vector<GridPiece> out;
    for (auto& list : cells) {
        std::shuffle(list.begin(), list.end(), random);
        out.push_back(piece_of(whole, field, std::move(list), random));
    }
    return out;
}

inline Frame frame_of(const std::vector<GridPiece>& pieces, const SurveyPieceOptions& options = {}) {
    std::vector<Survey> surveys;
    for (const GridPiece& piece : pieces) surveys.push_back(survey_piece(piece.grid, piece.field, options).value());
    return make_frame(surveys).value();
}

/// A triangle by the bits of its corners, the smallest first, direction kept.
using TriangleBits = std::array<std::array<std::uint64_t, 3>, 3>;

inline void add_triangles(const Surface& surface, std::vector<TriangleBits>& out) {
    const core::IndexColumn corners(surface.triangles);
    for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
        TriangleBits triangle;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                triangle[k][axis] = std::bit_cast<std::uint64_t>(surface.positions.at(corners[3 * t + k], axis));
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
        out.push_back(triangle);
    }
}

inline std::vector<TriangleBits> sorted(std::vector<TriangleBits> triangles) {
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

inline std::vector<TriangleBits> triangle_set(const Surface& surface) {
    std::vector<TriangleBits> out;
    add_triangles(surface, out);
    return sorted(std::move(out));
}

} // namespace isotet::test
