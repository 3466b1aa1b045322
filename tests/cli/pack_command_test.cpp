// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet pack`, and what commands make of packed files.
#include "program.hpp"

namespace isotet::test {
namespace {

class PackCommand : public Program {
protected:
    std::string packed(std::string grid = "make:mixed:6:gyroid,sphere", std::vector<std::string> more = {}) {
        std::vector<std::string> words{"pack", std::move(grid), path("g.isotet")};
        words.insert(words.end(), more.begin(), more.end());
        const RunResult run = isotet(words);
        EXPECT_EQ(run.status, 0) << run.err;
        return path("g.isotet");
    }
};

TEST_F(PackCommand, TellsWhatWasPacked) {
    const auto report = json_of({"pack", "make:mixed:6:gyroid,sphere", path("g.isotet")});
    EXPECT_EQ(report["fields"], nlohmann::json({"gyroid", "sphere"}));
    EXPECT_EQ(report["steps"], 1);
    EXPECT_EQ(report["bytes"], content_of(path("g.isotet")).size());
    EXPECT_GT(report["other_cells"], 0);
}

TEST_F(PackCommand, GivesTheSurfaceOfTheGrid) {
    packed("make:mixed:6:gyroid,sphere", {"--source-cells", "--gradients"});
    const std::vector<std::string> rest{"-f", "gyroid", "-i", "0.1,0.2", "--method", "clusters", "--edge-ends",
                                        "--source-cells", "--normals", "gradient", "-o"};
    const auto extract = [&](const std::string& grid, const std::string& out) {
        std::vector<std::string> words{"extract", grid};
        words.insert(words.end(), rest.begin(), rest.end());
        if (grid.ends_with(".isotet")) words.erase(words.begin() + 6, words.begin() + 8); // --method
        words.push_back(path(out));
        const RunResult run = isotet(words);
        EXPECT_EQ(run.status, 0) << run.err;
        return content_of(path(out));
    };
    const std::string expected = extract("make:mixed:6:gyroid,sphere", "a.vtp");
    EXPECT_FALSE(expected.empty());
    EXPECT_TRUE(extract(path("g.isotet"), "b.vtp") == expected);
}

TEST_F(PackCommand, ReadsOnlyAPart) {
    packed("make:kuhn:40:sphere");
    const auto whole = json_of({"extract", "make:kuhn:40:sphere", "-i", "0.1", "--method", "clusters"});
    const auto report = json_of({"extract", path("g.isotet"), "-i", "0.1"});
    EXPECT_EQ(report["surfaces"][0]["area"], whole["surfaces"][0]["area"]);
    EXPECT_EQ(report["method"], "clusters");
    EXPECT_LT(report["packed_file"]["bytes_read"], report["packed_file"]["bytes"]);
    const auto limited = json_of({"extract", path("g.isotet"), "-i", "0.1", "--memory", "300kB"});
    EXPECT_EQ(limited["surfaces"][0]["area"], whole["surfaces"][0]["area"]);
    EXPECT_LE(limited["packed_file"]["bytes_in_memory"], 300'000);
    EXPECT_EQ(whole["packed_file"], nullptr);
}

TEST_F(PackCommand, UnpacksForWhatNeedsCells) {
    packed("make:kuhn:6:sphere");
    const auto solid = json_of({"extract", path("g.isotet"), "-i", "0.3", "--solid", "below"});
    EXPECT_GT(solid["surfaces"][0]["solid"]["volume"], 0);
    EXPECT_EQ(solid["packed_file"], nullptr);
    EXPECT_NE(solid["notes"].dump().find("all of the packed file is read"), std::string::npos);
    EXPECT_EQ(isotet({"extract", path("g.isotet"), "-f", "x", "-i", "0.3"}).status, 0);
    EXPECT_EQ(isotet({"slice", path("g.isotet"), "--plane", "z=0"}).status, 0);
}

TEST_F(PackCommand, IsAskedByInfoAndCheck) {
    packed();
    const auto info = json_of({"info", path("g.isotet")});
    EXPECT_EQ(info["format"], "isotet");
    EXPECT_EQ(info["fields"][1]["name"], "sphere");
    EXPECT_EQ(json_of({"check", path("g.isotet")})["sound"], true);
    EXPECT_GT(json_of({"info", path("g.isotet"), "--survey"})["boundary_faces"], 0);
    std::string broken = content_of(path("g.isotet"));
    broken[6'000] ^= 1;
    put_content(path("g.isotet"), broken);
    const RunResult run = isotet({"check", path("g.isotet")});
    EXPECT_EQ(run.status, 3);
    EXPECT_TRUE(is_one_error(run, "its checksum differs"));
}

TEST_F(PackCommand, TakesAllStepsOfASeries) {
    std::string collection = "<VTKFile type=\"Collection\"><Collection>";
    for (const char* seed : {"1", "2"}) {
        const std::string name = std::string("s") + seed + ".vtu";
        const char* field = seed == std::string("1") ? "sphere" : "gyroid";
        ASSERT_EQ(isotet({"make", "kuhn", "--side", "4", "--fields", field, "-o", path(name)}).status, 0);
        std::string content = content_of(path(name));
        for (std::size_t at; (at = content.find(field)) != std::string::npos;) content.replace(at, 6, "valuep");
        put_content(path(name), content);
        collection += "<DataSet timestep=\"" + std::string(seed) + "\" file=\"" + name + "\"/>";
    }
    put_content(path("s.pvd"), collection + "</Collection></VTKFile>");
    packed(path("s.pvd"), {"--all-steps"});
    const auto info = json_of({"info", path("g.isotet")});
    EXPECT_EQ(info["times"], nlohmann::json({1, 2}));
    const auto steps = [&](const std::string& grid) {
        return json_of({"extract", grid, "--all-steps", "-f", "valuep", "-i", "0.3", "-o", path("o-{step}.vtp"),
                        "--method", grid.ends_with(".pvd") ? "clusters" : "auto"});
    };
    const auto a = steps(path("s.pvd")), b = steps(path("g.isotet"));
    ASSERT_EQ(b["surfaces"].size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(a["surfaces"][i]["area"], b["surfaces"][i]["area"]);
    ASSERT_EQ(isotet({"pack", path("s1.vtu"), path("g.isotet"), "--append"}).status, 0);
    EXPECT_EQ(json_of({"info", path("g.isotet")})["steps"], 3);
    EXPECT_EQ(json_of({"check", path("g.isotet")})["sound"], true);
    ASSERT_EQ(isotet({"make", "kuhn", "--side", "5", "--fields", "sphere", "-o", path("s2.vtu")}).status, 0);
    const RunResult run = isotet({"pack", path("s.pvd"), path("n.isotet"), "--all-steps", "--fields", "x"});
    EXPECT_EQ(run.status, 3);
    EXPECT_TRUE(is_one_error(run, "step 1 has other cells than step 0"));
    EXPECT_EQ(content_of(path("n.isotet")), "");
}

TEST_F(PackCommand, TakesFieldsSeparatedByCommas) {
    const auto names_of = [&](const std::string& fields) {
        return json_of({"pack", "make:kuhn:3:sphere,gyroid", path("f.isotet"), "--fields", fields})["fields"];
    };
    EXPECT_EQ(names_of("gyroid,x"), (nlohmann::json{"gyroid", "x"}));
    EXPECT_EQ(names_of("max(sphere,gyroid),sphere"), (nlohmann::json{"max(sphere,gyroid)", "sphere"}));
    EXPECT_TRUE(is_one_error(isotet({"pack", "make:kuhn:3", path("f.isotet"), "--fields", "x,nothing"}), "nothing"));
}

TEST_F(PackCommand, RefusesWhatItCannot) {
    EXPECT_TRUE(is_one_error(isotet({"pack", "make:kuhn:3", path("a.vtu")}), "must end in .isotet"));
    EXPECT_TRUE(is_one_error(isotet({"pack", "make:kuhn:3", path("a.isotet"), "--fields", "nothing"}), "nothing"));
    EXPECT_TRUE(is_one_error(isotet({"pack", "make:kelvin:3", path("a.isotet"), "--source-cells"}), "--source-cells"));
}

} // namespace
} // namespace isotet::test
