// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The named parts of a grid's boundary (BoundaryPatches): gathering, checking, other numbers of points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/result.hpp>

namespace isotet::core {

/// True for VTK's numbers of triangles, polygons and quadrilaterals of any degree.
constexpr bool is_flat_cell(std::uint8_t type) {
    return (type >= 5 && type <= 9) || type == 22 || type == 23 || type == 28 || type == 30 || type == 34 || type == 36 ||
           type == 69 || type == 70 || type == 76 || type == 77;
}

/// True for numbers that VTK may give to cells with a volume, linear or not.
constexpr bool has_a_volume(std::uint8_t type) {
    constexpr std::uint8_t first_solid = 10, quadratic_edge = 21, cubic_line = 35, lagrange_curve = 68, bezier_curve = 75;
    return type >= first_solid && !is_flat_cell(type) && type != quadratic_edge && type != cubic_line &&
           type != lagrange_curve && type != bezier_curve;
}

/// Gathers faces.
class PatchList {
public:
    /// The number of a patch by its name: from 0, in the order in which names are first asked for.
    std::int64_t number_of(const std::string& name) {
        for (const PatchName& known : names_)
            if (known.name == name) return known.number;
        names_.push_back({static_cast<std::int64_t>(names_.size()), name});
        return names_.back().number;
    }
    /// Names a number that the file states. The first name counts.
    void name(std::int64_t number, const std::string& name) {
        for (const PatchName& known : names_)
            if (known.number == number) return;
        names_.push_back({number, name});
    }
    void point(std::int64_t number) { points_.push_back(number); }
    /// The points since the last face are one of this patch; no points are none.
    void end_face(std::int64_t patch) {
        if (static_cast<std::int64_t>(points_.size()) == offsets_.back()) return;
        offsets_.push_back(static_cast<std::int64_t>(points_.size()));
        numbers_.push_back(patch);
    }
    BoundaryPatches finish() {
        if (numbers_.empty()) return {{}, {}, {}, std::move(names_)};
        return {Array::own(std::move(points_)), Array::own(std::move(offsets_)), Array::own(std::move(numbers_)),
                std::move(names_)};
    }

private:
    std::vector<std::int64_t> points_, offsets_{0}, numbers_;
    std::vector<PatchName> names_;
};

/// Adds the faces of some patches with other numbers of points: number_of(point), below 0 for one that is not there.
template <class NumberOf>
void append_patches(const BoundaryPatches& from, const NumberOf& number_of, PatchList& to) {
    for (const PatchName& patch : from.names) to.name(patch.number, patch.name);
    for (std::size_t face = 0; face < from.count(); ++face) {
        const auto begin = from.offsets.as<std::int64_t>()[face], end = from.offsets.as<std::int64_t>()[face + 1];
        for (std::int64_t i = begin; i < end; ++i) {
            const auto point = from.points.as<std::int64_t>()[static_cast<std::size_t>(i)];
            if (const std::int64_t number = number_of(static_cast<std::uint64_t>(point)); number >= 0) to.point(number);
        }
        to.end_face(from.numbers.as<std::int64_t>()[face]);
    }
}

/// The same patches with other numbers of points.
template <class NumberOf>
BoundaryPatches renumbered(const BoundaryPatches& from, const NumberOf& number_of) {
    PatchList list;
    append_patches(from, number_of, list);
    return list.finish();
}

/// Errors   invalid_data: arrays of other types or lengths, offsets that fall, points that the grid does not have
ISOTET_API Result<void> check_patches(const Grid& grid);

} // namespace isotet::core
