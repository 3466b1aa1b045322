// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Counts and area equal those of VTK's own filter: kept mode whenever no tied point is a false tie, default mode
// whenever no point is tied.
#include <cmath>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "golden/golden_files.hpp"
#include "golden/vtk_contour.hpp"
#include "support/close_values.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

struct Compared {
    int kept = 0, merged = 0;
};

void expect_equal_to_vtk(const Grid& grid, const PackedGrid& packed, const PointField& field, double isovalue,
                         bool split_cells, Compared& compared) {
    const VtkSurface vtk = vtk_contour(grid, field.values, isovalue, split_cells);
    for (const Ties ties : {Ties::keep, Ties::merge}) {
        ExtractOptions options;
        options.ties = ties;
        const Extraction out = extract(packed, isovalue, options).value();
        const bool certified = ties == Ties::keep ? out.report.false_ties.value() == 0 : out.report.tied_points == 0;
        if (!certified) continue;
        ++(ties == Ties::keep ? compared.kept : compared.merged);
        EXPECT_EQ(out.surface.vertex_count(), vtk.vertices)
            << field.name << " = " << isovalue << ", ties " << int(ties);
        EXPECT_EQ(out.surface.triangle_count(), vtk.triangles)
            << field.name << " = " << isovalue << ", ties " << int(ties);
        if (!std::isfinite(vtk.area)) continue; // VTK interpolates to infinity
        // Polygons of other cells than tets are not plane, and VTK cuts them along other diagonals.
        const double near = packed.report().pyramids + packed.report().wedges + packed.report().hexahedra ? 0.05 : 1e-5;
        EXPECT_NEAR(area(out.surface), vtk.area, near * vtk.area) << field.name << " = " << isovalue;
    }
}

/// Three levels, and the values of two points: ties where the field's precision allows them.
std::vector<double> isovalues_of(const PackedGrid& packed, const PointField& field) {
    const FieldReport& report = packed.field();
    std::vector<double> isovalues;
    for (const double share : {0.2, 0.5, 0.83})
        isovalues.push_back(report.lower + share * (report.upper - report.lower));
    for (const std::size_t point : {field.values.tuples() / 3, field.values.tuples() / 2})
        if (std::isfinite(field.values.at(point))) isovalues.push_back(field.values.at(point));
    return isovalues;
}

class RealGrid : public testing::TestWithParam<GoldenFile> {};

INSTANTIATE_TEST_SUITE_P(Data, RealGrid, testing::ValuesIn(golden_files), [](const auto& file) {
    std::string name = file.param.path;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
});

TEST_P(RealGrid, HasTheCountsAndAreasOfVtk) {
    auto read = read_golden(GetParam().path);
    ASSERT_TRUE(read) << read.error().message;
    const Grid& grid = read->grid;
    Compared compared;
    for (const std::string& name : fields_to_contour(grid)) {
        const PointField field = find_field(grid, name).value();
        for (const bool split_cells : {false, true}) {
            const PackedGrid packed = pack(grid, field, {.split_cells = split_cells}).value();
            for (const double isovalue : isovalues_of(packed, field))
                expect_equal_to_vtk(grid, packed, field, isovalue, split_cells, compared);
        }
    }
    EXPECT_GT(compared.kept, 0);
    EXPECT_GT(compared.merged, 0);
}

TEST_P(RealGrid, HasSurfacesThatAreClosedOffItsBoundary) {
    auto read = read_golden(GetParam().path);
    ASSERT_TRUE(read) << read.error().message;
    const Grid& grid = read->grid;
    const PointField field = find_field(grid, fields_to_contour(grid).front()).value();
    for (const Ties ties : {Ties::keep, Ties::merge}) {
        ContourOptions options;
        options.method = Method::clusters;
        options.ties = ties;
        options.edge_ends = true;
        ContourInput input;
        input.grid = grid;
        input.field = field;
        Contour contour = Contour::create(std::move(input), options).value();
        ASSERT_TRUE(contour.prepare());
        for (const double isovalue : isovalues_of(*contour.packed(), field)) {
            const ContourResult result = contour.extract(isovalue).value();
            const SurfaceReport report = check(result.surfaces[0].surface, {.grid = &grid, .field = &field}).value();
            EXPECT_TRUE(report.sound) << isovalue << ": " << (report.findings.empty() ? "" : report.findings[0].what);
        }
    }
}

void expect_random_grid_equal_to_vtk(std::uint32_t seed, const NastyOptions& nasty,
                                     const std::vector<double>& isovalues, Compared& compared) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const NastyGrid g = nasty_grid(seed, nasty);
    const PackedGrid packed = pack(g.grid, g.field).value();
    for (const double isovalue : isovalues) expect_equal_to_vtk(g.grid, packed, g.field, isovalue, false, compared);
}

TEST(RandomGrids, HaveTheCountsAndAreasOfVtk) {
    Compared compared;
    for (const std::uint32_t seed : Seeds(1, 8)) {
        expect_random_grid_equal_to_vtk(seed, {.side = 9, .values = 0, .mirrored = 0.4, .repeated = 0.1},
                                        {-0.5, 0.1, 0.8}, compared);
        expect_random_grid_equal_to_vtk(seed, {.side = 6, .values = 4, .no_data = 0.05, .missing = 0.1}, {0.5, 1, 2},
                                        compared);
        expect_random_grid_equal_to_vtk(
            seed, {.side = 6, .values = 3, .inverted = 0.3, .mirrored = 0.4, .repeated = 0.2}, {0.5, 1}, compared);
    }
    EXPECT_GT(compared.kept, 40);
    EXPECT_GT(compared.merged, 30);
}

TEST(MadeGrids, HaveTheCountsAndAreasOfVtk) {
    Compared compared;
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed", "layer"})
        for (std::size_t place = 0; place < 2; ++place) {
            const Grid grid = made_grid(shape, 9, {"gyroid", "integer"});
            for (const bool split_cells : {false, true}) {
                const PackedGrid packed = pack(grid, point_field(grid, place), {.split_cells = split_cells}).value();
                for (const double isovalue : {0.3, 1.0, 2.0})
                    expect_equal_to_vtk(grid, packed, point_field(grid, place), isovalue, split_cells, compared);
            }
        }
    EXPECT_GT(compared.merged, 20);
}

TEST(CloseValues, HaveTheCountsAndAreasOfVtk) {
    Compared compared;
    for (const bool far_values : {false, true}) {
        const CloseValues close{.far_values = far_values};
        const Grid grid = made_grid("perturbed", 12, {"gyroid"});
        const PointField field = close.field(grid);
        const PackedGrid packed = pack(grid, field).value();
        for (int step = 0; step < close.steps; ++step)
            expect_equal_to_vtk(grid, packed, field, close.isovalue(step, 0.3), false, compared);
    }
    EXPECT_EQ(compared.merged, 12);
}

} // namespace
} // namespace isotet::test
