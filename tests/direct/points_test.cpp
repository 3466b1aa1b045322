// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Points that no tet uses decide on nothing: not on offsets, scales, origin, ranges or ties, and they may be anywhere.
#include <cmath>
#include <limits>
#include <optional>

#include "direct/direct_support.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

const double nan = std::nan("");

/// How a point that no tet uses differs from one that tells nothing new.
struct Unused {
    std::optional<std::array<double, 3>> place{};
    std::optional<double> value{}; ///< of the contoured field
    std::optional<double> large{}; ///< of a carried field from 101323 to 101327
    std::optional<double> small{}; ///< of a carried field from -2 to 2
};

/// Values from -2 to 2 times `factor` plus `shift`, on points of which some are unused.
template <class Real, class Value>
void expect_unused_points_decide_nothing(const std::vector<Unused>& unused, const std::vector<double>& isovalues,
                                         double shift = 0, double factor = 1) {
    const Grid made = made_grid("perturbed", 4, {"gyroid"});
    std::vector<Real> points;
    std::vector<Value> values;
    std::vector<double> large, small;
    const auto add = [&](const std::array<double, 3>& place, double value, double of_large, double of_small) {
        for (const double x : place) points.push_back(static_cast<Real>(x));
        values.push_back(static_cast<Value>(value));
        large.push_back(of_large);
        small.push_back(of_small);
    };
    for (std::size_t p = 0; p < made.points.tuples(); ++p) {
        const double value = made.point_fields[0].values.at(p);
        add({made.points.at(p, 0) + 1000, made.points.at(p, 1), made.points.at(p, 2) - 3e5}, value * factor + shift,
            101325 + value, value);
    }
    for (const Unused& u : unused)
        add(u.place.value_or(std::array{1000.3, 0.2, -3e5 + 0.1}), u.value.value_or(0.3 * factor + shift),
            u.large.value_or(101325.5), u.small.value_or(0.5));
    Grid grid = made;
    grid.point_fields.clear();
    grid.points = Array::own(std::move(points), 3);
    const std::vector<Field> fields{{"large", Array::own(std::move(large))}, {"small", Array::own(std::move(small))}};
    for (const Precision precision : {Precision::float32, Precision::float64})
        expect_agreement(grid, field_of(values), isovalues, precision, fields);
}

TEST(UnusedPoints, DecideNotOnTheRange) {
    for (const double extreme : {1e9, -1e9})
        expect_unused_points_decide_nothing<float, float>({{.value = extreme}}, {0.1});
    expect_unused_points_decide_nothing<double, double>({{.value = 1e9}}, {50.1}, 50);
    expect_unused_points_decide_nothing<double, double>({{.value = 0}}, {101325.1}, 101325);
}

TEST(UnusedPoints, DecideNotOnTheScale) {
    for (const double odd : {1e30, -1e30, 1e-40})
        expect_unused_points_decide_nothing<float, float>({{.value = odd}}, {0.1});
    expect_unused_points_decide_nothing<double, double>({{.value = 1e-200}}, {0.1e80}, 0, 1e80);
    expect_unused_points_decide_nothing<double, double>({{.value = 1}}, {0.1e-80}, 0, 1e-80);
    expect_unused_points_decide_nothing<double, double>({{.value = 101325 + 0x1p-30}, {.value = 101325 + 1e-11}},
                                                        {101325.1}, 101325);
}

TEST(UnusedPoints, DecideNotOnHowIntegersAreStored) {
    expect_unused_points_decide_nothing<float, std::int64_t>({{.value = 0x1p60}}, {100, 0.5}, 0, 1000);
    expect_unused_points_decide_nothing<float, std::int32_t>({{.value = 0}}, {0x1p29 + 100}, 0x1p29, 1000);
}

TEST(UnusedPoints, DecideNotOnHowCarriedFieldsAreStored) {
    for (const double odd : {0.0, 1e9, -1e300, 1e-300})
        expect_unused_points_decide_nothing<float, float>({{.large = odd}}, {0.1});
    for (const double odd : {1e9, 1e300, -1e-300})
        expect_unused_points_decide_nothing<float, float>({{.small = odd}}, {0.1});
}

TEST(UnusedPoints, DecideNotOnTheOrigin) {
    for (const double far : {1e7, -1e7, 1e300, infinity, nan})
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::array<double, 3> place{1000.3, 0.2, -3e5 + 0.1};
            place[axis] = far;
            expect_unused_points_decide_nothing<double, float>({{.place = place}}, {0.1});
            expect_unused_points_decide_nothing<float, float>({{.place = place}}, {0.1});
        }
}

TEST(UnusedPoints, AreNeitherTiedNorWithoutData) {
    for (const double odd : {0.25, nan, infinity, -infinity})
        expect_unused_points_decide_nothing<float, float>({{.value = odd}}, {0.25, 0.1});
    expect_unused_points_decide_nothing<float, float>({{.value = static_cast<double>(0.1f)}}, {0.1}); // no near tie
    expect_unused_points_decide_nothing<double, double>({{.value = 0.25}, {.value = 0.25 + 0x1p-50}}, {0.25});
    expect_unused_points_decide_nothing<float, float>({{.large = nan, .small = infinity}}, {0.1});
}

TEST(UsedPoints, DecideEvenWhereUnusedOnesAreWatchedToo) {
    // The ends of the range are used; a tied point and one without data are not.
    expect_unused_points_decide_nothing<double, double>({{.value = 0.1}, {.value = nan}}, {0.1, 0.2});
}

TEST(CoarseTets, AreCountedWhereRoundingMovesCorners) {
    // Far from each other, two small cubes: float32 offsets from the middle are coarse.
    std::vector<std::array<double, 3>> points;
    std::vector<Corners> tets;
    std::vector<double> values;
    for (const double x : {-1e6, 1e6}) {
        const auto first = static_cast<std::int64_t>(points.size());
        points.insert(points.end(), {{x, 0, 0}, {x + 0.3, 0, 0}, {x, 0.3, 0}, {x, 0, 0.3}});
        tets.push_back({first, first + 1, first + 2, first + 3});
        values.insert(values.end(), {-1, 1, 1, 1});
    }
    const Grid grid = tet_grid<double>(points, tets);
    const DirectOptions single = with_everything(Ties::merge, Precision::float32);
    EXPECT_EQ(extract_on_both(grid, field_of(values), {0}, single).coarse_tets, 2u);
    EXPECT_EQ(extract_on_both(grid, field_of(values), {0, 0.5, 2}, single).coarse_tets, 4u);
    EXPECT_EQ(
        extract_on_both(grid, field_of(values), {0}, with_everything(Ties::merge, Precision::float64)).coarse_tets, 0u);
    EXPECT_EQ(extract_on_both(tet_grid<float>(points, tets), field_of(values), {0}, single).coarse_tets, 0u);
}

TEST(NoIsovalues, GiveTheReportOfTheFieldAlone) {
    const Grid grid = made_grid("mixed", 5, {"integer", "gyroid"});
    for (std::size_t f = 0; f < 2; ++f) {
        const DirectOptions options = with_everything(Ties::merge, Precision::float32);
        expect_surfaces_of_clusters(grid, point_field(grid, f), {}, options,
                                    extract_on_both(grid, point_field(grid, f), {}, options));
    }
}

} // namespace
} // namespace isotet::test
