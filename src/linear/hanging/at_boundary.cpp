// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Hanging points by the faces of a boundary alone: a face that smaller ones cover, and these, have no neighbour.
#include <isotet/active_cells.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "linear/checked_cells.hpp"
#include "linear/hanging/covers.hpp"
#include "linear/hanging/lone_faces.hpp"

namespace isotet {

namespace linear {

namespace {

/// By point: what it is of the triangles of a boundary.
class BoundaryPoints {
public:
    BoundaryPoints(const Surface& boundary, std::size_t points) : marks_(points) {
        const auto ends = boundary.edge_ends.as<std::int64_t>();
        boundary.triangles.visit([&](auto corners) {
            for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
                std::size_t lowest = points;
                for (std::size_t k = i; k < i + 3; ++k) {
                    const auto point = static_cast<std::size_t>(ends[2 * static_cast<std::size_t>(corners[k])]);
                    marks_[point] |= any;
                    lowest = std::min(lowest, point);
                }
                marks_[lowest] |= lowest_of_some;
            }
        });
    }

    bool has(std::uint64_t point) const { return marks_[point] != 0; }
    bool has_all(std::span<const std::uint64_t> loop) const {
        return std::ranges::all_of(loop, [&](std::uint64_t point) { return has(point); });
    }
    /// All cells with a face whose lowest point it is are there.
    bool is_lowest(std::uint64_t point) const { return (marks_[point] & lowest_of_some) != 0; }

private:
    static constexpr std::uint8_t any = 1, lowest_of_some = 2;

    std::vector<std::uint8_t> marks_;
};

bool fits(const Surface& boundary, std::uint64_t points) {
    if (boundary.edge_ends.type() != ScalarType::int64 || boundary.edge_ends.components() != 2) return false;
    const auto ends = boundary.edge_ends.as<std::int64_t>();
    const auto is_there = [&](std::int64_t point) { return static_cast<std::uint64_t>(point) < points; };
    const std::size_t vertices = ends.size() / 2;
    return std::ranges::all_of(ends, is_there) && boundary.triangles.visit([&](auto corners) {
        return std::ranges::all_of(corners, [&](auto corner) { return static_cast<std::uint64_t>(corner) < vertices; });
    });
}

/// The faces of the boundary, by the cells that have them.
Result<OpenFaces> faces_at(const BoundaryPoints& points, const core::CellReader& cells, const core::FaceReader& faces,
                           const Progress& progress) {
    const auto has_cell = [&](std::size_t cell) {
        std::size_t marked = 0;
        for (std::uint64_t i = cells.first(cell), n = i + cells.corners(cell); i < n; ++i)
            marked += points.has(cells.corner(i));
        return marked >= 3;
    };
    const auto has_face = [&](FaceWalk& walk, const OpenFaces::Place& place, const FaceHash& hash) {
        return points.is_lowest(hash.lowest) && points.has_all(walk.loop(place));
    };
    const auto found = lone_faces(cells, faces, has_cell, has_face, progress);
    if (!found) return found.error();
    return with_loops(*found, cells, faces);
}

} // namespace
} // namespace linear

Result<bool> has_hanging_points(const Grid& around, const Surface& boundary, const Run& run) {
    return core::carry_out("looking for hanging points", run, [&](const Progress& progress) -> Result<bool> {
        const auto all = linear::checked_cells(around, progress);
        if (!all) return all.error();
        const std::uint64_t points = all->cells.points();
        if (!linear::fits(boundary, points))
            return invalid_argument(fmt::format("the surface is no boundary of a grid of {} points", points));
        if (auto enough = core::require_memory("looking for hanging points", 9 * points); !enough)
            return enough.error();
        const auto faces =
            linear::faces_at({boundary, static_cast<std::size_t>(points)}, all->cells, all->faces, progress);
        if (!faces) return faces.error();
        const core::PointReader places(around.points);
        const auto covers = linear::find_covers(*faces, all->cells, places, progress);
        if (!covers) return covers.error();
        return !covers->whole.empty() || !covers->open.empty();
    });
}

} // namespace isotet
