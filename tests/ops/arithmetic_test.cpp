// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The arithmetic of the contract where it is awkward: ends of edges, NaN, normals of long and short triangles, normal
// codes.
#include "numbers/arithmetic.hpp"

#include <algorithm>
#include <bit>
#include <random>

#include <gtest/gtest.h>

#include "base/bits.hpp"
#include "base/system/memory.hpp"
#include "grid/cell/case_table.hpp"
#include "numbers/normal_code.hpp"

namespace isotet::test {
namespace {

using core::Vector;

template <class Real>
Real length(const Vector<Real>& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

TEST(EdgeWeight, IsZeroBelowTwoToMinus32AndOneAtTheUpperEnd) {
    EXPECT_EQ(core::edge_weight<float>({0}, -1, 0x1p32f), 0x1p-32f);
    EXPECT_EQ(core::edge_weight<float>({0}, -1, 0x1p33f), 0.0f);
    EXPECT_EQ(core::edge_weight<double>({0}, -1, 0x1p33), 0.0);
    EXPECT_EQ(core::edge_weight<float>({5}, 2, 5), 1.0f);
    EXPECT_EQ(core::edge_weight<float>({0}, -0x1p91f, 0x1p91f), 0.5f);
    EXPECT_EQ(core::edge_weight<float>({1}, 0, 3), 1.0f / 3.0f);
}

TEST(EdgeWeight, IsThatOfTheIsovalueAsGivenBetweenNeighbouringFloats) {
    constexpr float below = 1, above = 1 + 0x1p-23f;
    for (const double share : {0x1p-20, 0.1, 0.5, 0.999})
        EXPECT_NEAR(core::edge_weight(core::store_isovalue<float>(1 + share * 0x1p-23, {}), below, above), share,
                    0x1p-24);
}

/// A million isovalues and ends as near as can be, and far: 0 to 1, whatever is rounded.
TEST(EdgeWeight, IsNeverOutsideOfItsEdge) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> draw(-2, 2), share(0, 1);
    for (int i = 0; i < 1000000; ++i) {
        const double isovalue = draw(random);
        const auto stored = core::store_isovalue<float>(isovalue, {});
        const float below =
            i % 2 ? std::nextafter(stored.value, -3.0f) : static_cast<float>(isovalue - 4 - share(random));
        const float above = i % 4 < 2 ? stored.value : static_cast<float>(isovalue + 4 * share(random) + 0.001);
        const float t = core::edge_weight(stored, below, above);
        ASSERT_TRUE(t >= 0 && t <= 1) << t << " at " << isovalue;
    }
}

TEST(Interpolate, GivesExactlyTheEndsWhereTheFormulaAloneDoesNot) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> draw(-100, 100);
    int formula_misses = 0;
    for (int i = 0; i < 2000; ++i) {
        const float a = draw(random), b = draw(random), difference = b - a;
        formula_misses += a + difference != b;
        ASSERT_EQ(core::interpolate(a, b, 1.0f), b);
        ASSERT_EQ(core::interpolate(a, b, 0.0f), a);
    }
    EXPECT_GT(formula_misses, 100);
}

TEST(InterpolateField, GivesTheCanonicalNaNWhenAnEndHasNoData) {
    const float odd = std::bit_cast<float>(0xff801234u);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(core::interpolate_field(odd, 1.0f, 0.0f)), 0x7fc00000u);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(core::interpolate_field(1.0f, odd, 0.0f)), 0x7fc00000u);
    EXPECT_EQ(core::interpolate_field(1.0f, 3.0f, 0.5f), 2.0f);
}

TEST(FaceNormal, HasUnitLengthForTrianglesOfEverySize) {
    for (const float size : {0x1p-69f, 0x1p-40f, 1.0f, 0x1p40f, 0x1p80f}) {
        const Vector<float> n = core::face_normal<float>({0, 0, 0}, {size, 0, 0}, {0, size, 0});
        EXPECT_EQ(n, (Vector<float>{0, 0, 1})) << size;
    }
    std::mt19937 random(2);
    std::uniform_real_distribution<float> draw(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        const Vector<float> a{draw(random), draw(random), draw(random)}, b{draw(random), draw(random), draw(random)},
            c{draw(random), draw(random), draw(random)};
        const Vector<float> n = core::face_normal(a, b, c), back = core::face_normal(a, c, b);
        ASSERT_NEAR(length(n), 1, 1e-6);
        for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_NEAR(n[axis], -back[axis], 1e-6);
    }
}

TEST(FaceNormal, IsZeroForTrianglesWithoutArea) {
    EXPECT_EQ(core::face_normal<float>({1, 2, 3}, {1, 2, 3}, {4, 5, 7}), (Vector<float>{}));
    EXPECT_EQ(core::face_normal<float>({0, 0, 0}, {1, 2, 4}, {2, 4, 8}), (Vector<float>{}));
    EXPECT_EQ(core::face_normal<double>({0, 0, 0}, {0, 0, 0}, {0, 0, 0}), (Vector<double>{}));
}

TEST(VertexNormal, IsZeroWhenAnEndHasNoneOrTheyCancel) {
    const std::uint32_t up = core::encode_normal({0, 0, 1}), down = core::encode_normal({0, 0, -1}),
                        along = core::encode_normal({1, 0, 0});
    EXPECT_EQ(core::vertex_normal<float>(core::zero_normal_code, up, 0.5f), (Vector<float>{}));
    EXPECT_EQ(core::vertex_normal<float>(up, core::zero_normal_code, 0.0f), (Vector<float>{}));
    EXPECT_EQ(core::vertex_normal<float>(up, down, 0.5f), (Vector<float>{}));
    EXPECT_EQ(core::vertex_normal<float>(up, along, 1.0f), (Vector<float>{1, 0, 0}));
    EXPECT_NEAR(length(core::vertex_normal<float>(up, along, 0.3f)), 1, 1e-6);
}

TEST(NormalCode, IsWithinATenThousandthOfTheDirection) {
    std::mt19937 random(3);
    std::normal_distribution<double> draw;
    for (int i = 0; i < 20000; ++i) {
        const std::array<double, 3> n{draw(random), draw(random), draw(random)};
        const std::uint32_t code = core::encode_normal(n);
        ASSERT_NE(code, core::zero_normal_code);
        const Vector<double> back = core::direction_of<double>(code);
        const double size = length(n);
        for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_NEAR(back[axis], n[axis] / size, 1e-4);
    }
}

TEST(NormalCode, HoldsAxesExactlyAndKeepsOneCodeForNoDirection) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
            std::array<double, 3> n{};
            n[axis] = sign;
            EXPECT_EQ(core::direction_of<double>(core::encode_normal(n)), n);
            n[axis] = sign * 1e-300;
            EXPECT_EQ(core::direction_of<float>(core::encode_normal(n))[axis], static_cast<float>(sign));
        }
    EXPECT_EQ(core::encode_normal({0, 0, 0}), core::zero_normal_code);
    EXPECT_EQ(core::encode_normal({std::nan(""), 0, 1}), core::zero_normal_code);
    EXPECT_EQ(core::encode_normal({INFINITY, 0, 1}), core::zero_normal_code);
    EXPECT_EQ(core::direction_of<float>(core::zero_normal_code), (Vector<float>{}));
}

TEST(CaseTable, GivesACaseAndItsComplementTheSameDiagonalAndOppositeSides) {
    for (unsigned index = 1; index < 15; ++index) {
        const core::TetCase &a = core::case_table[index], &b = core::case_table[15 - index];
        ASSERT_EQ(a.triangles, std::popcount(index) == 2 ? 2 : 1);
        ASSERT_EQ(a.edges, a.triangles + 2);
        const auto edge = [](const core::ActiveEdge& e) {
            return std::pair(std::min(e.above, e.below), std::max(e.above, e.below));
        };
        ASSERT_EQ(edge(a.polygon[0]), edge(b.polygon[0])) << index; // where the diagonal starts
        for (std::size_t k = 1; k < a.edges; ++k) ASSERT_EQ(edge(a.polygon[k]), edge(b.polygon[a.edges - k])) << index;
    }
    EXPECT_EQ(core::case_table[0].triangles, 0);
    EXPECT_EQ(core::case_table[15].triangles, 0);
}

TEST(Bits, RankCountsTheBitsBefore) {
    std::mt19937_64 random(4);
    const std::array<std::uint64_t, 3> words{random(), random(), random()};
    std::size_t rank = 0;
    std::vector<std::size_t> listed;
    core::for_bits(words.data(), words.size(), [&](std::size_t i) { listed.push_back(i); });
    for (std::size_t i = 0; i < 192; ++i) {
        ASSERT_EQ(core::rank_of_bit(words.data(), i), rank);
        if (!core::test_bit(words.data(), i)) continue;
        ASSERT_EQ(listed.at(rank++), i);
    }
    EXPECT_EQ(core::rank_of_bit(words.data(), 192), rank);
    EXPECT_EQ(core::count_bits(words.data(), 3), rank);
}

TEST(RequireMemory, SaysWhatIsNeededAndWhatIsFree) {
    EXPECT_TRUE(core::require_memory("nothing", 0));
    const auto refused = core::require_memory("a planet", std::uint64_t{1} << 60);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
    EXPECT_EQ(refused.error().message.rfind("a planet needs 1152921.5 TB, but ", 0), 0u) << refused.error().message;
    EXPECT_EQ(core::format_bytes(999), "999 B");
    EXPECT_EQ(core::format_bytes(12300), "12.3 kB");
    EXPECT_EQ(core::format_bytes(12345678), "12.3 MB");
}

} // namespace
} // namespace isotet::test
