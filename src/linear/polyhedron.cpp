// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/polyhedron.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "linear/known_shape.hpp"

namespace isotet::linear {

namespace {

constexpr std::uint8_t vtk_type_of(core::CellKind kind) {
    switch (kind) {
    case core::CellKind::tetrahedron: return static_cast<std::uint8_t>(CellType::tetrahedron);
    case core::CellKind::pyramid: return static_cast<std::uint8_t>(CellType::pyramid);
    case core::CellKind::wedge: return static_cast<std::uint8_t>(CellType::wedge);
    case core::CellKind::hexahedron: break;
    }
    return static_cast<std::uint8_t>(CellType::hexahedron);
}

} // namespace

std::optional<core::WholeCell> PolyhedronSplitter::find_known_shape(std::size_t cell) {
    listed_.clear();
    const std::uint64_t first = cells_.first(cell), corners = cells_.corners(cell);
    if (corners <= 8)
        for (std::uint64_t i = 0; i < corners; ++i) listed_.push_back(cells_.corner(first + i));
    return known_shape(shell_, listed_, points_);
}

double PolyhedronSplitter::six_volumes(std::size_t cell) {
    if (!shell_.read(cells_, faces_, cell, points_)) return -1;
    const auto known = find_known_shape(cell);
    if (!known) return shell_.six_volumes(points_);
    double sum = 0;
    for (const core::Tet& tet : core::split_cell(*known)) sum += std::abs(points_.six_volumes(tet));
    return sum;
}

bool PolyhedronSplitter::keep_known_shape(std::size_t cell, Parts& out) {
    const auto known = find_known_shape(cell);
    if (!known) return false;
    out.add_cell(vtk_type_of(known->kind), std::span(known->corners).first(core::corner_count(known->kind)), cell);
    ++out.report.known_shapes;
    ++out.report.cells;
    return true;
}

void PolyhedronSplitter::cut_faces() {
    pieces_.clear();
    triangles_.clear();
    for (std::size_t face = 0; face < shell_.face_count(); ++face) {
        const auto loop = shell_.loop(face);
        loop_pieces_.clear();
        cut_face(loop, points_, loop_pieces_);
        for (const LoopPiece& piece : loop_pieces_) {
            OutwardPiece& outward = pieces_.emplace_back();
            outward.count = piece.count;
            for (std::uint32_t i = 0; i < piece.count; ++i) outward.corners[i] = loop[piece.corners[i]];
            auto& [a, b, c, d] = outward.corners;
            if (shell_.is_inward(face)) std::swap(b, piece.count == 4 ? d : c); // the diagonal stays
            triangles_.push_back({a, b, c});
            if (piece.count == 4) triangles_.push_back({a, c, d});
        }
    }
}

void PolyhedronSplitter::split_around_centre(std::size_t cell, Parts& out) {
    cut_faces();
    const Centre centre = find_centre(shell_.points(), triangles_, points_, single_);
    const std::uint64_t apex = out.add_point(shell_.points(), centre.weights);
    for (const auto& [corners, count] : pieces_) { // which are the bases: seen from inside
        const auto& [a, b, c, d] = corners;
        if (count == 4) out.add_cell(static_cast<std::uint8_t>(CellType::pyramid), std::array{a, d, c, b, apex}, cell);
        else out.add_cell(static_cast<std::uint8_t>(CellType::tetrahedron), std::array{a, c, b, apex}, cell);
    }
    out.report.cells += pieces_.size();
    ++out.report.centred;
    out.report.moved_centres += centre.moved;
    out.report.folded += centre.folded;
}

void PolyhedronSplitter::split(std::size_t cell, Parts& out) {
    ++out.report.polyhedra;
    if (!shell_.read(cells_, faces_, cell, points_)) {
        ++out.report.open;
        out.add_cell(0, {}, cell);
    } else if (!options_.known_shapes || !keep_known_shape(cell, out)) {
        split_around_centre(cell, out);
    }
}

} // namespace isotet::linear
