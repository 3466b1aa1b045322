// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/extract_files.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include <isotet/check.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "support/places.hpp"
#include "support/small_grid.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

ExtractJob solid_job(const std::string& grid, const std::string& out, SolidChoice::Kind kind) {
    ExtractJob job;
    job.grid.file = grid;
    job.out = out;
    job.solid = SolidChoice{kind, {}};
    return job;
}

TEST(SolidFiles, AreClosedWhenTheyAreReadBack) {
    const test::TemporaryFolder folder;
    for (const char* grid :
         {"make:kuhn:8:gyroid", "make:mixed:6:gyroid", "make:kelvin:3:gyroid", "make:tet10:3:sphere"})
        for (const char* name : {"s.stl", "s.ply", "s.vtp"}) {
            SCOPED_TRACE(testing::Message() << grid << " " << name);
            Listener listener;
            ExtractJob job = solid_job(grid, folder.file(name), SolidChoice::Kind::above);
            job.isovalues = {0.3};
            const ExtractNumbers numbers = extract_files(job, listener).value();
            ASSERT_EQ(numbers.surfaces.size(), 1u);
            ASSERT_TRUE(numbers.surfaces[0].solid.has_value());
            EXPECT_EQ(numbers.surfaces[0].solid->open_edges, 0u);
            EXPECT_GT(numbers.surfaces[0].solid->grid_volume, numbers.surfaces[0].solid->volume);
            const SurfaceFile read = read_surface(folder.file(name)).value();
            const SurfaceReport report = check(read.surface, {.closed = true, .weld = read.format == "stl"}).value();
            EXPECT_TRUE(report.sound) << (report.findings.empty() ? "" : report.findings[0].what);
            EXPECT_TRUE(report.closed);
            EXPECT_NEAR(report.volume, numbers.surfaces[0].solid->volume, 1e-5);
        }
}

TEST(SolidFiles, OneBetweenTwoIsovaluesIsTheDifferenceOfTwoBelow) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob below = solid_job("make:hex:8:gyroid", "", SolidChoice::Kind::below);
    below.isovalues = {-0.4, 0.4};
    const ExtractNumbers two = extract_files(below, listener).value();
    ExtractJob between = solid_job("make:hex:8:gyroid", "", SolidChoice::Kind::between);
    between.solid->range = {-0.4, 0.4};
    const ExtractNumbers one = extract_files(between, listener).value();
    ASSERT_EQ(one.surfaces.size(), 1u);
    EXPECT_NEAR(one.surfaces[0].solid->volume, two.surfaces[1].solid->volume - two.surfaces[0].solid->volume, 1e-5);
}

TEST(SolidFiles, OfKeptPartsHaveTheirVolumeAndTellOfCavities) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob job = solid_job("make:kuhn:8:sphere", folder.file("box.vtp"), SolidChoice::Kind::above);
    job.isovalues = {0.5};
    const SolidNumbers all = *extract_files(job, listener).value().surfaces[0].solid;
    job.keep = PartChoice{}; // the box without the ball's surface in it
    const SurfaceNumbers kept = extract_files(job, listener).value().surfaces[0];
    EXPECT_NEAR(kept.solid->volume, 8, 1e-6);
    EXPECT_LT(all.volume, 7.6);
    EXPECT_NEAR(kept.solid->boundary_area, 24, 1e-6);
    EXPECT_EQ(kept.solid->isosurface_area, 0);
    EXPECT_EQ(listener.noted.back(),
              "of the parts left out 1 is a cavity, of negative volume: the solid is filled there");
}

/// A cube of hexahedra with the cell field "group": 1 for them, 10 and 11 for quadrilaterals on its lower and upper side.
Grid cube_with_patches(std::uint64_t side) {
    Grid grid = test::made_grid("hex", side, {"sphere"});
    std::vector<std::int64_t> corners;
    for (std::size_t i = 0; i < grid.cells.connectivity.size(); ++i)
        corners.push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(i)));
    const std::size_t hexahedra = corners.size() / 8;
    std::vector<std::int64_t> offsets{0};
    for (std::size_t i = 1; i <= hexahedra; ++i) offsets.push_back(static_cast<std::int64_t>(8 * i));
    std::vector<std::uint8_t> types(hexahedra, 12);
    std::vector<std::int32_t> groups(hexahedra, 1);
    for (std::size_t i = 0; i < hexahedra; ++i)
        for (const bool top : {false, true}) {
            const std::size_t first = 8 * i + (top ? 4 : 0);
            if (grid.points.at(static_cast<std::size_t>(corners[first]), 2) != (top ? 1 : -1)) continue;
            for (std::size_t k = 0; k < 4; ++k) corners.push_back(corners[first + k]);
            offsets.push_back(static_cast<std::int64_t>(corners.size()));
            types.push_back(9);
            groups.push_back(top ? 11 : 10);
        }
    grid.cells.connectivity = Array::own(std::move(corners));
    grid.cells.offsets = Array::own(std::move(offsets));
    grid.cells.types = Array::own(std::move(types));
    grid.cell_fields.push_back({"group", Array::own(std::move(groups))});
    return grid;
}

TEST(SolidFiles, MarkTheirBoundaryByRegionAndPatch) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("cube.vtu");
    ASSERT_TRUE(write_grid(cube_with_patches(4), file));
    Listener listener;
    ExtractJob job = solid_job(file, folder.file("solid.vtp"), SolidChoice::Kind::below);
    job.isovalues = {1.2};
    ASSERT_TRUE(extract_files(job, listener));
    const Surface solid = read_surface(job.out).value().surface;
    const auto field = [&](const char* name) {
        return std::ranges::find(solid.cell_fields, name, &Field::name)->values;
    };
    const Array group = field("group"), patch = field("patch_group"), on_cell = field("patch_cell"),
                part = field("boundary");
    std::size_t on_patches = 0;
    for (std::size_t i = 0; i < solid.triangle_count(); ++i) {
        double height = 0; // of all corners
        for (std::size_t k = 0; k < 3; ++k)
            height += solid.positions.at(static_cast<std::size_t>(solid.triangles.at(i, k)), 2) / 3;
        const bool is_lower = part.at(i) == 1 && height < -1 + 1e-6, is_upper = part.at(i) == 1 && height > 1 - 1e-6;
        EXPECT_EQ(group.at(i), 1) << "of the cell";
        EXPECT_EQ(patch.at(i), is_lower ? 10 : is_upper ? 11 : -1);
        EXPECT_EQ(on_cell.at(i) >= 64, is_lower || is_upper);
        on_patches += is_lower || is_upper;
    }
    EXPECT_GT(on_patches, 8u);
    job.with = {{"group"}};
    ASSERT_TRUE(extract_files(job, listener));
    EXPECT_EQ(read_surface(job.out).value().surface.point_fields.size(), 0u);
}

TEST(SolidFiles, TellThePatchesThatAFileNames) {
    Listener listener;
    ExtractJob job =
        solid_job(test::source_folder().string() + "/data/msh/inclusions_v22_ascii.msh", "", SolidChoice::Kind::above);
    job.field.name = "x";
    job.isovalues = {0.25};
    const SolidNumbers solid = *extract_files(job, listener).value().surfaces[0].solid;
    ASSERT_EQ(solid.patches.size(), 1u);
    EXPECT_EQ(solid.patches[0].number, 3);
    EXPECT_EQ(solid.patches[0].name, "boundary");
    EXPECT_NEAR(solid.patches[0].area, 4, 1e-5) << "of the unit cube, cut off at a quarter";
}

TEST(SolidFiles, OfPiecesAreTogetherThatOfTheWhole) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob job = solid_job("make:mixed:4:gyroid", "", SolidChoice::Kind::below);
    job.isovalues = {0.3};
    const SolidNumbers whole = *extract_files(job, listener).value().surfaces[0].solid;
    double volume = 0, area = 0;
    std::vector<Surface> parts;
    for (std::uint64_t k = 0; k < 3; ++k) {
        job.piece = PieceOf{k, 3};
        job.out = folder.file(fmt::format("{}.stl", k));
        const SolidNumbers part = *extract_files(job, listener).value().surfaces[0].solid;
        volume += part.volume;
        area += part.boundary_area;
        parts.push_back(read_surface(job.out).value().surface);
    }
    EXPECT_NEAR(volume, whole.volume, 1e-6);
    EXPECT_NEAR(area, whole.boundary_area, 1e-6);
    EXPECT_TRUE(check(join(parts, {}), {.closed = true, .weld = true}).value().sound);
}

TEST(SolidFiles, ThatAreEmptySayWhichValuesTheFieldHas) {
    Listener listener;
    ExtractJob job = solid_job("make:kuhn:2:sphere", "", SolidChoice::Kind::above);
    job.field.name = "x";
    job.isovalues = {7};
    const Result<ExtractNumbers> refused = extract_files(job, listener);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "the solid is empty: it has values of 'x' 7 or more, but the field has -1 to 1; "
                                       "`allow_empty` writes it nevertheless");
    job.allow_empty = true;
    ASSERT_TRUE(extract_files(job, listener));
    EXPECT_EQ(std::ranges::count(listener.noted,
                                 "the solid is empty: it has values of 'x' 7 or more, but the field has -1 to 1"),
              1)
        << testing::PrintToString(listener.noted);
}

TEST(SolidFiles, TellPartsThatReducingLeavesOut) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob job = solid_job("make:kuhn:24:wavelet", folder.file("s.vtp"), SolidChoice::Kind::above);
    job.field.name = "wavelet";
    job.isovalues = {220};
    job.reduce = ReduceOptions{.share = 0.97};
    ASSERT_TRUE(extract_files(job, listener));
    EXPECT_TRUE(std::ranges::any_of(listener.noted, [](const std::string& note) {
        return note.find("connected parts are kept: the others were too small") != note.npos;
    })) << testing::PrintToString(listener.noted);
}

TEST(SolidFiles, RefuseWhatDoesNotGoTogether) {
    Listener listener;
    ExtractJob piece = solid_job("make:tet10:2:sphere", "", SolidChoice::Kind::above);
    piece.piece = PieceOf{0, 2};
    piece.isovalues = {0.5};
    ExtractJob gradient = solid_job("make:kuhn:4:gyroid", "", SolidChoice::Kind::above);
    gradient.contour.normals = Normals::gradient;
    ExtractJob other = solid_job("make:kuhn:4:gyroid", "", SolidChoice::Kind::between);
    other.solid->range = {0, 1};
    other.isovalues = {0.5};
    for (const ExtractJob& job : {piece, gradient, other}) {
        const auto done = extract_files(job, listener);
        ASSERT_FALSE(done);
        EXPECT_EQ(done.error().code, ErrorCode::invalid_argument);
    }
}

} // namespace
} // namespace isotet::jobs
