// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/extract_files.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include <isotet/make.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

std::string text_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(PartTable, HasARowForEachPartAndKeepsTheLargest) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob job;
    job.grid.file = "make:kuhn:20:gyroid";
    job.out = folder.file("s.vtp");
    job.isovalues = {0.95};
    job.parts_table = folder.file("parts.csv");
    job.keep = PartChoice{};
    const ExtractNumbers numbers = extract_files(job, listener).value();
    const SurfaceNumbers& surface = numbers.surfaces.at(0);
    ASSERT_TRUE(surface.parts.has_value());
    ASSERT_GT(surface.parts->parts.size(), 1u);
    EXPECT_EQ(surface.parts_kept, 1u);
    EXPECT_EQ(surface.triangles, surface.parts->parts[0].triangles);
    EXPECT_EQ(read_surface(job.out).value().surface.triangle_count(), surface.triangles);
    const std::string table = text_of(job.parts_table);
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(table, '\n')), surface.parts->parts.size() + 1);
    EXPECT_EQ(table.substr(0, table.find('\n')),
              "isovalue,time,part,triangles,vertices,area,volume,closed,centre_x,centre_y,centre_z,lower_x,lower_y,"
              "lower_z,upper_x,upper_y,upper_z,mean of gyroid");
}

TEST(PartTable, KeepsPartsOfMoreAreaOrVolume) {
    Listener listener;
    ExtractJob job;
    job.grid.file = "make:kuhn:20:gyroid";
    job.isovalues = {0.95};
    for (const auto kind : {PartChoice::Kind::area, PartChoice::Kind::volume}) {
        job.keep = PartChoice{kind, kind == PartChoice::Kind::area ? 0.3 : 100.0, {}};
        const ExtractNumbers numbers = extract_files(job, listener).value();
        const SurfaceNumbers& surface = numbers.surfaces.at(0);
        const auto kept =
            static_cast<std::uint64_t>(std::ranges::count_if(surface.parts->parts, [&](const SurfacePart& part) {
                return kind == PartChoice::Kind::area && part.area > 0.3;
            }));
        EXPECT_EQ(surface.parts_kept, kept);
        EXPECT_LT(kept, surface.parts->parts.size());
    }
}

/// A gyroid's grid with the cell field material: 2 where x > 0, else 1.
std::string two_materials(const test::TemporaryFolder& folder) {
    Grid grid = make_grid({.shape = "kuhn", .side = 20, .fields = {"gyroid"}}).value();
    std::vector<std::int32_t> material(grid.cells.count());
    for (std::size_t i = 0; i < material.size(); ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k)
            sum += grid.points.at(static_cast<std::size_t>(grid.cells.connectivity.at(4 * i + k)), 0);
        material[i] = sum > 0 ? 2 : 1;
    }
    grid.cell_fields.push_back({"material", Array::own(std::move(material))});
    const std::string file = folder.file("two.vtu");
    EXPECT_TRUE(static_cast<bool>(write_grid(grid, file)));
    return file;
}

TEST(PartTable, KeepsPartsThatTouchARegionOrTheBoundary) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob job;
    job.grid.file = two_materials(folder);
    job.field.name = "gyroid";
    job.out = folder.file("s.vtp");
    for (const bool solid : {false, true})
        for (const char* region : {"material=2", "material=2:7", "boundary"}) {
            SCOPED_TRACE(testing::Message() << region << (solid ? " of a solid" : ""));
            job.keep = PartChoice{PartChoice::Kind::touching, 0, region};
            job.isovalues = {solid ? 1.35 : 0.95};
            if (solid) job.solid = SolidChoice{};
            const ExtractNumbers numbers = extract_files(job, listener).value();
            const std::vector<SurfacePart>& parts = numbers.surfaces.at(0).parts->parts;
            const bool is_boundary = region[0] == 'b';
            const auto touches = [&](const SurfacePart& part) {
                if (!is_boundary) return part.upper[0] > 1e-6;
                return std::ranges::any_of(part.lower, [](double x) { return x < -1 + 1e-6; }) ||
                       std::ranges::any_of(part.upper, [](double x) { return x > 1 - 1e-6; });
            };
            const auto kept = static_cast<std::uint64_t>(std::ranges::count_if(parts, touches));
            EXPECT_EQ(numbers.surfaces[0].parts_kept, kept);
            EXPECT_GT(kept, 0u);
            EXPECT_LT(is_boundary ? 0 : kept, parts.size());
            const Surface written = read_surface(job.out).value().surface; // only solids carry what was not asked for
            EXPECT_EQ(std::ranges::count(written.cell_fields, "material", &Field::name), solid);
        }
}

TEST(PartTable, KnowsRegionsByTheirNames) {
    Listener listener;
    ExtractJob job;
    job.grid.file = (test::source_folder() / "data/msh/inclusions_v41_ascii.msh").string();
    job.field.name = "x";
    job.isovalues = {0.5};
    for (const char* region : {"domain", "inclusions", "gmsh:physical=2"}) {
        job.keep = PartChoice{PartChoice::Kind::touching, 0, region};
        EXPECT_EQ(extract_files(job, listener).value().surfaces.at(0).parts_kept, 1u) << region;
    }
    for (const char* region : {"inclusion", "material=2", "gmsh:physical=b", "gmsh:physical=2:1", "="}) {
        job.keep = PartChoice{PartChoice::Kind::touching, 0, region};
        const auto refused = extract_files(job, listener);
        ASSERT_FALSE(refused) << region;
        EXPECT_EQ(refused.error().code, ErrorCode::invalid_argument);
    }
}

TEST(PartTable, MayNotBeTheInputOrTheSurface) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob job;
    job.grid.file = "make:kuhn:4:gyroid";
    job.out = folder.file("s.vtp");
    job.parts_table = job.out;
    job.isovalues = {0};
    EXPECT_FALSE(extract_files(job, listener));
}

} // namespace
} // namespace isotet::jobs
