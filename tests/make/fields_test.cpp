// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The analytic fields have the values of their formulas at the points of the grid.
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include <isotet/make.hpp>

namespace {

using namespace isotet;

Grid with_field(const std::string& shape, const std::string& field, std::uint64_t seed = 1) {
    MakeOptions options;
    options.shape = shape;
    options.side = 6;
    options.fields = {field};
    options.seed = seed;
    return make_grid(options).value();
}

template <class Formula>
void expect_values(const std::string& field, const Formula& formula) {
    for (const char* shape : {"kuhn", "shuffled", "pyramid", "layer"}) {
        const Grid grid = with_field(shape, field);
        const Array& values = grid.point_fields.at(0).values;
        ASSERT_EQ(values.tuples(), grid.points.tuples());
        ASSERT_EQ(values.type(), ScalarType::float32);
        for (std::size_t p = 0; p < values.tuples(); ++p) {
            const double expected = formula(grid.points.at(p, 0), grid.points.at(p, 1), grid.points.at(p, 2));
            ASSERT_NEAR(values.at(p), expected, 1e-6 * (1 + std::abs(expected))) << shape << " point " << p;
        }
    }
}

TEST(MakeFields, SphereIsTheDistanceFromTheCentre) {
    expect_values("sphere", [](double x, double y, double z) { return std::hypot(x, y, z); });
}

TEST(MakeFields, TorusIsTheDistanceFromACircle) {
    expect_values("torus", [](double x, double y, double z) { return std::hypot(std::hypot(x, y) - 0.5, z); });
}

TEST(MakeFields, PlaneIsTheDistanceAlongItsNormal) {
    expect_values("plane", [](double x, double y, double z) { return (x + 2 * y + 3 * z) / std::sqrt(14.0); });
}

TEST(MakeFields, GyroidHasTwoPeriodsAlongEachAxis) {
    expect_values("gyroid", [](double x, double y, double z) {
        constexpr double w = 2 * std::numbers::pi;
        return std::sin(w * x) * std::cos(w * y) + std::sin(w * y) * std::cos(w * z) +
               std::sin(w * z) * std::cos(w * x);
    });
}

TEST(MakeFields, WaveletIsThatOfVtk) {
    expect_values("wavelet", [](double x, double y, double z) {
        const double gauss = std::exp(-(x * x + y * y + z * z) / (2 * 4 * 0.5 * 0.5));
        return 255 * gauss + 10 * std::sin(60 * x / 2) + 18 * std::sin(30 * y / 2) + 5 * std::cos(40 * z / 2);
    });
}

TEST(MakeFields, IntegerHasFiveValuesAndFollowsItsPoint) {
    const Grid grid = with_field("kuhn", "integer");
    const Array& values = grid.point_fields.at(0).values;
    ASSERT_EQ(values.type(), ScalarType::int32);
    const auto all = values.as<std::int32_t>();
    EXPECT_EQ(std::set<std::int32_t>(all.begin(), all.end()), (std::set<std::int32_t>{0, 1, 2, 3, 4}));
    EXPECT_NE(std::vector(all.begin(), all.end()), [] {
        const Grid other = with_field("kuhn", "integer", 2);
        const auto o = other.point_fields.at(0).values.as<std::int32_t>();
        return std::vector(o.begin(), o.end());
    }());
}

TEST(MakeFields, AreRefusedWhenUnknownOrAskedForTwice) {
    MakeOptions options;
    options.fields = {"sphere", "gyriod"};
    auto grid = make_grid(options);
    ASSERT_FALSE(grid);
    EXPECT_EQ(grid.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(grid.error().message.find("'gyriod', but must be one of gyroid, "), std::string::npos)
        << grid.error().message;
    options.fields = {"sphere", "sphere"};
    grid = make_grid(options);
    ASSERT_FALSE(grid);
    EXPECT_EQ(grid.error().code, ErrorCode::invalid_argument);
}

TEST(MakeFields, MayBeLeftOutAltogether) {
    MakeOptions options;
    options.fields = {};
    EXPECT_TRUE(make_grid(options).value().point_fields.empty());
}

} // namespace
