// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which values colour a grid or a surface, and the scale they get.
#include <isotet/scene.hpp>

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <isotet/make.hpp>

#include "grid/values/value_digest.hpp"
#include "support/seeds.hpp"

namespace isotet {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

Array doubles(std::vector<double> values, std::size_t components = 1) {
    return Array::own(std::move(values), components);
}

/// Two tets that share a face, with a value each.
Grid two_tets(double first, double second) {
    Grid grid;
    grid.points = doubles({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, 3, 1, 2, 3, 4});
    grid.point_fields = {{"p", doubles({1, 2, 3, 4, 5})}};
    grid.cell_fields = {{"c", doubles({first, second})}};
    return grid;
}

std::pair<double, double> ends(const Result<ColorScale>& scale) { return {scale->lower, scale->upper}; }

TEST(ColorScale, SpansTheFiniteValuesOfAllArrays) {
    const std::vector<Array> values{doubles({3, nan, infinity}), doubles({-2, 7, -infinity})};
    EXPECT_EQ(ends(color_scale(values, {})), (std::pair{-2.0, 7.0}));
    ColorOptions logarithmic;
    logarithmic.scale.logarithmic = true;
    EXPECT_EQ(ends(color_scale(values, logarithmic)), (std::pair{3.0, 7.0}));
}

TEST(ColorScale, OfOneValueOrNoneLiesAroundIt) {
    const auto around = [](std::vector<double> values, bool logarithmic) {
        ColorOptions options;
        options.scale.logarithmic = logarithmic;
        const std::vector<Array> arrays{doubles(std::move(values))};
        return ends(color_scale(arrays, options));
    };
    EXPECT_EQ(around({4, 4}, false), (std::pair{2.0, 6.0}));
    EXPECT_EQ(around({-4}, false), (std::pair{-6.0, -2.0}));
    EXPECT_EQ(around({0}, false), (std::pair{-1.0, 1.0}));
    EXPECT_EQ(around({nan}, false), (std::pair{-1.0, 1.0}));
    EXPECT_EQ(around({-3, 0}, true), (std::pair{0.5, 1.5}));
}

TEST(ColorScale, RefusesARangeThatIsNone) {
    for (const ValueRange range : {ValueRange{1, 1}, {2, 1}, {nan, 1}, {0, infinity}}) {
        const auto scale = color_scale({}, {{}, range});
        ASSERT_FALSE(scale) << range.lower << ' ' << range.upper;
        EXPECT_EQ(scale.error().code, ErrorCode::invalid_argument);
    }
    ColorOptions logarithmic{{}, ValueRange{0, 1}};
    logarithmic.scale.logarithmic = true;
    EXPECT_FALSE(color_scale({}, logarithmic));
    logarithmic.range->lower = 0.5;
    EXPECT_EQ(ends(color_scale({}, logarithmic)), (std::pair{0.5, 1.0}));
}

TEST(ColorScale, HasTheSameEndsForAnyNumberOfThreads) {
    std::vector<double> values(300'000);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<double>(i));
    const Array array = doubles(std::move(values));
    const ValueRange one = *colored_range(array, false, {1, {}});
    for (const int threads : {2, 5}) {
        const ValueRange many = *colored_range(array, false, {threads, {}});
        EXPECT_EQ(many.lower, one.lower);
        EXPECT_EQ(many.upper, one.upper);
    }
}

TEST(FindColors, GivesSomeCellsTheColoursOfAll) {
    const std::vector<std::vector<double>> kinds{{3, 1, 2},   {-0.0, 0, 1},
                                                 {nan, 4, 5}, {1, 2.5},
                                                 {-3, -1},    {infinity, -infinity, 2},
                                                 {nan},       {0, 0.5, -2, nan, infinity},
                                                 {}};
    for (const std::uint32_t seed : test::Seeds(1, 60)) {
        std::mt19937 random(seed);
        std::vector<double> kind = kinds[seed % kinds.size()];
        for (int i = 0; kind.empty() && i < 20; ++i) kind.push_back(i);
        Grid all, some;
        std::vector<double> values(200);
        for (double& value : values) value = kind[random() % kind.size()];
        all.cell_fields = {{"c", doubles(values)}};
        some.cell_fields = {{"c", doubles({values[7], values[100]})}};
        core::ValueDigest digest;
        digest.add(doubles({values.begin(), values.begin() + 90}), {});
        digest.add(doubles({values.begin() + 90, values.end()}), {});
        EXPECT_LT(digest.values().tuples(), 21u);
        for (const bool logarithmic : {false, true}) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << (logarithmic ? ", logarithmic" : ""));
            ColorOptions options;
            options.scale.logarithmic = logarithmic;
            const FoundColors expected = find_colors(all, "c", options).value();
            options.all_values = digest.values();
            const FoundColors found = find_colors(some, "c", options).value();
            EXPECT_EQ(found.notes, expected.notes);
            EXPECT_EQ(found.field.classes, expected.field.classes);
            EXPECT_EQ(found.field.has_no_data, expected.field.has_no_data);
            EXPECT_EQ(found.field.scale.lower, expected.field.scale.lower);
            EXPECT_EQ(found.field.scale.upper, expected.field.scale.upper);
            EXPECT_EQ(found.field.scale.classes.size(), expected.field.scale.classes.size());
            const double value = found.field.values.at(1), same = expected.field.values.at(100);
            EXPECT_TRUE(value == same || (std::isnan(value) && std::isnan(same)));
        }
    }
}

TEST(FindColors, GivesFewWholeNumbersOfCellsAColourEach) {
    const auto found = find_colors(two_tets(7, 40), "c");
    ASSERT_TRUE(found);
    EXPECT_EQ(found->field.association, Association::cell);
    EXPECT_EQ(found->field.classes, (std::vector<std::string>{"7", "40"}));
    EXPECT_EQ(found->field.scale.classes.size(), 2u);
    EXPECT_EQ(found->field.values.as<float>()[1], 1);
    ColorOptions named;
    named.names = {{40, "wing"}, {41, "tail"}};
    EXPECT_EQ(find_colors(two_tets(7, 40), "c", named)->field.classes, (std::vector<std::string>{"7", "wing"}));
    const auto ranged = find_colors(two_tets(7, 40), "c", {{}, ValueRange{0, 50}});
    ASSERT_TRUE(ranged);
    EXPECT_TRUE(ranged->field.classes.empty()) << "a range is of values, not of classes";
    EXPECT_TRUE(find_colors(two_tets(7.5, 40), "c")->field.classes.empty());
    const auto hole = find_colors(two_tets(7, nan), "c");
    EXPECT_TRUE(hole->field.has_no_data);
    EXPECT_TRUE(std::isnan(hole->field.values.as<float>()[1]));
}

TEST(FindColors, TakesPointFieldsFirstAndTheirComponents) {
    Grid grid = two_tets(1, 2);
    grid.point_fields.push_back({"c", doubles({0.5, 1, 1, 1, 1})});
    EXPECT_EQ(find_colors(grid, "c")->field.association, Association::point);
    grid.point_fields.push_back({"v", doubles({3, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 3)});
    EXPECT_EQ(find_colors(grid, "v:mag")->field.scale.upper, 5);
    EXPECT_EQ(find_colors(grid, "v").error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(find_colors(grid, "w").error().code, ErrorCode::invalid_argument);
}

TEST(FindColors, OfASurfaceNamesTheFieldsThatThereAre) {
    Surface surface;
    surface.positions = doubles({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    surface.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2}, 3);
    surface.point_fields = {{"p", doubles({1, 2, 3})}};
    surface.cell_fields = {{"c", doubles({4})}};
    EXPECT_EQ(find_colors(surface, "p")->field.association, Association::point);
    EXPECT_EQ(find_colors(surface, "c")->field.association, Association::cell);
    const auto none = find_colors(surface, "q");
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("'p'"), std::string::npos) << none.error().message;
    EXPECT_NE(none.error().message.find("'c'"), std::string::npos) << none.error().message;
}

TEST(FindColors, NotesValuesWithoutAPlaceOnALogarithmicScale) {
    ColorOptions logarithmic;
    logarithmic.scale.logarithmic = true;
    EXPECT_TRUE(find_colors(two_tets(0.5, 1), "c", logarithmic)->notes.empty());
    EXPECT_EQ(find_colors(two_tets(-0.5, 1), "c", logarithmic)->notes.size(), 1u);
    EXPECT_EQ(find_colors(two_tets(-0.5, 0), "c", logarithmic)->notes.size(), 2u);
}

} // namespace
} // namespace isotet
