// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids with all ways to put the corners of cells below, at and above the isovalue 1.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "grid/cell/cell_kind.hpp"
#include "grid/cells.hpp"
#include "support/random_grid.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {

using CornerPlaces = std::vector<std::array<double, 3>>;

/// VTK's type.
inline std::uint8_t vtk_type_of(core::CellKind kind) {
    static constexpr std::array<std::uint8_t, core::cell_kind_count> types{10, 14, 13, 12};
    return types[static_cast<std::size_t>(kind)];
}

/// The corners of a cell of one kind, upright, with flat faces.
inline CornerPlaces corners_of_one(core::CellKind kind) {
    const Grid one = made_grid(kind == core::CellKind::tetrahedron ? "kuhn"
                               : kind == core::CellKind::pyramid   ? "pyramid"
                               : kind == core::CellKind::wedge     ? "wedge"
                                                                   : "hex",
                               1, {});
    const core::WholeCell cell = core::CellReader::open(one).value().whole(0);
    CornerPlaces out;
    for (std::size_t k = 0; k < core::corner_count(kind); ++k)
        out.push_back({one.points.at(cell.corners[k], 0), one.points.at(cell.corners[k], 1),
                       one.points.at(cell.corners[k], 2)});
    return out;
}

/// Groups of cells, each with points of its own, in a lattice.
class ManyCells {
public:
    /// Begins a group at new points with the values 0, 1 and 2 that the digits of `index` to the base 3 say.
    void begin(const CornerPlaces& places, std::size_t index) {
        first_ = static_cast<std::int64_t>(values_.size());
        std::size_t rest = index;
        for (const auto& place : places) {
            values_.push_back(static_cast<float>(rest % 3));
            rest /= 3;
            for (std::size_t axis = 0; axis < 3; ++axis)
                points_.push_back(place[axis] + (axis == 0   ? 8.0 * static_cast<double>(groups_ % 81)
                                                 : axis == 1 ? 8.0 * static_cast<double>(groups_ / 81)
                                                             : 0.0));
        }
        ++groups_;
    }

    /// `corners`   among the points of the group
    void add_cell(core::CellKind kind, std::span<const std::uint8_t> corners) {
        for (const std::uint8_t corner : corners) connectivity_.push_back(first_ + corner);
        offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
        types_.push_back(vtk_type_of(kind));
    }

    NastyGrid take() {
        NastyGrid out;
        out.grid.points = Array::own(std::move(points_), 3);
        out.grid.cells.connectivity = Array::own(std::move(connectivity_));
        out.grid.cells.offsets = Array::own(std::move(offsets_));
        out.grid.cells.types = Array::own(std::move(types_));
        out.field = {"value", Array::own(std::move(values_)), false, {}};
        return out;
    }

private:
    std::vector<double> points_;
    std::vector<float> values_;
    std::vector<std::int64_t> connectivity_, offsets_{0};
    std::vector<std::uint8_t> types_;
    std::int64_t first_ = 0;
    std::size_t groups_ = 0;
};

inline std::size_t power_of_three(std::size_t exponent) {
    std::size_t out = 1;
    for (std::size_t i = 0; i < exponent; ++i) out *= 3;
    return out;
}

constexpr std::array<std::uint8_t, 8> corners_in_order{0, 1, 2, 3, 4, 5, 6, 7};

/// A cell of one kind for each way to give its corners the values 0, 1 and 2.
inline NastyGrid all_cases(core::CellKind kind) {
    const std::size_t corners = core::corner_count(kind);
    const CornerPlaces places = corners_of_one(kind);
    ManyCells out;
    for (std::size_t index = 0; index < power_of_three(corners); ++index) {
        out.begin(places, index);
        out.add_cell(kind, std::span(corners_in_order).first(corners));
    }
    return out.take();
}

/// A cell of one kind and its neighbour across a face, a tetrahedron or a pyramid, for each face and each way to give
/// the corners of the face, the others of the cell together, and that of the neighbour the values 0, 1 and 2.
inline NastyGrid all_neighbours(core::CellKind kind) {
    const std::size_t corners = core::corner_count(kind);
    CornerPlaces places = corners_of_one(kind);
    std::array<double, 3> middle{};
    for (const auto& place : places)
        for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] += place[axis] / static_cast<double>(corners);
    places.emplace_back();
    ManyCells out;
    for (const core::CellFace& face : core::shape_of(kind).faces()) {
        const std::size_t n = face.all().size();
        for (std::size_t axis = 0; axis < 3; ++axis) { // as far behind the face as the middle is before it
            double of_face = 0;
            for (const std::uint8_t corner : face.all()) of_face += places[corner][axis] / static_cast<double>(n);
            places[corners][axis] = 2 * of_face - middle[axis];
        }
        std::vector<std::uint8_t> neighbour(face.all().rbegin(), face.all().rend()); // outwards of the first cell
        neighbour.push_back(static_cast<std::uint8_t>(corners));
        for (std::size_t index = 0; index < power_of_three(n + 2); ++index) {
            std::vector<std::size_t> digits(corners + 1, index / power_of_three(n) % 3);
            for (std::size_t k = 0; k < n; ++k) digits[face.corners[k]] = index / power_of_three(k) % 3;
            digits[corners] = index / power_of_three(n + 1);
            std::size_t all = 0;
            for (std::size_t k = 0; k <= corners; ++k) all += digits[k] * power_of_three(k);
            out.begin(places, all);
            out.add_cell(kind, std::span(corners_in_order).first(corners));
            out.add_cell(n == 3 ? core::CellKind::tetrahedron : core::CellKind::pyramid, neighbour);
        }
    }
    return out.take();
}

} // namespace isotet::test
