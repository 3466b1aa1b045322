// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet clip`: how ranges are written, what is written, and what is told.
#include <isotet/read.hpp>

#include "program.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

using nlohmann::json;

TEST_F(Program, ClipWritesCellsThatAreReadBack) {
    const json report = json_of({"clip", "make:hex:12:gyroid,sphere", path("part.vtu"), "-f", "gyroid", "--above", "0.3"});
    EXPECT_EQ(report["command"], "clip");
    EXPECT_EQ(report["range"], json::array({0.3, nullptr}));
    const json step = report["steps"][0];
    EXPECT_GT(step["polyhedra"], 0);
    EXPECT_GT(step["whole_cells"], 0);
    const Grid grid = read(path("part.vtu")).value().grid;
    EXPECT_EQ(grid.points.tuples(), step["points"]);
    EXPECT_EQ(grid.cells.count(), step["cells"]);
    EXPECT_EQ(grid.point_fields.size(), 2u);
    ASSERT_EQ(grid.cell_fields.size(), 1u);
    EXPECT_EQ(grid.cell_fields[0].name, "source_cell");
    const json solid =
        json_of({"extract", path("part.vtu"), "-f", "gyroid", "--solid", "above", "-i", "-9"})["surfaces"][0]["solid"];
    const json same = json_of({"extract", "make:hex:12:gyroid", "-f", "gyroid", "--solid", "above", "-i",
                               "0.3"})["surfaces"][0]["solid"];
    EXPECT_NEAR(solid["volume"].get<double>(), same["volume"].get<double>(), 1e-4 * same["volume"].get<double>());
}

TEST_F(Program, ClipWritesLegacyFilesWithoutPolyhedra) {
    const std::vector<std::string> words{"clip", "make:hex:5:gyroid", path("part.vtk"), "-f", "gyroid",
                                         "--between", "0.1:0.4"};
    EXPECT_EQ(isotet(words).status, 2); // polyhedra
    std::vector<std::string> without = words;
    without.emplace_back("--no-polyhedra");
    const json step = json_of(without)["steps"][0];
    EXPECT_EQ(step["polyhedra"], 0);
    EXPECT_EQ(read(path("part.vtk")).value().grid.cells.count(), step["cells"]);
}

TEST_F(Program, ClipRefusesWhatIsNoRange) {
    EXPECT_EQ(isotet({"clip", "make:kuhn:2:sphere"}).status, 2);
    EXPECT_EQ(isotet({"clip", "make:kuhn:2:sphere", "--above", "1", "--below", "2"}).status, 2);
    for (const char* range : {"", "1", "2:1", "1:1", "a:b", "1:2:3"}) {
        const RunResult run = isotet({"clip", "make:kuhn:2:sphere", "--between", range});
        EXPECT_EQ(run.status, 2) << range;
        EXPECT_NE(run.err.find("--between got '" + std::string(range) + "', but it takes"), std::string::npos) << run.err;
    }
}

TEST_F(Program, ClipRefusesARangeThatHoldsNothing) {
    const RunResult run = isotet({"clip", "make:kuhn:4:sphere", path("none.vtu"), "-f", "sphere", "--above", "9"});
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("--allow-empty"), std::string::npos) << run.err;
    EXPECT_EQ(isotet({"clip", "make:kuhn:4:sphere", path("none.vtu"), "-f", "sphere", "--above", "9", "--allow-empty"})
                  .status,
              0);
}

} // namespace
} // namespace isotet::test
