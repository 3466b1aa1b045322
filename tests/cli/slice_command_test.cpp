// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet slice`: how shapes are written, and what is told.
#include "program.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

using nlohmann::json;

TEST_F(Program, SliceTakesPlanesSpheresAndCylinders) {
    const auto surfaces = [&](std::vector<std::string> shape) {
        std::vector<std::string> words{"slice", "make:kuhn:6:sphere"};
        words.insert(words.end(), shape.begin(), shape.end());
        return json_of(words)["surfaces"];
    };
    const struct {
        std::vector<std::string> shape;
        std::vector<double> at;
        double area;
    } cases[] = {{{"--plane", "z=0.25"}, {0.25}, 4},
                 {{"--plane=-x=0.25"}, {-0.25}, 4},
                 {{"--plane", "y=-0.5,0.1"}, {-0.5, 0.1}, 4},
                 {{"--plane", "0,0,2,0.5"}, {0.5}, 4},
                 {{"--plane", "0,0,2@7,7,0.25"}, {0.5}, 4},
                 {{"--plane", "z@7,7,0.25"}, {0.25}, 4},
                 {{"--along", "z"}, {0}, 4},
                 {{"--along", "0,2,0", "--count", "3"}, {-1, 0, 1}, 4},
                 {{"--sphere", "0,0,0,0.5"}, {0.5}, 3.1},
                 {{"--cylinder", "z@0,0,0,0.5"}, {0.5}, 6.2}};
    for (const auto& [shape, at, area] : cases) {
        const json made = surfaces(shape);
        ASSERT_EQ(made.size(), at.size()) << shape.back();
        for (std::size_t i = 0; i < at.size(); ++i) {
            EXPECT_EQ(made[i]["isovalue"], at[i]) << shape.back();
            EXPECT_NEAR(made[i]["area"].get<double>(), area, area == 4 ? 1e-5 : 0.7) << shape.back();
        }
    }
    EXPECT_EQ(surfaces({"--sphere", "0,0,0,0.5,0.6,0.7"}).size(), 3u);
}

TEST_F(Program, SliceTellsItsCommandAndField) {
    const json report = json_of({"slice", "make:kuhn:6:sphere", path("cut.vtp"), "--plane", "1,1,0@0,0,0"});
    EXPECT_EQ(report["command"], "slice");
    EXPECT_EQ(report["field"], "height along (1, 1, 0)");
    EXPECT_EQ(report["surfaces"][0]["file"], path("cut.vtp"));
    const RunResult table = isotet({"slice", "make:kuhn:6:sphere", "--plane", "z=0.5"});
    EXPECT_NE(table.out.find("z, -1 to 1"), std::string::npos) << table.out;
}

TEST_F(Program, SliceTakesSharesForOffsetsAndRadii) {
    for (const std::vector<std::string>& shape : {std::vector<std::string>{"--plane", "-z=50%v,0.25"},
                                                  {"--sphere", "0,0,0,0.5,10%v"},
                                                  {"--cylinder", "z@0,0,0,p20"}}) {
        const json report = json_of({"slice", "make:hex:4:sphere", shape[0], shape[1]});
        EXPECT_EQ(report["surfaces"].size(), shape[0] == "--cylinder" ? 1u : 2u);
    }
}

TEST_F(Program, SliceRefusesWhatIsNoShape) {
    const auto refused = [&](std::vector<std::string> shape) {
        std::vector<std::string> words{"slice", "make:kuhn:2:sphere"};
        words.insert(words.end(), shape.begin(), shape.end());
        const RunResult run = isotet(words);
        EXPECT_EQ(run.status, 2) << run.err;
        return run.err;
    };
    for (const char* plane : {"", "z", "z=", "w=1", "0,0,0,1", "1,2,3", "z@1,2", "z@1,2,50%v", "0,0,0@1,2,3", "z=1,b",
                              "z=101%v"})
        EXPECT_NE(refused({"--plane", plane}).find("--plane got '" + std::string(plane) + "', but it takes"),
                  std::string::npos)
            << plane;
    for (const char* sphere : {"", "1,2,3", "a,b,c,d"}) refused({"--sphere", sphere});
    EXPECT_NE(refused({"--sphere", "0,0,0,-1"}).find("the radius is -1"), std::string::npos);
    for (const char* cylinder : {"1,2,3,4", "z@1,2,3", "z@", "0,0,0@1,2,3,4"}) refused({"--cylinder", cylinder});
    refused({"--plane", "z=1", "--sphere", "0,0,0,1"});
    refused({"--count", "3", "--plane", "z=1"});
    EXPECT_NE(refused({}).find("nothing says where to cut: --plane, --along, --sphere or --cylinder does"),
              std::string::npos);
}

/// The reader process keeps only the cells that the shape cuts; the reference engine has all read.
TEST_F(Program, SliceOfAFileReadByVtkIsThatOfAllCells) {
    const std::string file = (source_folder() / "data/vtkhdf/can_hex.hdf").string();
    for (const char* shape : {"--plane=0.2,1,0.1,-1", "--sphere=0,5,-5,13", "--cylinder=y@0,0,-5,12"}) {
        const json some = json_of({"slice", file, path("some.vtp"), shape, "--with", ""});
        json_of({"slice", file, path("all.vtp"), shape, "--with", "", "--engine", "reference"});
        EXPECT_GT(some["surfaces"][0]["triangles"], 0) << shape;
        EXPECT_EQ(content_of(path("some.vtp")), content_of(path("all.vtp"))) << shape;
    }
}

TEST_F(Program, SliceThatMissesTheGridIsAnErrorUnlessItMayBeEmpty) {
    const RunResult run = isotet({"slice", "make:kuhn:4:sphere", path("s.vtp"), "--plane", "z=9"});
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("isovalue 9 is outside the range of 'z', -1 to 1: the surface is empty"), std::string::npos)
        << run.err;
    EXPECT_EQ(isotet({"slice", "make:kuhn:4:sphere", "--plane", "z=9", "--fail-if-empty"}).status, 3);
    EXPECT_EQ(isotet({"slice", "make:kuhn:4:sphere", path("s.vtp"), "--plane", "z=9", "--allow-empty"}).status, 0);
    EXPECT_EQ(isotet({"slice", "make:kuhn:4:sphere", path("s.vtp"), "--plane", "z=9,0.5"}).status, 0);
}

} // namespace
} // namespace isotet::test
