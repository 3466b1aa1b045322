// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The storage rule: rounding is monotone, "unchanged" compares exactly, and nothing stored is denormal or overflows.
#include "numbers/storage.hpp"

#include <algorithm>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include <isotet/pack.hpp>

#include "support/seeds.hpp"

namespace isotet::test {
namespace {

using core::Storage;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Doubles of all magnitudes, zeros and infinities among them, ascending.
std::vector<double> wild_values(std::uint32_t seed, double least_power, double max_power) {
    std::mt19937_64 random(seed);
    std::vector<double> values{0.0, -0.0, infinity, -infinity};
    for (int i = 0; i < 3000; ++i) {
        const double power = std::uniform_real_distribution<double>(least_power, max_power)(random);
        const double value = std::exp2(power) * (random() % 2 ? 1 : -1);
        values.insert(values.end(), {value, std::nextafter(value, infinity), value * (1 + 0x1p-30)});
    }
    std::sort(values.begin(), values.end());
    return values;
}

Storage storage_for(const std::vector<double>& values, ScalarType type, Precision precision) {
    core::ValueStatistics statistics;
    for (const double v : values) statistics.add(v);
    Storage storage = core::choose_offset(type, statistics, precision);
    double smallest = infinity, largest = 0;
    for (const double v : values) {
        const double magnitude = std::abs(v - storage.offset);
        if (!(magnitude > 0) || std::isinf(magnitude)) continue;
        smallest = std::min(smallest, magnitude);
        largest = std::max(largest, magnitude);
    }
    core::choose_scale(storage, smallest, largest);
    return storage;
}

template <class Real>
void expect_rules(const std::vector<double>& values, ScalarType type) {
    const Storage storage = storage_for(values, type, sizeof(Real) == 4 ? Precision::float32 : Precision::float64);
    int exponent = 0;
    ASSERT_EQ(std::frexp(storage.scale, &exponent), 0.5) << "the scale must be a power of two";
    Real before = -std::numeric_limits<Real>::infinity();
    for (const double value : values) {
        const Real stored = core::store_value<Real>(value, storage);
        ASSERT_GE(stored, before) << value;
        before = stored;
        const double magnitude = std::abs(static_cast<double>(stored));
        ASSERT_TRUE(magnitude == 0 || magnitude == 0x1p91 || (magnitude >= 0x1p-70 && magnitude <= 0x1p57)) << value;
        ASSERT_FALSE(stored == 0 && std::signbit(stored));
        // The isovalue's rounding is monotone, too, and agrees with that of the values: no tie vanishes.
        if (std::isinf(value)) continue;
        const core::StoredIsovalue<Real> isovalue = core::store_isovalue<Real>(value, storage);
        ASSERT_EQ(stored, isovalue.tied) << value;
        ASSERT_EQ(stored, isovalue.value) << value;
        ASSERT_EQ(isovalue.rest, 0) << value;
        ASSERT_LE(std::abs(static_cast<double>(isovalue.value)), 0x1p57);
    }
}

TEST(StoredValues, AreMonotoneNormalAndTieWithTheirOwnIsovalue) {
    for (const std::uint32_t seed : Seeds(1, 4)) {
        expect_rules<float>(wild_values(seed, -10, 10), ScalarType::float64);
        expect_rules<float>(wild_values(seed, -1060, 1020), ScalarType::float64);
        expect_rules<float>(wild_values(seed, 700, 1020), ScalarType::float64);
        expect_rules<float>(wild_values(seed, -1060, -900), ScalarType::float64);
        expect_rules<double>(wild_values(seed, -1060, 1020), ScalarType::float64);
        expect_rules<double>(wild_values(seed, -100, 40), ScalarType::float64);
    }
}

TEST(UnchangedValues, AreOnTheSideOfTheExactIsovalue) {
    std::mt19937_64 random(5);
    std::vector<double> values;
    for (int i = 0; i < 300; ++i)
        values.push_back(static_cast<double>(std::uniform_real_distribution<float>(-4, 9)(random)));
    const Storage storage = storage_for(values, ScalarType::float32, Precision::float32);
    ASSERT_TRUE(storage.unchanged);
    for (int i = 0; i < 300; ++i) {
        const double near = values[random() % values.size()];
        for (const double isovalue :
             {near, std::nextafter(near, infinity), std::nextafter(near, -infinity), near + 0.1})
            for (const double value : values) {
                const float given = core::store_value<float>(value, storage);
                const core::StoredIsovalue<float> stored = core::store_isovalue<float>(isovalue, storage);
                ASSERT_EQ(given >= stored.value, value >= isovalue);
                ASSERT_EQ(given == stored.tied, value == isovalue);
                ASSERT_NEAR(stored.sum(), isovalue, std::abs(isovalue) * 0x1p-47);
            }
    }
}

TEST(ChangedValues, NeverChangeSideWithoutATie) {
    std::mt19937_64 random(6);
    std::vector<double> values;
    for (int i = 0; i < 300; ++i) values.push_back(std::uniform_real_distribution<double>(101324, 101326)(random));
    const Storage storage = storage_for(values, ScalarType::float64, Precision::float32);
    EXPECT_NEAR(storage.offset, 101325, 0.1);
    for (const double isovalue : values)
        for (const double value : values) {
            const float stored = core::store_value<float>(value, storage),
                        wanted = core::store_isovalue<float>(isovalue, storage).tied;
            ASSERT_TRUE(stored == wanted || (stored > wanted) == (value > isovalue));
        }
}

TEST(Offset, IsTakenOnlyWhereTheRangeIsBelowAnEighthOfTheMagnitude) {
    const auto offset = [](ScalarType type, double lower, double upper, Precision precision = Precision::float32) {
        core::ValueStatistics statistics;
        statistics.add(lower);
        statistics.add(upper);
        return core::choose_offset(type, statistics, precision).offset;
    };
    EXPECT_EQ(offset(ScalarType::float64, 700, 800), 0); // exactly an eighth
    EXPECT_EQ(offset(ScalarType::float64, 701, 800), 750.5);
    EXPECT_EQ(offset(ScalarType::float64, -800, -701), -750.5);
    EXPECT_EQ(offset(ScalarType::float32, 701, 800), 0); // stored unchanged
    EXPECT_EQ(offset(ScalarType::int64, 701, 800), 0);   // below 2^24
    EXPECT_EQ(offset(ScalarType::int64, 0x1p30, 0x1p30 + 2), 0x1p30 + 1);
    EXPECT_EQ(offset(ScalarType::float64, 701, 800, Precision::float64), 0);
}

TEST(Scale, IsTakenOnlyWhereValuesAreHugeOrTiny) {
    const auto scale = [](double smallest, double largest) {
        Storage storage;
        core::choose_scale(storage, smallest, largest);
        return storage.scale;
    };
    EXPECT_EQ(scale(1, 0x1.fffp56), 1);
    EXPECT_EQ(scale(1, 0x1p57), 0.5);
    EXPECT_EQ(scale(0x1p-70, 1), 1);
    EXPECT_EQ(scale(0x1p-71, 1), 0x1p56);
    EXPECT_EQ(scale(0x1p-1074, 0x1p-1074), 0x1p1023);
    EXPECT_EQ(scale(1, std::numeric_limits<double>::max()), 0x1p-967);
}

TEST(Origin, IsAFloat32OnEveryAxis) {
    // Compilers have dropped the rounding of two axes that they worked on together.
    for (const double shift : {1e-13, 0.1, 1e6 / 3}) {
        Grid grid;
        std::vector<double> points{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
        for (std::size_t i = 0; i < points.size(); ++i) points[i] += shift * double(1 + i % 3);
        grid.points = Array::own(std::move(points), 3);
        grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, 3});
        const auto packed = pack(grid, {"x", Array::own(std::vector<float>{0, 1, 2, 3}), false, {}}).value();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::uint64_t bits;
            const double origin = packed.data().origin[axis];
            std::memcpy(&bits, &origin, sizeof bits);
            EXPECT_EQ(bits & 0x1fffffffu, 0u) << "axis " << axis << ", shift " << shift << ": " << origin;
        }
    }
}

TEST(NaN, IsToldByItsBits) {
    for (const std::uint32_t bits : {0x7fc00000u, 0xffc00000u, 0x7f800001u, 0xffffffffu})
        EXPECT_TRUE(core::is_nan(std::bit_cast<float>(bits)));
    for (const float x : {0.0f, -0.0f, INFINITY, -INFINITY, 1e-45f}) EXPECT_FALSE(core::is_nan(x));
    EXPECT_TRUE(core::is_nan(std::bit_cast<double>(0xfff0000000000001u)));
    EXPECT_FALSE(core::is_nan(infinity));
    EXPECT_EQ(std::bit_cast<std::uint32_t>(core::store_value<float>(std::bit_cast<double>(0xfff0000000000001u), {})),
              0x7fc00000u);
}

TEST(EqualsExactly, ComparesIntegersThatDoublesCannotHold) {
    constexpr std::int64_t big = (std::int64_t{1} << 53) + 1;
    EXPECT_FALSE(core::equals_exactly(big, 0x1p53));
    EXPECT_TRUE(core::equals_exactly(big - 1, 0x1p53));
    EXPECT_TRUE(core::equals_exactly(std::numeric_limits<std::int64_t>::min(), -0x1p63));
    EXPECT_FALSE(core::equals_exactly(std::numeric_limits<std::int64_t>::max(), 0x1p63));
    EXPECT_FALSE(core::equals_exactly(std::numeric_limits<std::uint64_t>::max(), 0x1p64));
    EXPECT_TRUE(core::equals_exactly(std::uint64_t{1} << 63, 0x1p63));
    EXPECT_FALSE(core::equals_exactly(std::numeric_limits<std::uint64_t>::max(), -1.0));
    EXPECT_FALSE(core::equals_exactly(std::uint8_t{3}, 3.5));
    EXPECT_TRUE(core::equals_exactly(std::int8_t{-3}, -3.0));
    EXPECT_FALSE(core::equals_exactly(std::int32_t{0}, std::nan("")));
    EXPECT_TRUE(core::equals_exactly(0.0f, -0.0));
}

template <class Real>
void expect_monotone_steps() {
    std::mt19937_64 random(9);
    for (int round = 0; round < 300; ++round) {
        const double magnitude = std::exp2(std::uniform_real_distribution<double>(-68, 90)(random));
        std::uniform_real_distribution<double> draw(-magnitude, magnitude);
        core::Range<Real> range{static_cast<Real>(draw(random)), static_cast<Real>(draw(random))};
        if (range.upper < range.lower) std::swap(range.lower, range.upper);
        std::vector<Real> values{range.lower, range.upper};
        for (int i = 0; i < 50; ++i)
            values.push_back(static_cast<Real>(
                std::clamp(draw(random), static_cast<double>(range.lower), static_cast<double>(range.upper))));
        std::sort(values.begin(), values.end());
        EXPECT_EQ(core::quantize(range.lower, range), 0);
        std::uint8_t before = 0;
        for (const Real value : values) {
            const std::uint8_t step = core::quantize(value, range);
            ASSERT_GE(step, before);
            before = step;
        }
        EXPECT_GE(core::quantize(range.upper, range), range.upper > range.lower ? 127 : 0);
    }
}

TEST(Quantize, IsMonotoneAndUsesItsSteps) {
    expect_monotone_steps<float>();
    expect_monotone_steps<double>();
    EXPECT_EQ(core::quantize(3.0f, core::Range<float>{3, 3}), 0);
    EXPECT_EQ(core::quantize(0x1p91f, core::Range<float>{-0x1p91f, 0x1p91f}), 128);
    EXPECT_EQ(core::quantize(0x1.fffffep0f, core::Range<float>{0, 0x1.fffffep0f}), 255);
}

} // namespace
} // namespace isotet::test
