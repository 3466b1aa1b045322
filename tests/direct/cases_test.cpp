// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All cases of one tet, of two that share a face, and of flat ones: as from the packed grid, which laws.cases hold to
// what the contract says.
#include <cmath>
#include <functional>

#include "direct/direct_support.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

using Place = std::array<double, 3>;

std::vector<float> values_of(int pattern, std::size_t points) {
    std::vector<float> values;
    for (; values.size() < points; pattern /= 3) values.push_back(static_cast<float>(pattern % 3 - 1));
    return values;
}

void expect_all_cases(const std::vector<Place>& points, const std::vector<Corners>& tets) {
    PackOptions pack_options;
    pack_options.source_cells = true;
    const Grid grid = tet_grid(points, tets);
    PackedGrid packed = pack(grid, field_of(values_of(0, points.size())), pack_options, {.threads = 1}).value();
    const int patterns = static_cast<int>(std::lround(std::pow(3, points.size())));
    for (int pattern = 0; pattern < patterns; ++pattern) {
        const PointField field = field_of(values_of(pattern, points.size()));
        packed = packed.with_field(field, {.threads = 1}).value();
        for (const Ties ties : {Ties::merge, Ties::keep})
            for (const Engine engine : both_engines) {
                DirectOptions options;
                options.extract.ties = ties;
                options.extract.edge_ends = options.extract.source_cells = true;
                const double isovalue = 0;
                const auto direct =
                    extract_direct_on(engine, grid, field, std::span(&isovalue, 1), options, {.threads = 1});
                ASSERT_EQ(sets_of(direct.value().surfaces.at(0).surface),
                          sets_of(extract(packed, 0, options.extract, {.threads = 1}).value().surface))
                    << "pattern " << pattern << ", tets " << testing::PrintToString(tets) << ", ties " << int(ties)
                    << ", engine " << int(engine);
            }
    }
}

void for_corner_orders(const Corners& tet, const std::function<void(const Corners&)>& visit) {
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    std::uint32_t number = 0;
    do
        if (number++ % seed_share == 0) visit({tet[order[0]], tet[order[1]], tet[order[2]], tet[order[3]]});
    while (std::next_permutation(order.begin(), order.end()));
}

const std::vector<Place> two_tets_places{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {4, 4, 8}};

TEST(OneTetOnce, IsThatOfThePackedGridInAll81CasesAndCornerOrders) {
    const std::vector<Place> points(two_tets_places.begin(), two_tets_places.begin() + 4);
    for_corner_orders({0, 1, 2, 3}, [&](const Corners& tet) { expect_all_cases(points, {tet}); });
}

TEST(TwoTetsOnce, AreThoseOfThePackedGridInAll243Cases) {
    for_corner_orders({0, 1, 2, 3},
                      [&](const Corners& first) { expect_all_cases(two_tets_places, {first, {1, 2, 3, 4}}); });
}

TEST(FlatTetsOnce, KeepTheOrderOfTheFileOrMirrorItWithMostOfTheGrid) {
    // A square's four corners are a flat tet between upright ones; once more with every tet mirrored.
    const std::vector<Place> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}, {0.5, 0.5, -1}};
    const std::vector<Corners> upright{{0, 1, 2, 4}, {0, 2, 3, 4}, {0, 2, 1, 3}, {0, 3, 1, 5}, {1, 3, 2, 5}};
    std::vector<Corners> mirrored = upright;
    for (Corners& tet : mirrored) std::swap(tet[1], tet[2]);
    for (const auto& tets : some_of({mirrored, upright})) expect_all_cases(points, tets);
    for (const auto& tets : {upright, mirrored})
        expect_agreement(tet_grid(points, tets), field_of<float>({-1, 1, -1, 1, -0.5f, 0.5f}), {0, 0.25});
}

TEST(FlatTetsOnce, TurnGradientsWithMostOfTheGridEvenWhereTheyAreNotCut) {
    // The flat tet has values on one side only, but its corners are ends of cut edges.
    const std::vector<Place> points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}, {0.5, 0.5, -1}};
    const std::vector<Corners> mirrored{{0, 2, 1, 4}, {0, 3, 2, 4}, {0, 1, 2, 3}, {0, 1, 3, 5}, {1, 2, 3, 5}};
    expect_agreement(tet_grid(points, mirrored), field_of<float>({1, 2, 3, 7, -1, -1}), {0});
}

TEST(SplitCellsOnce, KeepFlatPiecesAsUprightAsTheirCell) {
    // A hexahedron squeezed until some of its pieces are flat, and its mirror image.
    for (const double z : {0.0, 1.0, -1.0})
        for (const bool mirrored : {false, true}) {
            std::vector<float> points{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, static_cast<float>(z),
                                      0, 1, 1};
            if (mirrored)
                for (std::size_t i = 0; i < points.size(); i += 3) points[i] = -points[i];
            Grid grid;
            grid.points = Array::own(std::move(points), 3);
            grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 6, 7});
            grid.cells.uniform_type = CellType::hexahedron;
            for (unsigned pattern = 0; pattern < 256; pattern += seed_share) {
                std::vector<float> values;
                for (int k = 0; k < 8; ++k) values.push_back(pattern >> k & 1 ? 1.0f : -1.5f);
                expect_agreement(grid, field_of(values), {0});
            }
        }
}

TEST(CollapsedTetsOnce, GiveNothing) {
    const Grid grid = tet_grid(two_tets_places, {{0, 1, 2, 2}, {0, 1, 2, 3}, {4, 4, 4, 4}, {1, 0, 1, 3}});
    expect_agreement(grid, field_of<float>({-1, 1, 1, 1, 0}), {0, 0.5});
}

} // namespace
} // namespace isotet::test
