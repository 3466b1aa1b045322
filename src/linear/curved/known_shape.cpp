// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/known_shape.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "grid/cell/native_cells.hpp"

namespace isotet::linear {

namespace {

using core::CellKind;
using core::WholeCell;

std::optional<CellKind> kind_by_faces(const Shell& shell) {
    std::size_t triangles = 0, quads = 0;
    for (std::size_t face = 0; face < shell.face_count(); ++face) {
        triangles += shell.loop(face).size() == 3;
        quads += shell.loop(face).size() == 4;
    }
    if (triangles + quads != shell.face_count()) return std::nullopt;
    const std::size_t points = shell.points().size();
    if (triangles == 4 && quads == 0 && points == 4) return CellKind::tetrahedron;
    if (triangles == 4 && quads == 1 && points == 5) return CellKind::pyramid;
    if (triangles == 2 && quads == 3 && points == 6) return CellKind::wedge;
    if (triangles == 0 && quads == 6 && points == 8) return CellKind::hexahedron;
    return std::nullopt;
}

std::array<std::uint64_t, 4> canonical_loop(std::array<std::uint64_t, 4> loop, std::size_t count) {
    const auto end = loop.begin() + static_cast<std::ptrdiff_t>(count);
    std::rotate(loop.begin(), std::min_element(loop.begin(), end), end);
    if (*(end - 1) < loop[1]) std::reverse(loop.begin() + 1, end);
    return loop;
}

/// True when the faces of the cell are those of the shell.
bool has_faces_of(const WholeCell& cell, const Shell& shell) {
    if (core::has_repeated_corner(cell)) return false;
    for (const core::CellFace& face : core::shape_of(cell.kind).faces()) {
        std::array<std::uint64_t, 4> loop{};
        for (std::size_t k = 0; k < face.count; ++k) loop[k] = cell.corners[face.corners[k]];
        loop = canonical_loop(loop, face.count);
        bool found = false;
        for (std::size_t f = 0; f < shell.face_count() && !found; ++f)
            found = std::ranges::equal(shell.loop(f), std::span(loop).first(face.count));
        if (!found) return false;
    }
    return true;
}

/// The points that edges connect with one, ascending.
std::vector<std::uint64_t> neighbours_of(const Shell& shell, std::uint64_t point) {
    std::vector<std::uint64_t> out;
    for (std::size_t i = 0; i < shell.edges().size(); i += 2) { // each edge is there twice
        const Shell::Edge& edge = shell.edges()[i];
        if (edge.low == point) out.push_back(edge.high);
        if (edge.high == point) out.push_back(edge.low);
    }
    std::ranges::sort(out);
    return out;
}

/// A cell over a base: corners of the base, then for each the neighbour outside of it.
WholeCell over_base(const Shell& shell, CellKind kind, std::span<const std::uint64_t> base) {
    WholeCell cell{kind, {}};
    std::ranges::copy(base, cell.corners.begin());
    for (std::size_t k = 0; k < base.size(); ++k)
        for (const std::uint64_t other : neighbours_of(shell, base[k]))
            if (std::ranges::find(base, other) == base.end()) cell.corners[base.size() + k] = other;
    return cell;
}

std::span<const std::uint64_t> first_loop(const Shell& shell, std::size_t points) {
    for (std::size_t face = 0; face < shell.face_count(); ++face)
        if (shell.loop(face).size() == points) return shell.loop(face);
    return {};
}

WholeCell ordered(const Shell& shell, CellKind kind) {
    WholeCell cell{kind, {}};
    switch (kind) {
    case CellKind::tetrahedron: std::ranges::copy(shell.points(), cell.corners.begin()); break;
    case CellKind::pyramid: {
        const auto base = first_loop(shell, 4);
        std::ranges::copy(base, cell.corners.begin());
        for (const std::uint64_t point : shell.points())
            if (std::ranges::find(base, point) == base.end()) cell.corners[4] = point;
        break;
    }
    case CellKind::wedge: return over_base(shell, kind, first_loop(shell, 3));
    case CellKind::hexahedron: return over_base(shell, kind, first_loop(shell, 4)); // loops are sorted: the lowest one
    }
    return cell;
}

} // namespace

std::optional<WholeCell> known_shape(const Shell& shell, std::span<const std::uint64_t> listed,
                                     const core::PointReader& points) {
    const auto kind = kind_by_faces(shell);
    if (!kind) return std::nullopt;
    if (listed.size() == core::corner_count(*kind)) {
        WholeCell cell{*kind, {}};
        std::ranges::copy(listed, cell.corners.begin());
        if (has_faces_of(cell, shell)) return cell;
    }
    WholeCell cell = ordered(shell, *kind);
    if (!has_faces_of(cell, shell)) return std::nullopt;
    if (core::is_mirrored(cell.kind, cell.corners, [&](std::size_t corner) { return points[cell.corners[corner]]; }))
        cell.corners = core::mirrored(cell.kind, cell.corners);
    return cell;
}

} // namespace isotet::linear
