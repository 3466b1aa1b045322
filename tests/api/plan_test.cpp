// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The rule that chooses a method, and what it is expected to take, from a look at the field.
#include <limits>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/contour.hpp>
#include <isotet/extract.hpp>
#include <isotet/make.hpp>

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

TEST(FieldSample, PredictsTheTrianglesOfALargeSurface) {
    for (const char* shape : {"kuhn", "shuffled", "hex", "wedge", "mixed"}) {
        const FieldOnGrid on = made(shape, 24, "gyroid");
        const auto tets = static_cast<double>(survey(on.grid, {.faces = false}).value().tets);
        for (const bool split_cells : {false, true}) {
            const FieldSample sample = FieldSample::create(on.grid, on.field, split_cells).value();
            EXPECT_EQ(sample.points(), on.grid.points.tuples());
            EXPECT_LE(static_cast<double>(sample.tets()), 1.05 * tets) << shape;
            if (split_cells) {
                EXPECT_GE(static_cast<double>(sample.tets()), 0.95 * tets) << shape;
            }
            for (const double isovalue : {-0.8, 0.1}) {
                const DirectExtraction once =
                    extract_direct(on.grid, on.field, std::span(&isovalue, 1), {.split_cells = split_cells}).value();
                const auto triangles = static_cast<double>(once.surfaces.front().surface.triangle_count());
                EXPECT_NEAR(sample.triangles(isovalue), triangles, 0.2 * triangles) << shape << " at " << isovalue;
            }
            EXPECT_EQ(sample.triangles(100), 0);
            EXPECT_LT(sample.lower(), -1);
            EXPECT_GT(sample.upper(), 1);
        }
    }
}

TEST(FieldSample, PassesOverWhatHasNoDataAndWhatIsBroken) {
    FieldOnGrid on = made("kuhn", 2, "sphere");
    on.field.values =
        Array::own(std::vector<double>(on.grid.points.tuples(), std::numeric_limits<double>::quiet_NaN()));
    const FieldSample nothing = FieldSample::create(on.grid, on.field).value();
    EXPECT_GT(nothing.lower(), nothing.upper());
    EXPECT_EQ(nothing.triangles(0), 0);

    on.grid.cells.connectivity = Array::own(std::vector<std::int64_t>(4 * on.grid.cells.count(), 1'000'000'000));
    EXPECT_EQ(FieldSample::create(on.grid, on.field).value().triangles(0), 0);

    on.field.values = Array::own(std::vector<float>(3));
    const auto wrong = FieldSample::create(on.grid, on.field);
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(wrong.error().message.find("3 values"), std::string::npos) << wrong.error().message;
}

TEST(Rule, PacksOnlyWhereManySurfacesPayForIt) {
    EXPECT_EQ(method_for(1, false), Method::direct);
    EXPECT_EQ(method_for(31, false), Method::direct);
    EXPECT_EQ(method_for(32, false), Method::clusters);
    EXPECT_EQ(method_for(3, true), Method::direct);
    EXPECT_EQ(method_for(4, true), Method::clusters);
    EXPECT_EQ(method_for(4, true, Method::direct), Method::direct);
    EXPECT_EQ(method_for(1, false, Method::clusters), Method::clusters);
}

Workload workload_of(double surfaces) {
    Workload work;
    work.points = 200'000;
    work.tets = 1'000'000;
    work.surfaces = surfaces;
    work.triangles = work.triangles_together = 50'000;
    return work;
}

TEST(Estimate, IsLessForDirectExtractionOfOneSurfaceAndForClustersOfMany) {
    EXPECT_LT(estimate(Method::direct, workload_of(1)).seconds, estimate(Method::clusters, workload_of(1)).seconds);
    EXPECT_GT(estimate(Method::direct, workload_of(300)).seconds, estimate(Method::clusters, workload_of(300)).seconds);
    EXPECT_LT(estimate(Method::direct, workload_of(1)).bytes, estimate(Method::clusters, workload_of(1)).bytes);
}

TEST(Estimate, KnowsThatGradientsCostDirectExtractionPassesForEachSurface) {
    Workload work = workload_of(10);
    const double without = estimate(Method::direct, work).seconds;
    work.gradients = true;
    EXPECT_GT(estimate(Method::direct, work).seconds, 5 * without);
    EXPECT_GT(estimate(Method::direct, work).seconds, estimate(Method::clusters, work).seconds);
}

TEST(Estimate, GrowsWithTheTriangles) {
    Workload work = workload_of(1);
    const Estimate few = estimate(Method::direct, work);
    work.triangles = work.triangles_together = 10'000'000;
    EXPECT_GT(estimate(Method::direct, work).seconds, few.seconds);
    EXPECT_GT(estimate(Method::direct, work).bytes, few.bytes + std::uint64_t{100} * 9'000'000);
}

} // namespace
} // namespace isotet::test
