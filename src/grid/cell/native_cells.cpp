// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/cell/native_cells.hpp"

#include <algorithm>
#include <optional>
#include <span>

namespace isotet::core {

namespace {

/// A face by point numbers, corners that follow each other and are equal once.
struct PointFace {
    std::array<std::uint64_t, 4> corners{};
    std::size_t count = 0;

    std::span<const std::uint64_t> all() const { return {corners.data(), count}; }
    bool holds(std::uint64_t point) const { return std::ranges::find(all(), point) != all().end(); }
    std::uint64_t after(std::uint64_t point) const {
        const auto at = static_cast<std::size_t>(std::ranges::find(all(), point) - all().begin());
        return corners[(at + 1) % count];
    }
};

PointFace face_of(const WholeCell& cell, const CellFace& face) {
    PointFace out;
    for (const std::uint8_t corner : face.all())
        if (const std::uint64_t point = cell.corners[corner]; out.count == 0 || out.corners[out.count - 1] != point)
            out.corners[out.count++] = point;
    while (out.count > 1 && out.corners[0] == out.corners[out.count - 1]) --out.count;
    return out;
}

/// The faces of a cell that has some repeated corner.
class CollapsedFaces {
public:
    explicit CollapsedFaces(const WholeCell& cell) {
        for (const CellFace& face : shape_of(cell.kind).faces()) {
            const PointFace points = face_of(cell, face);
            if (points.count < 3) vanished_ = true;
            else faces_[count_++] = points;
        }
    }

    bool some_vanished() const { return vanished_; }

    /// No face meets itself, and no two share more than an edge.
    bool are_simple() const {
        for (std::size_t f = 0; f < count_; ++f) {
            const PointFace& face = faces_[f];
            if (face.count == 4 && (face.corners[0] == face.corners[2] || face.corners[1] == face.corners[3]))
                return false;
            for (std::size_t g = 0; g < f; ++g)
                if (std::ranges::count_if(face.all(), [&](std::uint64_t p) { return faces_[g].holds(p); }) > 2)
                    return false;
        }
        return true;
    }

    /// The wedge, pyramid or tet that has these faces.
    std::optional<WholeCell> as_kind() const {
        const std::size_t quads = with_corners(4), triangles = with_corners(3);
        if (quads == 3 && triangles == 2) return wedge();
        if (quads == 1 && triangles == 4) return pyramid();
        if (quads == 0 && triangles == 4) return tet();
        return std::nullopt;
    }

private:
    std::size_t with_corners(std::size_t corners) const {
        return static_cast<std::size_t>(std::count_if(faces_.begin(), faces_.begin() + count_,
                                                      [&](const PointFace& face) { return face.count == corners; }));
    }
    const PointFace& first_with(std::size_t corners) const {
        return *std::find_if(faces_.begin(), faces_.begin() + count_,
                             [&](const PointFace& face) { return face.count == corners; });
    }
    /// A point that the face does not have.
    std::uint64_t beside(const PointFace& face) const {
        for (std::size_t f = 0; f < count_; ++f)
            for (const std::uint64_t point : faces_[f].all())
                if (!face.holds(point)) return point;
        return face.corners[0];
    }

    std::optional<WholeCell> wedge() const {
        const PointFace& first = first_with(3);
        WholeCell out{CellKind::wedge, {}};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t corner = first.corners[k], next = first.corners[(k + 1) % 3];
            // Seen from outside, the quadrilateral beside this edge goes from `next` to `corner`, then across.
            const auto beside_edge = std::find_if(faces_.begin(), faces_.begin() + count_, [&](const PointFace& face) {
                return face.count == 4 && face.holds(next) && face.after(next) == corner;
            });
            if (beside_edge == faces_.begin() + count_) return std::nullopt;
            out.corners[k] = corner;
            out.corners[k + 3] = beside_edge->after(corner);
        }
        return out;
    }
    std::optional<WholeCell> pyramid() const {
        const PointFace& base = first_with(4);
        const auto& q = base.corners;
        return WholeCell{CellKind::pyramid, {q[0], q[3], q[2], q[1], beside(base)}};
    }
    std::optional<WholeCell> tet() const {
        const PointFace& face = faces_[0];
        return WholeCell{CellKind::tetrahedron, {beside(face), face.corners[0], face.corners[1], face.corners[2]}};
    }

    std::array<PointFace, 6> faces_;
    std::size_t count_ = 0;
    bool vanished_ = false;
};

void add_tets(const CellTets& tets, NativeParts& out) {
    out.collapsed = tets.collapsed;
    out.is_split = true;
    for (const Tet& tet : tets)
        out.cells[static_cast<std::size_t>(out.count++)] = {CellKind::tetrahedron, {tet[0], tet[1], tet[2], tet[3]}};
}

} // namespace

NativeParts native_parts(const WholeCell& cell) {
    NativeParts out;
    const auto keep = [&](const WholeCell& kept) { out.cells[static_cast<std::size_t>(out.count++)] = kept; };
    if (!has_repeated_corner(cell)) {
        keep(cell);
        return out;
    }
    const CellTets tets = split_cell(cell);
    if (tets.count == 0) {
        out.collapsed = tets.collapsed;
        return out;
    }
    const CollapsedFaces faces(cell);
    if (faces.are_simple()) {
        const auto smaller = faces.some_vanished() ? faces.as_kind() : cell;
        if (smaller && (smaller->kind == cell.kind || !has_repeated_corner(*smaller))) {
            keep(*smaller);
            return out;
        }
    }
    add_tets(tets, out);
    return out;
}

} // namespace isotet::core
