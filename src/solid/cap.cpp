// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/cap.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <tbb/parallel_sort.h>

#include "base/parallel.hpp"
#include "grid/orientation.hpp"
#include "solid/face_part.hpp"
#include "solid/warped_face.hpp"

namespace isotet::solid {

namespace {

/// A corner of a triangle before points have got numbers: a vertex of an isosurface, a place among the points of the
/// boundary, or an apex.
using Corner = std::uint64_t;
constexpr Corner point_bit = Corner{1} << 32, apex_bit = Corner{1} << 33;

struct RawTriangle {
    std::array<Corner, 3> corners;
    std::uint32_t face; ///< of the boundary
};

struct RawApex {
    Place3 position{};
    std::vector<Corner> around;
    std::array<double, 4> shift{};
    std::uint32_t face = 0;
};

/// What some faces become; apexes are numbered from 0.
struct RawCap {
    std::vector<RawTriangle> triangles;
    std::vector<RawApex> apexes;
    std::uint64_t seam_edges = 0, unfit_edges = 0;
};

template <class Real>
class CapMaker {
public:
    CapMaker(const BoundaryFaces& boundary, const Array& points, const Array& values, const Cuts<Real>& cuts)
        : boundary_(boundary),
          points_(points),
          cuts_(cuts),
          stored_(boundary.points.size()),
          rounding_(rounding_of(points.type())) {
        values.visit([&](auto typed) {
            core::parallel_each(stored_.size(), 1 << 14, [&](std::size_t place) {
                stored_[place] =
                    core::store_value<Real>(static_cast<double>(typed[boundary.points[place]]), cuts.storage);
            });
        });
    }

    void add_face(const BoundaryFace& face, RawCap& out) const {
        std::array<Side, 4> all_sides;
        for (std::size_t k = 0; k < face.count; ++k) all_sides[k] = side_of(face.places[k]);
        const auto sides = std::span<const Side>(all_sides).first(face.count);
        const bool is_cut = std::ranges::any_of(sides, [&](Side side) { return side != sides[0]; });
        if (is_cut && wall_of(face) == Wall::doubled) out.seam_edges += edges_across(sides);
        if (is_cut && wall_of(face) == Wall::unfit) out.unfit_edges += edges_across(sides);
        if (is_cut && is_warped(face)) return add_warped(face, sides, out);
        for_parts(sides, [&](std::span<const PartVertex> part) {
            std::array<Corner, 16> polygon;
            const std::size_t count = corners_of(face, part, polygon);
            const auto corners = std::span(polygon).first(count);
            add_fan(corners, first_corner(face, corners, is_cut), number_of(face), out.triangles);
        });
    }

    /// `place`   of a point of the boundary
    bool is_tied(std::uint32_t place) const {
        return (cuts_.lower && stored_[place] == cuts_.lower->isovalue.tied) ||
               (cuts_.upper && stored_[place] == cuts_.upper->isovalue.tied);
    }

private:
    Side side_of(std::uint32_t place) const {
        const Real value = stored_[place];
        if (cuts_.upper && value >= cuts_.upper->isovalue.value) return Side::above;
        return cuts_.lower && value < cuts_.lower->isovalue.value ? Side::below : Side::inside;
    }

    std::uint32_t number_of(const BoundaryFace& face) const {
        return static_cast<std::uint32_t>(&face - boundary_.faces.data());
    }

    Wall wall_of(const BoundaryFace& face) const {
        return boundary_.walls.empty() ? Wall::none : boundary_.walls[number_of(face)];
    }

    /// Edges of isosurfaces across a face with corners on these sides.
    static std::uint64_t edges_across(std::span<const Side> sides) {
        std::uint64_t crossings = 0;
        for (std::size_t k = 0; k < sides.size(); ++k) {
            const Side one = sides[k], next = sides[(k + 1) % sides.size()];
            crossings +=
                ((one == Side::below) != (next == Side::below)) + ((one == Side::above) != (next == Side::above));
        }
        return crossings / 2;
    }

    const Cut<Real>& cut_of(const PartVertex& vertex) const { return vertex.of_upper ? *cuts_.upper : *cuts_.lower; }

    /// The corners of a part, those that follow each other and are equal once. Returns how many.
    std::size_t corners_of(const BoundaryFace& face, std::span<const PartVertex> part,
                           std::array<Corner, 16>& polygon) const {
        std::size_t count = 0;
        for (const PartVertex& vertex : part) {
            const Corner corner = corner_of(face, vertex);
            if (count == 0 || polygon[count - 1] != corner) polygon[count++] = corner;
        }
        while (count > 1 && polygon[0] == polygon[count - 1]) --count;
        return count;
    }

    Corner corner_of(const BoundaryFace& face, const PartVertex& vertex) const {
        const std::uint32_t above = face.places[vertex.above];
        if (vertex.is_corner()) return corner_at(above);
        const Cut<Real>& cut = cut_of(vertex);
        if (stored_[above] == cut.isovalue.tied) return corner_at(above);
        const std::uint32_t found = vertex_on_edge(cut, face.places[vertex.below], above);
        // Every edge that an isovalue crosses has a vertex; a point in its place keeps the solid whole should one lack.
        return found == Rim::no_vertex ? above | point_bit : found + cut.first_vertex;
    }

    std::uint32_t vertex_on_edge(const Cut<Real>& cut, std::uint32_t below, std::uint32_t above) const {
        return cut.rim.find(boundary_.points[below], boundary_.points[above]);
    }

    /// A point of the grid: the isosurface's vertex where it is tied.
    Corner corner_at(std::uint32_t place) const {
        const std::uint64_t point = boundary_.points[place];
        for (const std::optional<Cut<Real>>* cut : {&cuts_.lower, &cuts_.upper}) {
            if (!*cut || stored_[place] != (*cut)->isovalue.tied) continue;
            if (const std::uint32_t found = (*cut)->rim.find(point, point); found != Rim::no_vertex)
                return found + (*cut)->first_vertex;
        }
        return place | point_bit;
    }

    /// Where the fan of a part begins. Where three corners are vertices of isosurfaces, as at ties, these may have a triangle
    /// there: the fan has the same one, so that both can be left out. Else a whole face begins in its lowest point, as when
    /// cells are split; so do those that are not flat.
    std::size_t first_corner(const BoundaryFace& face, std::span<const Corner> corners, bool is_cut) const {
        const std::size_t n = corners.size();
        const auto is_vertex = [&](std::size_t k) {
            const Corner corner = corners[k % n];
            return (corner & point_bit) == 0 || is_tied(static_cast<std::uint32_t>(corner));
        };
        std::size_t vertices = 0;
        for (std::size_t k = 0; k < n; ++k) vertices += is_vertex(k);
        if (n > 3 && vertices == 3 && !is_warped(face))
            for (std::size_t k = 0; k < n; ++k)
                for (std::size_t i = k + 1; is_vertex(k) && i + 1 < k + n; ++i)
                    if (is_vertex(i) && is_vertex(i + 1)) return k;
        return is_cut ? 0 : lowest_corner(face);
    }

    static std::size_t lowest_corner(const BoundaryFace& face) {
        return static_cast<std::size_t>(std::ranges::min_element(face.all()) - face.all().begin());
    }

    static void add_fan(std::span<const Corner> polygon, std::size_t start, std::uint32_t face,
                        std::vector<RawTriangle>& out) {
        if (polygon.size() < 3) return;
        const auto n = polygon.size();
        for (std::size_t k = 1; k + 1 < n; ++k)
            out.push_back({{polygon[start], polygon[(start + k) % n], polygon[(start + k + 1) % n]}, face});
    }

    Place3 place_of_point(std::uint32_t place) const { return points_[boundary_.points[place]]; }

    Place3 place_of(const BoundaryFace& face, const PartVertex& vertex, const Cut<Real>* cut) const {
        const std::uint32_t above = face.places[vertex.above];
        if (vertex.is_corner() || stored_[above] == cut->isovalue.tied) return place_of_point(above);
        const std::uint32_t found = vertex_on_edge(*cut, face.places[vertex.below], above);
        if (found == Rim::no_vertex) return place_of_point(above);
        Place3 out;
        for (std::size_t axis = 0; axis < 3; ++axis) out[axis] = cut->positions.at(found, axis);
        return out;
    }

    /// By more than the rounding of coordinates.
    bool is_warped(const BoundaryFace& face) const {
        if (face.count < 4) return false;
        std::array<Place3, 4> corners;
        for (std::size_t k = 0; k < 4; ++k) corners[k] = place_of_point(face.places[k]);
        return solid::is_warped(corners, rounding_ * largest_coordinate(corners));
    }

    /// The parts of a face on a side of some corners, as polygons from `origin`.
    std::vector<Polygon> polygons_of(const BoundaryFace& face, std::span<const Side> sides, const Place3& origin,
                                     const Cut<Real>* one_cut) const {
        std::vector<Polygon> out;
        for_parts(sides, [&](std::span<const PartVertex> part) {
            std::array<Place3, 16> corners;
            for (std::size_t k = 0; k < part.size(); ++k) {
                const Cut<Real>* cut = one_cut || part[k].is_corner() ? one_cut : &cut_of(part[k]);
                corners[k] = place_of(face, part[k], cut);
                for (std::size_t axis = 0; axis < 3; ++axis) corners[k][axis] -= origin[axis];
            }
            out.push_back(polygon_of(std::span(corners).first(part.size())));
        });
        return out;
    }

    /// What is cut off a face at one isovalue: of a whole volume the share below, or at and above it.
    double volume_cut_off(const BoundaryFace& face, const Place3& origin, const Cut<Real>& cut, Side side,
                          double whole) const {
        std::array<Side, 4> low, high;
        for (std::size_t k = 0; k < 4; ++k) {
            const bool is_above = stored_[face.places[k]] >= cut.isovalue.value;
            low[k] = is_above ? Side::above : Side::inside;
            high[k] = is_above ? Side::inside : Side::below;
        }
        std::vector<Polygon> parts = polygons_of(face, low, origin, &cut);
        const std::size_t low_parts = parts.size();
        for (const Polygon& part : polygons_of(face, high, origin, &cut)) parts.push_back(part);
        std::vector<double> volumes(parts.size());
        share_difference(whole, parts, volumes);
        double sum = 0;
        for (std::size_t i = 0; i < parts.size(); ++i)
            if ((i < low_parts) == (side == Side::below)) sum += volumes[i];
        return sum;
    }

    void add_warped(const BoundaryFace& face, std::span<const Side> sides, RawCap& out) const {
        const Place3 origin = place_of_point(face.places[0]);
        double whole = 0;
        const std::size_t start = lowest_corner(face);
        for (const std::size_t k : {1, 2}) {
            std::array<Place3, 3> triangle{place_of_point(face.places[start]),
                                           place_of_point(face.places[(start + k) % 4]),
                                           place_of_point(face.places[(start + k + 1) % 4])};
            for (Place3& corner : triangle)
                for (std::size_t axis = 0; axis < 3; ++axis) corner[axis] -= origin[axis];
            whole += polygon_of(triangle).volume;
        }
        double left = whole;
        if (cuts_.lower) left -= volume_cut_off(face, origin, *cuts_.lower, Side::below, whole);
        if (cuts_.upper) left -= volume_cut_off(face, origin, *cuts_.upper, Side::above, whole);
        const std::vector<Polygon> parts = polygons_of(face, sides, origin, nullptr);
        std::vector<double> volumes(parts.size());
        share_difference(left, parts, volumes);
        std::array<Place3, 4> corners;
        for (std::size_t k = 0; k < 4; ++k) corners[k] = place_of_point(face.places[k]);
        std::size_t next = 0;
        for_parts(sides, [&](std::span<const PartVertex> part) {
            std::array<Corner, 16> polygon;
            const std::size_t count = corners_of(face, part, polygon);
            const Polygon& here = parts[next];
            Place3 apex = apex_of(here, volumes[next]), from_mean;
            ++next;
            if (count < 3) return;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                from_mean[axis] = apex[axis] - here.mean[axis];
                apex[axis] += origin[axis];
            }
            std::vector<Corner> around;
            for (const PartVertex& vertex : part) around.push_back(corner_of(face, vertex));
            const Corner number = out.apexes.size() | apex_bit;
            for (std::size_t k = 0; k < count; ++k)
                out.triangles.push_back({{polygon[k], polygon[(k + 1) % count], number}, number_of(face)});
            out.apexes.push_back({apex, std::move(around), weights_of(corners, from_mean), number_of(face)});
        });
    }

    const BoundaryFaces& boundary_;
    core::PointReader points_;
    const Cuts<Real>& cuts_;
    std::vector<Real> stored_; ///< by place
    double rounding_;          ///< of coordinates
};

/// By ranges of faces, in their order whatever the threads do.
template <class Real>
RawCap raw_cap(const BoundaryFaces& boundary, const CapMaker<Real>& maker) {
    constexpr std::size_t faces_at_once = 1 << 12;
    const std::size_t ranges = (boundary.faces.size() + faces_at_once - 1) / faces_at_once;
    std::vector<RawCap> found(ranges);
    core::parallel_each(ranges, 1, [&](std::size_t range) {
        const std::size_t end = std::min(boundary.faces.size(), (range + 1) * faces_at_once);
        for (std::size_t i = range * faces_at_once; i < end; ++i) maker.add_face(boundary.faces[i], found[range]);
    });
    RawCap all;
    for (RawCap& some : found) {
        const Corner before = all.apexes.size();
        for (RawTriangle triangle : some.triangles) {
            for (Corner& corner : triangle.corners)
                if (corner & apex_bit) corner += before;
            all.triangles.push_back(triangle);
        }
        std::ranges::move(some.apexes, std::back_inserter(all.apexes));
        all.seam_edges += some.seam_edges;
        all.unfit_edges += some.unfit_edges;
    }
    return all;
}

struct DirectedEdge {
    std::uint32_t low, high;
    std::int32_t uses; ///< +1 from low to high

    friend bool operator<(const DirectedEdge& a, const DirectedEdge& b) {
        return a.low != b.low ? a.low < b.low : a.high < b.high;
    }
};

} // namespace

template <class Real>
Cap make_cap(const BoundaryFaces& boundary, const Array& points, const Array& values, const Cuts<Real>& cuts) {
    const CapMaker<Real> maker(boundary, points, values, cuts);
    RawCap raw = raw_cap(boundary, maker);
    std::vector<std::uint32_t> numbers(boundary.points.size(), Rim::no_vertex);
    for (const RawTriangle& triangle : raw.triangles)
        for (const Corner corner : triangle.corners)
            if (corner & point_bit) numbers[static_cast<std::uint32_t>(corner)] = 0;
    Cap cap;
    cap.seam_edges = raw.seam_edges;
    cap.unfit_edges = raw.unfit_edges;
    for (std::size_t place = 0; place < numbers.size(); ++place) {
        if (numbers[place] == Rim::no_vertex) continue;
        numbers[place] = cuts.vertices + static_cast<std::uint32_t>(cap.points.size());
        cap.points.push_back(boundary.points[place]);
        cap.tied.push_back(maker.is_tied(static_cast<std::uint32_t>(place)));
    }
    const std::uint32_t first_apex = cuts.vertices + static_cast<std::uint32_t>(cap.points.size());
    const auto vertex_of = [&](Corner corner) {
        const auto number = static_cast<std::uint32_t>(corner);
        return corner & apex_bit ? first_apex + number : corner & point_bit ? numbers[number] : number;
    };
    cap.triangles.resize(raw.triangles.size());
    cap.cells.resize(raw.triangles.size());
    core::parallel_each(raw.triangles.size(), 1 << 14, [&](std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) cap.triangles[i][k] = vertex_of(raw.triangles[i].corners[k]);
        cap.cells[i] = boundary.faces[raw.triangles[i].face].cell;
    });
    if (std::ranges::any_of(boundary.faces, [](const BoundaryFace& face) { return face.mark.any(); })) {
        cap.marks.resize(raw.triangles.size());
        for (std::size_t i = 0; i < cap.marks.size(); ++i) cap.marks[i] = boundary.faces[raw.triangles[i].face].mark;
    }
    cap.apexes.resize(raw.apexes.size());
    core::parallel_each(raw.apexes.size(), 1 << 12, [&](std::size_t i) {
        Apex& apex = cap.apexes[i];
        apex.position = raw.apexes[i].position;
        apex.shift = raw.apexes[i].shift;
        apex.face = raw.apexes[i].face;
        const BoundaryFace& face = boundary.faces[apex.face];
        for (std::size_t k = 0; k < 4; ++k) apex.corners[k] = boundary.points[face.places[k]];
        for (const Corner corner : raw.apexes[i].around) apex.around.push_back(vertex_of(corner));
    });
    return cap;
}

template Cap make_cap<float>(const BoundaryFaces&, const Array&, const Array&, const Cuts<float>&);
template Cap make_cap<double>(const BoundaryFaces&, const Array&, const Array&, const Cuts<double>&);

std::uint64_t count_open_edges(const Cap& cap, std::span<const std::uint32_t> isosurfaces, std::uint32_t vertices) {
    std::vector<std::uint8_t> in_cap(vertices);
    for (const auto& triangle : cap.triangles)
        for (const std::uint32_t vertex : triangle) in_cap[vertex] = 1;
    std::vector<DirectedEdge> edges;
    const auto add = [&](std::uint32_t from, std::uint32_t to) {
        edges.push_back(from < to ? DirectedEdge{from, to, 1} : DirectedEdge{to, from, -1});
    };
    for (const auto& triangle : cap.triangles)
        for (std::size_t k = 0; k < 3; ++k) add(triangle[k], triangle[(k + 1) % 3]);
    for (std::size_t i = 0; i < isosurfaces.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = isosurfaces[i + k], to = isosurfaces[i + (k + 1) % 3];
            if (in_cap[from] && in_cap[to]) add(from, to);
        }
    tbb::parallel_sort(edges.begin(), edges.end());
    std::uint64_t open = 0;
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        std::int32_t uses = 0;
        for (end = begin; end < edges.size() && !(edges[begin] < edges[end]); ++end) uses += edges[end].uses;
        open += uses != 0;
    }
    return open;
}

} // namespace isotet::solid
