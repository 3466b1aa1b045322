// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Random grids of tets, pyramids, wedges and hexahedra that share faces: all engines and methods agree, surfaces are
// closed off the boundary, whatever the cells look like.
#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/engine.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/engines.hpp"
#include "support/mixed_grid.hpp"
#include "support/seeds.hpp"
#include "support/surface_bytes.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {
namespace {

ExtractOptions everything(Ties ties, const NastyGrid& g) {
    ExtractOptions options;
    options.ties = ties;
    options.normals = Normals::gradient;
    options.edge_ends = options.source_cells = true;
    options.point_fields = {{"value", g.field.values}};
    return options;
}

/// Without regard to numbers and order.
SurfaceSets triangles_of(const Surface& surface) { return sets_of(surface); }

void expect_all_agree(std::uint32_t seed, const MixedOptions& mixed, Precision precision,
                      const std::vector<double>& isovalues, bool split_cells = false) {
    SCOPED_TRACE(testing::Message() << mixed.shape << ", seed " << seed);
    const NastyGrid g = mixed_grid(seed, mixed);
    const PackedGrid packed =
        pack(g.grid, g.field,
             {.precision = precision, .source_cells = true, .split_cells = split_cells, .gradients = true})
            .value();
    for (const double isovalue : isovalues)
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            SCOPED_TRACE(testing::Message() << "isovalue " << isovalue << ", ties " << int(ties));
            const ExtractOptions options = everything(ties, g);
            const Extraction cpu = extract(packed, isovalue, options).value();
            const Extraction reference = extract_on(Engine::reference, packed, isovalue, options).value();
            ASSERT_EQ(cpu.surface.vertex_count(), reference.surface.vertex_count());
            ASSERT_EQ(cpu.surface.triangle_count(), reference.surface.triangle_count());
            ASSERT_TRUE(bytes_of(cpu.surface) == bytes_of(reference.surface));
            ASSERT_EQ(cpu.report.selected_clusters, reference.report.selected_clusters);

            const DirectOptions direct_options{options, precision, split_cells};
            const auto direct = extract_direct(g.grid, g.field, std::span(&isovalue, 1), direct_options).value();
            const auto slow =
                extract_direct_by_reference(g.grid, g.field, std::span(&isovalue, 1), direct_options).value();
            const Surface &fast_surface = direct.surfaces[0].surface, &slow_surface = slow.surfaces[0].surface;
            ASSERT_EQ(fast_surface.vertex_count(), slow_surface.vertex_count());
            ASSERT_EQ(fast_surface.triangle_count(), slow_surface.triangle_count());
            ASSERT_TRUE(bytes_of(fast_surface) == bytes_of(slow_surface));
            const bool repeats = mixed.repeated > 0 || mixed.collapsed > 0; // which only packing drops
            ASSERT_TRUE(repeats || triangles_of(fast_surface) == triangles_of(cpu.surface));

            const SurfaceReport report =
                check(cpu.surface, {.grid = &g.grid, .field = &g.field, .split_cells = split_cells}).value();
            // Cells that collapse may come to lie in each other, and give the same triangle.
            const bool sound = mixed.collapsed > 0 ? report.blamed_edges == 0 : report.sound;
            ASSERT_TRUE(sound || ties == Ties::keep) << (report.findings.empty() ? "" : report.findings[0].what);
            ASSERT_EQ(report.unused_vertices, 0u);
        }
}

TEST(NativeCells, AgreeOnSmoothFields) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"})
        for (const std::uint32_t seed : Seeds(1, 2))
            expect_all_agree(seed, {.shape = shape, .side = 7, .values = 0, .moved = 0.1}, Precision::float32,
                             {-0.4, 0, 0.3});
}

TEST(NativeCells, AgreeOnIntegerFieldsFullOfTies) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"})
        for (const std::uint32_t seed : Seeds(1, 6))
            expect_all_agree(seed, {.shape = shape, .side = 3 + int(seed) % 3, .values = 2 + int(seed) % 4},
                             Precision::float32, {0, 0.5, 1, 2});
}

TEST(NativeCells, AgreeOnPointsWithoutData) {
    for (const std::uint32_t seed : Seeds(1, 8))
        expect_all_agree(seed, {.side = 3 + int(seed) % 3, .values = 4, .no_data = 0.03 * (1 + seed % 4)},
                         Precision::float32, {1, 1.5});
}

TEST(NativeCells, AgreeOnWarpedMirroredRepeatedAndMissingCells) {
    for (const std::uint32_t seed : Seeds(1, 8))
        expect_all_agree(seed,
                         {.side = 3 + int(seed) % 3,
                          .values = 3,
                          .no_data = 0.02,
                          .missing = 0.15,
                          .mirrored = 0.4,
                          .repeated = 0.1,
                          .moved = 0.6},
                         Precision::float32, {0.5, 1});
}

TEST(NativeCells, AgreeOnCollapsedCells) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"})
        for (const std::uint32_t seed : Seeds(1, 6))
            expect_all_agree(seed,
                             {.shape = shape, .side = 4, .values = int(seed % 2) * 4, .moved = 0.1, .collapsed = 0.15},
                             Precision::float32, {0.2, 1});
}

TEST(NativeCells, AgreeOnDoublePacking) {
    for (const std::uint32_t seed : Seeds(1, 4))
        expect_all_agree(seed, {.side = 5, .values = int(seed % 2) * 4, .no_data = 0.02, .wide = true},
                         Precision::float64, {0.25, 1});
}

TEST(NativeCells, AgreeWhereCellsAreSplit) {
    for (const std::uint32_t seed : Seeds(1, 4))
        expect_all_agree(seed,
                         {.side = 4, .values = int(seed % 2) * 4, .no_data = 0.02, .mirrored = 0.3, .collapsed = 0.1},
                         Precision::float32, {0.25, 1}, true);
}

} // namespace
} // namespace isotet::test
