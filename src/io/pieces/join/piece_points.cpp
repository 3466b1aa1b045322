// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join/piece_points.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <string>

#include <fmt/core.h>

#include "base/parallel.hpp"
#include "grid/orientation.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/join/face_streams.hpp"
#include "io/pieces/uniform_cells.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t points_at_once = std::size_t{1} << 15;

Error wrong_piece(const Piece& piece, const std::string& what) {
    return {ErrorCode::invalid_data, fmt::format("piece \"{}\": {}", escaped(piece.name), what)};
}

bool is_index(const Array& array) {
    return array.empty() || (!is_floating(array.type()) && size_of(array.type()) >= 4 && array.components() == 1);
}

std::optional<std::string> misfit(const Piece& piece) {
    const Cells& cells = piece.grid.cells;
    if (piece.grid.points.components() != 3) return "its points do not have three coordinates";
    if (!is_floating(piece.grid.points.type())) return "its points are neither float32 nor float64";
    if (!is_index(cells.connectivity) || !is_index(cells.offsets)) return "its cells are not told by integers";
    if (cells.types.empty() && cells.offsets.size() > 1) return "its cells have no types";
    if (!cells.types.empty() && cells.offsets.tuples() != cells.types.tuples() + 1)
        return fmt::format("it has {} cell types and {} offsets", cells.types.tuples(), cells.offsets.tuples());
    if (cells.types.size() > 0 && cells.types.type() != ScalarType::uint8) return "its cell types are not bytes";
    if (cells.types.empty() && !vtk_xml::corners_of_uniform(static_cast<std::uint8_t>(cells.uniform_type)))
        return fmt::format("its cells are of type {}", static_cast<int>(cells.uniform_type));
    const std::size_t points = piece.grid.points.tuples(), count = cells.count();
    for (const Field& field : piece.grid.point_fields)
        if (field.values.tuples() != points)
            return fmt::format("its point field \"{}\" has {} values for {} points", escaped(field.name),
                               field.values.tuples(), points);
    for (const Field& field : piece.grid.cell_fields)
        if (field.values.tuples() != count)
            return fmt::format("its cell field \"{}\" has {} values for {} cells", escaped(field.name),
                               field.values.tuples(), count);
    if (!piece.point_ids.empty() && piece.point_ids.size() != points) return "it does not have one number a point";
    if (!piece.cell_ids.empty() && piece.cell_ids.size() != count) return "it does not have one number a cell";
    if (!piece.left_out.empty() && piece.left_out.size() != count) return "it does not have one ghost mark a cell";
    return std::nullopt;
}

/// What is wrong with a cell; nothing where its corners are points of the piece.
std::optional<std::string> fault_of_cell(const PieceCells& cells, std::size_t cell, std::uint64_t points) {
    const std::uint64_t begin = cells.begin(cell), end = cells.begin(cell + 1);
    if (end < begin || end > cells.corners())
        return fmt::format("cell {} has corners {} to {} of {}", cell, begin, end, cells.corners());
    for (std::uint64_t i = begin; i < end; ++i)
        if (cells.corner(i) >= points)
            return fmt::format("cell {} has point {}, but there are {} points", cell,
                               static_cast<std::int64_t>(cells.corner(i)), points);
    return std::nullopt;
}

/// Marks the points of cells [first, last); false where a cell is broken.
bool mark(const PieceCells& cells, const std::vector<std::uint8_t>& left_out, std::size_t first, std::size_t last,
          std::vector<PointUse>& use) {
    for (std::size_t cell = first; cell < last; ++cell) {
        const std::uint64_t begin = cells.begin(cell), end = cells.begin(cell + 1);
        if (end < begin || end > cells.corners()) return false;
        const PointUse now = !left_out.empty() && left_out[cell] != 0 ? PointUse::left_out : PointUse::kept;
        for (std::uint64_t i = begin; i < end; ++i) {
            const std::uint64_t point = cells.corner(i);
            if (point >= use.size()) return false;
            const std::atomic_ref mark(use[point]);
            PointUse known = mark.load(std::memory_order_relaxed);
            while (known < now && !mark.compare_exchange_weak(known, now, std::memory_order_relaxed)) {}
        }
    }
    return true;
}

} // namespace

PieceCells::PieceCells(const Cells& cells)
    : connectivity_(cells.connectivity),
      offsets_(cells.offsets),
      types_(cells.types.empty() ? nullptr : cells.types.as<std::uint8_t>().data()),
      count_(cells.count()),
      corners_(cells.connectivity.size()),
      uniform_type_(static_cast<std::uint8_t>(cells.uniform_type)),
      uniform_corners_(vtk_xml::corners_of_uniform(uniform_type_).value_or(0)),
      has_offsets_(!cells.types.empty()) {}

Result<void> check_shape(const Piece& piece) {
    const auto what = misfit(piece);
    return what ? Result<void>(wrong_piece(piece, *what)) : Result<void>();
}

Result<std::vector<PointUse>> check_piece(const Piece& piece) {
    if (auto sound = check_shape(piece); !sound) return sound.error();
    const std::size_t points = piece.grid.points.tuples();
    std::vector<PointUse> use(points);
    const PieceCells cells(piece.grid.cells);
    std::atomic<bool> sound = true;
    core::parallel_ranges(cells.count(), points_at_once, [&](std::size_t begin, std::size_t end) {
        if (sound && !mark(cells, piece.left_out, begin, end, use)) sound = false;
    });
    for (std::size_t cell = 0; !sound && cell < cells.count(); ++cell)
        if (const auto what = fault_of_cell(cells, cell, points)) return wrong_piece(piece, *what);
    if (const auto faces = check_face_streams(piece.grid.cells, points); !faces)
        return wrong_piece(piece, faces.error().message);
    return use;
}

void Box::add(const Box& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lower[axis] = std::min(lower[axis], other.lower[axis]);
        upper[axis] = std::max(upper[axis], other.upper[axis]);
    }
}

bool Box::meets(const Box& other, double margin) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(lower[axis] - margin <= other.upper[axis] && other.lower[axis] - margin <= upper[axis])) return false;
    return true;
}

Box box_of(const Array& points, std::span<const PointUse> use) {
    const core::PointReader places(points);
    Box box;
    std::mutex mutex;
    core::parallel_ranges(points.tuples(), points_at_once, [&](std::size_t begin, std::size_t end) {
        Box part;
        for (std::size_t i = begin; i < end; ++i) {
            if (!use.empty() && use[i] != PointUse::kept) continue;
            const core::Point place = places[i];
            if (std::isfinite(place[0]) && std::isfinite(place[1]) && std::isfinite(place[2])) part.add({place, place});
        }
        const std::lock_guard lock(mutex);
        box.add(part);
    });
    return box;
}

} // namespace isotet::io
