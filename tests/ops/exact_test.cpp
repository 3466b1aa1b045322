// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Exact signs against integer arithmetic of 128 bits, and the canonical order of corners.
#include "numbers/exact.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "grid/cell/splitter.hpp"
#include "grid/orientation.hpp"
#include "numbers/box_sign.hpp"

namespace isotet::test {
namespace {

__extension__ using Wide = __int128;

using Whole = std::array<std::int64_t, 3>; ///< below 2^38, so that determinants of differences fit into 128 bits

Wide determinant(const Whole& a, const Whole& b, const Whole& c, const Whole& d) {
    const auto at = [&](const Whole& p, std::size_t axis) { return Wide{p[axis]} - a[axis]; };
    Wide sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
        sum += at(b, axis) * (at(c, j) * at(d, k) - at(c, k) * at(d, j));
    }
    return sum;
}

core::Point scaled(const Whole& p, int power) {
    return {std::ldexp(static_cast<double>(p[0]), power), std::ldexp(static_cast<double>(p[1]), power),
            std::ldexp(static_cast<double>(p[2]), power)};
}

void expect_exact(const Whole& a, const Whole& b, const Whole& c, const Whole& d) {
    const Wide exact = determinant(a, b, c, d);
    const int sign = exact > 0 ? 1 : exact < 0 ? -1 : 0;
    for (const int power : {0, -60, 50, -200}) {
        ASSERT_EQ(core::orientation_sign(scaled(a, power), scaled(b, power), scaled(c, power), scaled(d, power)), sign);
        ASSERT_EQ(core::orientation_sign(scaled(b, power), scaled(a, power), scaled(c, power), scaled(d, power)),
                  -sign);
        ASSERT_EQ(core::orientation_sign(scaled(d, power), scaled(a, power), scaled(b, power), scaled(c, power)),
                  -sign);
    }
}

class Draw {
public:
    explicit Draw(std::uint32_t seed) : random_(seed) {}
    std::int64_t number(std::int64_t most) { return std::uniform_int_distribution<std::int64_t>(-most, most)(random_); }
    Whole point(std::int64_t most) { return {number(most), number(most), number(most)}; }

private:
    std::mt19937_64 random_;
};

TEST(OrientationSign, EqualsIntegerArithmeticOnRandomTets) {
    for (const std::int64_t most : {std::int64_t{2}, std::int64_t{1000}, std::int64_t{1} << 37}) {
        Draw draw(static_cast<std::uint32_t>(most));
        for (int i = 0; i < 2000; ++i)
            expect_exact(draw.point(most), draw.point(most), draw.point(most), draw.point(most));
    }
}

TEST(OrientationSign, EqualsIntegerArithmeticOnFlatAndNearlyFlatTets) {
    Draw draw(7);
    for (int i = 0; i < 4000; ++i) {
        const Whole a = draw.point(std::int64_t{1} << 34), b = draw.point(std::int64_t{1} << 34),
                    c = draw.point(std::int64_t{1} << 34);
        const std::int64_t u = draw.number(2), v = draw.number(2);
        Whole d;
        for (std::size_t axis = 0; axis < 3; ++axis)
            d[axis] = a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]);
        expect_exact(a, b, c, d); // flat
        d[static_cast<std::size_t>(i % 3)] += i % 2 ? 1 : -1;
        expect_exact(a, b, c, d); // off by one unit
    }
}

TEST(OrientationSign, ChangesWithEveryExchangeOfCornersThatDoublesCannotResolve) {
    // Points of a plane in tenths, which binary fractions miss by a rounding each.
    std::mt19937 random(3);
    const auto tenth = [&] { return 0.1 * std::uniform_int_distribution<int>(-30, 30)(random); };
    int not_flat = 0;
    for (int i = 0; i < 3000; ++i) {
        std::array<core::Point, 4> p;
        for (core::Point& point : p) {
            point[0] = tenth();
            point[1] = tenth();
            point[2] = point[0] + point[1];
        }
        const int sign = core::orientation_sign(p[0], p[1], p[2], p[3]);
        not_flat += sign != 0;
        std::array<std::size_t, 4> order{0, 1, 2, 3};
        do {
            bool odd = false;
            for (std::size_t a = 0; a < 4; ++a)
                for (std::size_t b = a + 1; b < 4; ++b) odd ^= order[a] > order[b];
            ASSERT_EQ(core::orientation_sign(p[order[0]], p[order[1]], p[order[2]], p[order[3]]), odd ? -sign : sign);
        } while (std::next_permutation(order.begin(), order.end()));
    }
    EXPECT_GT(not_flat, 100);
}

TEST(OrientationSign, IsPositiveForAnUprightTetAtTheEndsOfTheRange) {
    for (const double unit : {0x1p-300, 0x1p-70, 1.0, 0x1p90}) {
        const core::Point o{0, 0, 0}, x{unit, 0, 0}, y{0, unit, 0}, z{0, 0, unit};
        EXPECT_EQ(core::orientation_sign(o, x, y, z), 1) << unit;
        EXPECT_EQ(core::orientation_sign(o, y, x, z), -1) << unit;
        EXPECT_EQ(core::orientation_sign(o, x, y, y), 0) << unit;
    }
}

/// The tets of a hexahedron, with whichever diagonals numbers of its corners choose.
struct PositionsOfTets {
    std::vector<std::array<std::uint8_t, 4>> tets;

    void expect(int) {}
    void add(std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d) { tets.push_back({a, b, c, d}); }
};

TEST(SignOfAllTets, IsThatOfEachWhereItTells) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> number(-1, 1);
    int told = 0, negative = 0;
    for (int i = 0; i < 20'000; ++i) {
        std::array<core::Point, 8> corners;
        const double aside = std::pow(10, -i % 12), flat = std::pow(10, -i % 5);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double factor = axis == 2 ? flat : 1;
            const double origin = 10 * number(random), a = factor * number(random), b = factor * number(random),
                         c = factor * number(random);
            const std::array<double, 8> ideal{0, a, a + b, b, c, a + c, a + b + c, b + c};
            for (std::size_t k = 0; k < 8; ++k)
                corners[k][axis] = origin + ideal[k] + (k == 0 ? 0 : factor * aside * number(random));
        }
        const int sign = core::sign_of_all_tets(corners);
        told += sign != 0;
        negative += sign < 0;
        std::array<std::uint64_t, 8> numbers{0, 1, 2, 3, 4, 5, 6, 7};
        std::ranges::shuffle(numbers, random);
        PositionsOfTets list;
        core::Splitter(numbers.data(), list).split(core::CellKind::hexahedron);
        for (const auto [a, b, c, d] : list.tets) {
            if (sign == 0) break;
            ASSERT_EQ(core::orientation_sign(corners[a], corners[b], corners[c], corners[d]), sign) << i;
            ASSERT_EQ(core::six_volumes(corners[a], corners[b], corners[c], corners[d]) < 0, sign < 0) << i;
        }
    }
    EXPECT_GT(told, 8'000);
    EXPECT_GT(negative, 4'000);
}

TEST(SignOfAllTets, IsToldOfBoxesAndOfNoCellWithAFlatTet) {
    std::array<core::Point, 8> box{
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
    EXPECT_EQ(core::sign_of_all_tets(box), 1);
    std::swap(box[0], box[4]), std::swap(box[1], box[5]), std::swap(box[2], box[6]), std::swap(box[3], box[7]);
    EXPECT_EQ(core::sign_of_all_tets(box), -1);
    box[6] = box[7];
    EXPECT_EQ(core::sign_of_all_tets(box), 0);
    for (core::Point& corner : box) corner[2] = 0;
    EXPECT_EQ(core::sign_of_all_tets(box), 0);
    box[3][0] = NAN;
    EXPECT_EQ(core::sign_of_all_tets(box), 0);
}

TEST(IsCollinear, EqualsIntegerArithmetic) {
    Draw draw(11);
    for (int i = 0; i < 4000; ++i) {
        const Whole a = draw.point(std::int64_t{1} << 34), b = draw.point(std::int64_t{1} << 34);
        const std::int64_t u = draw.number(5);
        Whole c;
        for (std::size_t axis = 0; axis < 3; ++axis) c[axis] = a[axis] + u * (b[axis] - a[axis]);
        ASSERT_TRUE(core::is_collinear(scaled(a, -40), scaled(b, -40), scaled(c, -40)));
        c[static_cast<std::size_t>(i % 3)] += 1;
        Wide largest = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t j = (axis + 1) % 3;
            const Wide cross =
                (Wide{b[axis]} - a[axis]) * (Wide{c[j]} - a[j]) - (Wide{b[j]} - a[j]) * (Wide{c[axis]} - a[axis]);
            largest = std::max(largest, cross < 0 ? -cross : cross);
        }
        ASSERT_EQ(core::is_collinear(scaled(a, -40), scaled(b, -40), scaled(c, -40)), largest == 0);
    }
}

TEST(Canonical, PutsTheLowestFirstAndTheLowestOfTheOthersSecondWithoutMirroring) {
    const core::Tet numbers{3, 8, 21, 55};
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    do {
        bool odd = false;
        for (std::size_t a = 0; a < 4; ++a)
            for (std::size_t b = a + 1; b < 4; ++b) odd ^= order[a] > order[b];
        const core::Tet tet{numbers[order[0]], numbers[order[1]], numbers[order[2]], numbers[order[3]]};
        const core::Tet expected = odd ? core::Tet{3, 8, 55, 21} : core::Tet{3, 8, 21, 55};
        ASSERT_EQ(core::canonical(tet), expected);
    } while (std::next_permutation(order.begin(), order.end()));
}

} // namespace
} // namespace isotet::test
