// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/lattice_faces.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "grid/cell/node_order.hpp"
#include "linear/curved/curved_kinds.hpp"
#include "linear/curved/high_degree.hpp"
#include "linear/hanging/cell_loops.hpp"
#include "linear/hanging/listed_cells.hpp"

namespace isotet::linear {

namespace {

/// Of a cell that becomes several along each edge.
std::optional<HighDegree> split_along_edges(const core::CellReader& cells, std::size_t cell) {
    const auto what = high_degree_of(cells.type(cell), cells.corners(cell));
    return what && what->degree > 2 ? what : std::nullopt;
}

/// By point.
using Marks = std::vector<std::uint8_t>;

bool has_marked_edge(const core::CellReader& cells, std::size_t cell, core::CellKind kind, const Marks& marks) {
    const std::uint64_t first = cells.first(cell);
    return std::ranges::any_of(core::edges_of(kind), [&](const auto& ends) {
        return marks[cells.corner(first + ends[0])] != 0 && marks[cells.corner(first + ends[1])] != 0;
    });
}

void mark_corners(const core::CellReader& cells, std::size_t cell, Marks& marks) {
    const std::uint64_t first = cells.first(cell), end = first + cells.corners(cell);
    for (std::uint64_t i = first; i < end; ++i) marks[cells.corner(i)] = 1;
}

/// The corners of quadratic cells on edges and faces of the cells that were split into them.
class LatticeFaces {
public:
    /// `marks`   both ends of the edges that are asked for, and all corners of the faces
    LatticeFaces(const core::CellReader& cells, const LinearGrid& split, const Marks& marks) {
        const auto parts = core::CellReader::open(split.grid);
        const auto sources = split.source_cells.as<std::uint64_t>();
        std::map<HighDegree, DegreePlan> plans;
        for (std::size_t part = 0, next = 0; part < sources.size(); part = next) {
            const std::uint64_t cell = sources[part];
            while (next < sources.size() && sources[next] == cell) ++next;
            const auto what = split_along_edges(cells, cell);
            if (!what || !has_marked_edge(cells, cell, what->kind, marks)) continue;
            const auto [plan, is_new] = plans.try_emplace(*what);
            if (is_new) plan->second = plan_of(*what);
            along_ = static_cast<int>((what->degree + 1) / 2);
            at_place_.assign(plan->second.rows.size(), 0);
            for (std::size_t i = 0; i < plan->second.cells.size(); ++i) {
                const auto& places = plan->second.cells[i].places;
                for (std::size_t k = 0; k < places.size(); ++k)
                    at_place_[places[k]] = parts->corner(parts->first(part + i) + k);
            }
            add(cells, cell, what->kind, marks);
        }
        std::ranges::sort(edges_, {}, [](const Edge& edge) { return std::tie(edge.ends, edge.first); });
        std::ranges::sort(faces_, {}, [](const Face& face) { return std::tie(face.corners, face.first); });
    }

    /// Appends the points between two corners, from the first to the second.
    bool append_between(std::uint64_t from, std::uint64_t to, std::vector<std::uint64_t>& out) const {
        const std::array ends{std::min(from, to), std::max(from, to)};
        const auto edge = std::ranges::lower_bound(edges_, ends, {}, &Edge::ends);
        if (edge == edges_.end() || edge->ends != ends) return false;
        const auto points = std::span(edge_points_).subspan(edge->first, edge->count);
        if (from < to) out.insert(out.end(), points.begin(), points.end());
        else out.insert(out.end(), points.rbegin(), points.rend());
        return true;
    }

    /// Appends the faces that one consists of.
    bool append_parts(std::span<const std::uint64_t> loop, std::vector<std::uint64_t>& out) const {
        if (loop.size() > 4) return false;
        const auto corners = key_of(loop);
        const auto face = std::ranges::lower_bound(faces_, corners, {}, &Face::corners);
        if (face == faces_.end() || face->corners != corners) return false;
        const auto parts = std::span(face_parts_).subspan(face->first, face->size);
        out.insert(out.end(), parts.begin(), parts.end());
        out[0] += face->count;
        return true;
    }

private:
    using At = std::array<int, 3>; ///< in steps of the quadratic cells
    struct Edge {
        std::array<std::uint64_t, 2> ends; ///< ascending
        std::size_t first, count;
    };
    struct Face {
        std::array<std::uint64_t, 4> corners;
        std::size_t first, size, count;
    };

    static std::array<std::uint64_t, 4> key_of(std::span<const std::uint64_t> loop) {
        std::array<std::uint64_t, 4> key;
        key.fill(std::numeric_limits<std::uint64_t>::max());
        std::ranges::copy(loop, key.begin());
        std::ranges::sort(key);
        return key;
    }

    std::uint64_t point(const At& at) const {
        const int side = 2 * along_ + 1;
        return at_place_[static_cast<std::size_t>(2 * (at[0] + side * (at[1] + side * at[2])))];
    }

    /// So many steps from a corner towards two others.
    std::uint64_t point(const At& from, const At& right, int i, const At& up, int j) const {
        At at{};
        for (std::size_t k = 0; k < 3; ++k)
            at[k] = from[k] + (right[k] - from[k]) / along_ * i + (up[k] - from[k]) / along_ * j;
        return point(at);
    }

    void add(const core::CellReader& cells, std::size_t cell, core::CellKind kind, const Marks& marks) {
        std::array<std::uint64_t, 8> corners{};
        std::array<At, 8> at{};
        const auto lattice = core::nodes_of_degree(kind, 1, core::NodeOrder::vtk);
        for (std::size_t i = 0; i < lattice.size(); ++i) {
            corners[i] = cells.corner(cells.first(cell) + i);
            for (std::size_t k = 0; k < 3; ++k) at[i][k] = along_ * lattice[i][k];
        }
        for (auto [low, high] : core::edges_of(kind)) {
            if (marks[corners[low]] == 0 || marks[corners[high]] == 0) continue;
            if (corners[low] > corners[high]) std::swap(low, high);
            edges_.push_back({{corners[low], corners[high]}, edge_points_.size(), 0});
            for (int i = 1; i < along_; ++i) edge_points_.push_back(point(at[low], at[high], i, at[low], 0));
            edges_.back().count = edge_points_.size() - edges_.back().first;
        }
        for (const core::CellFace& face : core::shape_of(kind).faces()) {
            std::array<std::uint64_t, 4> loop{};
            for (std::size_t i = 0; i < face.count; ++i) loop[i] = corners[face.corners[i]];
            const auto all = std::span(loop).first(face.count);
            if (std::ranges::any_of(all, [&](std::uint64_t corner) { return marks[corner] == 0; })) continue;
            faces_.push_back({key_of(all), face_parts_.size(), 0, 0});
            const At &from = at[face.corners[0]], &right = at[face.corners[1]], &up = at[face.corners[face.count - 1u]];
            if (face.count == 4) add_quadrilaterals(from, right, up);
            else add_triangles(from, right, up);
            faces_.back().size = face_parts_.size() - faces_.back().first;
        }
    }

    void add_quadrilaterals(const At& from, const At& right, const At& up) {
        const auto at = [&](int i, int j) { return point(from, right, i, up, j); };
        for (int j = 0; j < along_; ++j)
            for (int i = 0; i < along_; ++i) add_part({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    void add_triangles(const At& from, const At& right, const At& up) {
        const auto at = [&](int i, int j) { return point(from, right, i, up, j); };
        for (int j = 0; j < along_; ++j)
            for (int i = 0; i + j < along_; ++i) {
                add_part({at(i, j), at(i + 1, j), at(i, j + 1)});
                if (i + j + 1 < along_) add_part({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
            }
    }
    void add_part(std::initializer_list<std::uint64_t> loop) {
        face_parts_.push_back(loop.size());
        face_parts_.insert(face_parts_.end(), loop);
        ++faces_.back().count;
    }

    int along_ = 0;                       ///< quadratic cells of the one at hand along an edge
    std::vector<std::uint64_t> at_place_; ///< of the one at hand, by place of its plan
    std::vector<Edge> edges_;
    std::vector<Face> faces_;
    std::vector<std::uint64_t> edge_points_, face_parts_;
};

class LatticeLister {
public:
    LatticeLister(const core::CellReader& cells, const core::FaceReader& faces, const LatticeFaces& lattice)
        : cells_(cells), faces_(faces), lattice_(lattice), loops_(cells, faces) {}

    /// False: the cell stays as it is.
    bool list(std::size_t cell, ListedCell& out) {
        const bool is_listed = faces_.begin(cell) < faces_.end(cell) && core::is_polyhedron(cells_, faces_, cell);
        if (loops_.read(cell) && has_lattice_edge()) {
            // Where two cells beside it do not fit each other, edges have the points of one, and faces of the other.
            for (const bool with_faces : {true, false}) {
                list_faces(with_faces, out);
                if (edges_.find_points(out)) return true;
            }
        }
        if (!is_listed || core::prism_sides(cells_.type(cell)) > 0) return false;
        out.faces.clear();
        for (std::uint64_t i = faces_.begin(cell); i < faces_.end(cell); ++i) out.faces.push_back(faces_.at(i));
        out.points.clear();
        const std::uint64_t first = cells_.first(cell), end = first + cells_.corners(cell);
        for (std::uint64_t i = first; i < end; ++i) out.points.push_back(cells_.corner(i));
        return true;
    }

private:
    bool has_lattice_edge() {
        for (std::size_t face = 0; face < loops_.count(); ++face) {
            std::uint64_t before = loops_.loop(face).back();
            for (const std::uint64_t point : loops_.loop(face)) {
                between_.clear();
                if (lattice_.append_between(before, point, between_)) return true;
                before = point;
            }
        }
        return false;
    }

    void list_faces(bool with_faces, ListedCell& out) const {
        out.faces.assign(1, 0);
        for (std::size_t face = 0; face < loops_.count(); ++face) {
            const auto loop = loops_.loop(face);
            if (with_faces && lattice_.append_parts(loop, out.faces)) continue;
            const std::size_t at = begin_face(out);
            for (std::size_t i = 0; i < loop.size(); ++i) {
                out.faces.push_back(loop[i]);
                lattice_.append_between(loop[i], loop[i + 1 < loop.size() ? i + 1 : 0], out.faces);
            }
            end_face(at, loop, out);
        }
    }

    const core::CellReader& cells_;
    const core::FaceReader& faces_;
    const LatticeFaces& lattice_;
    CellLoops loops_;
    FaceEdges edges_;
    std::vector<std::uint64_t> between_;
};

} // namespace

bool has_polyhedra_at_lattices(const core::CellReader& cells, const core::FaceReader& faces) {
    Marks marks(cells.points());
    for (std::size_t cell = 0; cell < cells.count(); ++cell)
        if (core::is_polyhedron(cells, faces, cell)) mark_corners(cells, cell, marks);
    for (std::size_t cell = 0; cell < cells.count(); ++cell)
        if (const auto what = split_along_edges(cells, cell))
            if (has_marked_edge(cells, cell, what->kind, marks)) return true;
    return false;
}

Result<Cells> with_lattice_faces(const core::CellReader& cells, const core::FaceReader& faces, const LinearGrid& split,
                                 const Progress& progress) {
    Marks marks(cells.points());
    for (std::size_t cell = 0; cell < cells.count(); ++cell)
        if (core::is_contoured(cells.type(cell)) || core::is_polyhedron(cells, faces, cell))
            mark_corners(cells, cell, marks);
    const LatticeFaces lattice(cells, split, marks);
    LatticeLister lister(cells, faces, lattice);
    const auto sources = split.source_cells.as<std::uint64_t>();
    std::vector<ListedCell> listed;
    ListedCell one{};
    for (std::size_t cell = 0; cell < sources.size(); ++cell) {
        const std::uint64_t source = sources[cell];
        if (!core::is_contoured(cells.type(source)) && !core::is_polyhedral(cells.type(source))) continue;
        if (!lister.list(source, one)) continue;
        one.cell = cell;
        listed.push_back(one);
    }
    const auto parts = core::CellReader::open(split.grid);
    const auto none = core::FaceReader::open(split.grid.cells);
    if (!parts) return parts.error();
    if (!none) return none.error();
    return with_listed_cells(*parts, *none, listed, progress);
}

} // namespace isotet::linear
