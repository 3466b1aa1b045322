// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What contour_spectrum() refuses.
#include <limits>

#include <gtest/gtest.h>

#include <isotet/isovalues.hpp>

#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

std::string refusal(const PointField& field, const std::vector<double>& isovalues, const Run& run = {}) {
    const Grid grid = made_grid("kuhn", 2, {"sphere"});
    const auto out = contour_spectrum(grid, field.values.empty() ? point_field(grid) : field, isovalues, run);
    return out ? "" : out.error().message;
}

TEST(MisusedSpectrum, SaysWhatIsWrong) {
    EXPECT_EQ(refusal({}, {}), "0 isovalues, but there must be 1 to 65536");
    EXPECT_EQ(refusal({}, std::vector<double>(65'537)), "65537 isovalues, but there must be 1 to 65536");
    EXPECT_EQ(refusal({}, {0, std::numeric_limits<double>::infinity()}), "isovalues[1] is inf, but must be finite");
    EXPECT_EQ(refusal({}, {0.5, 0.25}), "isovalues[1] is 0.25, less than the one before, 0.5, but they must ascend");
    EXPECT_EQ(
        refusal(field_of(std::vector<float>(7)), {0}),
        "field 'value' has 7 values of 1 components, but the grid has 27 points and the contoured field must have 1 "
        "component");
}

TEST(MisusedSpectrum, TakesAtLeastOneStep) {
    const Grid grid = made_grid("kuhn", 2, {"sphere"});
    const auto out = contour_spectrum_over_range(grid, point_field(grid), 0);
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().message, "0 steps, but there must be 1 to 65535");
}

TEST(SpectrumOverTheRange, HasBothEnds) {
    const Grid grid = made_grid("kuhn", 2, {"plane"});
    const PointField field = point_field(grid);
    const auto out = contour_spectrum_over_range(grid, field, 4).value();
    ASSERT_EQ(out.isovalues.size(), 5u);
    EXPECT_EQ(out.isovalues.front(), field.values.at(0));
    EXPECT_EQ(out.isovalues.back(), field.values.at(26));
    EXPECT_EQ(out.volume_below.front(), 0);
}

TEST(SpectrumOverTheRange, IsOneValueOfAConstantFieldAndNoneWithoutData) {
    const Grid grid = made_grid("kuhn", 1, {"plane"});
    EXPECT_EQ(contour_spectrum_over_range(grid, field_of(std::vector<int>(8, 3)), 4).value().isovalues,
              std::vector<double>{3});
    const std::vector<float> none(8, std::numeric_limits<float>::quiet_NaN());
    EXPECT_TRUE(contour_spectrum_over_range(grid, field_of(none), 4).value().isovalues.empty());
}

TEST(MisusedSpectrum, StopsWhenCancelled) {
    const std::atomic<bool> cancel{true};
    const Grid grid = made_grid("kuhn", 8, {"sphere"});
    const std::vector<double> isovalues{0.5};
    const auto out =
        contour_spectrum(grid, point_field(grid), isovalues, {.progress = {.report = {}, .cancel = &cancel}});
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().code, ErrorCode::cancelled);
}

TEST(MisusedSpectrum, RefusesPointsThatAreNotThere) {
    const Grid grid = tet_grid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 4}});
    const std::vector<double> isovalues{0.5};
    const auto out = contour_spectrum(grid, field_of(std::vector<float>(4)), isovalues);
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().code, ErrorCode::invalid_data);
}

} // namespace
} // namespace isotet::test
