// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/cell_pieces.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <tuple>

#include "grid/cell/cell_cases.hpp"
#include "solid/face_part.hpp"

namespace isotet::solid {

namespace {

using Loop = std::vector<PieceVertex>;

/// One of the vertices that follow each other and are equal.
void drop_repeats(Loop& loop) {
    loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
    while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
}

/// The loops of an isosurface in a cell as edges (above, below), each from the apex of its fan.
std::vector<std::vector<core::ActiveEdge>> loops_of(core::CellKind kind, unsigned above) {
    std::vector<std::vector<core::ActiveEdge>> loops;
    if (kind == core::CellKind::tetrahedron) {
        const core::TetCase& tet = core::case_table[above];
        if (tet.edges > 0) loops.emplace_back(tet.polygon.begin(), tet.polygon.begin() + tet.edges);
        return loops;
    }
    const auto is_same = [](const core::ActiveEdge& a, const core::ActiveEdge& b) {
        return a.above == b.above && a.below == b.below;
    };
    for (const core::CellPolygon& polygon : core::polygons_of(kind, above)) {
        const bool goes_on = !loops.empty() && is_same(loops.back()[0], polygon.edges[0]);
        if (!goes_on) loops.push_back({polygon.edges[0], polygon.edges[1]});
        loops.back().push_back(polygon.edges[2]);
        if (polygon.triangles == 2) loops.back().push_back(polygon.edges[3]);
    }
    return loops;
}

/// An edge of a face, and the face.
struct FaceEdge {
    PieceVertex low = 0, high = 0;
    bool forward = false;
    std::uint8_t face = 0;

    auto ends() const { return std::tie(low, high); }
};

std::vector<FaceEdge> sorted_edges(std::span<const PieceFace> faces) {
    std::vector<FaceEdge> edges;
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t k = 0; k < faces[f].count; ++k) {
            const PieceVertex a = faces[f].vertices[k], b = faces[f].vertices[(k + 1) % faces[f].count];
            edges.push_back({std::min(a, b), std::max(a, b), a < b, static_cast<std::uint8_t>(f)});
        }
    std::ranges::sort(edges, [](const FaceEdge& a, const FaceEdge& b) {
        return std::tie(a.low, a.high, a.forward, a.face) < std::tie(b.low, b.high, b.forward, b.face);
    });
    return edges;
}

/// Whether two triangles are the same in opposite directions.
bool are_opposite(const PieceFace& a, const PieceFace& b) {
    if (a.count != 3 || b.count != 3) return false;
    const auto& v = a.vertices;
    const auto& w = b.vertices;
    for (std::size_t k = 0; k < 3; ++k)
        if (v[0] == w[k] && v[1] == w[(k + 2) % 3] && v[2] == w[(k + 1) % 3]) return true;
    return false;
}

/// At ties a triangle of the isosurface may lie on one of a face: nothing is between them.
void cancel_opposite(std::vector<PieceFace>& faces) {
    for (std::size_t a = 0; a < faces.size(); ++a)
        for (std::size_t b = a + 1; b < faces.size(); ++b) {
            if (!are_opposite(faces[a], faces[b])) continue;
            faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(b));
            faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(a));
            return cancel_opposite(faces);
        }
}

/// Calls f(edges) for the edges between the same vertices.
template <class F>
void for_same_edges(std::span<const FaceEdge> edges, const F& f) {
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        for (end = begin; end < edges.size() && edges[end].ends() == edges[begin].ends();) ++end;
        f(edges.subspan(begin, end - begin));
    }
}

/// The number of the shell of each face: the lowest face in it. Faces hang together where just two meet in an edge: at ties
/// two shells may touch in one.
std::vector<std::uint8_t> shells_of(std::size_t faces, std::span<const FaceEdge> edges) {
    std::vector<std::uint8_t> shell(faces);
    std::iota(shell.begin(), shell.end(), std::uint8_t{0});
    for (bool changed = true; changed;) {
        changed = false;
        for_same_edges(edges, [&](std::span<const FaceEdge> same) {
            if (same.size() != 2) return;
            std::uint8_t &a = shell[same[0].face], &b = shell[same[1].face];
            changed |= a != b;
            a = b = std::min(a, b);
        });
    }
    return shell;
}

/// In every shell each edge is in two faces, once in each direction.
bool are_closed(std::span<const std::uint8_t> shells, std::span<const FaceEdge> edges) {
    bool closed = true;
    for_same_edges(edges, [&](std::span<const FaceEdge> same) {
        for (const FaceEdge& edge : same) {
            const auto count = [&](bool forward) {
                return std::ranges::count_if(same, [&](const FaceEdge& other) {
                    return shells[other.face] == shells[edge.face] && other.forward == forward;
                });
            };
            closed = closed && count(true) == 1 && count(false) == 1;
        }
    });
    return closed;
}

/// The vertex behind `vertex` on the way around a face that has it.
PieceVertex vertex_after(const PieceFace& face, PieceVertex vertex) {
    const auto all = face.all();
    const auto at = static_cast<std::size_t>(std::ranges::find(all, vertex) - all.begin());
    return all[(at + 1) % all.size()];
}

bool face_holds(const PieceFace& face, PieceVertex vertex) {
    return std::ranges::find(face.all(), vertex) != face.all().end();
}

/// One shell, to be known as one of VTK's linear cells.
class ShellShape {
public:
    explicit ShellShape(std::span<const PieceFace> faces) : faces_(faces) {
        for (const PieceFace& face : faces) {
            ++with_corners_[face.count];
            for (const PieceVertex vertex : face.all())
                if (std::ranges::find(vertices_, vertex) == vertices_.end()) vertices_.push_back(vertex);
        }
    }

    const std::vector<PieceVertex>& vertices() const { return vertices_; }

    /// All of them are corners of one face of the cell.
    bool is_flat(const CellToCut& cell) const {
        if (vertices_.size() < 4) return true;
        return std::ranges::any_of(core::shape_of(cell.kind).faces(), [&](const core::CellFace& face) {
            return std::ranges::all_of(vertices_, [&](PieceVertex vertex) {
                return is_corner(vertex) && std::ranges::any_of(face.all(), [&](std::uint8_t corner) {
                           return cell.same[corner] == vertex / 9;
                       });
            });
        });
    }

    CellPiece piece() const {
        const auto is = [&](std::size_t triangles, std::size_t quadrilaterals, std::size_t vertices) {
            return with_corners_[3] == triangles && with_corners_[4] == quadrilaterals &&
                   triangles + quadrilaterals == faces_.size() && vertices_.size() == vertices;
        };
        std::optional<CellPiece> known;
        if (is(4, 0, 4)) known = tetrahedron();
        else if (is(4, 1, 5)) known = pyramid();
        else if (is(2, 3, 6)) known = wedge();
        else if (is(0, 6, 8)) known = hexahedron();
        if (known) return *std::move(known);
        return {42, vertices_, {faces_.begin(), faces_.end()}};
    }

private:
    const PieceFace& first_with(std::size_t count) const {
        return *std::ranges::find(faces_, count, [](const PieceFace& face) { return std::size_t{face.count}; });
    }
    PieceVertex beside(const PieceFace& face) const {
        return *std::ranges::find_if(vertices_, [&](PieceVertex vertex) { return !face_holds(face, vertex); });
    }
    /// The vertex of the quadrilateral that goes from `from` to `to`, on the way from there.
    std::optional<PieceVertex> across(PieceVertex from, PieceVertex to) const {
        for (const PieceFace& face : faces_)
            if (face.count == 4 && face_holds(face, from) && vertex_after(face, from) == to)
                return vertex_after(face, to);
        return std::nullopt;
    }
    static bool are_different(std::vector<PieceVertex> vertices) {
        std::ranges::sort(vertices);
        return std::ranges::adjacent_find(vertices) == vertices.end();
    }

    CellPiece tetrahedron() const {
        const auto& v = faces_[0].vertices;
        return {10, {v[0], v[2], v[1], beside(faces_[0])}, {}};
    }
    std::optional<CellPiece> pyramid() const {
        const PieceFace& base = first_with(4);
        const PieceVertex apex = beside(base);
        for (const PieceFace& face : faces_)
            if (face.count == 3 && !face_holds(face, apex)) return std::nullopt;
        const auto& v = base.vertices;
        return CellPiece{14, {v[0], v[3], v[2], v[1], apex}, {}};
    }
    std::optional<CellPiece> wedge() const {
        const auto& v = first_with(3).vertices;
        std::vector<PieceVertex> out{v[0], v[1], v[2]};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto up = across(v[(k + 1) % 3], v[k]);
            if (!up) return std::nullopt;
            out.push_back(*up);
        }
        if (!are_different(out)) return std::nullopt;
        std::ranges::rotate(out, out.begin() + 3); // VTK 9.7 has the first triangle inward
        return CellPiece{13, out, {}};
    }
    std::optional<CellPiece> hexahedron() const {
        const auto& v = faces_[0].vertices;
        std::vector<PieceVertex> out{v[0], v[3], v[2], v[1]};
        for (std::size_t k = 0; k < 4; ++k) {
            const auto up = across(v[(5 - k) % 4], v[(4 - k) % 4]); // from the corner before out[k] on the base's other side
            if (!up) return std::nullopt;
            out.push_back(*up);
        }
        if (!are_different(out)) return std::nullopt;
        return CellPiece{12, out, {}};
    }

    std::span<const PieceFace> faces_;
    std::vector<PieceVertex> vertices_;
    std::array<std::size_t, 13> with_corners_{};
};

/// All faces of the pieces of one cell.
class PieceFaces {
public:
    enum class Loops : std::uint8_t { triangles, quadrilaterals, whole };

    PieceFaces(const CellToCut& cell, Loops loops) : cell_(&cell), loops_(loops) {
        for (std::size_t f = 0; f < core::shape_of(cell.kind).face_count; ++f) add_parts(f);
        add_isosurface(false);
        add_isosurface(true);
    }

    std::vector<PieceFace> faces;
    std::vector<std::array<PieceVertex, 4>> quadrilaterals;

private:
    CornerState state(std::size_t corner) const { return cell_->states[corner]; }
    PieceVertex corner_code(std::size_t corner) const { return static_cast<PieceVertex>(9 * cell_->same[corner]); }
    PieceVertex cut_code(std::size_t below, std::size_t above, bool of_upper) const {
        if (state(above) == (of_upper ? CornerState::at_upper : CornerState::at_lower)) return corner_code(above);
        const std::uint8_t a = cell_->same[below], b = cell_->same[above];
        return static_cast<PieceVertex>(8 * std::min(a, b) + std::max(a, b) + (of_upper ? upper_cut : 0));
    }
    static Side side_of(CornerState state) {
        if (state == CornerState::below) return Side::below;
        return state >= CornerState::at_upper ? Side::above : Side::inside;
    }

    void add(Loop loop) {
        drop_repeats(loop);
        if (loop.size() < 3) return;
        PieceFace& face = faces.emplace_back();
        face.count = static_cast<std::uint8_t>(loop.size());
        std::ranges::copy(loop, face.vertices.begin());
    }

    void add_fan(const Loop& loop, std::size_t face, std::size_t part) {
        const auto apex = static_cast<PieceVertex>(inside_face + 8 * face + part);
        for (std::size_t k = 0; k < loop.size(); ++k) add({loop[k], loop[(k + 1) % loop.size()], apex});
    }

    void add_parts(std::size_t f) {
        const core::CellFace& shape = core::shape_of(cell_->kind).faces()[f];
        std::array<std::uint8_t, 4> corners{};
        std::array<Side, 4> sides{};
        for (std::size_t k = 0; k < shape.count; ++k) {
            corners[k] = shape.corners[(k + cell_->start[f]) % shape.count];
            sides[k] = side_of(state(corners[k]));
        }
        std::size_t parts = 0;
        for_parts(std::span<const Side>(sides).first(shape.count), [&](std::span<const PartVertex> part) {
            Loop loop;
            for (const PartVertex& vertex : part)
                loop.push_back(vertex.is_corner()
                                   ? corner_code(corners[vertex.above])
                                   : cut_code(corners[vertex.below], corners[vertex.above], vertex.of_upper));
            drop_repeats(loop);
            if (loop.size() < 3) return;
            if (cell_->has_fans[f]) add_fan(loop, f, parts++);
            else add(std::move(loop));
        });
    }

    void add_isosurface(bool of_upper) {
        unsigned above = 0;
        for (std::size_t k = 0; k < core::corner_count(cell_->kind); ++k)
            above |= unsigned{state(k) >= (of_upper ? CornerState::at_upper : CornerState::at_lower)} << k;
        for (const auto& edges : loops_of(cell_->kind, above)) {
            Loop loop;
            for (const core::ActiveEdge& edge : edges) loop.push_back(cut_code(edge.below, edge.above, of_upper));
            if (!of_upper) std::reverse(loop.begin() + 1, loop.end()); // the fan's apex stays
            add_loop(std::move(loop));
        }
    }

    void add_loop(Loop loop) {
        if (loops_ == Loops::whole) return add_simple_loops(std::move(loop));
        Loop once = loop;
        drop_repeats(once);
        if (loops_ == Loops::quadrilaterals && once.size() == 4 && once[0] != once[2] && once[1] != once[3]) {
            quadrilaterals.push_back({once[0], once[1], once[2], once[3]});
            return add(std::move(once));
        }
        for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
            const std::array triangle{loop[0], loop[k], loop[k + 1]};
            if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
                add({triangle.begin(), triangle.end()});
        }
    }

    /// A loop that comes twice to one vertex is two.
    void add_simple_loops(Loop loop) {
        drop_repeats(loop);
        for (std::size_t i = 0; i < loop.size(); ++i)
            for (std::size_t k = i + 1; k < loop.size(); ++k) {
                if (loop[i] != loop[k]) continue;
                const auto first = loop.begin() + static_cast<std::ptrdiff_t>(i),
                           last = loop.begin() + static_cast<std::ptrdiff_t>(k);
                Loop inner(first, last);
                loop.erase(first, last);
                add_simple_loops(std::move(inner));
                return add_simple_loops(std::move(loop));
            }
        add(std::move(loop));
    }

    const CellToCut* cell_;
    Loops loops_;
};

} // namespace

CellPieces pieces_of(const CellToCut& cell, IsosurfaceFaces isosurface) {
    using Loops = PieceFaces::Loops;
    PieceFaces found(cell, isosurface == IsosurfaceFaces::flat ? Loops::quadrilaterals : Loops::triangles);
    cancel_opposite(found.faces);
    std::vector<FaceEdge> edges = sorted_edges(found.faces);
    std::vector<std::uint8_t> shells = shells_of(found.faces.size(), edges);
    if (!are_closed(shells, edges)) {
        found = PieceFaces(cell, Loops::whole);
        edges = sorted_edges(found.faces);
        shells = shells_of(found.faces.size(), edges);
    }
    CellPieces out;
    out.quadrilaterals = std::move(found.quadrilaterals);
    for (std::size_t first = 0; first < shells.size(); ++first) {
        if (shells[first] != first) continue;
        std::vector<PieceFace> faces;
        for (std::size_t f = first; f < shells.size(); ++f)
            if (shells[f] == first) faces.push_back(found.faces[f]);
        const ShellShape shape(faces);
        if (shape.is_flat(cell)) ++out.flat;
        else out.pieces.push_back(shape.piece());
    }
    return out;
}

} // namespace isotet::solid
