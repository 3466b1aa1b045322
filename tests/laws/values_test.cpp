// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Values of every type and magnitude: what "tied points: 0" certifies, false ties, infinities, NaN, denormals.
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

const std::vector<std::array<double, 3>> unit{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

template <class T>
PackedGrid one_tet(std::vector<T> values, Precision precision = Precision::float32) {
    PackOptions options;
    options.precision = precision;
    return pack(tet_grid(unit, {{0, 1, 2, 3}}), field_of(std::move(values)), options).value();
}

/// Long double holds every double and every 64-bit integer exactly.
using Exact = long double;

/// Edges of the grid's tets that the given values cross, exactly compared.
template <class T>
std::size_t crossed_edges(const Grid& grid, const std::vector<T>& values, double isovalue) {
    std::set<std::pair<std::uint64_t, std::uint64_t>> crossed;
    const auto above = [&](std::uint64_t p) { return static_cast<Exact>(values[p]) >= static_cast<Exact>(isovalue); };
    const TetList list = split(grid).value();
    for (const auto& tet : list.tets)
        for (const std::uint64_t a : tet)
            for (const std::uint64_t b : tet)
                if (a < b && above(a) != above(b)) crossed.insert({a, b});
    return crossed.size();
}

/// Whether no point was tied, which certifies that every point is on the side that its given value says.
template <class T>
bool expect_certified(const Grid& grid, const PackedGrid& packed, const std::vector<T>& values, double isovalue) {
    ExtractOptions options;
    options.ties = Ties::keep;
    options.edge_ends = true;
    const Extraction out = extract(packed, isovalue, options).value();
    std::uint64_t exact_ties = 0;
    for (const T value : values) exact_ties += static_cast<Exact>(value) == static_cast<Exact>(isovalue);
    EXPECT_EQ(out.report.tied_points - out.report.false_ties.value(), exact_ties) << "a tie vanished at " << isovalue;
    if (out.report.tied_points != 0) return false;
    EXPECT_EQ(out.surface.vertex_count(), crossed_edges(grid, values, isovalue)) << isovalue;
    for (std::size_t v = 0; v < out.surface.vertex_count(); ++v) {
        const auto [below, above] = ends_of(out.surface, v);
        EXPECT_LT(static_cast<Exact>(values[static_cast<std::size_t>(below)]), static_cast<Exact>(isovalue));
        EXPECT_GE(static_cast<Exact>(values[static_cast<std::size_t>(above)]), static_cast<Exact>(isovalue));
    }
    return true;
}

/// A grid of 5^3 cubes, its values drawn by `draw(random)`, isovalues between, at and close to the values.
template <class T, class Draw>
void expect_certificate(std::uint32_t seed, const Draw& draw) {
    const Grid grid = made_grid("perturbed", 5, {"plane"}, seed);
    std::mt19937_64 random(seed);
    std::vector<T> values;
    for (std::size_t p = 0; p < grid.points.tuples(); ++p) values.push_back(draw(random));
    std::vector<double> isovalues;
    for (int i = 0; i < 12; ++i) {
        const auto a = static_cast<double>(values[random() % values.size()]);
        isovalues.insert(isovalues.end(), {a, std::nextafter(a, infinity), std::nextafter(a, -infinity),
                                           a / 2 + static_cast<double>(values[random() % values.size()]) / 2});
    }
    for (const Precision precision : {Precision::float32, Precision::float64}) {
        PackOptions options;
        options.precision = precision;
        const PackedGrid packed = pack(grid, field_of(values), options).value();
        int certified = 0;
        for (const double isovalue : isovalues) certified += expect_certified(grid, packed, values, isovalue);
        EXPECT_GT(certified, 0) << "seed " << seed << ": nothing was certified";
    }
}

double uniform(std::mt19937_64& random, double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random);
}

TEST(NoTiedPoint, CertifiesSidesOfOrdinaryDoubles) {
    expect_certificate<double>(1, [](auto& random) { return uniform(random, -1, 1); });
}

TEST(NoTiedPoint, CertifiesSidesOfAPressure) {
    expect_certificate<double>(2, [](auto& random) { return uniform(random, 101324, 101326); });
}

TEST(NoTiedPoint, CertifiesSidesOverFifteenDecades) {
    expect_certificate<double>(3, [](auto& random) { return std::pow(10.0, uniform(random, -12, 3)); });
}

TEST(NoTiedPoint, CertifiesSidesOfHugeValues) {
    expect_certificate<double>(4, [](auto& random) { return uniform(random, -1, 1.5) * 1e248; });
    expect_certificate<double>(
        5, [](auto& random) { return uniform(random, -1, 1) * std::numeric_limits<double>::max(); });
}

TEST(NoTiedPoint, CertifiesSidesOfPermeabilities) {
    expect_certificate<double>(6, [](auto& random) { return uniform(random, 1, 9) * 5e-22; });
    expect_certificate<float>(7, [](auto& random) { return static_cast<float>(uniform(random, 1, 9) * 5e-22); });
}

TEST(NoTiedPoint, CertifiesSidesOfFloats) {
    expect_certificate<float>(8, [](auto& random) { return static_cast<float>(uniform(random, -3, 5)); });
    expect_certificate<float>(9, [](auto& random) { return static_cast<float>(uniform(random, -1, 1) * 3e38); });
}

TEST(NoTiedPoint, CertifiesSidesOfIntegersBeyondDoubles) {
    constexpr std::int64_t base = std::int64_t{1} << 53;
    expect_certificate<std::int64_t>(10, [](auto& random) { return base + static_cast<std::int64_t>(random() % 100); });
    expect_certificate<std::int64_t>(11, [](auto& random) { return static_cast<std::int64_t>(random()); });
    expect_certificate<std::uint64_t>(12, [](auto& random) { return static_cast<std::uint64_t>(random()); });
}

TEST(NoTiedPoint, CertifiesSidesOfSmallIntegers) {
    expect_certificate<std::uint8_t>(13, [](auto& random) { return static_cast<std::uint8_t>(random()); });
    expect_certificate<std::int16_t>(14, [](auto& random) { return static_cast<std::int16_t>(random()); });
    expect_certificate<std::int32_t>(15, [](auto& random) { return static_cast<std::int32_t>(random()); });
}

TEST(Pressure, KeepsItsDigits) {
    const Grid grid = made_grid("kuhn", 6, {"plane"});
    std::vector<double> values;
    for (const float v : grid.point_fields[0].values.as<float>()) values.push_back(101325 + static_cast<double>(v));
    const PackedGrid packed = pack(grid, field_of(values)).value();
    EXPECT_NEAR(packed.field().offset, 101325, 2);
    EXPECT_FALSE(packed.field().unchanged);
    ExtractOptions options;
    options.edge_ends = true;
    const Extraction out = extract(packed, 101325.3, options).value();
    ASSERT_GT(out.surface.vertex_count(), 0u);
    for (std::size_t v = 0; v < out.surface.vertex_count(); ++v) {
        const auto [below, above] = ends_of(out.surface, v);
        const double s0 = values[static_cast<std::size_t>(below)], s1 = values[static_cast<std::size_t>(above)];
        EXPECT_NEAR(out.surface.edge_weights.at(v), (101325.3 - s0) / (s1 - s0), 2e-6);
    }
}

TEST(Scale, MakesSurfacesOfHugeAndTinyValuesTheSameBytes) {
    const Grid grid = made_grid("shuffled", 6, {"gyroid"});
    const auto surface_scaled_by = [&](double factor) {
        std::vector<double> values;
        for (const float v : grid.point_fields[0].values.as<float>()) values.push_back(static_cast<double>(v) * factor);
        ExtractOptions options;
        options.edge_ends = true;
        return bytes_of(extract(pack(grid, field_of(values)).value(), 0.25 * factor, options).value().surface);
    };
    const std::string plain = surface_scaled_by(1);
    for (const int power : {-900, -600, -100, -20, 20, 60, 800, 1020})
        EXPECT_TRUE(surface_scaled_by(std::exp2(power)) == plain) << "2^" << power;
}

template <class Real>
void expect_denormals_are_told_apart() {
    const Grid grid = made_grid("kuhn", 5, {"integer"});
    constexpr Real smallest = std::numeric_limits<Real>::denorm_min();
    std::vector<Real> values;
    std::vector<std::int32_t> plain;
    for (const std::int32_t v : grid.point_fields[0].values.as<std::int32_t>()) {
        values.push_back(static_cast<Real>(2 * v) * smallest);
        plain.push_back(2 * v);
    }
    const PackedGrid packed = pack(grid, field_of(values)).value(), expected = pack(grid, field_of(plain)).value();
    EXPECT_EQ(packed.field().flushed, 0u);
    for (const int isovalue : {1, 2, 3, 7})
        EXPECT_TRUE(
            bytes_of(extract(packed, static_cast<double>(static_cast<Real>(isovalue) * smallest)).value().surface) ==
            bytes_of(extract(expected, isovalue).value().surface))
            << isovalue;
}

TEST(Denormals, AreToldApartWhenNothingIsLarger) {
    expect_denormals_are_told_apart<float>();
    expect_denormals_are_told_apart<double>();
}

TEST(Denormals, AreZeroBesideLargeValuesAndCounted) {
    const PackedGrid packed = one_tet<float>({1e-40f, -1e-40f, -0.0f, 1.0f});
    EXPECT_EQ(packed.field().flushed, 2u);
    EXPECT_EQ(extract(packed, 0).value().report.tied_points, 3u);
    EXPECT_EQ(extract(packed, 0).value().report.false_ties, 2u);
}

TEST(Isovalue, TooSmallToTellFromZeroIsReportedAsAFalseTie) {
    const PackedGrid packed = one_tet<float>({0, 0, 0, 1});
    const ExtractReport report = extract(packed, 1e-30).value().report;
    EXPECT_EQ(report.tied_points, 3u);
    EXPECT_EQ(report.false_ties, 3u);
    EXPECT_EQ(report.isovalue_stored, 0);
}

TEST(Zeros, OfBothSignsAreTiedAlike) {
    const PackedGrid mixed = one_tet<float>({-0.0f, 0.0f, -1, 1}), plain = one_tet<float>({0, 0, -1, 1});
    for (const double zero : {0.0, -0.0}) {
        EXPECT_EQ(extract(mixed, zero).value().report.tied_points, 2u);
        EXPECT_TRUE(bytes_of(extract(mixed, zero).value().surface) == bytes_of(extract(plain, 0).value().surface));
    }
}

TEST(Infinity, GivesTheFiniteEndOrTheMiddle) {
    for (const Precision precision : {Precision::float32, Precision::float64}) {
        ExtractOptions options;
        options.edge_ends = true;
        const PackedGrid packed = one_tet<double>({-infinity, infinity, 1, 2}, precision);
        EXPECT_EQ(packed.field().infinite, 2u);
        const Surface surface = extract(packed, 0.5, options).value().surface;
        ASSERT_EQ(surface.vertex_count(), 3u);
        for (std::size_t v = 0; v < 3; ++v) {
            const auto [below, above] = ends_of(surface, v);
            EXPECT_EQ(below, 0);
            const std::array<double, 3> middle{0.5, 0, 0};
            EXPECT_EQ(position_of(surface, v), above == 1 ? middle : unit[static_cast<std::size_t>(above)]);
        }
        const Surface other =
            extract(one_tet<double>({-3, infinity, infinity, infinity}, precision), -1e300, options).value().surface;
        EXPECT_EQ(other.vertex_count(), 0u); // -3 is above, and nothing is below
    }
}

TEST(NoData, GivesNothingHoweverNaNIsWritten) {
    for (const std::uint32_t bits : {0x7fc00000u, 0xffc00000u, 0x7f800001u, 0x7fffffffu, 0xffffffffu}) {
        const PackedGrid packed = one_tet<float>({std::bit_cast<float>(bits), -1, 1, 2});
        EXPECT_EQ(packed.field().no_data, 1u);
        EXPECT_EQ(extract(packed, 0).value().surface.vertex_count(), 0u);
    }
    const PackedGrid nothing = one_tet<double>(std::vector<double>(4, std::nan("")));
    EXPECT_EQ(nothing.field().no_data, 4u);
    EXPECT_EQ(extract(nothing, 0).value().surface.triangle_count(), 0u);
    EXPECT_EQ(extract(nothing, 0).value().report.tied_points, 0u);
}

TEST(NoData, CutsAwayAHexahedronOrOfASplitOneTheTetsAtThatCorner) {
    const Grid grid = made_grid("hex", 1, {"plane"});
    std::vector<float> values(grid.point_fields[0].values.as<float>().begin(),
                              grid.point_fields[0].values.as<float>().end());
    const auto triangles = [&](bool split_cells) {
        const PackedGrid packed = pack(grid, field_of(values), {.split_cells = split_cells}).value();
        return extract(packed, 0.1).value().surface.triangle_count();
    };
    const std::size_t whole = triangles(true);
    EXPECT_EQ(triangles(false), 3u);
    values[3] = std::nanf("");
    EXPECT_LT(triangles(true), whole);
    EXPECT_GT(triangles(true), 0u);
    EXPECT_EQ(triangles(false), 0u);
}

TEST(IsovalueOnFloat32, IsComparedAsADouble) {
    const PackedGrid packed = one_tet<float>({0.7f, 0, 0, 1}); // 0.7f is less than 0.7
    const Extraction between = extract(packed, 0.7).value();
    EXPECT_EQ(between.report.tied_points, 0u);
    EXPECT_TRUE(between.report.near_tie);
    EXPECT_EQ(between.surface.vertex_count(), 3u); // only point 3 is above
    EXPECT_EQ(between.surface.triangle_count(), 1u);
    const double snapped = snap(Array::own(std::vector<float>{0}), 0.7);
    EXPECT_EQ(snapped, static_cast<double>(0.7f));
    const Extraction tied = extract(packed, snapped).value();
    EXPECT_EQ(tied.report.tied_points, 1u);
    EXPECT_EQ(tied.report.false_ties, 0u);
    EXPECT_FALSE(tied.report.near_tie);
    // 0.3f is greater than 0.3, and the least float32 that is: above, and no tie.
    const Extraction above = extract(one_tet<float>({0.3f, 0, 0, 0}), 0.3).value();
    EXPECT_EQ(above.report.tied_points, 0u);
    EXPECT_EQ(above.report.false_ties, 0u);
    EXPECT_TRUE(above.report.near_tie);
    EXPECT_NEAR(above.report.isovalue_stored, 0.3, 1e-14);
    EXPECT_EQ(above.surface.triangle_count(), 1u);
}

TEST(Snap, GivesTheNearestValueThatTheTypeHolds) {
    const auto snapped = []<class T>(T, double isovalue) { return snap(Array::own(std::vector<T>{0}), isovalue); };
    EXPECT_EQ(snapped(double{}, 0.7), 0.7);
    EXPECT_EQ(snapped(float{}, 1e300), static_cast<double>(std::numeric_limits<float>::max()));
    EXPECT_EQ(snapped(std::int32_t{}, 3.2), 3);
    EXPECT_EQ(snapped(std::int32_t{}, -3.7), -4);
    EXPECT_EQ(snapped(std::uint8_t{}, 300), 255);
    EXPECT_EQ(snapped(std::uint8_t{}, -5), 0);
    EXPECT_EQ(snapped(std::int16_t{}, -1e9), -32768);
}

TEST(FalseTies, AreToldFromTiesOfTheInput) {
    constexpr double close = 1 + 0x1p-40; // rounds to 1 in float32
    const PackedGrid packed = one_tet<double>({1, close, -50, 50});
    const ExtractReport report = extract(packed, 1).value().report;
    EXPECT_EQ(report.tied_points, 2u);
    EXPECT_EQ(report.false_ties, 1u);
    EXPECT_EQ(extract(packed, close).value().report.false_ties, 1u);
    EXPECT_EQ(extract(one_tet<double>({1, close, -50, 50}, Precision::float64), 1).value().report.tied_points, 1u);
}

TEST(FalseTies, OfIntegersBeyondDoublesAreToldExactly) {
    constexpr std::int64_t base = std::int64_t{1} << 53;
    const PackedGrid packed =
        one_tet<std::int64_t>({base, base + 1, base - 1000, base + 1000}); // base + 1 is no double
    const ExtractReport report = extract(packed, static_cast<double>(base)).value().report;
    EXPECT_EQ(report.tied_points, 2u);
    EXPECT_EQ(report.false_ties, 1u);
}

} // namespace
} // namespace isotet::test
