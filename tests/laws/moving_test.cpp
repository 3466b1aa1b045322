// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A packed grid with a new field or new points gives the surface of a grid packed anew; and where points are far from
// the origin, centimetres stay centimetres.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "packed/packed.hpp"
#include "support/random_grid.hpp"
#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {
namespace {

PackOptions with_everything(Precision precision = Precision::float32) {
    PackOptions options;
    options.precision = precision;
    options.gradients = options.source_cells = true;
    return options;
}

Surface whole_surface(const PackedGrid& packed, double isovalue, const PointField& carried, Ties ties = Ties::merge) {
    ExtractOptions options;
    options.ties = ties;
    options.normals = Normals::gradient;
    options.edge_ends = options.source_cells = true;
    options.point_fields = {{carried.name, carried.values}};
    return extract(packed, isovalue, options).value().surface;
}

template <class T>
PointField converted(const Array& values, double factor, double shift) {
    std::vector<T> out;
    for (std::size_t i = 0; i < values.tuples(); ++i) out.push_back(static_cast<T>(values.at(i) * factor + shift));
    return field_of(std::move(out));
}

TEST(SetField, GivesTheBytesOfAFreshPack) {
    const Grid grid = made_grid("shuffled", 9, {"gyroid", "integer"});
    const Array& gyroid = grid.point_fields[0].values;
    const NastyGrid nasty = nasty_grid(5, {.side = 9, .values = 4, .no_data = 0.1});
    const std::vector<PointField> fields{point_field(grid, 1),
                                         converted<float>(gyroid, 1, 0),
                                         nasty.field,
                                         converted<double>(gyroid, 1e-3, 101325),
                                         converted<double>(gyroid, 1e248, 0),
                                         converted<std::int64_t>(gyroid, 1e9, 0),
                                         converted<std::uint8_t>(gyroid, 50, 128)};
    for (const Precision precision : {Precision::float32, Precision::float64}) {
        PackedGrid packed = pack(grid, fields.back(), with_everything(precision)).value();
        for (const PointField& field : fields) {
            packed = packed.with_field(field).value();
            const PackedGrid fresh = pack(grid, field, with_everything(precision)).value();
            const double isovalue = (fresh.field().lower + fresh.field().upper) / 2;
            EXPECT_EQ(packed.field().offset, fresh.field().offset);
            EXPECT_EQ(packed.field().scale, fresh.field().scale);
            EXPECT_EQ(packed.field().no_data, fresh.field().no_data);
            for (const Ties ties : {Ties::merge, Ties::keep})
                EXPECT_TRUE(bytes_of(whole_surface(packed, isovalue, field, ties)) ==
                            bytes_of(whole_surface(fresh, isovalue, field, ties)))
                    << name_of(field.values.type());
        }
    }
}

TEST(SetField, CanBeCancelledAndDoneAgain) {
    const Grid grid = made_grid("kuhn", 6, {"sphere", "gyroid"});
    PackedGrid packed = pack(grid, point_field(grid, 0), with_everything()).value();
    const std::atomic<bool> cancel{true};
    Progress progress;
    progress.cancel = &cancel;
    const auto cancelled = packed.with_field(point_field(grid, 1), {.progress = progress});
    ASSERT_FALSE(cancelled);
    EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
    packed = packed.with_field(point_field(grid, 1)).value();
    const PackedGrid fresh = pack(grid, point_field(grid, 1), with_everything()).value();
    EXPECT_TRUE(bytes_of(whole_surface(packed, 0.1, point_field(grid, 1))) ==
                bytes_of(whole_surface(fresh, 0.1, point_field(grid, 1))));
}

template <class Real, class Move>
Array moved(const Array& points, const Move& move) {
    std::vector<Real> out;
    for (std::size_t p = 0; p < points.tuples(); ++p)
        for (const double x : move(std::array{points.at(p, 0), points.at(p, 1), points.at(p, 2)}))
            out.push_back(static_cast<Real>(x));
    return Array::own(std::move(out), 3);
}

std::array<double, 3> twisted(const std::array<double, 3>& p) {
    const double angle = 0.3 * p[2];
    return {p[0] * std::cos(angle) - p[1] * std::sin(angle), p[0] * std::sin(angle) + p[1] * std::cos(angle),
            p[2] + 0.1 * p[0] * p[0]};
}

TEST(SetPoints, GivesTheBytesOfAFreshPackWhereTheCurveIsTheSame) {
    // Doubling all coordinates changes neither the curve nor the clusters.
    Grid grid = made_grid("shuffled", 8, {"gyroid"});
    PackedGrid packed = pack(grid, point_field(grid), with_everything()).value();
    grid.points = moved<float>(grid.points, [](auto p) { return std::array{2 * p[0], 2 * p[1], 2 * p[2]}; });
    packed = packed.with_points(grid.points).value();
    const PackedGrid fresh = pack(grid, point_field(grid), with_everything()).value();
    EXPECT_TRUE(bytes_of(whole_surface(packed, 0.1, point_field(grid))) ==
                bytes_of(whole_surface(fresh, 0.1, point_field(grid))));
}

template <class Real>
void expect_moved_as_fresh(const Grid& original, Precision precision) {
    Grid grid = original;
    PackedGrid packed = pack(grid, point_field(grid), with_everything(precision)).value();
    for (const double shift : {0.0, 1e4}) {
        grid.points = moved<Real>(original.points, [shift](auto p) {
            const auto q = twisted(p);
            return std::array{q[0] + shift, q[1] - shift, q[2]};
        });
        packed = packed.with_points(grid.points).value();
        const PackedGrid fresh = pack(grid, point_field(grid), with_everything(precision)).value();
        EXPECT_EQ(packed.data().origin, fresh.data().origin);
        EXPECT_EQ(packed.report().coarse_clusters == 0, fresh.report().coarse_clusters == 0);
        const SurfaceSets expected = sets_of(whole_surface(fresh, 0.1, point_field(grid)));
        EXPECT_GT(expected.vertices.size(), 100u);
        EXPECT_EQ(sets_of(whole_surface(packed, 0.1, point_field(grid))), expected);
    }
}

TEST(SetPoints, GivesTheSurfaceOfAFreshPack) {
    const Grid grid = made_grid("mixed", 6, {"gyroid"});
    expect_moved_as_fresh<float>(grid, Precision::float32);
    expect_moved_as_fresh<double>(grid, Precision::float32);
    expect_moved_as_fresh<double>(grid, Precision::float64);
}

TEST(SetPoints, RefusesPointsThatTurnATetAndChangesNothing) {
    const Grid grid = made_grid("kuhn", 5, {"gyroid"});
    PackedGrid packed = pack(grid, point_field(grid), with_everything()).value();
    const std::string before = bytes_of(whole_surface(packed, 0.1, point_field(grid)));
    const auto mirrored =
        packed.with_points(moved<float>(grid.points, [](auto p) { return std::array{-p[0], p[1], p[2]}; }));
    ASSERT_FALSE(mirrored);
    EXPECT_EQ(mirrored.error().code, ErrorCode::invalid_data);
    EXPECT_NE(mirrored.error().message.find("750 cells change their orientation"), std::string::npos)
        << mirrored.error().message;
    const auto infinite =
        packed.with_points(moved<double>(grid.points, [](auto p) { return std::array{p[0], p[1] / 0.0, p[2]}; }));
    ASSERT_FALSE(infinite);
    EXPECT_EQ(infinite.error().code, ErrorCode::invalid_data);
    EXPECT_TRUE(bytes_of(whole_surface(packed, 0.1, point_field(grid))) == before);
}

TEST(SetPoints, IgnoresPointsThatNoTetUses) {
    PackedGrid packed = pack(tet_grid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {9, 9, 9}}, {{0, 1, 2, 3}}),
                             field_of<float>({0, 1, 1, 1, 1}))
                            .value();
    const Array points = Array::own(std::vector<float>{0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2, NAN, INFINITY, 1e30f}, 3);
    packed = packed.with_points(points).value();
    EXPECT_EQ(extract(packed, 0.5).value().surface.positions.at(0, 0) +
                  extract(packed, 0.5).value().surface.positions.at(1, 0) +
                  extract(packed, 0.5).value().surface.positions.at(2, 0),
              1);
}

/// A grid of 1 cm cells around (shift, shift / 2, 0), in metres, in double.
Grid centimetres(double shift) {
    Grid grid = made_grid("perturbed", 8, {"sphere"});
    grid.points = moved<double>(
        grid.points, [shift](auto p) { return std::array{shift + 0.04 * p[0], shift / 2 + 0.04 * p[1], 0.04 * p[2]}; });
    return grid;
}

TEST(HugeOffsets, LeaveCentimetreCellsAsTheyAre) {
    const Grid near = centimetres(0), far = centimetres(4e6);
    const PackedGrid packed_near = pack(near, point_field(near)).value(),
                     packed_far = pack(far, point_field(far)).value();
    EXPECT_NEAR(packed_far.data().origin[0], 4e6, 1);
    EXPECT_EQ(packed_far.report().coarse_clusters, 0u);
    ExtractOptions options;
    options.edge_ends = true;
    const Surface expected = extract(packed_near, 0.5, options).value().surface;
    const Surface surface = extract(packed_far, 0.5, options).value().surface;
    std::map<Ends, std::array<double, 3>> places;
    for (std::size_t v = 0; v < expected.vertex_count(); ++v) places[ends_of(expected, v)] = position_of(expected, v);
    ASSERT_GT(surface.vertex_count(), 100u);
    ASSERT_EQ(surface.vertex_count(), expected.vertex_count());
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
        const auto p = position_of(surface, v), q = places.at(ends_of(surface, v));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double offset = axis == 0 ? 4e6 : axis == 1 ? 2e6 : 0;
            ASSERT_NEAR(p[axis] - offset, q[axis], 2e-8); // 20 nm
        }
    }
}

TEST(HugeOffsets, ThatFloat32CannotHoldAreReportedAndDoublePackingHoldsThem) {
    // Two clouds of 1 cm cells, 8,000 km apart: one origin cannot serve both.
    const Grid here = centimetres(4e6), there = centimetres(-4e6);
    std::vector<double> points(here.points.as<double>().begin(), here.points.as<double>().end());
    points.insert(points.end(), there.points.as<double>().begin(), there.points.as<double>().end());
    std::vector<std::int64_t> corners;
    std::vector<float> values;
    for (const std::int64_t shift : {std::int64_t{0}, static_cast<std::int64_t>(here.points.tuples())}) {
        for (std::size_t i = 0; i < here.cells.connectivity.size(); ++i)
            corners.push_back(shift + static_cast<std::int64_t>(here.cells.connectivity.at(i)));
        for (const float v : here.point_fields[0].values.as<float>()) values.push_back(v);
    }
    Grid both;
    both.points = Array::own(std::move(points), 3);
    both.cells.connectivity = Array::own(std::move(corners));
    const PackedGrid single = pack(both, field_of(values)).value();
    EXPECT_EQ(single.report().coarse_clusters, single.report().clusters);
    const PackedGrid precise = pack(both, field_of(values), with_everything(Precision::float64)).value();
    EXPECT_EQ(precise.report().coarse_clusters, 0u);
    EXPECT_EQ(precise.data().origin, (std::array<double, 3>{}));
    const Surface surface = extract(precise, 0.5).value().surface;
    EXPECT_EQ(surface.positions.type(), ScalarType::float64);
    for (std::size_t v = 0; v < surface.vertex_count(); ++v)
        ASSERT_NEAR(std::abs(surface.positions.at(v, 0)), 4e6, 0.021);
}

TEST(Coordinates, TooSmallForTheContractAreZeroAndCounted) {
    const Grid grid = tet_grid({{1e-30, 0, 0}, {1, 1e-25, -0.0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
    const PackedGrid packed = pack(grid, field_of<float>({1, 0, 0, 0})).value();
    EXPECT_EQ(packed.report().flushed_coordinates, 2u);
    const Surface surface = extract(packed, 1).value().surface; // a peak: nothing
    EXPECT_EQ(surface.vertex_count(), 0u);
}

} // namespace
} // namespace isotet::test
