// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet check`: what it says no to, and how.
#include "program.hpp"

namespace isotet::test {
namespace {

using nlohmann::json;

/// A tetrahedron's four faces, outward, as OBJ; some may be left out or repeated.
std::string faces(const std::vector<std::string>& triangles) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    for (const std::string& triangle : triangles) text += "f " + triangle + "\n";
    return text;
}

const std::vector<std::string> closed{"1 3 2", "1 2 4", "2 3 4", "1 4 3"};

TEST_F(Program, CheckHasEveryPromisedKey) {
    put_content(path("s.obj"), faces(closed));
    const json report = json_of({"check", path("s.obj")});
    for (const char* key :
         {"schema", "vertices", "triangles", "closed", "boundary_edges", "non_manifold_edges", "inconsistent_edges",
          "hanging_edges",
          "equal_corner_triangles", "zero_area_triangles", "duplicate_triangles", "double_sheets", "touching_vertices",
          "coincident_vertices", "components", "euler", "genus", "area", "volume", "clean"}) {
        EXPECT_TRUE(report.contains(key)) << key;
    }
    EXPECT_EQ(report["euler"], 2);
    EXPECT_EQ(report["genus"], json::array({0}));
    EXPECT_EQ(report["closed"], true);
    EXPECT_EQ(report["clean"], true);
    EXPECT_DOUBLE_EQ(report["volume"].get<double>(), 1.0 / 6);
}

TEST_F(Program, CheckOnlyCountsBoundaryEdgesUnlessTheSurfaceMustBeClosed) {
    put_content(path("s.obj"), faces({closed[0], closed[1], closed[2]}));
    const json report = json_of({"check", path("s.obj")});
    EXPECT_EQ(report["boundary_edges"], 3);
    EXPECT_EQ(report["closed"], false);
    EXPECT_TRUE(report["volume"].is_null());
    const RunResult run = isotet({"check", path("s.obj"), "--closed"});
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.out.find("not sound"), std::string::npos) << run.out;
    EXPECT_EQ(run.err, "");
}

TEST_F(Program, CheckSaysNoToARepeatedTriangle) {
    put_content(path("s.obj"), faces({closed[0], closed[1], closed[2], closed[3], closed[3]}));
    EXPECT_EQ(json_of({"check", path("s.obj")}, 1)["duplicate_triangles"], 1);
}

TEST_F(Program, CheckSaysNoToEqualCorners) {
    put_content(path("s.obj"), faces({closed[0], closed[1], closed[2], closed[3], "2 2 3"}));
    EXPECT_EQ(json_of({"check", path("s.obj")}, 1)["equal_corner_triangles"], 1);
}

TEST_F(Program, CheckSaysNoToADoubleSheetOnlyWhenStrict) {
    put_content(path("s.obj"), faces({"1 2 3", "1 3 2"}));
    EXPECT_EQ(isotet({"check", path("s.obj")}).status, 0);
    EXPECT_EQ(json_of({"check", path("s.obj"), "--strict"}, 1)["double_sheets"], 1);
}

TEST_F(Program, CheckWeldsStlFirst) {
    EXPECT_EQ(isotet({"extract", "make:kuhn:6:sphere", path("s.stl"), "-i", "0.6"}).status, 0);
    const json report = json_of({"check", path("s.stl"), "--closed"});
    EXPECT_EQ(report["closed"], true);
    EXPECT_EQ(report["euler"], 2);
}

TEST_F(Program, CheckAllowsOpenEdgesOnTheBoundaryOfTheGridOnly) {
    const std::string grid = "make:kuhn:6:integer";
    EXPECT_EQ(isotet({"extract", grid, path("s.vtp"), "-i", "2", "--edge-ends"}).status, 0);
    EXPECT_EQ(json_of({"check", path("s.vtp"), "--grid", grid})["sound"], true);
    EXPECT_EQ(isotet({"extract", grid, path("none.vtp"), "-i", "1e6", "--edge-ends", "--allow-empty"}).status, 0);
    EXPECT_EQ(json_of({"check", path("none.vtp"), "--grid", grid})["sound"], true) << "an empty surface";
    EXPECT_EQ(isotet({"check", path("s.vtp"), "--closed"}).status, 1);
}

TEST_F(Program, CheckSaysTwoToAGridWithoutEdgeEnds) {
    EXPECT_EQ(isotet({"extract", "make:kuhn:4:sphere", path("s.vtp"), "-i", "0.6"}).status, 0);
    const RunResult run = isotet({"check", path("s.vtp"), "--grid", "make:kuhn:4:sphere"});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "edge_ends"));
}

TEST_F(Program, CheckSaysThreeToAFileThatIsNoSurface) {
    put_content(path("s.vtp"), "no surface at all");
    EXPECT_EQ(isotet({"check", path("s.vtp")}).status, 3);
    EXPECT_EQ(isotet({"check", path("missing.ply")}).status, 3);
}

TEST_F(Program, CheckWritesItsReportAlsoWhereItSaysNo) {
    put_content(path("s.obj"), faces({closed[0]}));
    EXPECT_EQ(isotet({"check", path("s.obj"), "--closed", "--json", path("r.json")}).status, 1);
    const json report = json::parse(content_of(path("r.json")));
    EXPECT_EQ(report["sound"], false);
    EXPECT_FALSE(report["findings"].empty());
}

} // namespace
} // namespace isotet::test
