// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Numbers in place of no value: what counts as one, and that nothing changes where there is none.
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/isovalues.hpp>

#include "fields/fill_values.hpp"

namespace isotet {
namespace {

/// 280 to 310, and one of the numbers twice.
template <class Real>
std::vector<Real> with_fill(double fill) {
    std::vector<Real> values;
    for (int i = 0; i <= 30; ++i) values.push_back(static_cast<Real>(280 + i));
    values.insert(values.begin() + 7, static_cast<Real>(fill));
    values.push_back(static_cast<Real>(fill));
    return values;
}

template <class Real>
void expect_fill(double fill) {
    SCOPED_TRACE(fmt::format("{} of {} bytes", fill, sizeof(Real)));
    const Array values = Array::own(with_fill<Real>(fill));
    const FillValues found = core::find_fill_values(values).value();
    ASSERT_EQ(found.numbers.size(), 1u);
    EXPECT_EQ(found.numbers[0].value, static_cast<double>(static_cast<Real>(fill)));
    EXPECT_EQ(found.numbers[0].count, 2u);
    EXPECT_EQ(found.others.lower, 280);
    EXPECT_EQ(found.others.upper, 310);
    const PointField field{"T", values, false, {}};
    EXPECT_EQ(RangeLevels({.count = 1, .whole_range = true})(field).value(), std::vector<double>{295});
    const ValueRange typical = typical_range(values);
    EXPECT_GE(typical.lower, 280);
    EXPECT_LE(typical.upper, 310);
}

TEST(FillValues, AreThoseThatProgramsWrite) {
    for (const double fill :
         {-999.25, -999.0, -9999.0, -99999.0, 99999.0, 1e20, -1e20, 1e30, -1e30, 9.969209968386869e36, -3.4e38,
          1.70141e38, 3.4028234663852886e38, -3.4028234663852886e38, -2147483648.0}) {
        expect_fill<float>(fill);
        expect_fill<double>(fill);
    }
    expect_fill<double>(1.7976931348623157e308);
    expect_fill<double>(-1.7976931348623157e308);
    expect_fill<std::int32_t>(-2147483647.0);
    expect_fill<std::int16_t>(-32768.0);
}

TEST(FillValues, MayBeSeveral) {
    std::vector<double> values = with_fill<double>(1e30);
    values.push_back(-999);
    values.push_back(std::numeric_limits<double>::quiet_NaN());
    const FillValues found = core::find_fill_values(Array::own(values)).value();
    ASSERT_EQ(found.numbers.size(), 2u);
    EXPECT_EQ(found.numbers[0].value, -999);
    EXPECT_EQ(found.numbers[1].value, 1e30);
    EXPECT_EQ(found.others.upper, 310);
}

TEST(FillValues, OfPartsAreThoseOfAllValues) {
    std::vector<double> values = with_fill<double>(-9999);
    core::FillFinder finder;
    for (const double value : values) EXPECT_TRUE(finder.add(Array::own(std::vector<double>{value})));
    EXPECT_TRUE(finder.add(Array::own(std::vector<double>{std::numeric_limits<double>::quiet_NaN()})));
    const FillValues found = finder.find();
    ASSERT_EQ(found.numbers.size(), 1u);
    EXPECT_EQ(found.numbers[0].count, 2u);
    EXPECT_EQ(found.others.lower, 280);
    EXPECT_EQ(found.others.upper, 310);
    EXPECT_EQ(found.values, values.size() + 1);
}

TEST(FillValues, AreNoneNearTheOthersOrAmongThem) {
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    for (const std::vector<double>& values :
         std::vector<std::vector<double>>{{280, 290, 310},
                                          {280, 290, 1e6},                // far, but no number that stands for none
                                          {-9999, -9000, -5000, 5000},    // not far
                                          {9997, 9998, 9999},             // numbers of cells
                                          {1, 1, 1e20},                   // the others are all one
                                          {1e18, 3e19, 1e20},             // densities
                                          {-9999, -9999},                 //
                                          {1e20, 2e20, 3e20, 4e20, 5e20}, // all are large
                                          {1, 2, 1e20, 2e20, 3e20, 4e20, 5e20},
                                          {nothing, nothing},
                                          {}}) {
        SCOPED_TRACE(testing::PrintToString(values));
        const Array array = Array::own(values);
        const FillValues found = core::find_fill_values(array).value();
        EXPECT_TRUE(found.numbers.empty());
        const ComponentStatistics all = statistics_of(array).value().at(0);
        if (!(all.lower <= all.upper)) {
            EXPECT_GT(found.others.lower, found.others.upper);
            continue;
        }
        EXPECT_EQ(found.others.lower, all.lower);
        EXPECT_EQ(found.others.upper, all.upper);
    }
    const Array among = Array::own(std::vector<double>{-9999, -2000, -999, 0, 3000});
    EXPECT_EQ(core::find_fill_values(among).value().numbers.size(), 1u) << "-999 is among the others";
    EXPECT_TRUE(core::find_fill_values(Array::own(with_fill<double>(1e20), 3)).value().numbers.empty()) << "a vector";
}

} // namespace
} // namespace isotet
