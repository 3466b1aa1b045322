// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the program says to wrong command lines, and with which exit status.
#include "program.hpp"
#include "small_grid.hpp"

namespace isotet::test {
namespace {

struct Misuse {
    std::vector<std::string> arguments;
    std::string says;
};

class ProgramMisuse : public testing::TestWithParam<Misuse> {};

TEST_P(ProgramMisuse, IsOneSentenceOnStandardErrorAndStatusTwo) {
    const RunResult run = isotet(GetParam().arguments);
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, GetParam().says));
    EXPECT_EQ(run.out, "");
}

const Misuse misuses[] = {
    {{}, "no command"},
    {{"extrct"}, "'extrct' is neither a command nor a file"},
    {{"extract"}, "FILE is required"},
    {{"extract", "make:kuhn:2", "--bogus"}, "there is no option '--bogus' ("},
    {{"extract", "--isovalues=3"}, "there is no option '--isovalues'; the nearest is --isovalue"},
    {{"--bogus"}, "there is no option '--bogus'"},
    {{"help", "extrct"}, "'extrct' is no command; commands are info, extract"},
    {{"extract", "make:kuhn:2:sphere", "-i", "1", "s-{val}.vtp"},
     "has {val}, but here only {value} and {time} and {step} can stand for something"},
    {{"extract", "make:kuhn:2", "a.vtp", "-o", "b.vtp", "-i", "1"}, "OUT got 'a.vtp'"},
    {{"extract", "", "-i", "1"}, "FILE got '', but it takes the name of a file"},
    {{"extract", "make:kuhn:2:sphere", "", "-i", "1"}, "OUT got ''"},
    {{"extract", "make:kuhn:2:sphere", "-o", "", "-i", "1"}, "--output got ''"},
    {{"extract", "make:kuhn:2:sphere", "-i", "1", "--json", ""}, "--json got ''"},
    {{"extract", "make:kuhn:2:sphere", "-i", "abc"}, "--isovalue got 'abc'"},
    {{"extract", "make:kuhn:2:sphere", "-i", "1,,2"}, "--isovalue got ''"},
    {{"extract", "make:kuhn:2:sphere", "-i", "nan"}, "--isovalue got 'nan'"},
    {{"extract", "make:kuhn:2:sphere", "-i", "1e999"}, "--isovalue got '1e999'"},
    {{"extract", "make:kuhn:2:sphere", "-i", "1", "--levels", "2"}, "excludes"},
    {{"extract", "make:kuhn:2:sphere", "--levels", "0"}, "--levels got '0'"},
    {{"extract", "make:kuhn:2:sphere", "--levels", "-3"}, "--levels got '-3'"},
    {{"extract", "make:kuhn:2:sphere", "-j", "1.5"}, "--threads got '1.5'"},
    {{"extract", "make:kuhn:2:sphere", "--normals", "smooth"},
     "--normals got 'smooth', but it takes none|gradient|face|vertex"},
    {{"extract", "make:kuhn:2:sphere", "--time", "0", "--step", "0"}, "excludes"},
    {{"extract", "make:kuhn:2:sphere", "--time", "3"}, "time 3 was asked for, but the file knows no time"},
    {{"extract", "make:kuhn:2:sphere", "--step", "1"}, "step 1 was asked for, but the file has 1 time step"},
    {{"extract", "make:kuhn:2:sphere", "-i", "1", "s-{time}.vtp"}, "has {time}, but the grid knows no time"},
    {{"extract", "make:kuhn:2:sphere,gyroid", "-f", "gyrod", "-i", "1"},
     "there is no field 'gyrod': the grid has 'gyroid', 'sphere'"},
    {{"extract", "make:kuhn:2:sphere", "-f", "sphere:foo", "-i", "1"}, "field 'sphere' has no component 'foo'"},
    {{"extract", "make:kuhn:2:sphere", "a.vtp", "-i", "0.1", "0.2"}, "'0.2' is one word too many; several numbers"},
    {{"extract", "make:kuhn:2:sphere", "--cell-field", "-i", "1"}, "'sphere' is no cell field"},
    {{"extract", "make:kuhn:2:sphere", "--with", "spere", "-i", "1"}, "there is no field 'spere'"},
    {{"extract", "make:kuhn:2:sphere", "-i", "1", "surface.xyz"}, "must end in one of"},
    {{"extract", "make:kuhn:2:sphere", "-i", "1", "surface"}, "must end in one of"},
    {{"extract", "make:kuhn:2:sphere", "-i", "1", "s.stl", "--edge-ends"}, "--edge-ends was asked for, but stl"},
    {{"extract", "make:kuhn:2:sphere", "-i", "1", "s.ply", "--source-cells"}, "--source-cells was asked for, but ply"},
    {{"extract", "make:sponge:2:sphere", "-i", "1"}, "sponge"},
    {{"extract", "make:kuhn:0:sphere", "-i", "1"}, "side"},
    {{"make", "kuhn", "-o", "a.vtu"}, "--side is required"},
    {{"make", "kuhn", "--side", "0", "-o", "a.vtu"}, "--side got '0'"},
    {{"make", "kuhn", "--side", "2"}, "--output is required"},
    {{"make", "kuhn", "--side", "2", "-o", "a.stl"}, "must end in one of"},
    {{"make", "cube", "--side", "2", "-o", "a.vtu"}, "cube"},
    {{"make", "kuhn", "--side", "2", "--fields", "sphere,heat", "-o", "a.vtu"}, "heat"},
    {{"check"}, "SURFACE is required"},
    {{"check", "a.vtp", "-f", "p"}, "--grid"},
    {{"info", "make:kuhn:2", "more"}, "more"},
    {{"formats", "--quiet", "--verbose"}, "excludes"},
    {{"devices", "--device", ""}, "--device got ''"},
    {{"docs", "poem"}, "poem"},
};

INSTANTIATE_TEST_SUITE_P(CommandLines, ProgramMisuse, testing::ValuesIn(misuses));

TEST_F(Program, LeavesNoFileWhereUsageIsWrong) {
    EXPECT_EQ(isotet({"extract", "make:kuhn:2:sphere", "-i", "1", path("s.vtp"), "--with", "nothing"}).status, 2);
    EXPECT_EQ(folder.entries(), 0u);
}

TEST_F(Program, RefusesToWriteOverItsInput) {
    const std::string grid = path("grid.vtk");
    put_content(grid, small_grid({{"p", {0, 1, 2, 3, 4}}}));
    const std::string before = content_of(grid);
    const RunResult run = isotet({"extract", grid, "-i", "1", "-o", folder.path().string() + "/./grid.vtk"});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "it would be overwritten"));
    EXPECT_EQ(content_of(grid), before);
}

TEST_F(Program, RefusesToWriteOverItsInputThroughALink) {
    const std::string grid = path("grid.msh");
    put_content(grid, small_grid({{"p", {0, 1, 2, 3, 4}}}));
    std::filesystem::create_symlink(grid, path("link.vtp"));
    std::filesystem::create_hard_link(grid, path("hard.vtp"));
    EXPECT_TRUE(is_one_error(isotet({"extract", grid, "-i", "1", path("link.vtp")}), "it would be overwritten"));
    EXPECT_TRUE(is_one_error(isotet({"extract", grid, "-i", "1", path("hard.vtp")}), "it would be overwritten"));
    EXPECT_TRUE(is_one_error(isotet({"info", grid, "--json", path("hard.vtp")}), "it would be overwritten"));
}

TEST_F(Program, RefusesAValueNameThatIsTheInput) {
    const std::string grid = path("1.vtk");
    put_content(grid, small_grid({{"p", {0, 1, 2, 3, 4}}}));
    const RunResult run = isotet({"extract", grid, "-f", "p", "-i", "1", path("{value}.vtk")});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "it would be overwritten"));
}

TEST_F(Program, RefusesOneFileForSurfaceAndJson) {
    const RunResult run = isotet({"extract", "make:kuhn:2:sphere", "-i", "1", path("a.vtp"), "--json", path("a.vtp")});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "two outputs are the same file"));
    EXPECT_EQ(folder.entries(), 0u);
}

TEST_F(Program, RefusesAFolderAsOutput) {
    std::filesystem::create_directory(path("folder.vtp"));
    const RunResult run = isotet({"extract", "make:kuhn:2:sphere", "-i", "1", path("folder.vtp")});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "folder"));
}

TEST_F(Program, SaysThreeToAFileThatIsNotThere) {
    const RunResult run = isotet({path("missing.msh")});
    EXPECT_EQ(run.status, 3);
    EXPECT_TRUE(is_one_error(run, "missing.msh"));
}

TEST_F(Program, SaysThreeToBrokenData) {
    put_content(path("broken.msh"), small_grid({}).substr(0, 150));
    const RunResult run = isotet({"extract", path("broken.msh"), path("s.vtp"), "-f", "x", "-i", "0.5"});
    EXPECT_EQ(run.status, 3);
    EXPECT_TRUE(is_one_error(run, "broken.msh"));
    EXPECT_EQ(folder.entries(), 1u);
}

TEST_F(Program, HelpIsACommandToo) {
    EXPECT_EQ(isotet({"help"}).out, isotet({"--help"}).out);
    const RunResult run = isotet({"help", "extract"});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.out, isotet({"extract", "--help"}).out);
}

TEST_F(Program, SaysHelpOnStandardOutputWithStatusZero) {
    for (const char* command : {"info", "extract", "check", "make", "formats"}) {
        const RunResult run = isotet({command, "--help"});
        EXPECT_EQ(run.status, 0) << command;
        EXPECT_NE(run.out.find(std::string("Usage: isotet ") + command), std::string::npos) << run.out;
        EXPECT_EQ(run.err, "");
    }
    EXPECT_NE(isotet({"--help"}).out.find("130  interrupted"), std::string::npos);
}

TEST_F(Program, HelpTellsOfCommonOptionsAndHelpAllOfAll) {
    const std::string common = isotet({"extract", "--help"}).out, all = isotet({"extract", "--help-all"}).out;
    for (const char* text : {"\n  -i, --isovalue ", "\n  --solid ", "\nExamples:\n", " --help-all\n"})
        EXPECT_NE(common.find(text), std::string::npos) << text;
    EXPECT_EQ(common.find("--centre"), std::string::npos) << common;
    for (const char* text : {"\n  -i, --isovalue ", "\n  --centre ", "\nTriangles of solids ", "\nExamples:\n"})
        EXPECT_NE(all.find(text), std::string::npos) << text;
    EXPECT_EQ(all.find("more options"), std::string::npos) << all;
}

} // namespace
} // namespace isotet::test
