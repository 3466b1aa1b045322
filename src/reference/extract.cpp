// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "reference/extract.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "numbers/arithmetic.hpp"
#include "reference/triangles.hpp"

namespace isotet::reference {

namespace {

using core::Packed;

/// A stored cell with packed point numbers.
struct ReferenceCell {
    core::CellKind kind;
    std::vector<std::uint64_t> points;
    std::uint32_t cluster;
    std::uint64_t word; ///< its first
};

using Edge = std::pair<std::uint64_t, std::uint64_t>; ///< packed points, lower first

std::vector<ReferenceCell> all_cells(const Packed& packed) {
    std::vector<ReferenceCell> cells;
    for (std::uint32_t c = 0; c < packed.clusters(); ++c) {
        std::uint64_t locals[core::max_cluster_points];
        core::local_points(packed, c, locals);
        std::uint64_t word = packed.headers[c].first_word;
        for (const core::StoredTet& tet : packed.cluster_tets(c)) {
            const auto& v = tet.corners;
            cells.push_back(
                {core::CellKind::tetrahedron, {locals[v[0]], locals[v[1]], locals[v[2]], locals[v[3]]}, c, word++});
        }
        packed.for_other_cells(c, [&](const core::StoredCell& cell) {
            ReferenceCell& out =
                cells.emplace_back(cell.kind, std::vector<std::uint64_t>{}, c, packed.headers[c].first_word + cell.word);
            for (const std::uint8_t corner : cell.corners) out.points.push_back(locals[corner]);
        });
    }
    return cells;
}

Edge edge_of(std::uint64_t a, std::uint64_t b) { return {std::min(a, b), std::max(a, b)}; }

/// The clusters that hold an edge, as far as the question goes: the lowest, and whether there is another.
struct Holders {
    std::uint32_t owner = std::numeric_limits<std::uint32_t>::max();
    bool several = false;

    void add(std::uint32_t cluster) {
        several |= owner != std::numeric_limits<std::uint32_t>::max() && cluster != owner;
        owner = std::min(owner, cluster);
    }
};

enum Kind { tied_point = 0, seam_edge = 1, inner_edge = 2 };

/// Where a vertex stands in the order: cluster, kind, then the lower and the higher packed point. Local indices ascend
/// with packed points, and so do own seam edges in stored order.
using Place = std::tuple<std::uint32_t, int, std::uint64_t, std::uint64_t>;

template <class Real>
Result<ops::RawSurface> extract_one(const Packed& packed, const ops::Request<Real>& request,
                                    const core::StoredIsovalue<Real>& isovalue, const Progress& progress) {
    const auto& reals = packed.as<Real>();
    const auto value = [&](std::uint64_t p) { return reals.values[p]; };
    const auto is_above = [&](std::uint64_t p) { return value(p) >= isovalue.value; };
    const auto is_tied = [&](std::uint64_t p) { return value(p) == isovalue.tied; };
    const std::vector<ReferenceCell> cells = all_cells(packed);

    std::map<Edge, Holders> edge_holders;
    std::map<std::uint64_t, std::uint32_t> point_owner;
    for (const ReferenceCell& cell : cells) {
        for (const std::uint64_t point : cell.points) {
            const auto [owner, is_new] = point_owner.try_emplace(point, cell.cluster);
            if (!is_new) owner->second = std::min(owner->second, cell.cluster);
        }
        for (const auto& [a, b] : core::edges_of(cell.kind))
            edge_holders[edge_of(cell.points[a], cell.points[b])].add(cell.cluster);
    }
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "extraction was cancelled"};

    // The vertex on the edge between a point above (or tied) and one below.
    const auto place_of = [&](std::uint64_t above, std::uint64_t below) -> Place {
        if (request.ties == Ties::merge && is_tied(above)) return {point_owner.at(above), tied_point, above, above};
        const Edge edge = edge_of(above, below);
        const Holders& holders = edge_holders.at(edge);
        return {holders.owner, holders.several ? seam_edge : inner_edge, edge.first, edge.second};
    };

    std::vector<std::array<Place, 3>> triangles;
    std::vector<std::int64_t> source_cells;
    std::set<Place> places;
    for (const ReferenceCell& cell : cells) {
        unsigned index = 0;
        bool valid = true;
        for (std::size_t k = 0; k < cell.points.size(); ++k) {
            valid &= !core::is_nan(value(cell.points[k]));
            index |= unsigned{is_above(cell.points[k])} << k;
        }
        if (!valid) continue;
        for (const auto& edges : triangles_of(cell.kind, index)) {
            std::array<Place, 3> triangle;
            for (std::size_t k = 0; k < 3; ++k)
                triangle[k] = place_of(cell.points[edges[k].above], cell.points[edges[k].below]);
            if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
            triangles.push_back(triangle);
            places.insert(triangle.begin(), triangle.end());
            if (request.source_cells) source_cells.push_back(static_cast<std::int64_t>(packed.user_cell(cell.word)));
        }
    }
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "extraction was cancelled"};

    std::map<Place, std::uint64_t> numbers;
    std::vector<Real> positions, weights;
    std::vector<float> normals;
    std::vector<std::int64_t> ends;
    for (const Place& place : places) {
        numbers.emplace_hint(numbers.end(), place, numbers.size());
        const auto [cluster, kind, a, b] = place;
        const std::uint64_t below = kind == tied_point ? a : is_above(a) ? b : a;
        const std::uint64_t above = below == a ? b : a;
        const Real t = kind == tied_point ? Real(0) : core::edge_weight(isovalue, value(below), value(above));
        for (std::size_t axis = 0; axis < 3; ++axis)
            positions.push_back(
                core::interpolate(reals.positions[3 * below + axis], reals.positions[3 * above + axis], t));
        if (request.ends) {
            ends.push_back(static_cast<std::int64_t>(packed.user_point(below)));
            ends.push_back(static_cast<std::int64_t>(packed.user_point(above)));
            weights.push_back(t);
        }
        if (request.normals)
            for (const Real x : core::vertex_normal(packed.gradients[below], packed.gradients[above], t))
                normals.push_back(static_cast<float>(x));
    }

    ops::RawSurface surface;
    const auto number_triangles = [&]<class Index>(std::vector<Index> out) {
        for (const auto& triangle : triangles)
            for (const Place& place : triangle) out.push_back(static_cast<Index>(numbers.at(place)));
        surface.triangles = Array::own(std::move(out), 3);
    };
    if (places.size() < std::uint64_t{1} << 32) number_triangles(std::vector<std::uint32_t>{});
    else number_triangles(std::vector<std::uint64_t>{});
    surface.positions = Array::own(std::move(positions), 3);
    if (request.ends) {
        surface.ends = Array::own(std::move(ends), 2);
        surface.weights = Array::own(std::move(weights));
    }
    if (request.normals) surface.normals = Array::own(std::move(normals), 3);
    if (request.source_cells) surface.source_cells = Array::own(std::move(source_cells));
    for (std::size_t c = 0; c < packed.clusters(); ++c)
        surface.selected_clusters += reals.ranges[c].lower <= isovalue.value && isovalue.value <= reals.ranges[c].upper;
    surface.tied_points =
        static_cast<std::uint64_t>(std::count(reals.values.begin(), reals.values.end(), isovalue.tied));
    return surface;
}

} // namespace

template <class Real>
Result<ops::RawSurfaces> extract(const Packed& packed, const ops::Request<Real>& request, const Progress& progress) {
    ops::RawSurfaces out;
    for (const core::StoredIsovalue<Real>& isovalue : request.isovalues) {
        auto surface = extract_one(packed, request, isovalue, progress);
        if (!surface) return std::move(surface).error();
        out.surfaces.push_back(*std::move(surface));
    }
    return out;
}

template Result<ops::RawSurfaces> extract<float>(const Packed&, const ops::Request<float>&, const Progress&);
template Result<ops::RawSurfaces> extract<double>(const Packed&, const ops::Request<double>&, const Progress&);

} // namespace isotet::reference
