// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Storing a field side by side gives what storing its values one by one gives, in every type and whatever passes it
// takes.
#include "packed/field_storage.hpp"

#include <bit>
#include <random>

#include <gtest/gtest.h>

#include <isotet/pack.hpp>

#include "numbers/level.hpp"
#include "packed/group_ranges.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

using core::Packed;

/// One of a few kinds of values that decide on offset, scale and passes.
template <class T>
T some_value(std::mt19937& random, int kind) {
    const double x = std::uniform_real_distribution<double>(0, 100)(random);
    if constexpr (std::is_integral_v<T>) {
        constexpr T largest = std::numeric_limits<T>::max();
        return kind % 2 ? static_cast<T>(largest - static_cast<T>(x)) : static_cast<T>(x);
    } else {
        const double rare = std::uniform_real_distribution<double>(0, 1)(random);
        if (kind >= 4 && rare < 0.05) return std::numeric_limits<T>::quiet_NaN();
        if (kind >= 4 && rare < 0.08)
            return rare < 0.065 ? std::numeric_limits<T>::infinity() : -std::numeric_limits<T>::infinity();
        if (kind >= 4 && rare < 0.12) return T(-0.0);
        switch (kind % 4) {
        case 0: return static_cast<T>(x - 50);
        case 1: return static_cast<T>(101325 + x / 100); // an offset
        case 2: return static_cast<T>(x * 1e-25);        // a scale
        default:
            return static_cast<T>(rare < 0.5 ? x * 1e30 : x * 1e-30); // a scale, and values too small beside others
        }
    }
}

struct Expected {
    core::ValueStatistics statistics;
    core::Storage storage;
    std::uint64_t flushed = 0;
};

template <class Real>
Expected expected_of(const Array& values, const Packed& packed, std::vector<Real>& stored) {
    Expected out;
    std::vector<double> exact;
    for (std::size_t i = 0; i < packed.points(); ++i) exact.push_back(values.at(packed.user_point(i)));
    for (const double value : exact) out.statistics.add(value);
    out.storage =
        core::choose_offset(values.type(), out.statistics, packed.single() ? Precision::float32 : Precision::float64);
    double smallest = std::numeric_limits<double>::infinity(), largest = 0;
    for (const double value : exact) {
        const double magnitude = std::abs(value - out.storage.offset);
        if (!(magnitude > 0) || std::isinf(magnitude)) continue;
        smallest = std::min(smallest, magnitude);
        largest = std::max(largest, magnitude);
    }
    core::choose_scale(out.storage, smallest, largest);
    for (const double value : exact) {
        stored.push_back(core::store_value<Real>(value, out.storage));
        out.flushed += stored.back() == 0 && value != out.storage.offset;
    }
    return out;
}

template <class Real, class T>
void expect_stored_like_one_by_one(int kind) {
    const Grid grid = made_grid("shuffled", 5, {"sphere"}); // 216 points: whole lanes and a rest
    PackOptions options;
    options.precision = sizeof(Real) == 4 ? Precision::float32 : Precision::float64;
    const PackedGrid packed = pack(grid, point_field(grid), options).value();
    std::mt19937 random(static_cast<unsigned>(kind) + 1);
    std::vector<T> values;
    for (std::size_t p = 0; p < grid.points.tuples(); ++p) values.push_back(some_value<T>(random, kind));
    const Array array = Array::own(std::move(values));

    std::vector<Real> expected, stored(packed.data().points());
    const Expected one_by_one = expected_of(array, packed.data(), expected);
    const core::FieldStorage field = core::store_field_values(array, packed.data(), {}, stored.data());
    SCOPED_TRACE(std::string(name_of(array.type())) + ", kind " + std::to_string(kind));
    EXPECT_EQ(field.storage.offset, one_by_one.storage.offset);
    EXPECT_EQ(field.storage.scale, one_by_one.storage.scale);
    EXPECT_EQ(field.storage.unchanged, one_by_one.storage.unchanged);
    EXPECT_EQ(field.statistics.lower, one_by_one.statistics.lower);
    EXPECT_EQ(field.statistics.upper, one_by_one.statistics.upper);
    EXPECT_EQ(field.statistics.no_data, one_by_one.statistics.no_data);
    EXPECT_EQ(field.statistics.infinite, one_by_one.statistics.infinite);
    EXPECT_EQ(field.flushed, one_by_one.flushed);
    EXPECT_EQ(std::memcmp(stored.data(), expected.data(), sizeof(Real) * stored.size()), 0);
    EXPECT_EQ(core::choose_storage(array, packed.data()).scale, one_by_one.storage.scale);
}

TEST(FieldStorage, IsThatOfValuesStoredOneByOne) {
    for (int kind = 0; kind < 8; ++kind) {
        expect_stored_like_one_by_one<float, float>(kind);
        expect_stored_like_one_by_one<float, double>(kind);
        expect_stored_like_one_by_one<double, float>(kind);
        expect_stored_like_one_by_one<double, double>(kind);
    }
    for (int kind = 0; kind < 2; ++kind) {
        expect_stored_like_one_by_one<float, std::int8_t>(kind);
        expect_stored_like_one_by_one<float, std::uint16_t>(kind);
        expect_stored_like_one_by_one<float, std::int32_t>(kind);
        expect_stored_like_one_by_one<float, std::uint64_t>(kind);
        expect_stored_like_one_by_one<double, std::int64_t>(kind);
    }
}

TEST(GroupRanges, AreThoseOfTheCornersOnEveryLevel) {
    std::mt19937 random(7);
    constexpr std::size_t groups = 9;
    std::vector<core::StoredTet> all(core::group_size * groups);
    for (core::StoredTet& tet : all)
        for (std::uint8_t& corner : tet.corners)
            corner = static_cast<std::uint8_t>(random() % core::max_cluster_points);
    for (int round = 0; round < 20; ++round) {
        // The last group is whole, or not.
        const auto tets = std::span(all).first(all.size() - static_cast<std::size_t>(round) / 2 * 3);
        core::PointSteps lower, upper;
        for (std::size_t k = 0; k < lower.size(); ++k) {
            lower[k] = upper[k] = static_cast<std::uint8_t>(random() % (round % 2 ? 256 : 3) + (round % 2 ? 0 : 200));
            if (random() % 7 == 0) lower[k] = 255, upper[k] = 0;
        }
        for (int level = 0; level <= int(core::best_level()); ++level) {
            core::force_level(core::Level(level));
            std::array<core::GroupRange, groups> out;
            core::find_group_ranges(tets, lower, upper, out.data());
            core::force_level({});
            for (std::size_t g = 0; g < groups; ++g) {
                std::uint8_t least = 255, most = 0;
                for (std::size_t i = core::group_size * g; i < std::min(tets.size(), core::group_size * (g + 1)); ++i)
                    for (const std::uint8_t corner : tets[i].corners) {
                        least = std::min(least, lower[corner]);
                        most = std::max(most, upper[corner]);
                    }
                EXPECT_EQ(out[g].lower, least) << core::name_of(core::Level(level));
                EXPECT_EQ(out[g].upper, most) << core::name_of(core::Level(level));
            }
        }
    }
}

} // namespace
} // namespace isotet::test
