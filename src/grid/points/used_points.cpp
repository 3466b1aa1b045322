// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/points/used_points.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <type_traits>
#include <utility>

#include "base/parallel.hpp"
#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "grid/patches.hpp"

namespace isotet::core {

namespace {

/// Calls visit(cell, place in the stream, point) for the points of all faces. False where the stream does not fit, which the
/// checks of what was read tell.
template <class Visit>
bool each_point_of_faces(const FaceReader& faces, std::size_t cells, const Visit& visit) {
    for (std::size_t cell = 0; cell < cells; ++cell) {
        if (!fault_of_faces(faces, cell, std::numeric_limits<std::uint64_t>::max()).empty()) return false;
        for (std::uint64_t at = faces.begin(cell) + 1; at < faces.end(cell);)
            for (std::uint64_t left = faces.at(at++); left > 0; --left, ++at) visit(cell, at, faces.at(at));
    }
    return true;
}

/// Streams that do not fit stay.
template <class Number>
void renumber_faces(Cells& cells, const Number& number) {
    const auto faces = FaceReader::open(cells);
    if (!faces || !faces->has_faces()) return;
    std::vector<std::int64_t> stream(cells.faces.size());
    for (std::size_t i = 0; i < stream.size(); ++i) stream[i] = static_cast<std::int64_t>(faces->at(i));
    if (each_point_of_faces(*faces, cells.count(),
                            [&](std::size_t, std::uint64_t at, std::uint64_t point) { stream[at] = number(point); }))
        cells.faces = Array::own(std::move(stream));
}

} // namespace

std::vector<std::uint8_t> points_of_cells(const CellReader& cells,
                                          const std::function<bool(std::size_t cell)>& counts) {
    std::vector<std::uint8_t> used(cells.points());
    parallel_each(cells.count(), 1 << 14, [&](std::size_t cell) {
        if (!counts(cell)) return;
        const std::uint64_t first = cells.first(cell), end = first + cells.corners(cell);
        for (std::uint64_t i = first; i < end; ++i)
            std::atomic_ref(used[cells.corner(i)]).store(1, std::memory_order_relaxed);
    });
    return used;
}

void mark_points_of_faces(const Cells& cells, std::vector<std::uint8_t>& used,
                          const std::function<bool(std::size_t cell)>& counts) {
    const auto faces = FaceReader::open(cells);
    if (!faces || !faces->has_faces()) return;
    each_point_of_faces(*faces, cells.count(), [&](std::size_t cell, std::uint64_t, std::uint64_t point) {
        if (point < used.size() && counts(cell)) used[point] = 1;
    });
}

std::vector<std::uint8_t> keep_used_points(Grid& grid) {
    std::vector<std::uint8_t> used(grid.points.tuples());
    IndexColumn(grid.cells.connectivity).visit([&](const auto* corners) {
        for (std::size_t i = 0; i < grid.cells.connectivity.size(); ++i)
            if (const std::uint64_t point = widened(corners[i]); point < used.size()) used[point] = 1;
    });
    mark_points_of_faces(grid.cells, used, [](std::size_t) { return true; });
    std::vector<std::int64_t> place(used.size(), -1);
    std::int64_t next = 0;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i]) place[i] = next++;
    if (static_cast<std::size_t>(next) == used.size()) return {};
    const auto number = [&](std::uint64_t point) { return point < place.size() ? place[point] : next; };
    std::vector<std::int64_t> corners(grid.cells.connectivity.size());
    IndexColumn(grid.cells.connectivity).visit([&](const auto* from) {
        for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = number(widened(from[i]));
    });
    grid.patches = renumbered(
        grid.patches, [&](std::uint64_t point) { return point < place.size() ? place[point] : std::int64_t{-1}; });
    renumber_faces(grid.cells, number);
    grid.cells.connectivity = Array::own(std::move(corners));
    grid.points = kept_tuples(grid.points, used);
    grid.point_numbers = kept_tuples(grid.point_numbers, used);
    for (Field& field : grid.point_fields) field.values = kept_tuples(field.values, used);
    return used;
}

Array kept_tuples(const Array& values, const std::vector<std::uint8_t>& kept) {
    if (values.empty()) return values;
    return values.visit([&](auto from) {
        using Value = std::remove_const_t<typename decltype(from)::value_type>;
        const std::size_t width = values.components();
        const auto count = static_cast<std::size_t>(std::ranges::count(kept, 1));
        std::vector<Value> to;
        to.reserve(count * width);
        for (std::size_t i = 0; i < kept.size(); ++i)
            if (kept[i]) to.insert(to.end(), from.begin() + i * width, from.begin() + (i + 1) * width);
        return Array::own(std::move(to), width);
    });
}

} // namespace isotet::core
