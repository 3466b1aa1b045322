// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Clusters hold every tet once and keep their limits; the packed arrays say what packed.hpp draws.
#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include <isotet/pack.hpp>

#include "packed/build/growth.hpp"
#include "packed/stored_cells.hpp"
#include "grid/orientation.hpp"
#include "packed/packed.hpp"
#include "numbers/storage.hpp"
#include "support/brute_weld.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

using core::Tet;

core::RankedTet ranked(const Tet& tet) {
    core::RankedTet out;
    std::copy(tet.begin(), tet.end(), out.begin());
    return out;
}

void expect_clusters(const std::vector<Tet>& tets) {
    core::Buffer<core::RankedTet> ranks(tets.size());
    std::transform(tets.begin(), tets.end(), ranks.begin(), ranked);
    const core::BlockClusters block = core::grow_clusters(std::move(ranks));
    ASSERT_EQ(block.order.size(), tets.size());
    std::vector<std::uint32_t> sorted(block.order.begin(), block.order.end());
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t i = 0; i < sorted.size(); ++i)
        ASSERT_EQ(sorted[i], i) << "a tet is missing or twice in the clusters";
    std::size_t tet = 0, point = 0;
    for (const auto& cluster : block.clusters) {
        ASSERT_GT(cluster.cells[0], 0u);
        ASSERT_LE(cluster.points, core::max_cluster_points);
        ASSERT_LE(cluster.cells[0], core::max_cluster_tets);
        std::set<std::uint64_t> listed(block.points.begin() + static_cast<std::ptrdiff_t>(point),
                                       block.points.begin() + static_cast<std::ptrdiff_t>(point + cluster.points));
        ASSERT_EQ(listed.size(), cluster.points);
        std::set<std::uint64_t> used;
        for (std::size_t end = tet + cluster.cells[0]; tet < end; ++tet)
            for (std::size_t k = 0; k < 4; ++k) {
                const std::uint8_t corner = block.words[tet].corners[k];
                ASSERT_LT(corner, cluster.points);
                ASSERT_EQ(block.points[point + corner], tets[block.order[tet]][k]);
                used.insert(tets[block.order[tet]][k]);
            }
        ASSERT_EQ(used, listed) << "a cluster lists points that its tets do not use";
        point += cluster.points;
    }
    ASSERT_EQ(point, block.points.size());
}

TEST(Growth, PutsEveryTetOfAGridIntoOneCluster) {
    for (const char* shape : {"kuhn", "shuffled", "mixed"})
        expect_clusters(split(made_grid(shape, 9, {"plane"})).value().tets);
}

TEST(Growth, PutsEveryTetOfASoupIntoOneCluster) {
    std::mt19937 random(2);
    for (const std::uint64_t points : {4u, 20u, 300u, 5000u}) {
        std::vector<Tet> tets;
        while (tets.size() < 3000) {
            std::set<std::uint64_t> corners;
            while (corners.size() < 4) corners.insert(random() % points);
            Tet tet;
            std::copy(corners.begin(), corners.end(), tet.begin());
            tets.push_back(tet);
        }
        expect_clusters(tets);
    }
}

TEST(Growth, PutsEveryTetOfAFanIntoOneCluster) {
    std::vector<Tet> around_edge, around_point, apart;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        around_edge.push_back({0, 1, i + 2, i + 3});
        around_point.push_back({0, 3 * i + 1, 3 * i + 2, 3 * i + 3});
        apart.push_back({4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3});
    }
    expect_clusters(around_edge);
    expect_clusters(around_point);
    expect_clusters(apart);
    expect_clusters({{5, 6, 7, 8}});
}

/// Everything that packed.hpp says of the arrays, found again from the tets alone.
void expect_packed_arrays(const Grid& grid, const PointField& field, bool split_cells = false) {
    PackOptions options;
    options.source_cells = true;
    options.split_cells = split_cells;
    const PackedGrid packed_grid = pack(grid, field, options).value();
    const core::Packed& packed = packed_grid.data();
    std::map<std::uint64_t, std::set<std::size_t>> point_holders; // by packed point
    std::map<std::pair<std::uint64_t, std::uint64_t>, std::set<std::size_t>> edge_holders;
    std::vector<std::vector<std::uint64_t>> locals(packed.clusters());
    std::multiset<std::pair<std::vector<std::uint64_t>, std::int64_t>> stored;
    std::uint64_t next_point = 0;
    for (std::size_t c = 0; c < packed.clusters(); ++c) {
        const core::ClusterHeader& h = packed.headers[c];
        ASSERT_EQ(h.first_point, next_point);
        next_point += h.own_points;
        locals[c].resize(core::max_cluster_points);
        const std::size_t count = core::local_points(packed, c, locals[c].data());
        locals[c].resize(count);
        ASSERT_EQ(count, std::size_t{h.own_points} + h.ghost_points);
        ASSERT_LE(count, core::max_cluster_points);
        ASSERT_TRUE(std::ranges::adjacent_find(locals[c], std::greater_equal<>{}) == locals[c].end());
        const auto tets = packed.cluster_tets(c);
        for (std::size_t i = 0; i < tets.size(); ++i) {
            std::array<std::uint64_t, 4> user{};
            for (std::size_t a = 0; a < 4; ++a) {
                const std::uint64_t p = locals[c].at(tets[i].corners[a]);
                point_holders[p].insert(c);
                user[a] = packed.user_point(p);
                for (std::size_t b = 0; b < 4; ++b)
                    if (const std::uint64_t q = locals[c].at(tets[i].corners[b]); p < q) edge_holders[{p, q}].insert(c);
            }
            ASSERT_EQ(core::canonical(user), user);
            stored.emplace(std::vector<std::uint64_t>(user.begin(), user.end()),
                           static_cast<std::int64_t>(packed.user_cell(packed.headers[c].first_word + i)));
        }
        packed.for_other_cells(c, [&](const core::StoredCell& cell) {
            for (const std::uint8_t corner : cell.corners) point_holders[locals[c].at(corner)].insert(c);
            for (const core::CellFace& face : core::shape_of(cell.kind).faces())
                for (std::size_t k = 0; k < face.count; ++k) {
                    const std::uint64_t p = locals[c].at(cell.corners[face.corners[k]]),
                                        q = locals[c].at(cell.corners[face.corners[(k + 1) % face.count]]);
                    edge_holders[{std::min(p, q), std::max(p, q)}].insert(c);
                }
            const core::WholeCell user = core::ranked_cell(packed, locals[c].data(), cell);
            stored.emplace(std::vector<std::uint64_t>(user.corners.begin(), user.corners.begin() + cell.corners.size()),
                           static_cast<std::int64_t>(packed.user_cell(packed.headers[c].first_word + cell.word)));
        });
    }
    ASSERT_EQ(next_point, packed.points());
    ASSERT_EQ(point_holders.size(), packed.points());

    decltype(stored) expected;
    const auto cells = core::CellReader::open(grid).value();
    if (cells.only_tets() || split_cells) {
        for (const UprightTet& tet : upright_tets(grid)) {
            const Tet corners = core::canonical(tet.corners);
            expected.emplace(std::vector<std::uint64_t>(corners.begin(), corners.end()), tet.cell);
        }
    } else { // made grids: upright, each once, tets as the file has them aside
        for (std::size_t cell = 0; cell < cells.count(); ++cell) {
            core::WholeCell whole = cells.whole(cell);
            if (whole.kind == core::CellKind::wedge) // stored with the first triangle outwards, made with it inwards
                std::rotate(whole.corners.begin(), whole.corners.begin() + 3, whole.corners.begin() + 6);
            Tet tet{whole.corners[0], whole.corners[1], whole.corners[2], whole.corners[3]};
            tet = core::canonical(tet);
            const auto end = whole.corners.begin() + static_cast<std::ptrdiff_t>(core::corner_count(whole.kind));
            expected.emplace(whole.kind == core::CellKind::tetrahedron
                                 ? std::vector<std::uint64_t>(tet.begin(), tet.end())
                                 : std::vector<std::uint64_t>(whole.corners.begin(), end),
                             static_cast<std::int64_t>(cell));
        }
    }
    ASSERT_EQ(stored, expected);

    const auto owner_of = [&](std::uint64_t point) { return *point_holders.at(point).begin(); };
    for (std::size_t c = 0; c < packed.clusters(); ++c) {
        const core::ClusterHeader& h = packed.headers[c];
        const core::ClusterLinks links = packed.cluster_links(c);
        for (std::size_t k = 0; k < locals[c].size(); ++k) {
            ASSERT_TRUE(point_holders.at(locals[c][k]).contains(c));
            ASSERT_EQ(owner_of(locals[c][k]) == c, k >= h.ghost_points);
        }
        std::set<std::pair<std::uint64_t, std::uint64_t>> seams, listed;
        for (const auto& [edge, holders] : edge_holders)
            if (holders.contains(c) && holders.size() > 1) seams.insert(edge);
        for (const core::SeamEdge& edge : links.own_seams) {
            ASSERT_LT(edge.lower, edge.higher);
            const std::pair pair{locals[c].at(edge.lower), locals[c].at(edge.higher)};
            ASSERT_EQ(*edge_holders.at(pair).begin(), c);
            ASSERT_TRUE(listed.insert(pair).second);
        }
        ASSERT_TRUE(std::ranges::is_sorted(links.own_seams));
        std::size_t k = 0;
        for (const core::Neighbour& neighbour : links.neighbours) {
            ASSERT_LT(neighbour.cluster, c);
            for (const std::size_t end = k + neighbour.ghost_seams; k < end; ++k) {
                const core::SeamEdge seam = links.ghost_seams[k];
                const std::pair pair{locals[c].at(seam.lower), locals[c].at(seam.higher)};
                ASSERT_EQ(*edge_holders.at(pair).begin(), neighbour.cluster);
                const core::SeamEdge there = packed.cluster_links(neighbour.cluster).own_seams[links.seam_index(k)];
                ASSERT_EQ(pair, (std::pair{locals[neighbour.cluster].at(there.lower),
                                           locals[neighbour.cluster].at(there.higher)}));
                ASSERT_TRUE(listed.insert(pair).second);
            }
        }
        ASSERT_EQ(k, links.ghost_seams.size());
        ASSERT_EQ(listed, seams);

        const auto& reals = packed.as<float>();
        bool no_data = false;
        for (const std::uint64_t p : locals[c]) {
            const float value = reals.values[p];
            no_data |= core::is_nan(value);
            ASSERT_TRUE(core::is_nan(value) || (reals.ranges[c].lower <= value && value <= reals.ranges[c].upper));
        }
        ASSERT_EQ(packed.has_no_data[c] != 0, no_data);
        const auto tets = packed.cluster_tets(c);
        for (std::size_t i = 0; i < tets.size(); ++i) {
            const core::GroupRange group = packed.group_ranges[h.first_group + i / core::group_size];
            for (const std::uint8_t corner : tets[i].corners) {
                const float value = reals.values[locals[c][corner]];
                if (core::is_nan(value)) continue;
                const std::uint8_t step = core::quantize(value, reals.ranges[c]);
                ASSERT_TRUE(group.lower <= step && step <= group.upper);
            }
        }
        std::map<core::CellKind, std::size_t> seen;
        packed.for_other_cells(c, [&](const core::StoredCell& cell) {
            std::size_t place = seen[cell.kind]++ / core::cells_per_group(cell.kind);
            for (core::CellKind kind : core::cell_kinds)
                if (kind < cell.kind) place += h.groups(kind);
            const core::GroupRange group = packed.group_ranges[h.first_group + place];
            for (const std::uint8_t corner : cell.corners) {
                const float value = reals.values[locals[c][corner]];
                if (core::is_nan(value)) continue;
                const std::uint8_t step = core::quantize(value, reals.ranges[c]);
                ASSERT_TRUE(group.lower <= step && step <= group.upper);
            }
        });
    }
}

TEST(PackedArrays, SayWhatTheTetsSay) {
    for (const std::uint32_t seed : Seeds(1, 4)) {
        const NastyGrid g = nasty_grid(seed, {.side = 8,
                                              .values = 5,
                                              .no_data = 0.05,
                                              .missing = 0.2 * (seed % 2),
                                              .inverted = 0.1,
                                              .mirrored = 0.3,
                                              .repeated = 0.1});
        expect_packed_arrays(g.grid, g.field);
    }
    for (const char* shape : {"kuhn", "layer", "mixed", "hex", "wedge", "pyramid"}) {
        const Grid grid = made_grid(shape, 7, {"gyroid"});
        expect_packed_arrays(grid, point_field(grid));
    }
    const Grid mixed = made_grid("mixed", 7, {"gyroid"});
    expect_packed_arrays(mixed, point_field(mixed), true);
}

// Tets between any four of few points: clusters with more own seams than a byte can number.
TEST(PackedArrays, SayWhatTheTetsSayWhereClustersHaveManySeams) {
    std::mt19937 random(3);
    std::vector<std::array<double, 3>> points(150);
    for (auto& point : points)
        for (double& x : point) x = std::uniform_real_distribution<double>(-1, 1)(random);
    std::vector<Corners> tets(4000);
    for (Corners& tet : tets)
        for (std::int64_t& corner : tet) corner = std::uniform_int_distribution<std::int64_t>(0, 149)(random);
    const Grid grid = tet_grid(points, tets);
    const PointField field = field_of(std::vector<float>(points.size(), 1));
    const PackedGrid packed = pack(grid, field).value();
    EXPECT_TRUE(std::ranges::any_of(packed.data().headers, [](const auto& header) { return header.wide_seams; }));
    EXPECT_FALSE(std::ranges::all_of(packed.data().headers, [](const auto& header) { return header.wide_seams; }));
    expect_packed_arrays(grid, field);
}

TEST(RepeatedTets, AreFoundAmongManyOfOnePoint) {
    // Any three of eleven points around a twelfth: 165 tets, each several times and in any order of corners.
    std::mt19937 random(5);
    std::vector<std::array<double, 3>> points{{0, 0, 0}};
    for (int i = 0; i < 11; ++i) {
        const auto coordinate = [&] { return 1 + static_cast<double>(random() % 1000); };
        points.push_back({coordinate(), coordinate(), coordinate()});
    }
    std::vector<Corners> tets;
    std::map<std::set<std::uint64_t>, std::uint64_t> first;
    while (tets.size() < 2000) {
        std::set<std::uint64_t> corners{0};
        while (corners.size() < 4) corners.insert(1 + random() % 11);
        first.emplace(corners, tets.size());
        Corners tet;
        std::copy(corners.begin(), corners.end(), tet.begin());
        std::shuffle(tet.begin(), tet.end(), random);
        tets.push_back(tet);
    }
    PackOptions options;
    options.source_cells = true;
    const PackedGrid packed = pack(tet_grid(points, tets), field_of(std::vector<float>(12, 0)), options).value();
    EXPECT_EQ(packed.report().tets, first.size());
    EXPECT_EQ(packed.report().repeated_tets, tets.size() - first.size());
    std::set<std::uint64_t> kept, expected;
    const core::Packed& data = packed.data();
    for (std::size_t c = 0; c < data.clusters(); ++c)
        for (std::size_t i = 0; i < data.headers[c].tets(); ++i)
            kept.insert(data.user_cell(data.headers[c].first_word + i));
    for (const auto& [corners, cell] : first) expected.insert(cell);
    EXPECT_EQ(kept, expected);
}

TEST(PackReport, CountsWhatIsOdd) {
    // An upright tet, the same again in another order, an inverted one, a flat one, a collapsed one; point 7 is unused.
    const std::vector<std::array<double, 3>> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                                    {1, 1, 1}, {1, 1, 0}, {3, 3, 3}, {4, 4, 4}};
    const std::vector<Corners> tets{{0, 1, 2, 3}, {1, 0, 3, 2}, {1, 2, 3, 6}, {1, 2, 4, 3}, {0, 1, 5, 2}, {0, 1, 1, 3}};
    const PackReport report = pack(tet_grid(points, tets), field_of(std::vector<float>(8, 0))).value().report();
    EXPECT_EQ(report.points, 7u);
    EXPECT_EQ(report.tets, 4u);
    EXPECT_EQ(report.repeated_tets, 1u);
    EXPECT_EQ(report.collapsed_tets, 1u);
    EXPECT_EQ(report.flat_tets, 1u);
    EXPECT_EQ(report.inverted_tets, 1u);
    EXPECT_EQ(report.negative_tets, 1u);
    EXPECT_EQ(report.clusters, 1u);
}

} // namespace
} // namespace isotet::test
