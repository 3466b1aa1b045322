// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/extract_files.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "jobs/listener.hpp"
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
        job.keep = PartChoice{kind, kind == PartChoice::Kind::area ? 0.3 : 100.0};
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
