// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet render` on the CPU: what figures need.
#include <filesystem>
#include <fstream>
#include <iterator>

#include <isotet/picture.hpp>

#include "cli/program.hpp"
#include "cli/small_grid.hpp"

namespace isotet::test {
namespace {

class RenderOnCpu : public Program {
protected:
    std::vector<std::string> command(const std::string& out, std::vector<std::string> more) {
        more.insert(more.begin(), {"render", "make:kuhn:8:sphere,gyroid", "-o", path(out), "--size", "160x120"});
        return more;
    }
    Picture picture(const std::string& out, std::vector<std::string> more) {
        const RunResult run = isotet(command(out, std::move(more)));
        EXPECT_EQ(run.status, 0) << run.err;
        return read_picture(path(out)).value();
    }
    std::string error(std::vector<std::string> more) {
        more.push_back("-q");
        const RunResult run = isotet(command("e.png", std::move(more)));
        EXPECT_EQ(run.status, 2) << run.err;
        return run.err;
    }
    static double unlike(const Picture& a, const Picture& b) { return difference(a, b, 2).value(); }
};

TEST_F(RenderOnCpu, LooksByAnglesAxesAndText) {
    const std::vector<std::string> base{"-i", "0.5", "-f", "sphere", "--plain"};
    const auto with = [&](const std::string& out, std::vector<std::string> more) {
        more.insert(more.begin(), base.begin(), base.end());
        return picture(out, std::move(more));
    };
    EXPECT_EQ(unlike(with("a.png", {"--view", "90,0"}), with("b.png", {"--view", "+x"})), 0);
    EXPECT_GT(unlike(with("a.png", {"--view", "30,20"}), with("b.png", {"--view", "30,60"})), 0.01);
    EXPECT_GT(unlike(with("a.png", {"--zoom", "2"}), with("b.png", {})), 0.01);
    EXPECT_GT(unlike(with("a.png", {"--fit", "surface"}), with("b.png", {})), 0.01);
    EXPECT_GT(unlike(with("a.png", {"--up", "x"}), with("b.png", {})), 0.01);
    auto words = command("c.png", base);
    words.insert(words.end(), {"--view", "20,70", "--zoom", "1.5"});
    const std::string camera = json_of(words)["camera"];
    EXPECT_EQ(unlike(with("d.png", {"--camera", camera}), read_picture(path("c.png")).value()), 0);
    EXPECT_NE(error({"--view", "30"}).find("--view got '30'"), std::string::npos);
    EXPECT_NE(error({"--camera", "here"}).find("--camera got 'here'"), std::string::npos);
    EXPECT_NE(error({"--zoom", "0"}).find("--zoom got '0'"), std::string::npos);
}

TEST_F(RenderOnCpu, StretchesAxesButNotColours) {
    auto words = command("a.png", {"-f", "z", "-i", "0.5", "--color-by", "z", "--scale", "1,1,3"});
    EXPECT_LE(json_of(words)["color_range"][1], 1.001) << "colours are those of the grid as it is";
    EXPECT_NE(error({"--scale", "1,1"}).find("--scale got '1,1'"), std::string::npos);
    EXPECT_NE(error({"--scale", "1,1,-1"}).find("--scale got"), std::string::npos);
}

TEST_F(RenderOnCpu, ShowsSlicesAndWhatIsNotClipped) {
    auto words = command("a.png", {"-f", "gyroid", "--slice", "x=0.1", "--clip", "x=0.1", "--edges"});
    const auto report = json_of(words);
    EXPECT_GT(report["slice_triangles"], 100);
    EXPECT_EQ(report["color_by"], "gyroid");
    EXPECT_TRUE(report["field"].is_null());
    EXPECT_EQ(report["surfaces"].size(), 0u);
    const std::vector<std::string> plain{"-f", "sphere", "-i", "0.8", "--plain", "--boundary", "0"};
    auto clipped = plain;
    clipped.insert(clipped.end(), {"--clip", "-y=0"});
    EXPECT_GT(unlike(picture("b.png", plain), picture("c.png", clipped)), 0.05);
    EXPECT_NE(error({"--clip", "w=1"}).find("--clip got 'w=1'"), std::string::npos);
    EXPECT_NE(error({"--slice", "0,0,0,1"}).find("--slice got"), std::string::npos);
}

TEST_F(RenderOnCpu, ColoursTheBoundaryInClassesOrByAScale) {
    put_content(path("g.msh"), small_grid({{.name = "region", .values = {7, 9}, .on_cells = true}}));
    RunResult run = isotet({"render", path("g.msh"), "-o", path("g.png"), "--size", "400x300"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("'region', numbers of regions, colours the boundary"), std::string::npos) << run.err;
    const auto report = json_of(command("a.png", {"--boundary-color-by", "gyroid"}));
    EXPECT_EQ(report["color_by"], "gyroid");
    EXPECT_TRUE(report["field"].is_null());
    EXPECT_NE(error({"--boundary-color-by", "gyroid", "--color-by", "sphere"}).find("one colour scale"),
              std::string::npos);
}

TEST_F(RenderOnCpu, DrawsAGridWithoutFields) {
    put_content(path("g.msh"), small_grid({}));
    const RunResult run = isotet({"render", path("g.msh"), "-o", path("g.png"), "--size", "160x120"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("the boundary of the grid is drawn"), std::string::npos) << run.err;
}

TEST_F(RenderOnCpu, DrawsEveryTimeStepWithOneCameraAndOneScale) {
    const std::string file = (source_folder() / "data/exodus/tension_tets_stress_3steps.e").string();
    const auto report =
        json_of({"render", file, "-f", "nodal_Cauchy_Stress_1", "--levels", "2", "--color-by", "nodal_Cauchy_Stress_1",
                 "--all-steps", "-o", path("s{frame}.png"), "--size", "300x200"});
    EXPECT_EQ(report["pictures"], 3);
    EXPECT_EQ(report["step"], 2);
    EXPECT_LT(report["color_range"][0], report["color_range"][1]);
    EXPECT_TRUE(std::filesystem::exists(path("s1.png")) && std::filesystem::exists(path("s3.png")));
    const RunResult one = isotet({"render", file, "--all-steps", "-o", path("one.png")});
    EXPECT_EQ(one.status, 2) << "three pictures need three names";
    const RunResult film = isotet({"render", file, "-f", "nodal_Cauchy_Stress_1", "--levels", "2", "--all-steps", "-o",
                                   path("s{frame}.png"), "--size", "60x40"});
    EXPECT_NE(film.err.find("ffmpeg -framerate 12 -i '"), std::string::npos) << film.err;
}

// One thread reads each step when it is wanted, several read the next one while a picture is drawn.
TEST_F(RenderOnCpu, ReadsStepsAheadWithoutADifference) {
    std::ofstream series(path("series.pvd"));
    series << "<?xml version=\"1.0\"?><VTKFile type=\"Collection\"><Collection>";
    for (const std::string step : {"1", "2", "3"}) {
        const std::string file = path("step" + step + ".vtu");
        ASSERT_EQ(isotet({"make", "perturbed", "--side", "6", "--fields", "gyroid", "--seed", step, "-o", file}).status,
                  0);
        series << "<DataSet timestep=\"" << step << "\" file=\"step" << step << ".vtu\"/>";
    }
    series << "</Collection></VTKFile>";
    series.close();
    const auto draw = [&](const std::string& threads) {
        return isotet({"render", path("series.pvd"), "-i", "0.3", "--all-steps", "-o",
                       path("t" + threads + "-{frame}.png"), "--size", "120x90", "--threads", threads});
    };
    ASSERT_EQ(draw("1").status, 0);
    ASSERT_EQ(draw("3").status, 0);
    const auto content = [&](const std::string& name) {
        std::ifstream file(path(name), std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    for (const std::string frame : {"1", "2", "3"})
        EXPECT_TRUE(content("t1-" + frame + ".png") == content("t3-" + frame + ".png"));
    EXPECT_FALSE(content("t1-1.png") == content("t1-2.png"));

    std::ofstream(path("step3.vtu")) << "broken";
    std::filesystem::remove(path("t3-1.png"));
    const RunResult broken = draw("3");
    EXPECT_EQ(broken.status, 3);
    EXPECT_NE(broken.err.find("step3.vtu"), std::string::npos) << broken.err;
    EXPECT_TRUE(std::filesystem::exists(path("t3-1.png"))) << "what came before is there";
}

TEST_F(RenderOnCpu, ShadesByTheNormalsThatAreAskedFor) {
    const auto shaded = [&](const char* normals) {
        return picture(std::string(normals) + ".png",
                       {"-f", "gyroid", "-i", "0.3", "--plain", "--boundary", "0", "--normals", normals});
    };
    const Picture vertex = shaded("vertex"), gradient = shaded("gradient"), face = shaded("face");
    EXPECT_GT(unlike(vertex, face), 0.1);
    EXPECT_GT(unlike(vertex, gradient), 0.01);
}

TEST_F(RenderOnCpu, DrawsAVolumeWithWhatIsInIt) {
    const std::vector<std::string> base{"-f", "gyroid", "--plain", "--volume"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), base.begin(), base.end());
        return more;
    };
    const Picture ramp = picture("r.png", with({}));
    EXPECT_EQ(unlike(picture("a.png", with({"--opacity", "ramp", "--threads", "1"})), ramp), 0);
    for (const char* opacity : {"peaks", "peaks:1", "shell", "-1:0,0:0.5,1:0"})
        EXPECT_GT(unlike(picture("b.png", with({std::string("--opacity=") + opacity})), ramp), 0.01) << opacity;
    EXPECT_GT(unlike(picture("b.png", with({"--opacity-length", "9"})), ramp), 0.01);
    const auto curve = [&](std::vector<std::string> more) {
        auto words = command("b.png", with(std::move(more)));
        return json_of(words)["volume"]["opacity"];
    };
    EXPECT_EQ(curve({"--opacity", "peaks", "--levels", "2"}), curve({"--opacity", "peaks:2"}));
    EXPECT_GT(unlike(picture("b.png", with({"-i", "0.5", "--opacity", "0.9"})), ramp), 0.01) << "a surface inside";
    EXPECT_GT(unlike(picture("b.png", with({"--clip", "x=0"})), ramp), 0.01);
    EXPECT_GT(unlike(picture("b.png", with({"--volume-shading"})), ramp), 0.01);
    EXPECT_GT(unlike(picture("b.png", with({"--log", "--range", "0.1,1"})), ramp), 0.01);
    auto words = command("c.png", with({"--dirac", "0.2,0.5"}));
    const auto report = json_of(words)["volume"];
    EXPECT_EQ(report["isovalues"].size(), 2u);
    EXPECT_EQ(report["opacity"].size(), 0u) << "the surfaces alone";
    for (const char* number : {"clusters", "tets", "segments", "bytes", "opacity_length"})
        EXPECT_GT(report[number], 0) << number;
    EXPECT_NE(isotet(command("n.png", with({"--opacity", "5:0,6:1,7:0"}))).err.find("nothing of the volume is seen"),
              std::string::npos);
    EXPECT_EQ(isotet(command("n.png", with({"--dirac", "0.2"}))).err.find("is seen"), std::string::npos);
    const RunResult film = isotet({"render", "make:kuhn:6:gyroid", "--volume", "--sweep=-0.5,0.5,3", "-o",
                                   path("v{frame}.png"), "--size", "60x40"});
    EXPECT_EQ(film.status, 0) << film.err;
    EXPECT_GT(unlike(read_picture(path("v1.png")).value(), read_picture(path("v3.png")).value()), 0.01);
}

TEST_F(RenderOnCpu, TakesColoursAndOpacityFromFiles) {
    put_content(path("map.json"), R"([{"Name": "one", "ColorSpace": "RGB", "NanColor": [1, 0, 0],
        "RGBPoints": [0, 0, 0, 1, 5, 1, 1, 0], "Points": [-1, 0, 0.5, 0, 0, 0.5, 0.5, 0, 1, 0, 0.5, 0]}])");
    put_content(path("points.txt"), "# of the gyroid\n-1:0\n0:0.5\n1:0\n");
    const std::vector<std::string> base{"-f", "gyroid", "--volume"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), base.begin(), base.end());
        return more;
    };
    const Picture expected = picture("a.png", with({"--opacity=-1:0,0:0.5,1:0"}));
    for (const char* file : {"map.json", "points.txt", "map.json:one"})
        EXPECT_EQ(unlike(picture("b.png", with({"--opacity", "@" + path(file)})), expected), 0) << file;
    EXPECT_GT(
        unlike(picture("b.png", with({"--opacity=-1:0,0:0.5,1:0", "--colormap", "@" + path("map.json")})), expected),
        0.02);
    EXPECT_GT(unlike(picture("b.png", {"-f", "gyroid", "--levels", "2", "--colormap", "@" + path("map.json")}),
                     picture("c.png", {"-f", "gyroid", "--levels", "2"})),
              0.02)
        << "isosurfaces have its colours, too";
    put_content(path("none.json"), R"({"Name": "n", "RGBPoints": [0, 0, 0, 1, 5, 1, 1, 0]})");
    const auto refused = [&](std::vector<std::string> more) {
        const RunResult run = isotet(command("e.png", with(std::move(more))));
        return std::to_string(run.status) + run.err;
    };
    EXPECT_NE(refused({"--opacity", "@" + path("none.json")}).find("no Points of opacity"), std::string::npos);
    EXPECT_NE(refused({"--opacity", "@" + path("map.json:two")}).find("no colour map 'two', but 'one'"),
              std::string::npos);
    EXPECT_NE(refused({"--colormap", "@" + path("points.txt")}).find("is not JSON"), std::string::npos);
    EXPECT_NE(refused({"--colormap", "@" + path("gone.json")}).find("cannot be read"), std::string::npos);
    EXPECT_EQ(refused({"--colormap", "@" + path("gone.json")})[0], '3');
    EXPECT_NE(refused({"--opacity", "@" + path("")}).find("cannot be read"), std::string::npos) << "a folder";
    EXPECT_NE(refused({"--colormap", "jet"}).find("--colormap got 'jet'"), std::string::npos);
    const RunResult over = isotet(
        {"render", "make:kuhn:4:gyroid", "--volume", "--colormap", "@" + path("map.json"), "-o", path("map.json")});
    EXPECT_NE(over.status, 0) << "what is read is not written over";
}

TEST_F(RenderOnCpu, RefusesWhatDoesNotGoWithAVolume) {
    const auto says = [&](std::vector<std::string> more, const char* text) {
        more.insert(more.begin(), {"-f", "gyroid"});
        const std::string told = error(std::move(more));
        EXPECT_NE(told.find(text), std::string::npos) << told;
    };
    says({"--opacity", "ramp"}, "that of a volume: --volume");
    says({"--opacity-length", "1"}, "that of a volume: --volume");
    says({"--volume-shading"}, "that of a volume: --volume");
    says({"--volume", "--opacity-length", "0"}, "a number above 0");
    says({"--volume", "--opacity", "0:0,1:3"}, "point 2 of the opacity has 3");
    says({"--volume", "--opacity", "2"}, "a number from 0 to 1");
    says({"--volume", "--method", "direct"}, "needs the grid in clusters");
    says({"--volume", "--method", "textures"}, "draws tets");
    says({"--volume", "--color-by", "sphere"}, "one colour scale");
    says({"--volume", "--sweep", "0,1,2", "--opacity", "0:1"}, "moves a peak");
    const RunResult surface =
        isotet({"render", "make:kuhn:4:gyroid", "-i", "0", "-o", path("s.png"), "--device", "none", "-q"});
    EXPECT_EQ(surface.status, 0) << surface.err;
}

} // namespace
} // namespace isotet::test
