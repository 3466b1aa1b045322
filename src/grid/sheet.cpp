// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <isotet/grid.hpp>

#include "base/errors.hpp"
#include "grid/boundary_faces.hpp"
#include "grid/cells.hpp"
#include "grid/patches.hpp"

namespace isotet::core {

namespace {

enum FlatType : std::uint8_t {
    triangle_strip = 6,
    polygon = 7,
    pixel = 8,
    quad = 9,
    quadratic_triangle = 22,
    quadratic_quad = 23,
    biquadratic_quad = 28,
    quadratic_linear_quad = 30,
    biquadratic_triangle = 34,
    quadratic_polygon = 36,
    lagrange_triangle = 69,
    lagrange_quadrilateral = 70,
    bezier_triangle = 76,
    bezier_quadrilateral = 77
};

constexpr std::uint64_t nodes_needed(std::uint8_t type) {
    switch (type) {
    case pixel:
    case quad:
    case lagrange_quadrilateral:
    case bezier_quadrilateral: return 4;
    case quadratic_triangle:
    case quadratic_linear_quad:
    case quadratic_polygon: return 6;
    case biquadratic_triangle: return 7;
    case quadratic_quad: return 8;
    case biquadratic_quad: return 9;
    default: return 3;
    }
}

Error broken(const CellReader& cells, std::size_t cell) {
    return invalid_data(
        fmt::format("cells[{}] ({}) has {} corners, too few for its type or of points that are not there: "
                    "the grid has {} points",
                    cell, name_of_cell_type(cells.type(cell)), cells.corners(cell), cells.points()));
}

/// Gathers triangles of cells, by places in the connectivity.
class TriangleList {
public:
    explicit TriangleList(const CellReader& reader) : cells_(reader) {}

    /// False: the cell has too few nodes, or points that are not there.
    bool add_cell(std::size_t cell) {
        const std::uint8_t type = cells_.type(cell);
        if (!is_flat_cell(type)) return true;
        cell_ = cell;
        first_ = cells_.first(cell);
        const std::uint64_t count = cells_.corners(cell);
        if (count < 3 && (type == polygon || type == triangle_strip)) return true; // without an area
        if (count < nodes_needed(type)) return false;
        for (std::uint64_t i = 0; i < count; ++i)
            if (cells_.corner(first_ + i) >= cells_.points()) return false;
        split(type, count);
        return true;
    }

    std::vector<std::array<std::uint64_t, 3>> triangles; ///< corners are points
    std::vector<std::int64_t> cells;                     ///< of each triangle

private:
    void split(std::uint8_t type, std::uint64_t count) {
        switch (type) {
        case triangle_strip:
            for (std::uint64_t i = 0; i + 2 < count; ++i) i % 2 == 0 ? add(i, i + 1, i + 2) : add(i + 1, i, i + 2);
            return;
        case pixel: add(0, 1, 3), add(0, 3, 2); return;
        case quadratic_triangle: return add_quadratic(3, false);
        case biquadratic_triangle: return add_quadratic(3, true);
        case quadratic_quad: return add_quadratic(4, false);
        case biquadratic_quad: return add_quadratic(4, true);
        case quadratic_polygon: return add_quadratic(count / 2, false);
        case quadratic_linear_quad: add(0, 4, 5), add(0, 5, 3), add(4, 1, 2), add(4, 2, 5); return;
        case lagrange_triangle:
        case bezier_triangle: add(0, 1, 2); return;
        case lagrange_quadrilateral:
        case bezier_quadrilateral: return add_fan(4);
        default: add_fan(count);
        }
    }
    void add(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
        const std::array<std::uint64_t, 3> corners{cells_.corner(first_ + a), cells_.corner(first_ + b),
                                                   cells_.corner(first_ + c)};
        if (corners[0] == corners[1] || corners[0] == corners[2] || corners[1] == corners[2]) return;
        triangles.push_back(corners);
        cells.push_back(static_cast<std::int64_t>(cell_));
    }
    void add_fan(std::uint64_t corners) {
        for (std::uint64_t i = 1; i + 1 < corners; ++i) add(0, i, i + 1);
    }
    /// The corners with the middles of their edges, and what the middles enclose.
    void add_quadratic(std::uint64_t corners, bool has_centre) {
        for (std::uint64_t i = 0; i < corners; ++i) add(corners + (i + corners - 1) % corners, i, corners + i);
        for (std::uint64_t i = 0; has_centre && i < corners; ++i)
            add(2 * corners, corners + i, corners + (i + 1) % corners);
        for (std::uint64_t i = 1; !has_centre && i + 1 < corners; ++i) add(corners, corners + i, corners + i + 1);
    }

    const CellReader& cells_;
    std::size_t cell_ = 0;
    std::uint64_t first_ = 0;
};

/// The points that triangles use, ascending; corners become their places among them.
std::vector<std::uint64_t> number_points(std::vector<std::array<std::uint64_t, 3>>& triangles, std::uint64_t points) {
    std::vector<std::uint64_t> place(points, 0);
    for (const auto& corners : triangles)
        for (const std::uint64_t corner : corners) place[corner] = 1;
    std::vector<std::uint64_t> used;
    for (std::uint64_t point = 0; point < points; ++point)
        if (place[point] == 1) {
            place[point] = used.size();
            used.push_back(point);
        }
    for (auto& corners : triangles)
        for (std::uint64_t& corner : corners) corner = place[corner];
    return used;
}

/// As check_cells() asks of contoured cells.
Result<void> check_places(const Array& points, const std::vector<std::uint64_t>& used) {
    for (const std::uint64_t point : used)
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (const double x = points.at(point, axis); !(std::abs(x) < 0x1p91))
                return invalid_data(
                    fmt::format("points[{}] has {} coordinate {}, but cells use the point, and coordinates "
                                "must be finite and below 2^91",
                                point, "xyz"[axis], x));
    return {};
}

} // namespace

Result<Surface> sheet_of(const Grid& grid, const Progress& progress) {
    const auto cells = CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto ok = check_cells(grid, *cells, progress); !ok) return ok.error();
    TriangleList list(*cells);
    constexpr std::size_t cells_between_looks = 1 << 16;
    for (std::size_t cell = 0; cell < cells->count(); ++cell) {
        if (cell % cells_between_looks == 0 && progress.cancelled())
            return Error{ErrorCode::cancelled, "finding the boundary was cancelled"};
        if (!list.add_cell(cell)) return broken(*cells, cell);
    }
    const std::vector<std::uint64_t> used = number_points(list.triangles, grid.points.tuples());
    if (used.size() > std::numeric_limits<std::uint32_t>::max())
        return invalid_data("flat cells have more than 2^32 points, but a surface that is drawn has fewer");
    if (auto sound = check_places(grid.points, used); !sound) return sound.error();
    Surface surface;
    place_vertices(surface, grid.points, used);
    std::vector<std::uint32_t> triangles(3 * list.triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
        triangles[i] = static_cast<std::uint32_t>(list.triangles[i / 3][i % 3]);
    surface.triangles = Array::own(std::move(triangles), 3);
    surface.source_cells = Array::own(std::move(list.cells));
    return surface;
}

} // namespace isotet::core

namespace isotet {

bool has_only_flat_cells(const Cells& cells) {
    if (cells.types.type() != ScalarType::uint8 || cells.types.empty())
        return cells.count() > 0 && core::is_flat_cell(static_cast<std::uint8_t>(cells.uniform_type));
    const auto types = cells.types.as<std::uint8_t>();
    return std::ranges::none_of(types, core::has_a_volume) && std::ranges::any_of(types, core::is_flat_cell);
}

} // namespace isotet
