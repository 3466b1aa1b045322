// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/double_sheets.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <iterator>
#include <utility>

#include <tbb/parallel_sort.h>

#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "grid/orientation.hpp"
#include "grid/surface_rows.hpp"
#include "solid/warped_face.hpp"

namespace isotet::solid {

namespace {

using Vertex = std::uint32_t; // of the solid; behind these, of other pieces
using Corners = std::array<Vertex, 3>;

/// A triangle by its vertices, ascending, and whether it has them the other way round.
struct TiedTriangle {
    Corners corners;
    bool turned = false;
    bool whole = false; ///< all corners are tied
    bool taken = false;
    bool reshaped = false; ///< it has other corners than the solid's triangle
    std::uint64_t number = 0;

    friend bool operator<(const TiedTriangle& a, const TiedTriangle& b) {
        if (a.corners != b.corners) return a.corners < b.corners;
        return a.turned != b.turned ? b.turned : a.number < b.number;
    }
};

TiedTriangle tied_triangle(Corners corners, std::uint64_t number) {
    std::ranges::rotate(corners, std::ranges::min_element(corners));
    const bool turned = corners[1] > corners[2];
    if (turned) std::swap(corners[1], corners[2]);
    return {corners, turned, false, false, false, number};
}

struct HalfEdge {
    Vertex from, to, third; ///< corner of its triangle

    friend bool operator<(const HalfEdge& a, const HalfEdge& b) {
        return std::array{a.from, a.to, a.third} < std::array{b.from, b.to, b.third};
    }
};

/// Triangles of which some may lie back to back.
class TiedTriangles {
public:
    static constexpr std::uint64_t of_others = ~std::uint64_t{0};

    explicit TiedTriangles(std::size_t count) { triangles_.reserve(count); }

    void add(const Corners& corners, bool whole, std::uint64_t number) {
        triangles_.push_back(tied_triangle(corners, number));
        triangles_.back().whole = whole;
    }

    /// `shape`        is_flat() of four tied vertices, are_opposed() of two triangles of these
    /// `isosurface`   triangles of the solid with lower numbers are of isosurfaces
    /// Returns        false: it was cancelled
    template <class Shape>
    bool cancel(const Shape& shape, std::uint64_t isosurface, const Progress& progress) {
        do {
            if (progress.cancelled()) return false;
            pair_triangles();
        } while (pair_quadrilaterals(shape, isosurface));
        return true;
    }

    /// Triangles of the solid that are left with other corners.
    std::vector<TiedTriangle> reshaped() const {
        std::vector<TiedTriangle> out;
        std::ranges::copy_if(triangles_, std::back_inserter(out), [](const TiedTriangle& triangle) {
            return triangle.reshaped && triangle.number != of_others;
        });
        return out;
    }

    /// Those of the solid that are left out, ascending.
    std::vector<std::uint64_t> left_out() && {
        std::ranges::sort(left_out_);
        return std::move(left_out_);
    }

private:
    static bool by_number(const TiedTriangle* a, const TiedTriangle* b) { return a->number < b->number; }

    void pair_triangles() {
        tbb::parallel_sort(triangles_.begin(), triangles_.end());
        for (std::size_t begin = 0, end = 0; begin < triangles_.size(); begin = end) {
            const auto is_like_it = [&](std::size_t i) {
                return i < triangles_.size() && triangles_[i].corners == triangles_[begin].corners;
            };
            std::size_t turned = begin;
            while (is_like_it(turned) && !triangles_[turned].turned) ++turned;
            for (end = turned; is_like_it(end);) ++end;
            for (std::size_t i = 0; i < std::min(turned - begin, end - turned); ++i)
                triangles_[begin + i].taken = triangles_[turned + i].taken = true;
        }
        drop_taken();
    }

    /// abc and acd are one side of a quadrilateral abcd, adb and bdc the other. Returns whether there was one. Parts of faces
    /// have three corners on isosurfaces at most.
    template <class Shape>
    bool pair_quadrilaterals(const Shape& shape, std::uint64_t isosurface) {
        const std::size_t before = triangles_.size();
        const std::vector<std::array<Vertex, 4>> quadrilaterals = find_quadrilaterals(shape);
        for (const auto& [a, b, c, d] : quadrilaterals) {
            const auto found = find_all({{{a, b, c}, {a, c, d}, {a, d, b}, {b, d, c}}});
            if (std::ranges::find(found, nullptr) != found.end()) continue;
            for (TiedTriangle* triangle : found) triangle->taken = true;
        }
        std::vector<TiedTriangle> left;
        for (const auto& [a, b, c, d] : quadrilaterals) {
            const auto [first, second, across, other] = find_all({{{a, b, c}, {a, c, d}, {a, d, b}, {b, d, c}}});
            TiedTriangle* const against = across ? across : other;
            if (!first || !second || !against) continue;
            // What is left has the vertices, and is of the part and the piece, that both are of.
            if ((first->number == of_others) != (second->number == of_others)) continue;
            if ((first->number < isosurface) != (second->number < isosurface)) continue;
            // Else it lies beside them: three triangles around a point.
            if (!shape.are_opposed({a, b, c}, across ? Corners{a, d, b} : Corners{b, d, c})) continue;
            for (TiedTriangle* triangle : {first, second, against}) triangle->taken = true;
            TiedTriangle* const kept = std::min(first, second, by_number);
            left.push_back(tied_triangle(across ? Corners{b, c, d} : Corners{a, b, d}, kept->number));
            left.back().whole = left.back().reshaped = true;
            kept->number = of_others; // it is not left out
        }
        drop_taken();
        triangles_.insert(triangles_.end(), left.begin(), left.end());
        return triangles_.size() != before;
    }

    /// In an order that follows from the triangles alone; each several times.
    template <class Shape>
    std::vector<std::array<Vertex, 4>> find_quadrilaterals(const Shape& shape) const {
        std::vector<HalfEdge> edges;
        edges.reserve(3 * static_cast<std::size_t>(std::ranges::count_if(triangles_, &TiedTriangle::whole)));
        for (const TiedTriangle& triangle : triangles_) {
            if (!triangle.whole) continue;
            Corners at = triangle.corners;
            if (triangle.turned) std::swap(at[1], at[2]);
            for (std::size_t k = 0; k < 3; ++k) edges.push_back({at[k], at[(k + 1) % 3], at[(k + 2) % 3]});
        }
        tbb::parallel_sort(edges.begin(), edges.end());
        const auto along = [&](Vertex from, Vertex to) {
            return std::ranges::equal_range(edges, std::pair(from, to), {},
                                            [](const HalfEdge& edge) { return std::pair(edge.from, edge.to); });
        };
        constexpr std::size_t edges_at_once = 1 << 14;
        std::vector<std::vector<std::array<Vertex, 4>>> found((edges.size() + edges_at_once - 1) / edges_at_once);
        core::parallel_each(found.size(), 1, [&](std::size_t range) {
            const std::size_t end = std::min(edges.size(), (range + 1) * edges_at_once);
            for (std::size_t i = range * edges_at_once; i < end; ++i) {
                const auto [c, a, b] = edges[i];
                if (c < a) continue; // seen from the other side
                for (const HalfEdge& across : along(a, c)) {
                    const Vertex d = across.third;
                    if (d == b || (along(b, d).empty() && along(d, b).empty())) continue;
                    if (shape.is_flat({a, b, c, d})) found[range].push_back({a, b, c, d});
                }
            }
        });
        std::vector<std::array<Vertex, 4>> all;
        for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
        return all;
    }

    /// One of each that is not taken; null where there is none.
    std::array<TiedTriangle*, 4> find_all(const std::array<Corners, 4>& wanted) {
        std::array<TiedTriangle*, 4> found{};
        for (std::size_t i = 0; i < 4; ++i) {
            const TiedTriangle like = tied_triangle(wanted[i], 0);
            auto at = std::lower_bound(triangles_.begin(), triangles_.end(), like);
            while (at != triangles_.end() && at->corners == like.corners && at->turned == like.turned && at->taken)
                ++at;
            if (at != triangles_.end() && at->corners == like.corners && at->turned == like.turned) found[i] = &*at;
        }
        return found;
    }

    void drop_taken() {
        for (const TiedTriangle& triangle : triangles_)
            if (triangle.taken && triangle.number != of_others) left_out_.push_back(triangle.number);
        std::erase_if(triangles_, [](const TiedTriangle& triangle) { return triangle.taken; });
    }

    std::vector<TiedTriangle> triangles_; ///< ascending once triangles are paired
    std::vector<std::uint64_t> left_out_; ///< of the solid
};

/// A vertex by the ends of its edge, both the point where it is one, and by the isosurface that it is of.
struct Name {
    std::int64_t below = -1, above = -2;
    bool of_upper = false;

    bool is_point() const { return below == above; }
    auto operator<=>(const Name&) const = default;
};

Name name_of_point(std::int64_t point) { return {point, point, false}; }

void append_names(const Shell& shell, std::vector<Name>& out) {
    if (shell.surface.vertex_count() == 0) return;
    const auto ends = shell.surface.edge_ends.as<std::int64_t>();
    for (std::size_t i = 0; i < ends.size(); i += 2)
        out.push_back(ends[i] == ends[i + 1] ? name_of_point(ends[i]) : Name{ends[i], ends[i + 1], !shell.mirrored});
}

std::size_t vertices_of(std::span<const Shell> shells) {
    std::size_t count = 0;
    for (const Shell& shell : shells) count += shell.surface.vertex_count();
    return count;
}

/// What the vertices of a solid are, those of the shells first; later those that only other pieces have.
class Vertices {
public:
    Vertices(const Surface& solid, std::span<const Shell> shells, const Cap& cap, const Array& points)
        : points_(points),
          on_isosurfaces_(vertices_of(shells)),
          of_solid_(solid.vertex_count()),
          rounding_(rounding_of(points.type())) {
        names_.reserve(of_solid_);
        for (const Shell& shell : shells) append_names(shell, names_);
        for (const std::uint64_t point : cap.points) names_.push_back(name_of_point(static_cast<std::int64_t>(point)));
        names_.resize(of_solid_); // inside faces
        tied_.assign(of_solid_, 0);
        std::ranges::copy(cap.tied, tied_.begin() + static_cast<std::ptrdiff_t>(on_isosurfaces_));
    }

    bool is_tied(Vertex vertex) const {
        const bool is_of_cap = vertex >= on_isosurfaces_ && vertex < of_solid_;
        return is_of_cap ? tied_[vertex] != 0 : names_[vertex].is_point();
    }

    /// By no more than coordinates are rounded. Of tied vertices.
    bool is_flat(const std::array<Vertex, 4>& corners) const {
        std::array<Place3, 4> places;
        for (std::size_t k = 0; k < 4; ++k) places[k] = place_of(corners[k]);
        return !is_warped(places, rounding_ * largest_coordinate(places));
    }

    /// Whether two triangles of one plane face opposite ways. Of tied vertices.
    bool are_opposed(const Corners& one, const Corners& other) const {
        const Place3 a = area_of(one), b = area_of(other);
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < 0;
    }

    /// The numbers of another shell's vertices: those of equal ones, else new ones.
    std::vector<Vertex> add(const Shell& shell) {
        if (by_name_.empty()) {
            for (std::size_t i = 0; i < of_solid_; ++i)
                if (names_[i] != Name{}) by_name_.emplace_back(names_[i], static_cast<Vertex>(i));
            tbb::parallel_sort(by_name_.begin(), by_name_.end());
        }
        std::vector<Name> names;
        append_names(shell, names);
        std::vector<Vertex> out;
        for (std::size_t i = 0; i < names.size(); ++i) {
            const auto found = std::ranges::lower_bound(by_name_, names[i], {}, &std::pair<Name, Vertex>::first);
            const bool is_known = found != by_name_.end() && found->first == names[i];
            out.push_back(is_known ? found->second : static_cast<Vertex>(names_.size()));
            if (is_known) continue;
            names_.push_back(names[i]);
        }
        return out;
    }

private:
    Place3 place_of(Vertex vertex) const { return points_[static_cast<std::uint64_t>(names_[vertex].below)]; }
    Place3 area_of(const Corners& corners) const {
        return polygon_of(std::array{place_of(corners[0]), place_of(corners[1]), place_of(corners[2])}).area;
    }

    core::PointReader points_;
    std::size_t on_isosurfaces_, of_solid_;
    double rounding_; ///< of points
    std::vector<Name> names_;
    std::vector<std::uint8_t> tied_;               ///< of those that the cap adds
    std::vector<std::pair<Name, Vertex>> by_name_; ///< of the solid
};

Array with_corners(const Array& triangles, const std::vector<TiedTriangle>& reshaped) {
    const auto before = triangles.as<std::uint32_t>();
    std::vector<std::uint32_t> out(before.begin(), before.end());
    for (const TiedTriangle& triangle : reshaped) {
        Corners corners = triangle.corners;
        if (triangle.turned) std::swap(corners[1], corners[2]);
        std::ranges::copy(corners, out.begin() + static_cast<std::ptrdiff_t>(3 * triangle.number));
    }
    return Array::own(std::move(out), 3);
}

std::vector<std::uint64_t> all_but(std::uint64_t count, const std::vector<std::uint64_t>& left_out) {
    std::vector<std::uint64_t> kept;
    kept.reserve(count - left_out.size());
    auto next = left_out.begin();
    for (std::uint64_t i = 0; i < count; ++i)
        if (next != left_out.end() && *next == i) ++next;
        else kept.push_back(i);
    return kept;
}

} // namespace

Result<std::vector<std::uint64_t>> leave_out_double_sheets(Surface& solid, std::span<const Shell> shells,
                                                           const Cap& cap, std::span<const Shell> others,
                                                           const Array& points, const Progress& progress) {
    Vertices vertices(solid, shells, cap, points);
    const std::uint64_t isosurface = solid.triangle_count() - cap.triangles.size();
    const auto count_tied = [&](const Corners& corners) {
        return std::ranges::count_if(corners, [&](Vertex vertex) { return vertices.is_tied(vertex); });
    };
    const auto triangles = solid.triangles.as<std::uint32_t>();
    const auto corners_of = [&](std::size_t i) {
        return Corners{triangles[3 * i], triangles[3 * i + 1], triangles[3 * i + 2]};
    };
    std::uint64_t tied = 0;
    for (std::size_t i = 0; i < solid.triangle_count(); ++i) tied += count_tied(corners_of(i)) > 0;
    for (const Shell& shell : others) tied += shell.surface.triangle_count();
    constexpr std::uint64_t bytes_a_triangle = 150;
    if (auto ok = core::require_memory("leaving out double sheets", bytes_a_triangle * tied); !ok) return ok.error();
    TiedTriangles sheets(tied);
    for (std::size_t i = 0; i < solid.triangle_count(); ++i)
        if (const auto count = count_tied(corners_of(i))) sheets.add(corners_of(i), count == 3, i);
    for (const Shell& shell : others) {
        const std::vector<Vertex> of_shell = vertices.add(shell);
        for (std::size_t i = 0; i < shell.surface.triangle_count(); ++i) {
            const auto at = shell.surface.triangles.as<std::uint32_t>().subspan(3 * i, 3);
            Corners corners{of_shell[at[0]], of_shell[at[1]], of_shell[at[2]]};
            if (shell.mirrored) std::swap(corners[1], corners[2]);
            if (const auto count = count_tied(corners)) sheets.add(corners, count == 3, TiedTriangles::of_others);
        }
    }
    if (!sheets.cancel(vertices, isosurface, progress))
        return Error{ErrorCode::cancelled, "leaving out double sheets was cancelled"};
    if (const auto reshaped = sheets.reshaped(); !reshaped.empty())
        solid.triangles = with_corners(solid.triangles, reshaped);
    std::vector<std::uint64_t> left_out = std::move(sheets).left_out();
    if (!left_out.empty()) solid = core::with_triangles(solid, all_but(solid.triangle_count(), left_out));
    return left_out;
}

} // namespace isotet::solid
