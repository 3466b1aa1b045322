// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Whether the card makes the surfaces that the processor does, of a small grid of all kinds of cells.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "card.hpp"

namespace isotet::web {

namespace {

constexpr int side = 9; ///< cubes each way: several clusters

/// Corners by bits: x, y, z.
struct CellOfCube {
    std::uint8_t type; ///< VTK's
    std::vector<int> corners;
};
const std::vector<CellOfCube>& cells_of_cube(int kind) {
    static const std::array<std::vector<CellOfCube>, 4> cells{
        {{{12, {0, 1, 3, 2, 4, 5, 7, 6}}},
         {{13, {0, 2, 1, 4, 6, 5}}, {13, {1, 2, 3, 5, 6, 7}}},
         {{14, {0, 1, 3, 2, 4}}, {14, {1, 5, 7, 3, 4}}, {14, {2, 3, 7, 6, 4}}},
         {{10, {0, 1, 3, 7}},
          {10, {0, 3, 2, 7}},
          {10, {0, 2, 6, 7}},
          {10, {0, 6, 4, 7}},
          {10, {0, 4, 5, 7}},
          {10, {0, 5, 1, 7}}}}};
    return cells[static_cast<std::size_t>(kind)];
}

/// In the first half of the cubes tets, then cells of all kinds; neighbours need not fit. Whole numbers, so that there
/// are ties with the isovalue 0, and edges of many clusters; a point without data.
Result<PackedGrid> small_grid() {
    constexpr int row = side + 1;
    std::vector<float> points, values;
    for (int i = 0; i < row * row * row; ++i) {
        const std::array<int, 3> at{i % row, i / row % row, i / row / row};
        for (const int axis : at) points.push_back(static_cast<float>(axis) / 7 + 0.1F);
        values.push_back(static_cast<float>((at[0] * at[0] * 7 + at[1] * (5 + at[2]) + at[2] * 3) % 13 - 6));
    }
    values[values.size() / 3] = std::numeric_limits<float>::quiet_NaN();
    std::vector<std::int32_t> corners, offsets{0};
    std::vector<std::uint8_t> types;
    for (int cube = 0; cube < side * side * side; ++cube) {
        const int first = cube % side + row * (cube / side % side + row * (cube / side / side));
        for (const CellOfCube& cell : cells_of_cube(2 * cube < side * side * side ? 3 : cube % 4)) {
            for (const int corner : cell.corners)
                corners.push_back(first + (corner & 1) + row * (corner >> 1 & 1) + row * row * (corner >> 2));
            offsets.push_back(static_cast<std::int32_t>(corners.size()));
            types.push_back(cell.type);
        }
    }
    Grid grid;
    grid.points = Array::own(std::move(points), 3);
    grid.cells.connectivity = Array::own(std::move(corners));
    grid.cells.offsets = Array::own(std::move(offsets));
    grid.cells.types = Array::own(std::move(types));
    return pack(grid, {"values", Array::own(std::move(values))}, {}, {1, {}});
}

/// How many floats lie between two, one of them counted.
std::int64_t steps_between(float a, float b) {
    const auto place = [](float x) {
        const auto bits = std::bit_cast<std::int32_t>(x);
        return std::int64_t{bits < 0 ? std::numeric_limits<std::int32_t>::min() - bits : bits};
    };
    return std::abs(place(a) - place(b));
}

/// The same triangles, and vertices within one unit in the last place.
bool is_like(const Surface& found, const Surface& right) {
    if (found.triangles.bytes() != right.triangles.bytes() || found.positions.bytes() != right.positions.bytes())
        return false;
    if (std::memcmp(found.triangles.data(), right.triangles.data(), right.triangles.bytes()) != 0) return false;
    const auto a = found.positions.as<float>(), b = right.positions.as<float>();
    for (std::size_t i = 0; i < a.size(); ++i)
        if (steps_between(a[i], b[i]) > 1) return false;
    return true;
}

} // namespace

Result<void> test_card() {
    static std::optional<PackedGrid> grid;
    if (!grid) {
        Result<PackedGrid> made = small_grid();
        if (!made) return made.error();
        grid = *made;
    }
    for (const double isovalue : {0.0, 0.3}) {
        const Result<Extraction> found = card().extract(*grid, isovalue, {});
        if (!found) return found.error();
        const Result<Extraction> right = extract(*grid, isovalue, {}, {1, {}});
        if (!right) return right.error();
        if (right->surface.triangles.size() == 0 || !is_like(found->surface, right->surface))
            return Error{ErrorCode::no_device, "it gives another surface of a small grid than the processor does"};
    }
    grid.reset();
    return {};
}

} // namespace isotet::web
