// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids with hanging points through the jobs: closed by default, also where only some cells are read.
#include <algorithm>

#include <gtest/gtest.h>

#include <isotet/jobs/check_files.hpp>
#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/look_into.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "support/small_grid.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

bool has_note(const test::Listener& heard, const std::string& part) {
    return std::ranges::any_of(heard.noted,
                               [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

ExtractJob job_for(const std::string& grid, const std::string& out, HangingChoice choice) {
    ExtractJob job;
    job.grid.file = grid;
    job.grid.hanging_points = choice;
    job.field.name = "sphere";
    job.isovalues = {0.5};
    job.out = out;
    return job;
}

bool is_closed(const std::string& surface) {
    CheckJob job;
    job.surface = surface;
    job.closed = true;
    test::Listener quiet;
    return check_files(job, quiet).value().report.closed;
}

TEST(HangingPointJobs, CloseWhatIsReadWholeAndWhatIsReadInPart) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("octree.vtu");
    ASSERT_TRUE(write_grid(test::made_grid("octree-random", 5, {"sphere"}), file));
    for (const std::string& grid : {file, std::string("make:octree-random:5:sphere")})
        for (const HangingChoice choice : {HangingChoice::close, HangingChoice::interpolate, HangingChoice::leave}) {
            test::Listener heard;
            const std::string out = folder.file("surface.vtp");
            ASSERT_TRUE(extract_files(job_for(grid, out, choice), heard));
            EXPECT_EQ(is_closed(out), choice != HangingChoice::leave) << grid;
            EXPECT_EQ(has_note(heard, "hang on faces or edges of larger cells"), choice != HangingChoice::leave);
            EXPECT_EQ(has_note(heard, "they have those of the larger cells"), choice == HangingChoice::interpolate);
            EXPECT_EQ(has_note(heard, "they have their own"), choice == HangingChoice::close);
        }
}

TEST(HangingPointJobs, SaysNothingOfGridsWithoutThem) {
    const test::TemporaryFolder folder;
    test::Listener heard;
    const std::string out = folder.file("surface.vtp");
    ASSERT_TRUE(extract_files(job_for("make:mixed:4:sphere", out, HangingChoice::close), heard));
    EXPECT_FALSE(has_note(heard, "hang"));
}

TEST(HangingPointJobs, TellWhatIsClosed) {
    InfoJob job;
    job.grid.file = "make:octree:4:sphere";
    job.survey = true;
    test::Listener heard;
    const GridSummary found = look_into(job, heard).value();
    EXPECT_EQ(found.hanging_points, found.hanging.points);
    EXPECT_GT(found.hanging.cells, 0u);
    EXPECT_EQ(found.hanging.open_faces, 0u);
    EXPECT_GT(found.hanging.levels, 0u);
    EXPECT_FALSE(found.report.cells_by_type.contains(42)) << "cells are counted as the file has them";
}

} // namespace
} // namespace isotet::jobs
