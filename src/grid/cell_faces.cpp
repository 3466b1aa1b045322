// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/cell_faces.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/orientation.hpp"

namespace isotet::core {

namespace {

bool holds_face_indices(const Array& array) {
    return !is_floating(array.type()) && size_of(array.type()) >= 4 && array.components() == 1;
}

std::string fault_of_point(const Grid& grid, std::uint64_t point) {
    constexpr double limit = 0x1p91;
    if (point < grid.points.tuples()) {
        const Point place = PointReader(grid.points)[point];
        if (std::abs(place[0]) < limit && std::abs(place[1]) < limit && std::abs(place[2]) < limit) return {};
    }
    if (point >= grid.points.tuples())
        return fmt::format("has point {}, but the grid has {} points", static_cast<std::int64_t>(point),
                           grid.points.tuples());
    return fmt::format("has point {}, whose coordinates are not finite and below 2^91", point);
}

/// What is wrong with a cell; empty: nothing.
/// `sound`   all points are: then a face's need no look beside that of fault_of_faces()
std::string fault_of_polyhedron(const Grid& grid, const CellReader& cells, const FaceReader& faces, std::size_t cell,
                                bool sound) {
    if (std::string fault = fault_of_faces(faces, cell, cells.points()); !fault.empty()) return fault;
    if (cells.type(cell) != polyhedron_type || faces.begin(cell) == faces.end(cell)) return {};
    const std::uint64_t first = cells.first(cell), corners = cells.corners(cell);
    for (std::uint64_t i = first; i < first + corners; ++i) {
        if (sound && cells.corner(i) < cells.points()) continue;
        if (std::string fault = fault_of_point(grid, cells.corner(i)); !fault.empty()) return fault;
    }
    if (sound) return {};
    std::uint64_t at = faces.begin(cell) + 1;
    while (at < faces.end(cell))
        for (const std::uint64_t end = at + faces.at(at) + 1; ++at < end;)
            if (std::string fault = fault_of_point(grid, faces.at(at)); !fault.empty()) return fault;
    return {};
}

} // namespace

std::string fault_of_faces(const FaceReader& faces, std::size_t cell, std::uint64_t points) {
    const std::uint64_t begin = faces.begin(cell), end = faces.end(cell);
    if (begin > end || end > faces.size())
        return fmt::format("has faces {} to {}, but there are {} entries, and offsets must not fall",
                           static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end), faces.size());
    if (begin == end) return {};
    std::uint64_t at = begin + 1;
    for (std::uint64_t face = 0; face < faces.at(begin); ++face) {
        const std::uint64_t count = at < end ? faces.at(at) : 0;
        if (at >= end || count > end - at - 1)
            return fmt::format("has {} faces, but its {} entries end in face {}",
                               static_cast<std::int64_t>(faces.at(begin)), end - begin, face);
        for (std::uint64_t i = at + 1; i <= at + count; ++i)
            if (faces.at(i) >= points)
                return fmt::format("has a face with point {}, but the grid has {} points",
                                   static_cast<std::int64_t>(faces.at(i)), points);
        at += count + 1;
    }
    if (at != end)
        return fmt::format("has {} faces in {} entries, but {} are left over", faces.at(begin), end - begin, end - at);
    return {};
}

Result<FaceReader> FaceReader::open(const Cells& cells) {
    FaceReader reader;
    if (cells.faces.empty()) return reader;
    if (!holds_face_indices(cells.faces) || !holds_face_indices(cells.face_offsets))
        return invalid_data(
            fmt::format("faces are {} with offsets of {}, but both must be 32- or 64-bit integers with 1 "
                        "component",
                        name_of(cells.faces.type()), name_of(cells.face_offsets.type())));
    if (cells.face_offsets.tuples() != cells.count() + 1)
        return invalid_data(
            fmt::format("there are {} offsets of faces for {} cells, but there must be one more than cells",
                        cells.face_offsets.tuples(), cells.count()));
    reader.stream_ = IndexColumn(cells.faces);
    reader.offsets_ = IndexColumn(cells.face_offsets);
    reader.size_ = cells.faces.tuples();
    reader.has_faces_ = true;
    return reader;
}

Result<void> check_faces(const Grid& grid, const CellReader& cells, const Progress& progress) {
    const auto faces = FaceReader::open(grid.cells);
    if (!faces) return faces.error();
    if (!faces->has_faces()) return {};
    std::atomic<std::size_t> lowest{std::numeric_limits<std::size_t>::max()};
    const bool sound = all_points_are_sound(grid);
    parallel_pieces(cells.count(), 1 << 12, progress, [&](std::size_t begin, std::size_t end) {
        if (begin > lowest.load(std::memory_order_relaxed)) return;
        for (std::size_t cell = begin; cell < end; ++cell) {
            if (fault_of_polyhedron(grid, cells, *faces, cell, sound).empty()) continue;
            std::size_t seen = lowest.load(std::memory_order_relaxed);
            while (cell < seen && !lowest.compare_exchange_weak(seen, cell, std::memory_order_relaxed)) {}
            return;
        }
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "checking the faces was cancelled"};
    if (const std::size_t cell = lowest.load(); cell < cells.count())
        return invalid_data(fmt::format("cells[{}] ({}) {}", cell, name_of_cell_type(cells.type(cell)),
                                        fault_of_polyhedron(grid, cells, *faces, cell, sound)));
    return {};
}

} // namespace isotet::core
