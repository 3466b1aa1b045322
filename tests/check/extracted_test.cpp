// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Extracted surfaces pass the rule of the boundary faces, and fail it as soon as one triangle is missing or turned.
#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/check.hpp>
#include <isotet/extract.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>

namespace {

using namespace isotet;

struct Extracted {
    Grid grid;
    PointField field;
    Surface surface;

    Extracted(std::string_view what, double isovalue, Ties ties) {
        grid = make_grid(parse_make(what).value()).value();
        field = find_field(grid, "").value();
        const PackedGrid packed = pack(grid, field).value();
        ExtractOptions options;
        options.ties = ties;
        options.edge_ends = true;
        surface = extract(packed, isovalue, options).value().surface;
    }
    SurfaceReport report() const { return check(surface, {.grid = &grid, .field = &field}).value(); }

    /// The corners of all triangles, to be changed.
    std::vector<std::uint32_t> corners() const {
        const auto all = surface.triangles.as<std::uint32_t>();
        return {all.begin(), all.end()};
    }
};

TEST(CheckExtracted, FindsSurfacesOfManyTiesSoundInBothModes) {
    for (const char* shape : {"kuhn:12:integer", "shuffled:12:integer", "mixed:9:integer"})
        for (const double isovalue : {1.0, 2.0, 2.5, 4.0})
            for (const Ties ties : {Ties::merge, Ties::keep}) {
                const SurfaceReport report = Extracted(shape, isovalue, ties).report();
                EXPECT_GT(report.triangles, 0u) << shape << " at " << isovalue;
                EXPECT_TRUE(report.sound) << shape << " at " << isovalue;
            }
}

TEST(CheckExtracted, BlamesTheThreeEdgesOfAMissingTriangle) {
    Extracted sphere("perturbed:12:sphere", 0.6, Ties::merge);
    auto corners = sphere.corners();
    corners.resize(corners.size() - 3);
    sphere.surface.triangles = Array::own(std::move(corners), 3);
    EXPECT_EQ(sphere.report().blamed_edges, 3u);
}

TEST(CheckExtracted, BlamesTheThreeEdgesOfATurnedTriangle) {
    Extracted sphere("mixed:12:sphere", 0.6, Ties::merge);
    auto corners = sphere.corners();
    std::swap(corners[0], corners[1]);
    sphere.surface.triangles = Array::own(std::move(corners), 3);
    const SurfaceReport report = sphere.report();
    EXPECT_EQ(report.inconsistent_edges, 3u);
    EXPECT_EQ(report.blamed_edges, 3u);
}

TEST(CheckExtracted, BlamesARepeatedTriangle) {
    Extracted sphere("kuhn:12:sphere", 0.6, Ties::merge);
    auto corners = sphere.corners();
    const std::uint32_t repeated[] = {corners[1], corners[2], corners[0]};
    corners.insert(corners.end(), repeated, repeated + 3);
    sphere.surface.triangles = Array::own(std::move(corners), 3);
    EXPECT_EQ(sphere.report().blamed_duplicates, 1u);
}

} // namespace
