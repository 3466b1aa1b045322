// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is expected of each way, from a look at the field and from speeds.
#include <atomic>
#include <limits>

#include <gtest/gtest.h>

#include <isotet/choose.hpp>
#include <isotet/extract_once.hpp>
#include <isotet/make.hpp>

#include "api/speeds.hpp"

namespace isotet::test {
namespace {

struct FieldOnGrid {
    Grid grid;
    PointField field;
};

FieldOnGrid made(const std::string& shape, std::uint64_t side, const std::string& name) {
    FieldOnGrid out;
    out.grid = make_grid({.shape = shape, .side = side, .fields = {name}}).value();
    out.field = find_field(out.grid, name).value();
    return out;
}

TEST(FieldSample, ForetellsTheTrianglesOfALargeSurface) {
    for (const char* shape : {"kuhn", "shuffled", "hex", "wedge", "mixed"}) {
        const FieldOnGrid on = made(shape, 24, "gyroid");
        const FieldSample sample = FieldSample::take(on.grid, on.field).value();
        EXPECT_EQ(sample.points(), on.grid.points.tuples());
        const auto tets = static_cast<double>(survey(on.grid, {.faces = false}).value().tets);
        EXPECT_NEAR(static_cast<double>(sample.tets()), tets, 0.05 * tets) << shape;
        for (const double isovalue : {-0.8, 0.1}) {
            const ExtractedOnce once = extract_once(on.grid, on.field, std::span(&isovalue, 1)).value();
            const auto triangles = static_cast<double>(once.surfaces.front().surface.triangle_count());
            EXPECT_NEAR(sample.triangles(isovalue), triangles, 0.2 * triangles) << shape << " at " << isovalue;
        }
        EXPECT_EQ(sample.triangles(100), 0);
        EXPECT_LT(sample.lower(), -1);
        EXPECT_GT(sample.upper(), 1);
    }
}

TEST(FieldSample, PassesOverWhatHasNoDataAndWhatIsBroken) {
    FieldOnGrid on = made("kuhn", 2, "sphere");
    on.field.values =
        Array::own(std::vector<double>(on.grid.points.tuples(), std::numeric_limits<double>::quiet_NaN()));
    const FieldSample nothing = FieldSample::take(on.grid, on.field).value();
    EXPECT_GT(nothing.lower(), nothing.upper());
    EXPECT_EQ(nothing.triangles(0), 0);

    on.grid.cells.connectivity = Array::own(std::vector<std::int64_t>(4 * on.grid.cells.count(), 1'000'000'000));
    EXPECT_EQ(FieldSample::take(on.grid, on.field).value().triangles(0), 0);

    on.field.values = Array::own(std::vector<float>(3));
    const auto wrong = FieldSample::take(on.grid, on.field);
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(wrong.error().message.find("3 values"), std::string::npos) << wrong.error().message;
}

Task task_of(double surfaces) {
    Task task;
    task.points = 200'000;
    task.tets = 1'000'000;
    task.surfaces = surfaces;
    task.triangles = task.triangles_together = 50'000;
    task.memory_free = 1'000'000'000;
    return task;
}

TEST(Weigh, PacksOnlyWhereManySurfacesPayForIt) {
    EXPECT_EQ(weigh(task_of(1), typical_speeds()).front().way, Way::brute);
    EXPECT_EQ(weigh(task_of(10'000), typical_speeds()).front().way, Way::clusters);
    EXPECT_EQ(weigh(task_of(1), typical_speeds()).size(), 2u);
}

TEST(Weigh, TakesADeviceWhereThereIsOneThatIsFaster) {
    const DeviceSpeeds fast{.upload_tet = 1e-9, .call = 1e-4, .tet = 0, .triangle = 1e-9};
    Task task = task_of(10'000);
    EXPECT_EQ(weigh(task, typical_speeds(), &fast).size(), 2u) << "no memory of a device is known";
    task.device_memory_free = 1'000'000'000;
    EXPECT_EQ(weigh(task, typical_speeds(), &fast).front().way, Way::device_clusters);
    const DeviceSpeeds slow{.upload_tet = 1e-9, .call = 1, .tet = 0, .triangle = 1e-9};
    EXPECT_EQ(weigh(task, typical_speeds(), &slow).front().way, Way::clusters);
    task.device_memory_free = 1'000'000;
    EXPECT_EQ(weigh(task, typical_speeds(), &fast).front().way, Way::clusters);
}

TEST(Weigh, KnowsThatGradientsCostBruteAPassForEachSurface) {
    Task task = task_of(10);
    EXPECT_EQ(weigh(task, typical_speeds()).front().way, Way::brute);
    task.gradients = true;
    EXPECT_EQ(weigh(task, typical_speeds()).front().way, Way::clusters);
}

TEST(Weigh, PutsTheSmallestFirstWhereNothingFits) {
    Task task = task_of(10'000);
    task.memory_free = 1'000;
    const std::vector<Forecast> ways = weigh(task, typical_speeds());
    EXPECT_FALSE(ways.front().fits);
    EXPECT_LT(ways.front().bytes, ways.back().bytes);
}

TEST(Weigh, PutsWhatDoesNotFitLast) {
    Task task = task_of(10'000);
    task.memory_free = 20'000'000; // half of what packing takes
    const std::vector<Forecast> ways = weigh(task, typical_speeds());
    EXPECT_EQ(ways.front().way, Way::brute);
    EXPECT_TRUE(ways.front().fits);
    EXPECT_FALSE(ways.back().fits);
    EXPECT_LT(ways.back().seconds, ways.front().seconds);
}

TEST(Speeds, AreMeasured) {
    const Speeds speeds = api::measure_speeds(16, 1, {}).value();
    for (const double positive : {speeds.pack_call, speeds.pack_tet, speeds.brute_call, speeds.brute_tet,
                                  speeds.brute_triangle, speeds.clusters_call, speeds.clusters_triangle})
        EXPECT_GT(positive, 0);
    EXPECT_GE(speeds.clusters_tet, 0);
    const std::atomic<bool> cancel = true;
    const auto cancelled = measure_speeds(1, {.report = {}, .cancel = &cancel});
    ASSERT_FALSE(cancelled);
    EXPECT_EQ(cancelled.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace isotet::test
