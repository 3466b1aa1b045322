// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/extract_files.hpp>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/read.hpp>

#include "jobs/listener.hpp"
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

TEST(SolidFiles, RefuseWhatDoesNotGoTogether) {
    Listener listener;
    ExtractJob piece = solid_job("make:kuhn:4:gyroid", "", SolidChoice::Kind::above);
    piece.piece = PieceOf{0, 2};
    ExtractJob gradient = solid_job("make:kuhn:4:gyroid", "", SolidChoice::Kind::above);
    gradient.normals = Normals::gradient;
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
