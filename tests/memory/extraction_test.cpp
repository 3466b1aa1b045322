// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Extraction takes no more memory than its header promises, and than it predicts: allocations are counted.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "base/system/block.hpp"
#include "memory/counted_memory.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

/// Tets that share nothing: no surface has more vertices and records for its triangles.
Grid loose_tets(int count) {
    std::vector<std::array<double, 3>> points;
    std::vector<Corners> tets;
    for (int t = 0; t < count; ++t) {
        const double x = t % 100, y = t / 100 % 100, z = t / 10000;
        const auto first = static_cast<std::int64_t>(points.size());
        points.insert(points.end(), {{x, y, z}, {x + 0.9, y, z}, {x, y + 0.9, z}, {x, y, z + 0.9}});
        tets.push_back({first, first + 1, first + 2, first + 3});
    }
    return tet_grid(points, tets);
}

struct Options {
    std::string name;
    ExtractOptions extract;
};

std::vector<Options> all_options(const Field& point_field, const Field& cell_field) {
    std::vector<Options> all(7);
    all[0].name = "the surface alone";
    all[1].name = "keep";
    all[1].extract.ties = Ties::keep;
    all[2].name = "face normals";
    all[2].extract.normals = Normals::face;
    all[3].name = "gradient normals";
    all[3].extract.normals = Normals::gradient;
    all[4].name = "a point field";
    all[4].extract.point_fields = {point_field};
    all[5].name = "a cell field";
    all[5].extract.cell_fields = {cell_field};
    all[6].name = "everything";
    all[6].extract.ties = Ties::keep;
    all[6].extract.normals = Normals::gradient;
    all[6].extract.edge_ends = all[6].extract.source_cells = true;
    all[6].extract.point_fields = {point_field};
    all[6].extract.cell_fields = {cell_field};
    return all;
}

void expect_limits_hold(const PackedGrid& packed, const std::vector<double>& isovalues, const ExtractOptions& options,
                        const Run& run) {
    std::vector<Extraction> surfaces;
    const auto measure = [&] {
        surfaces.clear();
        core::drop_kept_blocks(); // what is kept from before would be used without being taken
        return peak_bytes([&] { surfaces = extract(packed, isovalues, options, run).value(); });
    };
    // A worker thread that starts late takes memory of its own meanwhile, which is counted, too: so the lower of two.
    const std::size_t peak = std::min(measure(), measure());
    std::size_t output = 0, triangles = 0, selected = 0;
    for (const Extraction& extraction : surfaces) {
        output += extraction.report.surface_bytes;
        triangles += extraction.surface.triangle_count();
        selected += extraction.report.selected_clusters;
    }
    const auto threads = static_cast<std::size_t>(run.threads);
    const std::size_t limit = 48 * triangles + 100 * selected + 16 * packed.report().clusters + 1'000'000 * threads;
    const ExtractReport& report = surfaces[0].report;
    EXPECT_LE(peak, output + limit) << triangles << " triangles, " << selected << " selected clusters";
    EXPECT_LE(report.transient_bytes, limit);
    // The heap's rounding, what does not grow, and the moment when a block is mapped too large and cut to whole huge
    // pages.
    const std::size_t small = 20'000 * (threads + isovalues.size()) + (std::size_t{2} << 20);
    EXPECT_LE(peak, output + report.transient_bytes + small);
    EXPECT_LE(output + report.transient_bytes, report.predicted_bytes);
}

void expect_limits_hold(const Grid& grid, const PointField& field, Precision precision,
                        const std::vector<double>& isovalues) {
    PackOptions pack_options;
    pack_options.precision = precision;
    pack_options.gradients = pack_options.source_cells = true;
    const PackedGrid packed = pack(grid, field, pack_options).value();
    const std::size_t cells = grid.cells.count();
    const Field cell_field{"cell", Array::own(std::vector<double>(cells, 1.0))};
    for (const Options& options : all_options({"point", field.values}, cell_field))
        for (const int threads : {1, 4}) {
            SCOPED_TRACE(options.name + ", " + std::to_string(threads) + " threads");
            // The field is looked at first, which takes no memory either.
            expect_limits_hold(packed, {isovalues[0]}, options.extract, {.threads = threads});
            expect_limits_hold(packed, isovalues, options.extract, {.threads = threads});
        }
}

TEST(ExtractionMemory, StaysWithinItsLimitsOnSmoothFields) {
    const Grid grid = made_grid("kuhn", 40, {"gyroid"}); // 384,000 tets
    expect_limits_hold(grid, point_field(grid), Precision::float32, {0.1, 0.11, 0.12, -0.9});
}

TEST(ExtractionMemory, StaysWithinItsLimitsOnShuffledGrids) {
    const Grid grid = made_grid("shuffled", 30, {"gyroid"});
    expect_limits_hold(grid, point_field(grid), Precision::float32, {0.3, 0, -0.3});
    expect_limits_hold(grid, point_field(grid), Precision::float64, {0.3, 0, -0.3});
}

TEST(ExtractionMemory, StaysWithinItsLimitsOnFieldsFullOfTies) {
    const Grid grid = made_grid("mixed", 24, {"integer"});
    expect_limits_hold(grid, point_field(grid), Precision::float32, {0, 1, 2, 2.5});
}

TEST(ExtractionMemory, StaysWithinItsLimitsOnTangledGridsWithNaN) {
    for (const std::uint32_t seed : Seeds(1, 2)) {
        const NastyGrid g = nasty_grid(
            seed, {.side = 20, .values = 5, .no_data = 0.05, .missing = 0.1, .inverted = 0.1, .repeated = 0.1});
        expect_limits_hold(g.grid, g.field, seed % 2 ? Precision::float32 : Precision::float64, {0, 1, 1.5});
    }
}

TEST(ExtractionMemory, StaysWithinItsLimitsOnLooseTets) {
    const Grid grid = loose_tets(60'000);
    std::vector<float> values(grid.points.tuples());
    for (std::size_t p = 0; p < values.size(); ++p)
        values[p] = static_cast<float>(p % 4) + 1e-5f * static_cast<float>(p % 1000);
    expect_limits_hold(grid, field_of(values), Precision::float32, {0.5, 1.5, 2.5});
}

TEST(ExtractionMemory, IsSmallForSmallSurfacesOnLargeGrids) {
    const Grid grid = made_grid("kuhn", 60, {"plane"});
    expect_limits_hold(grid, point_field(grid), Precision::float32, {1e9, -1e9});
    expect_limits_hold(grid, point_field(grid), Precision::float32, {0.5});
}

} // namespace
} // namespace isotet::test
