// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All 81 cases {below, tied, above} of one tet, in every order of its corners, and all 243 of two tets that share a
// face, against what the contract says of each case.
#include <cmath>
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/engines.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {
namespace {

using Place = std::array<double, 3>;

/// Values -1, 0 and 1 for the digits 0, 1 and 2 of `pattern`, the isovalue is 0: a vertex between below and above lies
/// exactly in the middle of its edge.
std::vector<float> values_of(int pattern, std::size_t points) {
    std::vector<float> values;
    for (; values.size() < points; pattern /= 3) values.push_back(static_cast<float>(pattern % 3 - 1));
    return values;
}

/// What the contract says of one tet.
struct Expected {
    std::size_t triangles = 0;
    std::map<Ends, Place> vertices;
};

Expected expected_of(const Corners& tet, const std::vector<float>& values, const std::vector<Place>& points,
                     Ties ties) {
    std::vector<std::int64_t> tied, above, below;
    for (const std::int64_t p : tet) {
        const float value = values[static_cast<std::size_t>(p)];
        (value < 0 ? below : value > 0 ? above : tied).push_back(p);
    }
    const auto place = [&](std::int64_t p) { return points[static_cast<std::size_t>(p)]; };
    const auto middle = [&](std::int64_t p, std::int64_t q) {
        return Place{(place(p)[0] + place(q)[0]) / 2, (place(p)[1] + place(q)[1]) / 2, (place(p)[2] + place(q)[2]) / 2};
    };
    const std::size_t t = tied.size(), a = above.size(), b = below.size();
    Expected out;
    if (ties == Ties::keep) {
        out.triangles = b == 0 || b == 4 ? 0 : b == 2 ? 2 : 1;
        for (const std::int64_t low : below) {
            for (const std::int64_t high : above) out.vertices[{low, high}] = middle(low, high);
            for (const std::int64_t point : tied) out.vertices[{low, point}] = place(point);
        }
        return out;
    }
    out.triangles = t == 0 && a == 2 && b == 2 ? 2 : b > 0 && (a > 0 || t == 3) ? 1 : 0;
    if (out.triangles == 0) return out;
    for (const std::int64_t point : tied) out.vertices[{point, point}] = place(point);
    for (const std::int64_t low : below)
        for (const std::int64_t high : above) out.vertices[{low, high}] = middle(low, high);
    return out;
}

/// The gradient of the linear function through a tet's values, times six volumes: its direction if the tet is upright.
Place gradient_times_volume(const Corners& tet, const std::vector<float>& values, const std::vector<Place>& points) {
    std::array<Place, 3> edge{};
    std::array<double, 3> rise{};
    const auto at = [&](std::size_t k) { return static_cast<std::size_t>(tet[k]); };
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t axis = 0; axis < 3; ++axis) edge[k][axis] = points[at(k + 1)][axis] - points[at(0)][axis];
        rise[k] = static_cast<double>(values[at(k + 1)]) - static_cast<double>(values[at(0)]);
    }
    Place out{};
    double volume = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
        const auto cross = [&](std::size_t m, std::size_t n) {
            return edge[m][j] * edge[n][k] - edge[m][k] * edge[n][j];
        };
        out[axis] = rise[0] * cross(1, 2) + rise[1] * cross(2, 0) + rise[2] * cross(0, 1);
        volume += edge[0][axis] * cross(1, 2);
    }
    for (double& x : out) x *= volume > 0 ? 1 : -1;
    return out;
}

double dot_with_normal(const Surface& surface, std::size_t triangle, const Place& direction) {
    const auto c = corners_of(surface, triangle);
    const Place a = position_of(surface, c[0]), b = position_of(surface, c[1]), d = position_of(surface, c[2]);
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
        sum += direction[axis] * ((b[j] - a[j]) * (d[k] - a[k]) - (b[k] - a[k]) * (d[j] - a[j]));
    }
    return sum;
}

/// Checks counts, vertices and orientation of a surface of some tets; source cells are the tets.
void expect_case(const Surface& surface, const std::vector<Corners>& tets, const std::vector<float>& values,
                 const std::vector<Place>& points, Ties ties) {
    std::map<Ends, Place> vertices;
    std::size_t triangles = 0;
    for (const Corners& tet : tets) {
        const Expected one = expected_of(tet, values, points, ties);
        triangles += one.triangles;
        vertices.insert(one.vertices.begin(), one.vertices.end());
    }
    ASSERT_EQ(surface.triangle_count(), triangles);
    ASSERT_EQ(surface.vertex_count(), vertices.size());
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
        const auto wanted = vertices.find(ends_of(surface, v));
        ASSERT_NE(wanted, vertices.end());
        ASSERT_EQ(position_of(surface, v), wanted->second);
    }
    std::vector<bool> used(surface.vertex_count(), false);
    for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
        const Corners& tet = tets[static_cast<std::size_t>(surface.source_cells.as<std::int64_t>()[t])];
        const double up = dot_with_normal(surface, t, gradient_times_volume(tet, values, points));
        // Kept mode may give triangles without area where points are tied; no others.
        ASSERT_TRUE(ties == Ties::merge ? up > 0 : up >= 0) << "triangle " << t << ", normal times gradient " << up;
        for (const std::size_t v : corners_of(surface, t)) used[v] = true;
    }
    ASSERT_TRUE(std::ranges::all_of(used, [](bool is_used) { return is_used; }));
}

/// The face of both tets when they share one; edges that lie in it must be used equally often in both directions.
void expect_closed_across(const Corners& shared, const Surface& surface) {
    std::map<DirectedEdge, int> uses;
    std::map<std::array<Ends, 3>, int> faces;
    for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
        const auto c = corners_of(surface, t);
        std::array<Ends, 3> corner{ends_of(surface, c[0]), ends_of(surface, c[1]), ends_of(surface, c[2])};
        for (std::size_t k = 0; k < 3; ++k) ++uses[{corner[k], corner[(k + 1) % 3]}];
        std::rotate(corner.begin(), std::ranges::min_element(corner), corner.end());
        ASSERT_EQ(++faces[corner], 1) << "a triangle occurs twice";
    }
    const auto in_shared = [&](std::int64_t p) { return p == shared[0] || p == shared[1] || p == shared[2]; };
    for (const auto& [edge, count] : uses) {
        const auto back = uses.find({edge.second, edge.first});
        const int backward = back == uses.end() ? 0 : back->second;
        std::set<std::int64_t> ends{edge.first.first, edge.first.second, edge.second.first, edge.second.second};
        const bool lies_in_both_tets = std::ranges::all_of(ends, in_shared) && ends.size() == 3;
        ASSERT_TRUE(count == backward || !lies_in_both_tets);
    }
}

void for_corner_orders(const Corners& tet, const std::function<void(const Corners&)>& visit) {
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    std::uint32_t number = 0;
    do
        if (number++ % seed_share == 0) visit({tet[order[0]], tet[order[1]], tet[order[2]], tet[order[3]]});
    while (std::next_permutation(order.begin(), order.end()));
}

void expect_all_cases(const std::vector<Place>& points, const std::vector<Corners>& tets, const Corners* shared) {
    PackOptions pack_options;
    pack_options.source_cells = true;
    PackedGrid packed =
        pack(tet_grid(points, tets), field_of(values_of(0, points.size())), pack_options, {.threads = 1}).value();
    const int patterns = static_cast<int>(std::lround(std::pow(3, points.size())));
    for (int pattern = 0; pattern < patterns; ++pattern) {
        const std::vector<float> values = values_of(pattern, points.size());
        packed = packed.with_field(field_of(values), {.threads = 1}).value();
        for (const Ties ties : {Ties::merge, Ties::keep})
            for (const Engine engine : both_engines) {
                SCOPED_TRACE(testing::Message()
                             << "values " << testing::PrintToString(values) << ", tets " << testing::PrintToString(tets)
                             << ", ties " << int(ties) << ", engine " << int(engine));
                ExtractOptions options;
                options.ties = ties;
                options.edge_ends = true;
                options.source_cells = true;
                const Surface surface = extract_on(engine, packed, 0, options, {.threads = 1}).value().surface;
                ASSERT_NO_FATAL_FAILURE(expect_case(surface, tets, values, points, ties));
                if (shared) {
                    ASSERT_NO_FATAL_FAILURE(expect_closed_across(*shared, surface));
                }
            }
    }
}

const std::vector<Place> two_tets_places{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {4, 4, 8}};

TEST(OneTet, GivesWhatTheContractSaysInAll81CasesAndCornerOrders) {
    const std::vector<Place> points(two_tets_places.begin(), two_tets_places.begin() + 4);
    for_corner_orders({0, 1, 2, 3}, [&](const Corners& tet) { expect_all_cases(points, {tet}, nullptr); });
}

TEST(TwoTets, GiveWhatTheContractSaysInAll243CasesAndAreClosedAcrossTheirFace) {
    const Corners shared{1, 2, 3, 3};
    for_corner_orders({0, 1, 2, 3}, [&](const Corners& first) {
        expect_all_cases(two_tets_places, {first, {1, 2, 3, 4}}, &shared);
        expect_all_cases(two_tets_places, {{4, 1, 2, 3}, first}, &shared);
    });
}

TEST(TwoTets, GiveADoubleSheetWhereTheirFaceIsTiedAndBothApexesAreBelow) {
    const Grid grid = tet_grid(two_tets_places, {{0, 1, 2, 3}, {1, 2, 3, 4}});
    const PackedGrid packed = pack(grid, field_of<float>({-1, 0, 0, 0, -1})).value();
    EXPECT_EQ(extract(packed, 0).value().surface.triangle_count(), 2u);
    EXPECT_EQ(extract(packed, 0).value().surface.vertex_count(), 3u);
    // Above on one side: one sheet. Above on both sides: none.
    EXPECT_EQ(extract(pack(grid, field_of<float>({-1, 0, 0, 0, 1})).value(), 0).value().surface.triangle_count(), 1u);
    EXPECT_EQ(extract(pack(grid, field_of<float>({1, 0, 0, 0, 1})).value(), 0).value().surface.triangle_count(), 0u);
}

TEST(IsolatedPeak, GivesNoVertexInDefaultMode) {
    // Only point 0 reaches the isovalue: it has active edges, but no triangle uses them.
    const PackedGrid packed =
        pack(tet_grid(two_tets_places, {{0, 1, 2, 3}}), field_of<float>({0, -1, -1, -1, 0})).value();
    const Extraction merged = extract(packed, 0).value();
    EXPECT_EQ(merged.surface.vertex_count(), 0u);
    EXPECT_EQ(merged.report.tied_points, 1u); // point 4 is tied, too, but no tet uses it
    ExtractOptions keep;
    keep.ties = Ties::keep;
    EXPECT_EQ(extract(packed, 0, keep).value().surface.vertex_count(), 3u);
    EXPECT_EQ(extract(packed, 0, keep).value().surface.triangle_count(), 1u);
}

} // namespace
} // namespace isotet::test
