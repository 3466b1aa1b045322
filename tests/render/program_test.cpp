// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet render`: pictures of grids and of surfaces, and what it says when there is nothing to draw, or nobody to draw
// it.
#include <filesystem>
#include <fstream>
#include <iterator>

#include <isotet/picture.hpp>

#include "cli/program.hpp"
#include "cli/small_grid.hpp"
#include "vulkan/software_device.hpp"

namespace isotet::test {
namespace {

class Render : public Program {
protected:
    static std::string content(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::vector<std::string> command(const std::string& input, const std::string& out,
                                     std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"render", input, "-o", path(out), "--size", "80x60", "--device", test_device()});
        return more;
    }
};

TEST_F(Render, DrawsTheSamePictureEveryTime) {
    const std::vector<std::string> nothing_else{"--plain", "--boundary", "0", "--opacity", "1"};
    const auto report = json_of(command("make:kuhn:8:sphere,gyroid", "a.png", nothing_else));
    EXPECT_EQ(report["field"], "sphere");
    EXPECT_EQ(report["surfaces"].size(), 3u);
    EXPECT_EQ(report["width"], 80);
    EXPECT_EQ(report["drawing"]["bytes_down"], 80 * 60 * 4) << "nothing but the picture comes back";
    ASSERT_EQ(isotet(command("make:kuhn:8:sphere,gyroid", "b.png", nothing_else)).status, 0);
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

TEST_F(Render, StretchesHeightsOfFlatReservoirs) {
    put_content(path("flat.grdecl"), R"(SPECGRID
 2 1 1 1 F /
COORD
 0 0 100 0 0 200  1000 0 100 1000 0 200  2000 0 100 2000 0 200
 0 1000 100 0 1000 200  1000 1000 100 1000 1000 200  2000 1000 100 2000 1000 200 /
ZCORN
 8*100 8*110 /
PORO
 0.1 0.2 /
)");
    const auto draw = [&](const std::string& out, const std::vector<std::string>& more) {
        std::vector<std::string> words = command(path("flat.grdecl"), out, more);
        words.insert(words.end(), {"--boundary-color-by", "PORO"});
        return isotet(words).err;
    };
    EXPECT_NE(draw("a.png", {}).find("heights are drawn 50 times as large; --scale 1,1,1 draws them as they are"),
              std::string::npos);
    EXPECT_EQ(draw("b.png", {"--scale", "1,1,50"}).find("heights are drawn"), std::string::npos);
    EXPECT_EQ(draw("c.png", {"--scale", "1,1,1"}).find("heights are drawn"), std::string::npos);
    EXPECT_TRUE(content(path("a.png")) == content(path("b.png")));
    EXPECT_FALSE(content(path("a.png")) == content(path("c.png")));
}

TEST_F(Render, ColoursAndSaysWhatTheColoursMean) {
    auto words = command("make:kuhn:8:sphere,gyroid", "a.png",
                         {"-f", "sphere", "-i", "0.5", "--color-by", "gyroid", "--colormap", "cool-warm"});
    auto report = json_of(words);
    EXPECT_EQ(report["color_by"], "gyroid");
    EXPECT_LE(report["color_range"][0], -1);
    EXPECT_EQ(report["boundary_faces"], 6 * 8 * 8 * 2);
    words.insert(words.end(), {"--range", "-0.5,0.5"});
    report = json_of(words);
    EXPECT_EQ(report["color_range"][1], 0.5);
    words.insert(words.end(), {"--log", "-q"});
    const RunResult run = isotet(words);
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(
        run, "the range of colours begins with -0.5, but a logarithmic scale takes positive numbers only"));
}

TEST_F(Render, SaysWhatItCannotShow) {
    put_content(path("g.msh"), small_grid({{.name = "f", .values = {1, 0, 0, 0, 0}},
                                           {.name = "signed", .values = {-1, 0, 1, 2, 3}},
                                           {.name = "same", .values = {3, 3, 3, 3, 3}},
                                           {.name = "速度", .values = {1, 0, 0, 0, 0}}}));
    const auto notes = [&](std::vector<std::string> more) {
        const RunResult run = isotet(command(path("g.msh"), "a.png", std::move(more)));
        EXPECT_EQ(run.status, 0) << run.err;
        return run.err;
    };
    EXPECT_NE(notes({"-f", "f", "-i", "0.5", "--color-by", "signed", "--log"})
                  .find("'signed' has values that are not positive: on the logarithmic scale they have the colour of "
                        "its lower end"),
              std::string::npos);
    EXPECT_EQ(notes({"-f", "f", "-i", "0.5", "--color-by", "signed"}).find("not positive"), std::string::npos);
    EXPECT_NE(notes({"-f", "same", "-i", "3"}).find("there is no surface at 3: all values of 'same' are 3"),
              std::string::npos);
    const auto large = [&](const char* field) {
        return isotet({"render", path("g.msh"), "-o", path("a.png"), "--size", "400x300", "--device", test_device(),
                       "-f", field, "-i", "0.5"})
            .err;
    };
    EXPECT_EQ(large("f").find("the font"), std::string::npos);
    EXPECT_NE(large("速度").find("the font of isotet lacks letters of 'g.msh"), std::string::npos);
}

TEST_F(Render, ExtractsOnEitherEngineTheSamePicture) {
    const std::vector<std::string> more{"-f", "gyroid", "-i", "0.2", "--color-by", "sphere"};
    auto on_cpu = command("make:kuhn:8:sphere,gyroid", "cpu.png", more),
         on_device = command("make:kuhn:8:sphere,gyroid", "device.png", more);
    on_device.insert(on_device.end(), {"--engine", "vulkan"});
    const auto direct = json_of(on_cpu);
    EXPECT_EQ(direct["engine"], "cpu");
    EXPECT_EQ(direct["method"], "direct") << "one surface is not worth packing";
    EXPECT_EQ(direct["seconds"]["pack"], 0);
    const auto report = json_of(on_device);
    EXPECT_EQ(report["engine"], "vulkan");
    EXPECT_LT(report["extracting"]["bytes_down"], 1000) << "the surface stays where it is";
    EXPECT_GT(content(path("device.png")).size(), 1000u);
}

TEST_F(Render, PacksForManySurfacesOnlyAndDrawsTheSamePicture) {
    const auto method = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"--plain"});
        return json_of(command("make:kuhn:8:sphere,gyroid", "{frame}.png", std::move(more)))["method"];
    };
    EXPECT_EQ(method({"-f", "gyroid", "--normals", "gradient", "--sweep", "-0.5,0.5,3"}), "direct");
    EXPECT_EQ(method({"-f", "gyroid", "--normals", "gradient", "--sweep", "-0.5,0.5,4"}), "clusters");
    const std::vector<std::string> more{"-f", "gyroid", "-i", "0.2", "--color-by", "sphere"};
    ASSERT_EQ(isotet(command("make:kuhn:8:sphere,gyroid", "direct.png", more)).status, 0);
    auto clusters = command("make:kuhn:8:sphere,gyroid", "clusters.png", more);
    clusters.insert(clusters.end(), {"--method", "clusters", "--reference", path("direct.png")});
    const auto report = json_of(clusters);
    EXPECT_EQ(report["method"], "clusters");
    EXPECT_GT(report["seconds"]["pack"], 0);
}

TEST_F(Render, TakesThePictureAsASecondName) {
    EXPECT_EQ(isotet({"render", "make:kuhn:4:sphere", path("a.png"), "-i", "0.5", "--size", "64x48", "--device",
                      test_device()})
                  .status,
              0);
    EXPECT_TRUE(std::filesystem::exists(path("a.png")));
    const RunResult wrong =
        isotet({"render", "make:kuhn:4:sphere", path("a-{frme}.png"), "-i", "0.5", "--device", test_device()});
    EXPECT_EQ(wrong.status, 2);
    EXPECT_TRUE(is_one_error(wrong, "has {frme}, but here only {frame} can stand for something"));
}

TEST_F(Render, DrawsTheSamePictureByEveryMethod) {
    const std::vector<std::string> more{"-i", "0.5", "--plain", "--boundary", "0"};
    ASSERT_EQ(isotet(command("make:kuhn:8:sphere", "clusters.png", more)).status, 0);
    for (const std::string method : {"registers", "registers_instanced", "textures", "mesh"}) {
        for (const std::string index : {"none", "span_space"}) {
            auto words = command("make:kuhn:8:sphere", method + ".png", more);
            words.insert(words.end(), {"--method", method, "--index", index, "--reference", path("clusters.png")});
            if (method.starts_with("registers")) words.insert(words.end(), {"--threshold", "0.5"}); // shaded by faces
            const auto report = json_of(words);
            EXPECT_EQ(report["method"], method);
            EXPECT_EQ(report["index"], index);
            EXPECT_EQ(report["engine"], "none");
            EXPECT_TRUE(report["surfaces"][0]["triangles"].is_null());
            const std::uint64_t tets = report["surfaces"][0]["tets"], sent = report["surfaces"][0]["bytes_sent"];
            EXPECT_EQ(sent, index == "none" ? 0 : 4 * tets);
            EXPECT_EQ(tets == 3072, index == "none") << tets;
            const std::uint64_t record = method == "registers" ? 272 : method == "registers_instanced" ? 64 : 16;
            const std::uint64_t tables = method == "textures" || method == "mesh" ? 2 * 16 * 9 * 9 * 9 + 176 : 0;
            const std::uint64_t ranges = method == "mesh" ? 3072 / 32 * 8 : 0;
            EXPECT_EQ(report["store"]["bytes"], 3072 * record + tables + ranges);
            EXPECT_EQ(report["store"]["sent_every_time"], 0);
        }
    }
}

TEST_F(Render, RefusesWhatMethodsThatDrawTetsCannotDo) {
    const auto error = [&](std::vector<std::string> more) {
        more.push_back("-q");
        const RunResult run = isotet(command("make:kuhn:4:sphere,gyroid", "a.png", std::move(more)));
        EXPECT_EQ(run.status, 2);
        return run.err;
    };
    EXPECT_NE(error({"--method", "textures", "--color-by", "gyroid"}).find("but --method textures makes none"),
              std::string::npos);
    EXPECT_NE(error({"--method", "registers", "--engine", "cpu"}).find("but --method registers extracts nothing"),
              std::string::npos);
    EXPECT_NE(error({"--index", "octree"}).find("but surfaces are drawn"), std::string::npos);
    EXPECT_NE(error({"--method", "points"}).find("--method got 'points'"), std::string::npos);
}

TEST_F(Render, ComparesWithAReference) {
    ASSERT_EQ(isotet(command("make:kuhn:8:sphere", "a.png", {"-i", "0.5"})).status, 0);
    const auto again = [&](const char* isovalue, const char* threshold) {
        return isotet(command("make:kuhn:8:sphere", "b.png",
                              {"-i", isovalue, "--reference", path("a.png"), "--threshold", threshold}));
    };
    EXPECT_EQ(again("0.5", "0").status, 0);
    const RunResult other = again("0.7", "0.001");
    EXPECT_EQ(other.status, 1);
    EXPECT_NE(other.err.find("% of the pixels differ from "), std::string::npos) << other.err;
    EXPECT_EQ(again("0.7", "1").status, 0);
    const RunResult missing =
        isotet({"render", "make:kuhn:8:sphere", "-o", path("b.png"), "--reference", path("none.png")});
    EXPECT_EQ(missing.status, 3);
}

TEST_F(Render, WritesTextWhereThereIsRoom) {
    const auto words = [&](const char* out, const char* size) {
        return std::vector<std::string>{"render", "make:kuhn:8:sphere", "-o",         path(out), "--size",
                                        size,     "--device",           test_device()};
    };
    RunResult run = isotet(words("a.png", "400x300"));
    EXPECT_EQ(run.err.find("too small for text"), std::string::npos) << run.err;
    run = isotet(words("b.png", "40x30"));
    EXPECT_NE(run.err.find("the picture, 40 x 30, is too small for text"), std::string::npos) << run.err;
}

TEST_F(Render, SaysThatASoftwareDeviceDraws) {
    const RunResult run = isotet(command("make:kuhn:4:sphere", "a.png", {"-i", "0.5"}));
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.err.find("note: a software device draws: "), std::string::npos) << run.err;
}

TEST_F(Render, SaysWhenThereIsNoSurface) {
    const RunResult run = isotet(command("make:kuhn:4:sphere", "a.png", {"-i", "99", "--allow-empty"}));
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.err.find("there is no surface at 99: the values of 'sphere' go from"), std::string::npos) << run.err;
}

TEST_F(Render, IsWhatBenchMeasuresWithEveryMethodAndIndex) {
    const auto report = json_of({"bench", "make:kuhn:6:sphere", "-i", "0.6", "--device", test_device(), "--rounds", "1",
                                 "--indexes", "none,interval_tree,octree,seed_set,span_space,cluster_ranges"});
    EXPECT_EQ(report["device"]["kind"], "software");
    ASSERT_EQ(report["rows"].size(), 3 + 4 * 6u);
    const std::uint64_t tets = 6 * 6 * 6 * 6;
    for (const auto& row : report["rows"]) {
        EXPECT_TRUE(row["missing"].is_null()) << row;
        EXPECT_GT(row["seconds"]["draw"], 0);
        if (row["index"].is_null()) {
            EXPECT_GT(row["triangles"], 0) << row;
        } else if (row["index"] == "none") {
            EXPECT_EQ(row["tets_looked_at"], tets);
            EXPECT_EQ(row["bytes"]["sent"], 0);
        } else {
            EXPECT_LT(row["tets_looked_at"], tets) << row;
            EXPECT_EQ(row["bytes"]["sent"], 4 * row["tets_looked_at"].get<std::uint64_t>());
        }
    }
}

TEST_F(Render, OfWhatDoesNotFitCrossesTheBusWhenBenchMeasuresIt) {
    const auto crossing = [](const char* memory) {
        return json_of({"bench", "make:kuhn:30:sphere", "-i", "0.6", "--device", test_device(), "--device-memory",
                        memory, "--rounds", "1", "--methods", "registers", "--indexes", "none"})["rows"][0];
    };
    const auto all = crossing("1GB"), some = crossing("32MB");
    EXPECT_EQ(all["bytes"]["crossing"], 0);
    EXPECT_GT(some["bytes"]["crossing"], 0) << some;
    EXPECT_EQ(all["bytes"]["device"],
              some["bytes"]["device"].get<std::uint64_t>() + some["bytes"]["crossing"].get<std::uint64_t>());
}

TEST_F(Render, IsNothingThatBenchCouldMeasureWithoutMemory) {
    const RunResult run =
        isotet({"bench", "make:kuhn:4:sphere", "--device", test_device(), "--device-memory", "1kB", "--rounds", "1"});
    EXPECT_EQ(run.status, 4);
    EXPECT_NE(run.err.find("nothing could be measured: "), std::string::npos) << run.err;
    EXPECT_NE(run.out.find("not measured: direct on make:kuhn:4:sphere: "), std::string::npos) << run.out;
}

TEST_F(Render, RefusesIsovaluesThatAreAllOutsideTheRange) {
    EXPECT_EQ(isotet(command("make:kuhn:4:sphere", "a.png", {"-i", "0.5,7"})).status, 0) << "one is inside";
    RunResult outside =
        isotet({"render", "make:kuhn:4:sphere", path("b.png"), "-f", "sphere", "-i", "-1,7", "--size", "80x60"});
    EXPECT_EQ(outside.status, 3);
    EXPECT_TRUE(is_one_error(outside, "isovalue -1 is outside the range of 'sphere'"));
    EXPECT_FALSE(std::filesystem::exists(path("b.png")));
    outside = isotet({"render", "make:kuhn:4:sphere", path("b.png"), "-f", "sphere", "-i", "-1,7", "--size", "80x60",
                      "--allow-empty"});
    EXPECT_EQ(outside.status, 0) << outside.err;
}

TEST_F(Render, RefusesWhatCannotBe) {
    RunResult run = isotet({"render", "make:kuhn:4:sphere", "--device", "none", "--engine", "vulkan"});
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

TEST_F(Render, NeedsADriverOnlyForADevice) {
    RunOptions without;
    without.environment = {{"VK_DRIVER_FILES", "/nonexistent"}, {"VK_ICD_FILENAMES", "/nonexistent"}};
    std::vector<std::string> words{"render", "make:kuhn:4:sphere", "-i", "0.5", "-o", path("a.png")};
    const RunResult drawn = isotet(words, without);
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    words.insert(words.end(), {"--engine", "vulkan"});
    const RunResult run = isotet(words, without);
    EXPECT_EQ(run.status, 4);
    EXPECT_TRUE(is_one_error(run, "nothing can be drawn: "));
}

TEST_F(Render, DrawsOnTheCpuWhatADeviceDraws) {
    const auto drawn = [&](const char* out, std::vector<std::string> more) {
        more.insert(more.begin(), {"render", "make:kuhn:12:sphere,gyroid", "-o", path(out), "-f", "gyroid", "-i",
                                   "0.2,-0.3", "--color-by", "sphere", "--outline", "--size", "400x300"});
        return more;
    };
    ASSERT_EQ(isotet(drawn("device.png", {"--device", test_device()})).status, 0);
    std::vector<std::string> words = drawn("cpu.png", {"--occlusion", "0"}); // which devices do not draw
    EXPECT_TRUE(json_of(words)["device"].is_null());
    const Picture cpu = read_picture(path("cpu.png")).value(), device = read_picture(path("device.png")).value();
    EXPECT_LE(difference(cpu, device, 1).value(), 0.001);
    const std::string bytes = content(path("cpu.png"));
    words.insert(words.end(), {"--threads", "1"});
    ASSERT_EQ(isotet(words).status, 0);
    EXPECT_TRUE(content(path("cpu.png")) == bytes) << "on any number of threads";
    const RunResult run = isotet(drawn("device.png", {"--device", test_device(), "--occlusion", "0.5"}));
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "--occlusion and a device, but only the CPU darkens folds"));
}

TEST_F(Render, FollowsRaysThroughVolumesOnADevice) {
    for (const std::vector<std::string>& what :
         {std::vector<std::string>{"--opacity", "peaks:2", "-i", "0.2"}, {"--dirac", "0.2,-0.3", "--clip", "x=0.1"}}) {
        const auto drawn = [&](const char* out) {
            std::vector<std::string> words{"render", "make:mixed:6:gyroid", "-o", path(out), "--volume", "--size",
                                           "90x70"};
            words.insert(words.end(), what.begin(), what.end());
            return words;
        };
        ASSERT_EQ(isotet(drawn("cpu.png")).status, 0);
        std::vector<std::string> words = drawn("device.png");
        words.insert(words.end(), {"--device", test_device()});
        const auto report = json_of(words);
        EXPECT_EQ(report["device"]["kind"], "software");
        EXPECT_GT(report["volume"]["segments"], 0);
        EXPECT_GT(report["drawing"]["bytes_up"], 0);
        EXPECT_TRUE(content(path("device.png")) == content(path("cpu.png")));
        words.insert(words.end(), {"--device-memory", "1MB"});
        const RunResult short_of_memory = isotet(words);
        EXPECT_EQ(short_of_memory.status, 0);
        EXPECT_NE(short_of_memory.err.find("the CPU draws the volume: "), std::string::npos) << short_of_memory.err;
        EXPECT_TRUE(content(path("device.png")) == content(path("cpu.png")));
    }
}

TEST_F(Render, SweepsThroughIsovaluesIntoNumberedFiles) {
    auto report = json_of(command("make:kuhn:6:sphere", "s{frame}.png", {"--sweep", "0.2,0.8,11", "--plain"}));
    EXPECT_EQ(report["pictures"], 11);
    EXPECT_EQ(report["surfaces"][0]["isovalue"], 0.8);
    EXPECT_FALSE(std::filesystem::exists(path("s0.png")) || std::filesystem::exists(path("s1.png")));
    EXPECT_NE(content(path("s01.png")), content(path("s11.png")));
    // Each is the picture that its isovalue gives alone.
    report = json_of(command("make:kuhn:6:sphere", "t{frame}.png", {"--sweep", "0.4,0.6,3", "--plain"}));
    EXPECT_TRUE(content(path("s06.png")) == content(path("t2.png"))) << "in the middle of the range: of one colour";
    EXPECT_EQ(report["pictures"], 3);
}

TEST_F(Render, OrbitsIntoOneAnimatedFile) {
    const auto report = json_of(command("make:kuhn:6:gyroid", "o.webp", {"--orbit", "4", "-i", "0.1", "--fps", "2"}));
    EXPECT_EQ(report["pictures"], 4);
    const std::string file = content(path("o.webp"));
    EXPECT_EQ(report["bytes"], file.size());
    EXPECT_EQ(file.substr(8, 4), "WEBP");
    std::size_t frames = 0;
    for (std::size_t at = file.find("ANMF"); at != std::string::npos; at = file.find("ANMF", at + 1)) ++frames;
    EXPECT_EQ(frames, 4u);
}

TEST_F(Render, RefusesFramesThatFitNoFile) {
    const auto error = [&](const std::string& out, std::vector<std::string> more) {
        more.push_back("-q");
        const RunResult run = isotet(command("make:kuhn:4:sphere", out, std::move(more)));
        EXPECT_EQ(run.status, 2);
        return run.err;
    };
    EXPECT_NE(
        error("a.png", {"--orbit", "4"}).find("but 4 pictures need one that ends in .webp, or that holds {frame}"),
        std::string::npos);
    EXPECT_NE(error("a{frame}.webp", {"--orbit", "4"}).find("4 pictures need"), std::string::npos);
    EXPECT_NE(error("a{frame}.png", {}).find("but there is one picture: only those of --sweep, --orbit or --all-steps"),
              std::string::npos);
    EXPECT_NE(error("a.webp", {}).find("it must end in .png"), std::string::npos);
    EXPECT_NE(error("a.webp", {"--sweep", "0,1"}).find("--sweep takes three numbers, not 2"), std::string::npos);
    EXPECT_NE(error("a.webp", {"--sweep", "0,1,1.5"}).find("--sweep ends with 1.5"), std::string::npos);
    EXPECT_NE(error("a.webp", {"--sweep", "0,1,5", "-i", "1"}).find("--sweep"), std::string::npos);
}

} // namespace
} // namespace isotet::test
