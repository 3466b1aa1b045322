// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Area and volume against the isovalue are those of the surfaces that are extracted.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/engine.hpp>
#include <isotet/extract.hpp>
#include <isotet/isovalues.hpp>

#include "support/mixed_grid.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

const std::vector<std::array<double, 3>> corner_places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

std::vector<double> drawn_isovalues(std::uint32_t seed, double lower, double upper, int count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> draw(lower, upper);
    std::vector<double> isovalues;
    for (int i = 0; i < count; ++i) isovalues.push_back(draw(random));
    std::sort(isovalues.begin(), isovalues.end());
    return isovalues;
}

SurfaceReport measured(const Grid& grid, const PointField& field, double isovalue) {
    DirectOptions options;
    options.precision = Precision::float64;
    options.split_cells = true;
    const auto out = extract_direct(grid, field, std::span(&isovalue, 1), options).value();
    return check(out.surfaces.front().surface).value();
}

void expect_near_all(const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    double most = 0;
    for (const double x : b) most = std::max(most, x);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-12 * most) << i;
}

TEST(SpectrumOfOneTet, IsTheCornerThatIsCutOff) {
    const Grid grid = tet_grid(corner_places, {{0, 1, 2, 3}});
    const std::vector<double> isovalues{0, 0.25, 0.5, 1, 2};
    const auto out = contour_spectrum(grid, field_of(std::vector<double>{0, 1, 1, 1}), isovalues).value();
    EXPECT_EQ(out.tets, 1u);
    EXPECT_DOUBLE_EQ(out.volume, 1.0 / 6);
    const double face = std::sqrt(3.0) / 2;
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_DOUBLE_EQ(out.area[i], face * isovalues[i] * isovalues[i]);
        EXPECT_DOUBLE_EQ(out.volume_below[i], std::pow(isovalues[i], 3) / 6);
    }
    EXPECT_EQ(out.area[4], 0);
    EXPECT_EQ(out.volume_below[4], out.volume);
}

TEST(SpectrumOfOneTet, CountsAFaceOfTiesOnlyWithTheCornerBelow) {
    const Grid grid = tet_grid(corner_places, {{0, 1, 2, 3}});
    const std::vector<double> one{1};
    EXPECT_GT(contour_spectrum(grid, field_of(std::vector<float>{0, 1, 1, 1}), one).value().area[0], 0);
    EXPECT_EQ(contour_spectrum(grid, field_of(std::vector<float>{2, 1, 1, 1}), one).value().area[0], 0);
    EXPECT_EQ(contour_spectrum(grid, field_of(std::vector<float>{1, 1, 1, 1}), one).value().volume_below[0], 0);
}

TEST(SpectrumOfOneTet, HoldsForValuesOfAnyMagnitude) {
    const Grid grid = tet_grid(corner_places, {{0, 1, 2, 3}});
    const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
    for (const std::vector<double>& v : {std::vector<double>{-most, most, most, most},
                                         {0, 4 * least, 4 * least, 4 * least},
                                         {0, least, most, most},
                                         {0, 1, std::nextafter(1.0, 2), 2}}) {
        std::vector<double> isovalues{v[0], v[0] / 2 + v[3] / 2, v[1], v[2], v[3]};
        std::sort(isovalues.begin(), isovalues.end());
        const auto out = contour_spectrum(grid, field_of(v), isovalues).value();
        for (std::size_t i = 0; i < isovalues.size(); ++i) {
            EXPECT_TRUE(out.area[i] >= 0 && out.area[i] <= 1) << out.area[i];
            EXPECT_TRUE(out.volume_below[i] >= 0 && out.volume_below[i] <= out.volume) << out.volume_below[i];
        }
        EXPECT_NEAR(out.volume_below.back(), out.volume, 1e-12);
    }
}

TEST(Spectrum, LeavesTetsWithoutDataOut) {
    const double none = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    const Grid grid = tet_grid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {-1, -1, -1}},
                               {{0, 1, 2, 3}, {1, 2, 3, 4}, {0, 2, 1, 5}});
    const std::vector<double> half{0.5};
    const auto out = contour_spectrum(grid, field_of(std::vector<double>{0, 1, 1, 1, none, infinite}), half).value();
    EXPECT_EQ(out.tets, 1u);
    EXPECT_EQ(out.no_data_tets, 2u);
    EXPECT_DOUBLE_EQ(out.volume, 1.0 / 6);
}

TEST(Spectrum, HasTheAreaOfTheSurfaceAtAnyIsovalue) {
    for (const char* shape : {"kuhn", "shuffled", "layer", "mixed"}) {
        const Grid grid = made_grid(shape, 7, {"gyroid"}, 3);
        const PointField field = point_field(grid);
        const auto isovalues = drawn_isovalues(5, -1.4, 1.4, 12);
        const auto out = contour_spectrum(grid, field, isovalues).value();
        for (std::size_t i = 0; i < isovalues.size(); ++i) {
            const double area = measured(grid, field, isovalues[i]).area;
            EXPECT_NEAR(out.area[i], area, 1e-6 * (area + 1)) << shape << " at " << isovalues[i];
        }
    }
}

TEST(Spectrum, HasTheVolumeThatClosedSurfacesEnclose) {
    for (const char* shape : {"kuhn", "perturbed", "hex", "pyramid"}) {
        const Grid grid = made_grid(shape, 12, {"sphere"});
        const auto isovalues = drawn_isovalues(9, 0.2, 0.95, 8);
        const auto out = contour_spectrum(grid, point_field(grid), isovalues).value();
        for (std::size_t i = 0; i < isovalues.size(); ++i) {
            const SurfaceReport surface = measured(grid, point_field(grid), isovalues[i]);
            ASSERT_TRUE(surface.closed);
            EXPECT_NEAR(out.volume_below[i], std::abs(surface.volume), 1e-6) << shape << " at " << isovalues[i];
        }
        EXPECT_NEAR(out.volume, 8, 1e-6);
    }
}

TEST(Spectrum, VolumeNeverFallsAndEndsAtTheWhole) {
    for (const std::uint32_t seed : {1, 2, 3}) {
        NastyOptions nasty;
        nasty.values = seed == 1 ? 4 : 0;
        nasty.no_data = 0.02;
        nasty.inverted = 0.1;
        const NastyGrid made = nasty_grid(seed, nasty);
        auto isovalues = drawn_isovalues(seed, -2, 5, 400);
        isovalues.push_back(100);
        const auto out = contour_spectrum(made.grid, made.field, isovalues).value();
        for (std::size_t i = 1; i < isovalues.size(); ++i) EXPECT_GE(out.volume_below[i], out.volume_below[i - 1]);
        EXPECT_NEAR(out.volume_below.back(), out.volume, 1e-12 * out.volume);
        EXPECT_EQ(out.area.back(), 0);
    }
}

TEST(Spectrum, OfTheCpuEngineIsThatOfTheReference) {
    for (const std::uint32_t seed : {1, 2, 3, 4}) {
        MixedOptions mixed;
        mixed.values = seed % 2 == 0 ? 4 : 0;
        mixed.no_data = 0.02;
        mixed.mirrored = 0.2;
        mixed.collapsed = 0.1;
        mixed.wide = seed > 2;
        const NastyGrid made = mixed_grid(seed, mixed);
        auto isovalues = drawn_isovalues(seed, -1, 4, 20);
        isovalues.insert(isovalues.end(), {0, 1, 2, 3});
        std::sort(isovalues.begin(), isovalues.end());
        const auto ours = contour_spectrum(made.grid, made.field, isovalues).value();
        const auto reference = contour_spectrum_by_reference(made.grid, made.field, isovalues).value();
        expect_near_all(ours.area, reference.area);
        expect_near_all(ours.volume_below, reference.volume_below);
        EXPECT_EQ(ours.tets, reference.tets);
        EXPECT_EQ(ours.no_data_tets, reference.no_data_tets);
        EXPECT_NEAR(ours.volume, reference.volume, 1e-12 * reference.volume);
    }
}

TEST(Spectrum, IsTheSameBytesForAnyNumberOfThreads) {
    const Grid grid = made_grid("perturbed", 24, {"gyroid"});
    const auto isovalues = drawn_isovalues(7, -1.5, 1.5, 100);
    const auto one = contour_spectrum(grid, point_field(grid), isovalues, {.threads = 1}).value();
    for (const int threads : {2, 7}) {
        const auto out = contour_spectrum(grid, point_field(grid), isovalues, {.threads = threads}).value();
        EXPECT_EQ(out.area, one.area);
        EXPECT_EQ(out.volume_below, one.volume_below);
        EXPECT_EQ(out.volume, one.volume);
    }
}

TEST(Spectrum, TakesQuadraticCellsAtTheirNodes) {
    const Grid quadratic = made_grid("tet10", 4, {"plane"});
    const std::vector<double> isovalues{0.1};
    const auto out = contour_spectrum(quadratic, point_field(quadratic), isovalues).value();
    const Grid linear = made_grid("kuhn", 4, {"plane"});
    const auto same = contour_spectrum(linear, point_field(linear), isovalues).value();
    EXPECT_NEAR(out.area[0], same.area[0], 1e-5);
    EXPECT_NEAR(out.volume_below[0], same.volume_below[0], 1e-5);
    EXPECT_EQ(out.tets, 8 * same.tets);
}

} // namespace
} // namespace isotet::test
