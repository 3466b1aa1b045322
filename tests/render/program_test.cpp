// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet render`: pictures of grids and of surfaces, and what it says when there is nothing to draw, or nobody to draw it.
#include <fstream>
#include <iterator>

#include "cli/program.hpp"

namespace isotet::test {
namespace {

class Render : public Program {
protected:
    static std::string content(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::vector<std::string> command(const std::string& input, const std::string& out, std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"render", input, "-o", path(out), "--size", "80x60", "--device", "software"});
        return more;
    }
};

TEST_F(Render, DrawsTheSamePictureEveryTime) {
    const auto report = json_of(command("make:kuhn:8:sphere,gyroid", "a.png"));
    EXPECT_EQ(report["field"], "sphere");
    EXPECT_EQ(report["surfaces"].size(), 3u);
    EXPECT_EQ(report["width"], 80);
    EXPECT_EQ(report["drawing"]["bytes_down"], 80 * 60 * 4) << "nothing but the picture comes back";
    ASSERT_EQ(isotet(command("make:kuhn:8:sphere,gyroid", "b.png")).status, 0);
    EXPECT_GT(content(path("a.png")).size(), 500u);
    EXPECT_TRUE(content(path("a.png")) == content(path("b.png")));
}

TEST_F(Render, DrawsASurfaceFromAFile) {
    ASSERT_EQ(isotet({"extract", "make:kuhn:8:sphere", path("s.stl"), "-i", "0.5"}).status, 0);
    const auto report = json_of(command(path("s.stl"), "s.png"));
    EXPECT_EQ(report["format"], "stl");
    EXPECT_GT(report["surfaces"][0]["triangles"], 100);
    const RunResult run = isotet(command(path("s.stl"), "s.png", {"-i", "1", "-q"}));
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "is a surface: it has no isovalues"));
}

TEST_F(Render, SaysThatASoftwareDeviceDraws) {
    const RunResult run = isotet(command("make:kuhn:4:sphere", "a.png", {"-i", "0.5"}));
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.err.find("note: a software device draws: "), std::string::npos) << run.err;
}

TEST_F(Render, SaysWhenThereIsNoSurface) {
    const RunResult run = isotet(command("make:kuhn:4:sphere", "a.png", {"-i", "99"}));
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.err.find("there is no surface at 99: the values of 'sphere' go from"), std::string::npos) << run.err;
}

TEST_F(Render, RefusesWhatCannotBe) {
    RunResult run = isotet({"render", "make:kuhn:4:sphere", "--device", "none"});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "only a device can draw"));
    run = isotet(command("make:kuhn:4:sphere", "a.gif"));
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "must end in .png"));
    run = isotet({"render", "make:kuhn:4:sphere", "--size", "0x4"});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "--size got '0x4'"));
    run = isotet(command("make:kuhn:4:sphere", "a.png", {"--background", "mauve"}));
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "--background got 'mauve'"));
    run = isotet(command(path("nowhere.stl"), "a.png"));
    EXPECT_EQ(run.status, 3);
}

TEST_F(Render, SaysWhyNothingCanBeDrawn) {
    RunOptions without;
    without.environment = {{"VK_DRIVER_FILES", "/nonexistent"}, {"VK_ICD_FILENAMES", "/nonexistent"}};
    const RunResult run = isotet({"render", "make:kuhn:4:sphere", "-i", "0.5", "-o", path("a.png")}, without);
    EXPECT_EQ(run.status, 4);
    EXPECT_TRUE(is_one_error(run, "nothing can be drawn: "));
}

} // namespace
} // namespace isotet::test
