// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet make`: grids in files.
#include "program.hpp"

namespace isotet::test {
namespace {

TEST_F(Program, MakeTellsWhatItWrote) {
    const auto report = json_of({"make", "kuhn", "--side", "3", "--fields", "sphere,integer", "-o", path("g.vtu")});
    EXPECT_EQ(report["cells"], 162);
    EXPECT_EQ(report["points"], 64);
    EXPECT_EQ(report["fields"], (nlohmann::json{"sphere", "integer"}));
    EXPECT_EQ(report["bytes"], std::filesystem::file_size(path("g.vtu")));
}

TEST_F(Program, MakeWritesTheSameBytesForAnyThreadCount) {
    for (const char* shape : {"shuffled", "mixed"}) {
        EXPECT_EQ(isotet({"make", shape, "--side", "5", "-j", "1", "-o", path("one.vtk")}).status, 0);
        EXPECT_EQ(isotet({"make", shape, "--side", "5", "-j", "7", "-o", path("seven.vtk")}).status, 0);
        EXPECT_EQ(content_of(path("one.vtk")), content_of(path("seven.vtk"))) << shape;
    }
}

TEST_F(Program, MakeTakesASeed) {
    EXPECT_EQ(isotet({"make", "shuffled", "--side", "3", "--seed", "1", "-o", path("1.vtk")}).status, 0);
    EXPECT_EQ(isotet({"make", "shuffled", "--side", "3", "--seed", "2", "-o", path("2.vtk")}).status, 0);
    EXPECT_NE(content_of(path("1.vtk")), content_of(path("2.vtk")));
}

TEST_F(Program, MakeRefusesMoreThanTheMachineHas) {
    const RunResult run = isotet({"make", "kuhn", "--side", "4096", "-o", path("g.vtu")});
    EXPECT_EQ(run.status, 4);
    EXPECT_TRUE(is_one_error(run, ""));
    EXPECT_EQ(folder.entries(), 0u);
}

} // namespace
} // namespace isotet::test
