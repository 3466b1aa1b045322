// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/polyhedron.hpp"

#include <array>
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

bool PolyhedronSplitter::keep_known_shape(std::size_t cell, Parts& out) {
    listed_.clear();
    const std::uint64_t first = cells_.first(cell), corners = cells_.corners(cell);
    if (corners <= 8)
        for (std::uint64_t i = 0; i < corners; ++i) listed_.push_back(cells_.corner(first + i));
    const auto known = known_shape(shell_, listed_, points_);
    if (!known) return false;
    out.add_cell(vtk_type_of(known->kind), std::span(known->corners).first(core::corner_count(known->kind)), cell);
    ++out.report.known_shapes;
    ++out.report.cells;
    return true;
}

/// The triangles of all faces, turned outward.
void PolyhedronSplitter::find_triangles() {
    loop_triangles_.clear();
    triangle_ends_.clear();
    triangles_.clear();
    for (std::size_t face = 0; face < shell_.face_count(); ++face) {
        const auto loop = shell_.loop(face);
        triangulate(loop, points_, loop_triangles_);
        for (std::size_t i = triangles_.size(); i < loop_triangles_.size(); ++i) {
            OutwardTriangle triangle{loop[loop_triangles_[i][0]], loop[loop_triangles_[i][1]],
                                     loop[loop_triangles_[i][2]]};
            if (shell_.is_inward(face)) std::swap(triangle[1], triangle[2]);
            triangles_.push_back(triangle);
        }
        triangle_ends_.push_back(triangles_.size());
    }
}

void PolyhedronSplitter::split_around_centre(std::size_t cell, Parts& out) {
    find_triangles();
    const Centre centre = find_centre(shell_.points(), triangles_, points_, single_);
    const std::uint64_t apex = out.add_point(shell_.points(), centre.weights);
    std::size_t next = 0;
    for (std::size_t face = 0; face < shell_.face_count(); ++face) {
        const auto loop = shell_.loop(face);
        if (loop.size() == 4) {
            std::array<std::uint64_t, 5> pyramid{loop[0], loop[1], loop[2], loop[3], apex}; // its base is inward
            if (!shell_.is_inward(face)) std::swap(pyramid[1], pyramid[3]);
            out.add_cell(static_cast<std::uint8_t>(CellType::pyramid), pyramid, cell);
            ++out.report.cells;
        } else {
            for (std::size_t i = next; i < triangle_ends_[face]; ++i) {
                const OutwardTriangle& t = triangles_[i];
                out.add_cell(static_cast<std::uint8_t>(CellType::tetrahedron), std::array{t[0], t[2], t[1], apex},
                             cell);
                ++out.report.cells;
            }
        }
        next = triangle_ends_[face];
    }
    ++out.report.centred;
    out.report.moved_centres += centre.moved;
    out.report.folded += centre.folded;
}

void PolyhedronSplitter::split(std::size_t cell, Parts& out) {
    ++out.report.polyhedra;
    if (!shell_.read(faces_, cell, points_)) {
        ++out.report.open;
        out.add_cell(0, {}, cell);
    } else if (!options_.known_shapes || !keep_known_shape(cell, out)) {
        split_around_centre(cell, out);
    }
}

} // namespace isotet::linear
