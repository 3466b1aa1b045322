// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/polyhedra/polyhedron.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "linear/curved/known_shape.hpp"

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

void halve_quadrilaterals(std::vector<LoopPiece>& pieces) {
    const std::size_t count = pieces.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (pieces[i].count == 3) continue;
        const auto [a, b, c, d] = pieces[i].corners;
        pieces[i] = {{a, b, c, 0}, 3};
        pieces.push_back({{a, c, d, 0}, 3});
    }
}

PieceKey key_of(const OutwardPiece& piece, std::uint32_t number) {
    std::array<std::uint64_t, 4> around = piece.corners;
    const auto end = around.begin() + piece.count;
    std::rotate(around.begin(), std::min_element(around.begin(), end), end);
    const bool forward = around[1] < *(end - 1);
    if (!forward) std::swap(around[1], *(end - 1));
    if (piece.count == 3) around[3] = around[2];
    return {around, number, forward};
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
    for (std::size_t face = 0; face < shell_.face_count(); ++face) {
        const auto loop = shell_.loop(face);
        loop_pieces_.clear();
        cut_face(loop, points_, loop_pieces_);
        if (loop.size() > 4 && large_ == LargeFaces::triangles) halve_quadrilaterals(loop_pieces_);
        for (const LoopPiece& piece : loop_pieces_) {
            OutwardPiece& outward = pieces_.emplace_back();
            outward.count = piece.count;
            for (std::uint32_t i = 0; i < piece.count; ++i) outward.corners[i] = loop[piece.corners[i]];
            auto& [a, b, c, d] = outward.corners;
            if (shell_.is_inward(face)) std::swap(b, piece.count == 4 ? d : c); // the diagonal stays
        }
    }
}

/// Two faces that share more than an edge may both have a piece on the same corners. Cells over these are the same but for
/// their sign, so both are left out: what is behind the two faces meets there.
void PolyhedronSplitter::cancel_pieces() {
    keys_.clear();
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) keys_.push_back(key_of(pieces_[i], i));
    std::ranges::sort(keys_);
    const auto same = [](const PieceKey& a, const PieceKey& b) { return a.around == b.around; };
    if (std::ranges::adjacent_find(keys_, same) == keys_.end()) return;
    for (std::size_t i = 1; i < keys_.size(); ++i) {
        OutwardPiece &before = pieces_[keys_[i - 1].piece], &piece = pieces_[keys_[i].piece];
        if (before.count && same(keys_[i - 1], keys_[i]) && keys_[i - 1].forward != keys_[i].forward)
            before.count = piece.count = 0;
    }
    std::erase_if(pieces_, [](const OutwardPiece& piece) { return piece.count == 0; });
}

/// Whether a piece may be inside out as it is stored: as the centre sees it, or a pyramid by its other diagonal.
bool PolyhedronSplitter::keeps_order(const OutwardPiece& piece, const Centre& centre) const {
    if (!centre.sees_all) return true;
    const auto& [a, b, c, d] = piece.corners;
    if (piece.count == 3 || std::min(a, c) < std::min(b, d)) return false; // the diagonal that the centre has seen
    return core::orientation_sign(points_[a], points_[d], points_[b], centre.place) <= 0 ||
           core::orientation_sign(points_[b], points_[d], points_[c], centre.place) <= 0;
}

void PolyhedronSplitter::split_around_centre(std::size_t cell, Parts& out) {
    cut_faces();
    cancel_pieces();
    if (pieces_.empty()) {
        ++out.report.open;
        return out.add_cell(0, {}, cell);
    }
    triangles_.clear();
    for (const auto& [corners, count] : pieces_) {
        const auto& [a, b, c, d] = corners;
        triangles_.push_back({a, b, c});
        if (count == 4) triangles_.push_back({a, c, d});
    }
    const Centre centre = find_centre(shell_.points(), triangles_, points_, single_);
    const std::uint64_t apex = out.add_point(shell_.points(), centre.weights);
    for (const OutwardPiece& piece : pieces_) { // which are the bases: seen from inside
        const auto& [a, b, c, d] = piece.corners;
        const bool ordered = keeps_order(piece, centre);
        if (piece.count == 4)
            out.add_cell(ordered ? core::ordered_pyramid : static_cast<std::uint8_t>(CellType::pyramid),
                         std::array{a, d, c, b, apex}, cell);
        else
            out.add_cell(ordered ? core::ordered_tetrahedron : static_cast<std::uint8_t>(CellType::tetrahedron),
                         std::array{a, c, b, apex}, cell);
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
