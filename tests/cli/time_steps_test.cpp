// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Time steps: which one is taken, and what becomes of all of them.
#include <fmt/format.h>

#include "program.hpp"
#include "small_grid.hpp"

namespace isotet::test {
namespace {

using nlohmann::json;

class ProgramWithTimes : public Program {
protected:
    void SetUp() override {
        put_content(grid,
                    small_grid({{"p", {0, 1, 1, 1, 2}, 0}, {"p", {0, 2, 2, 2, 4}, 0.1}, {"p", {0, 4, 4, 4, 8}, 2.5}}));
    }
    std::string grid = path("g.msh");
};

TEST_F(ProgramWithTimes, InfoListsTheTimes) { EXPECT_EQ(json_of({"info", grid})["times"], json::array({0, 0.1, 2.5})); }

TEST_F(ProgramWithTimes, InfoShowsEachOfAFewTimes) {
    const RunResult run = isotet({"info", grid, "--step", "1"});
    EXPECT_NE(run.out.find("3, times 0, 0.1, 2.5; this is step 1, time 0.1\n"), std::string::npos) << run.out;
}

TEST_F(ProgramWithTimes, InfoTellsRangesOverAllSteps) {
    const json one = json_of({"info", grid}), all = json_of({"info", grid, "--all-steps"});
    EXPECT_EQ(one["fields"][0]["range"][0], json::array({0, 2}));
    EXPECT_EQ(all["fields"][0]["range"][0], json::array({0, 8}));
    EXPECT_EQ(all["steps_of_ranges"], 3);
    EXPECT_NE(isotet({"info", grid, "--all-steps"}).out.find("those of all 3 time steps"), std::string::npos);
    EXPECT_EQ(isotet({"info", grid, "--all-steps", "--step", "1"}).status, 2);
}

TEST_F(Program, InfoShowsTheFirstAndTheLastOfManyTimes) {
    std::vector<SmallField> steps;
    for (int step = 0; step < 11; ++step) steps.push_back({"p", {0, 1, 1, 1, 2}, 0.5 * step});
    put_content(path("many.msh"), small_grid(steps));
    const RunResult run = isotet({"info", path("many.msh"), "--step", "2"});
    EXPECT_NE(run.out.find("11, times 0 to 5; this is step 2, time 1\n"), std::string::npos) << run.out;
    EXPECT_EQ(json_of({"info", path("many.msh")})["times"].size(), 11u);
}

TEST_F(ProgramWithTimes, OneGlbHasAllStepsAndUsdFilesAStage) {
    ASSERT_EQ(isotet({"extract", grid, path("all.glb"), "-f", "p", "-i", "0.5", "--all-steps"}).status, 0);
    const std::string glb = content_of(path("all.glb"));
    const json head =
        json::parse(glb.substr(20, static_cast<unsigned char>(glb[12]) + 256U * static_cast<unsigned char>(glb[13])));
    EXPECT_EQ(head["meshes"].size(), 3u);
    EXPECT_EQ(head["animations"][0]["channels"].size(), 3u);
    EXPECT_EQ(isotet({"extract", grid, path("all.stl"), "-f", "p", "-i", "0.5", "--all-steps"}).status, 2);
    ASSERT_EQ(isotet({"extract", grid, path("u_{step}.usda"), "-f", "p", "-i", "0.5", "--all-steps"}).status, 0);
    EXPECT_NE(content_of(path("u.usda")).find("@@@./u_2.usda@@@"), std::string::npos);
}

TEST_F(ProgramWithTimes, TheFirstStepIsTakenWithANote) {
    const RunResult run = isotet({"extract", grid, "-f", "p", "-i", "0.5"});
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.err.find("isotet: note: the file has 3 time steps: step 0"), std::string::npos) << run.err;
}

TEST_F(ProgramWithTimes, AStepIsTakenByNumberOrTime) {
    EXPECT_EQ(json_of({"extract", grid, "-f", "p", "-i", "1", "--step", "2"})["range"], json::array({0, 8}));
    const json report = json_of({"extract", grid, "-f", "p", "-i", "1", "--time", "0.1"});
    EXPECT_EQ(report["range"], json::array({0, 4}));
    EXPECT_EQ(report["surfaces"][0]["time"], 0.1);
}

TEST_F(ProgramWithTimes, ATimeThatIsNotThereIsAnErrorWithThoseThatAre) {
    const RunResult run = isotet({"extract", grid, "-f", "p", "-i", "1", "--time", "0.100001"});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "the file has 3 times: 0, 0.1, 2.5; the nearest is 0.1"));
    EXPECT_EQ(isotet({"extract", grid, "-f", "p", "-i", "1", "--time", "0.1000000000000001"}).status, 0);
}

TEST_F(ProgramWithTimes, AllStepsMakeOneFileEachAndEqualThoseOfSingleSteps) {
    const json report = json_of({"extract", grid, path("s-{time}.vtp"), "-f", "p", "-i", "1", "--all-steps"});
    ASSERT_EQ(report["surfaces"].size(), 3u);
    int step = 0;
    for (const char* time : {"0", "0.1", "2.5"}) {
        const std::string single = path("single.vtp");
        EXPECT_EQ(
            isotet({"extract", grid, single, "-f", "p", "-i", "1", "-q", "--step", std::to_string(step++)}).status, 0);
        EXPECT_EQ(content_of(path(fmt::format("s-{}.vtp", time))), content_of(single)) << time;
    }
}

TEST_F(Program, ExportSkipsStepsWithoutTheFieldAndTakesARangeByShares) {
    ASSERT_EQ(isotet({"make", "kuhn", "--side", "2", "--fields", "sphere", "-o", path("0.vtu")}).status, 0);
    ASSERT_EQ(isotet({"make", "kuhn", "--side", "2", "--fields", "sphere,gyroid", "-o", path("1.vtu")}).status, 0);
    put_content(path("run.pvd"), "<VTKFile type='Collection'><Collection><DataSet timestep='0' file='0.vtu'/>"
                                 "<DataSet timestep='1' file='1.vtu'/></Collection></VTKFile>");
    const std::vector<std::string> all{"export", path("run.pvd"), path("a.html"), "--all-steps", "--surfaces", "2"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), all.begin(), all.end());
        return more;
    };
    EXPECT_EQ(json_of(with({"-f", "gyroid"}))["steps"], 1);
    for (const char* field : {"gyroid", "sphere"}) {
        const RunResult one = isotet({"export", path("run.pvd"), path("b.html"), "-f", field, "--color-by", "gyroid"});
        EXPECT_EQ(one.status, 0) << one.err;
        EXPECT_NE(one.err.find("step 0 has no 'gyroid': step 1, time 1, was taken"), std::string::npos) << one.err;
    }
    EXPECT_EQ(json_of(with({"-f", "sphere"}))["steps"], 2);
    EXPECT_EQ(json_of(with({"-f", "sphere", "--color-by", "gyroid"}))["steps"], 1);
    EXPECT_EQ(json_of(with({"-f", "sphere", "--between", "0%v,100%v"}))["isovalues"],
              json_of(with({"-f", "sphere"}))["isovalues"]);
    EXPECT_EQ(isotet(with({"-f", "sphere", "--between", "90%v,10%v"})).status, 3);
}

TEST_F(ProgramWithTimes, TheRangeOfASeriesIsThatOfTheLastStep) {
    const RunResult run = isotet({"extract", grid, "-f", "p", "-i", "1", "--all-steps"});
    EXPECT_NE(run.out.find("p, 0 to 8 in the last time step"), std::string::npos) << run.out;
}

TEST_F(ProgramWithTimes, AllStepsIntoOneFileAreRefused) {
    const RunResult run = isotet({"extract", grid, path("s.vtp"), "-f", "p", "-i", "1", "--all-steps"});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "has neither {step} nor {time}"));
}

TEST_F(ProgramWithTimes, LevelsFollowTheRangeOfEachStep) {
    const json report = json_of({"extract", grid, "-f", "p", "--levels", "1", "--all-steps"});
    std::vector<double> isovalues;
    for (const json& surface : report["surfaces"]) isovalues.push_back(surface["isovalue"]);
    EXPECT_EQ(isovalues, (std::vector<double>{1, 2, 4}));
}

TEST_F(ProgramWithTimes, TheCellsAreNotPackedAgainWhereOnlyValuesChange) {
    const RunResult run = isotet({"extract", grid, "-f", "p", "-i", "1", "--all-steps", "-v", "--method", "clusters"});
    EXPECT_EQ(run.status, 0) << run.err;
    std::size_t count = 0;
    for (std::size_t at = 0; (at = run.err.find("not packed again", at)) != std::string::npos; ++at) ++count;
    EXPECT_EQ(count, 2u) << run.err;
}

TEST_F(ProgramWithTimes, StepsNumberTheFilesOfASeriesAndACollectionNamesThem) {
    const json report = json_of({"extract", grid, path("s-{step}.vtp"), "-f", "p", "-i", "1", "--all-steps"});
    for (const char* step : {"0", "1", "2"}) EXPECT_TRUE(std::filesystem::exists(path(fmt::format("s-{}.vtp", step))));
    EXPECT_EQ(report["collection"], path("s.pvd"));
    const std::string collection = content_of(path("s.pvd"));
    EXPECT_NE(collection.find("timestep=\"0.1\" group=\"\" part=\"0\" file=\"s-1.vtp\""), std::string::npos)
        << collection;
    EXPECT_NE(collection.find("timestep=\"2.5\""), std::string::npos);
}

TEST_F(ProgramWithTimes, SurfacesOfOneTimeArePartsOfTheCollection) {
    const RunResult run =
        isotet({"extract", grid, path("{value}_{time}.vtp"), "-f", "p", "-i", "0.5,1", "--all-steps"});
    EXPECT_EQ(run.status, 0) << run.err;
    const std::string collection = content_of(path("series.pvd"));
    EXPECT_NE(collection.find("timestep=\"2.5\" group=\"\" part=\"1\" file=\"1_2.5.vtp\""), std::string::npos)
        << collection;
}

TEST_F(ProgramWithTimes, ACollectionIsWrittenForASeriesOfVtpOnlyAndNeverOverTheInput) {
    EXPECT_TRUE(
        json_of({"extract", grid, path("s-{step}.ply"), "-f", "p", "-i", "1", "--all-steps"})["collection"].is_null());
    EXPECT_TRUE(
        json_of({"extract", grid, path("s-{step}.vtp"), "-f", "p", "-i", "1", "--step", "1"})["collection"].is_null());
    EXPECT_TRUE(std::filesystem::exists(path("s-1.vtp")));
    std::filesystem::create_symlink(grid, path("g.pvd"));
    const RunResult run = isotet({"extract", grid, path("g-{step}.vtp"), "-f", "p", "-i", "1", "--all-steps"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("no collection of the series is written"), std::string::npos) << run.err;
    EXPECT_TRUE(std::filesystem::is_symlink(path("g.pvd")));
}

TEST_F(ProgramWithTimes, ACollectionReplacesOneOfIsotetAndNoOther) {
    const auto extract = [&] {
        return isotet({"extract", grid, path("s-{step}.vtp"), "-f", "p", "-i", "1", "--all-steps"});
    };
    ASSERT_EQ(extract().status, 0);
    const std::string own = content_of(path("s.pvd"));
    const RunResult again = extract();
    EXPECT_EQ(again.err.find("no collection"), std::string::npos) << again.err;
    const std::string other =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "  <Collection>\n  </Collection>\n</VTKFile>\n";
    for (const std::string& content : {other, std::string("mine"), std::string()}) {
        std::ofstream(path("s.pvd")) << content;
        const RunResult run = extract();
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_NE(run.err.find("is there already, and not of isotet"), std::string::npos) << run.err;
        EXPECT_EQ(content_of(path("s.pvd")), content);
    }
    std::filesystem::remove(path("s.pvd"));
    ASSERT_EQ(extract().status, 0);
    EXPECT_EQ(content_of(path("s.pvd")), own);
}

} // namespace
} // namespace isotet::test
