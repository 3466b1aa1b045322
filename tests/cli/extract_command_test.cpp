// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet extract`: files, names, numbers.
#include <filesystem>
#include <limits>

#include <fmt/format.h>

#include <isotet/read.hpp>

#include "program.hpp"
#include "small_grid.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

using nlohmann::json;

SurfaceFile read_back(const std::string& path) {
    Result<SurfaceFile> file = read_surface(path);
    if (!file) {
        ADD_FAILURE() << file.error().message;
        return {};
    }
    return *std::move(file);
}

const Array* field(const std::vector<Field>& fields, std::string_view name) {
    for (const Field& candidate : fields) {
        if (candidate.name == name) return &candidate.values;
    }
    return nullptr;
}

TEST_F(Program, ShortOptionsMayHaveAnEqualsSign) {
    for (const std::vector<std::string>& isovalue :
         {std::vector<std::string>{"-i=-0.3"}, {"-i-0.3"}, {"-i", "-0.3"}, {"--isovalue=-0.3"}}) {
        std::vector<std::string> words{"extract", "make:kuhn:6:gyroid", "-f=gyroid"};
        words.insert(words.end(), isovalue.begin(), isovalue.end());
        EXPECT_EQ(json_of(words)["surfaces"][0]["isovalue"], -0.3) << isovalue.front();
    }
}

TEST_F(Program, ExtractHasEveryPromisedKey) {
    const json report = json_of({"extract", "make:kuhn:6:sphere", path("s.vtp"), "-i", "0.5"});
    for (const char* key : {"schema", "points", "tets", "cells_left_out", "field", "engine", "method", "method_why",
                            "predicted", "measured", "threads", "seconds", "bytes", "surfaces"}) {
        EXPECT_TRUE(report.contains(key)) << key;
    }
    for (const char* key : {"read", "pack"}) EXPECT_TRUE(report["seconds"][key].is_number()) << key;
    for (const char* key : {"packed", "sources", "normals", "transient_peak"})
        EXPECT_TRUE(report["bytes"][key].is_number_unsigned()) << key;
    ASSERT_EQ(report["surfaces"].size(), 1u);
    const json& surface = report["surfaces"][0];
    for (const char* key :
         {"isovalue", "time", "tied_points", "false_ties", "vertices", "triangles", "area", "seconds", "file"}) {
        EXPECT_TRUE(surface.contains(key)) << key;
    }
    for (const char* key : {"extract", "write"}) EXPECT_TRUE(surface["seconds"][key].is_number()) << key;
    EXPECT_EQ(report["cells"], 1296);
    EXPECT_EQ(report["field"], "sphere");
    EXPECT_EQ(surface["file"], path("s.vtp"));
}

TEST_F(Program, ExtractTakesEachFileByItselfWhereItsNameIsInTheOutput) {
    put_content(path("pump.msh"), small_grid({{"p", {0, 1, 1, 1, 2}}}));
    put_content(path("valve.msh"), small_grid({{"p", {0, 3, 3, 3, 6}}}));
    put_content(path("other.msh"), small_grid({{"q", {0, 3, 3, 3, 6}}}));
    const std::vector<std::string> words{
        "extract", path("pump.msh"),  path("other.msh"), path("valve.msh"), "-f", "p", "-i", "0.5",
        "-o",      path("{name}.vtp")};
    const json report = json_of(words, 2);
    ASSERT_EQ(report["files"].size(), 3u);
    EXPECT_NE(report["files"][0]["error"].get<std::string>().find("there is no field 'p'"), std::string::npos);
    for (const char* name : {"pump", "valve"}) {
        const std::string alone = path(std::string(name) + "_alone.vtp");
        ASSERT_EQ(isotet({"extract", path(std::string(name) + ".msh"), alone, "-f", "p", "-i", "0.5"}).status, 0);
        EXPECT_EQ(content_of(path(std::string(name) + ".vtp")), content_of(alone)) << name;
    }
    std::filesystem::create_directory(path("old"));
    put_content(path("old/pump.msh"), content_of(path("pump.msh")));
    const RunResult twice = isotet({"extract", path("pump.msh"), path("old/pump.msh"), "-o", path("{name}.stl")});
    EXPECT_EQ(twice.status, 2);
    EXPECT_TRUE(is_one_error(twice, "have the same name, 'pump'"));
    const std::string before = content_of(path("valve.msh"));
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"--json", path("valve.msh")}, {"--parts", path("parts.csv")}}) {
        std::vector<std::string> wrong = words;
        wrong.insert(wrong.end(), more.begin(), more.end());
        EXPECT_EQ(isotet(wrong).status, 2) << more.front();
    }
    EXPECT_EQ(isotet({"info", path("pump.msh"), path("valve.msh"), "--json", path("valve.msh")}).status, 2);
    EXPECT_EQ(content_of(path("valve.msh")), before);
}

TEST_F(Program, ExtractGivesTheSameSurfaceByEveryMethod) {
    const auto extracted = [&](const std::string& method, const std::string& out) {
        return json_of({"extract", "make:mixed:6:integer", path(out), "-i", "2", "-i", "2.5", "--method", method,
                        "--normals", "gradient"});
    };
    const json clusters = extracted("clusters", "c.vtp"), direct = extracted("direct", "d.vtp");
    for (const char* key : {"vertices", "triangles", "tied_points", "false_ties"})
        for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(clusters["surfaces"][i][key], direct["surfaces"][i][key]) << key;
    EXPECT_EQ(clusters["range"], direct["range"]);
    EXPECT_EQ(read_back(path("d.vtp")).surface.triangle_count(), read_back(path("c.vtp")).surface.triangle_count());
    EXPECT_EQ(clusters["method"], "clusters");
    EXPECT_EQ(clusters["points"], 451);
    EXPECT_TRUE(clusters["tets"].is_number_unsigned());
    EXPECT_GT(clusters["bytes"]["packed"], 0);
    EXPECT_EQ(direct["method"], "direct");
    EXPECT_TRUE(direct["points"].is_null());
    EXPECT_EQ(direct["bytes"]["packed"], 0);
    for (const json& report : {clusters, direct}) EXPECT_EQ(report["method_why"], "asked for");
}

TEST_F(Program, ExtractChoosesTheMethodByTheNumberOfSurfacesAlone) {
    const auto method = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"extract", "make:kuhn:4:sphere"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return json_of(arguments)["method"].get<std::string>();
    };
    EXPECT_EQ(method({}), "direct");
    EXPECT_EQ(method({"--levels", "31"}), "direct");
    EXPECT_EQ(method({"--levels", "32"}), "clusters");
    EXPECT_EQ(method({"--levels", "32", "--engine", "reference"}), "clusters");
    EXPECT_EQ(method({"--levels", "3", "--normals", "gradient"}), "direct");
    EXPECT_EQ(method({"--levels", "4", "--normals", "gradient"}), "clusters");
    const RunResult run = isotet({"extract", "make:kuhn:4:sphere", "-i", "0.5", "-v"});
    EXPECT_NE(run.out.find("direct (1 surface)"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find(" predicted, took "), std::string::npos) << run.out;
}

TEST_F(Program, ExtractPredictsTimeAndMemory) {
    for (const char* method : {"direct", "clusters"}) {
        const json report = json_of({"extract", "make:hex:6:sphere", "-i", "0.5", "--method", method});
        EXPECT_EQ(report["method_why"], "asked for");
        EXPECT_GT(report["predicted"]["seconds"], 0);
        EXPECT_GT(report["measured"]["seconds"], 0);
    }
    const json reference = json_of({"extract", "make:hex:6:sphere", "-i", "0.5", "--engine", "reference"});
    EXPECT_TRUE(reference["predicted"].is_null());
}

TEST_F(Program, ExtractTakesIsovaluesByTheirShare) {
    const json report = json_of({"extract", "make:kuhn:8:gyroid", "-i", "p95,0.1,50%v", "--volumes"});
    ASSERT_EQ(report["surfaces"].size(), 3u);
    EXPECT_EQ(report["surfaces"][0]["isovalue"], 0.1);
    EXPECT_NEAR(report["surfaces"][2]["volume_below"].get<double>(), 4, 1e-6);
    EXPECT_NEAR(report["surfaces"][2]["volume_above"].get<double>(), 4, 1e-6);
    put_content(path("shares.txt"), "p95 # the highest\n0.1 50%v\n");
    const json listed = json_of({"extract", "make:kuhn:8:gyroid", "-i", "@" + path("shares.txt")});
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(listed["surfaces"][i]["isovalue"], report["surfaces"][i]["isovalue"]);
    EXPECT_FALSE(listed["surfaces"][0].contains("volume_below"));
    const RunResult table = isotet({"extract", "make:kuhn:8:gyroid", "-i", "50%v", "--volumes"});
    EXPECT_NE(table.out.find("volume below  volume above"), std::string::npos) << table.out;
    for (const char* wrong : {"101%v", "-1%v", "%v", "p", "p101", "50%", "pq"}) {
        const RunResult run = isotet({"extract", "make:kuhn:2:gyroid", std::string("-i=") + wrong});
        EXPECT_EQ(run.status, 2) << wrong;
        EXPECT_NE(run.err.find(wrong), std::string::npos) << run.err;
    }
}

TEST_F(Program, ExtractNotesTiesThatComeFromRoundingAndTheRemedy) {
    put_content(path("g.msh"), small_grid({{"p", {1, 1 + 0x1p-40, -50, 50, 1}}}));
    const auto run = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"extract", path("g.msh"), "-f", "p", "-i", "1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return isotet(arguments);
    };
    for (const char* method : {"direct", "clusters"}) {
        const RunResult single = run({"--method", method});
        EXPECT_NE(
            single.err.find("isovalue 1: 1 point is tied (equal to it) only by rounding; --precision double keeps "
                            "them apart"),
            std::string::npos)
            << single.err;
        EXPECT_EQ(single.out.find("false"), std::string::npos) << single.out;
        const RunResult exact = run({"--method", method, "--precision", "double"});
        EXPECT_EQ(exact.err.find("only by rounding"), std::string::npos) << exact.err;
    }
}

TEST_F(Program, ExtractDirectlyTakesTheMiddleOfTheRangeAndTellsWhatItLeavesOut) {
    std::string grid = small_grid({{"p", {1, 2, 3, 4, 8}}});
    put_content(path("g.msh"), grid);
    const RunResult run = isotet({"extract", path("g.msh"), "-f", "p", "--method", "direct"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("isotet: note: no isovalue was given: 4.5"), std::string::npos) << run.err;
}

TEST_F(Program, ExtractSaysWhenAFieldHasNoFiniteValue) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    put_content(path("g.msh"), small_grid({{"p", {nan, nan, nan, nan, nan}}}));
    for (const char* method : {"direct", "clusters"}) {
        const RunResult run = isotet({"extract", path("g.msh"), "-f", "p", "--method", method});
        EXPECT_EQ(run.status, 3) << method;
        EXPECT_NE(run.err.find("field 'p' has no finite value"), std::string::npos) << run.err;
        const json report = json_of({"extract", path("g.msh"), "-f", "p", "-i", "1", "--method", method});
        EXPECT_TRUE(report["range"].is_null()) << method;
        EXPECT_EQ(report["surfaces"][0]["triangles"], 0);
    }
}

TEST_F(Program, ExtractOnADeviceDirectlyIsRefused) {
    const RunResult run =
        isotet({"extract", "make:kuhn:4:sphere", "--engine", "vulkan", "--device", "software", "--method", "direct"});
    EXPECT_EQ(run.status, run.err.find("--method direct") == std::string::npos ? 4 : 2) << run.err;
}

TEST_F(Program, ExtractWritesTheNumbersThatItTells) {
    const json report = json_of({"extract", "make:kuhn:6:sphere", path("s.vtp"), "-i", "0.5"});
    const SurfaceFile file = read_back(path("s.vtp"));
    EXPECT_EQ(report["surfaces"][0]["vertices"], file.surface.vertex_count());
    EXPECT_EQ(report["surfaces"][0]["triangles"], file.surface.triangle_count());
    EXPECT_GT(file.surface.triangle_count(), 0u);
}

TEST_F(Program, ExtractTellsNumbersAndWritesNothingWithoutOut) {
    const RunResult run = isotet({"extract", "make:kuhn:6:sphere", "-i", "0.5"}, {.folder = folder.path().string()});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("triangles"), std::string::npos);
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(folder.entries(), 0u);
}

TEST_F(Program, ExtractTakesTheMiddleOfTheRangeWithoutAnIsovalue) {
    put_content(path("g.msh"), small_grid({{"p", {1, 2, 3, 4, 8}}}));
    const RunResult run = isotet({"extract", path("g.msh"), "-f", "p", "--json", path("n.json")});
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.err.find("isotet: note: no isovalue was given: 4.5"), std::string::npos) << run.err;
    EXPECT_EQ(json::parse(content_of(path("n.json")))["surfaces"][0]["isovalue"], 4.5);
}

TEST_F(Program, ExtractJoinsSeveralIsovaluesWithACellField) {
    const json report = json_of({"extract", "make:kuhn:6:sphere", path("s.vtp"), "-i", "0.5,0.7", "-i", "0.9"});
    ASSERT_EQ(report["surfaces"].size(), 3u);
    std::uint64_t triangles = 0;
    for (const json& surface : report["surfaces"]) {
        triangles += surface["triangles"].get<std::uint64_t>();
        EXPECT_EQ(surface["file"], path("s.vtp"));
    }
    const SurfaceFile file = read_back(path("s.vtp"));
    EXPECT_EQ(file.surface.triangle_count(), triangles);
    const Array* isovalues = field(file.surface.cell_fields, "isovalue");
    ASSERT_NE(isovalues, nullptr);
    EXPECT_EQ(isovalues->at(0), 0.5);
    EXPECT_EQ(isovalues->at(isovalues->tuples() - 1), 0.9);
}

TEST_F(Program, ExtractWritesOneFileForEachValueNamedByTheShortestDecimal) {
    const json report =
        json_of({"extract", "make:kuhn:6:sphere", path("s-{value}.stl"), "-i", "0.5,1,0.30000000000000004,1e-7"});
    EXPECT_EQ(report["surfaces"].size(), 4u);
    for (const char* name : {"s-0.5.stl", "s-1.stl", "s-0.30000000000000004.stl", "s-1e-07.stl"}) {
        EXPECT_TRUE(std::filesystem::exists(path(name))) << name;
    }
    EXPECT_EQ(folder.entries(), 4u);
    EXPECT_EQ(field(read_back(path("s-0.5.stl")).surface.cell_fields, "isovalue"), nullptr);
}

TEST_F(Program, ExtractCutsLevelsEvenlyInsideTheRange) {
    put_content(path("g.msh"), small_grid({{"p", {1, 2, 3, 4, 9}}}));
    const json report = json_of({"extract", path("g.msh"), "-f", "p", "--levels", "3"});
    ASSERT_EQ(report["surfaces"].size(), 3u);
    for (int k = 1; k <= 3; ++k) EXPECT_EQ(report["surfaces"][k - 1]["isovalue"], 1 + k * (9.0 - 1) / 4);
}

TEST_F(Program, ExtractTakesNegativeValuesAndExponents) {
    const json report = json_of({"extract", "make:kuhn:4:plane", "-i", "-0.25,+5e-1"});
    EXPECT_EQ(report["surfaces"][0]["isovalue"], -0.25);
    EXPECT_EQ(report["surfaces"][1]["isovalue"], 0.5);
}

TEST_F(Program, ExtractMakesAValidEmptyFileOutsideTheRange) {
    for (const char* name : {"e.vtp", "e.ply", "e.stl", "e.obj", "e.vtk", "e.ts"}) {
        const RunResult run = isotet({"extract", "make:kuhn:4:sphere", path(name), "-i", "99", "--allow-empty"});
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_NE(run.err.find("isotet: note: isovalue 99 is outside the range"), std::string::npos) << run.err;
        EXPECT_NE(run.err.find("0 to 1.732"), std::string::npos) << run.err;
        EXPECT_EQ(read_back(path(name)).surface.triangle_count(), 0u) << name;
        EXPECT_EQ(isotet({"check", path(name), "--strict", "--closed"}).status, 0) << name;
    }
}

TEST_F(Program, ExtractSnapsToTheTypeOfTheField) {
    const json report = json_of({"extract", "make:kuhn:4:sphere", "-i", "0.7", "--snap"});
    EXPECT_EQ(report["surfaces"][0]["isovalue"], static_cast<double>(0.7f));
    EXPECT_EQ(json_of({"extract", "make:kuhn:4:integer", "-i", "2.2", "--snap"})["surfaces"][0]["isovalue"], 2);
}

TEST_F(Program, ExtractCountsTiedPoints) {
    put_content(path("g.msh"), small_grid({{"p", {1, 2, 2, 3, 0}}}));
    EXPECT_EQ(json_of({"extract", path("g.msh"), "-f", "p", "-i", "2"})["surfaces"][0]["tied_points"], 2);
}

TEST_F(Program, ExtractCarriesAllPointFieldsUnlessWithSaysElse) {
    put_content(path("g.msh"), small_grid({{"p", {0, 1, 1, 1, 2}}, {"q", {5, 6, 7, 8, 9}}, {"c", {3, 4}, 0, true}}));
    EXPECT_EQ(isotet({"extract", path("g.msh"), path("all.vtp"), "-f", "p", "-i", "0.5"}).status, 0);
    const SurfaceFile all = read_back(path("all.vtp"));
    EXPECT_NE(field(all.surface.point_fields, "p"), nullptr);
    EXPECT_NE(field(all.surface.point_fields, "q"), nullptr);
    EXPECT_EQ(field(all.surface.cell_fields, "c"), nullptr);

    EXPECT_EQ(isotet({"extract", path("g.msh"), path("some.vtp"), "-f", "p", "-i", "0.5", "--with", "c", "--with", "x"})
                  .status,
              0);
    const SurfaceFile some = read_back(path("some.vtp"));
    EXPECT_EQ(field(some.surface.point_fields, "p"), nullptr);
    EXPECT_NE(field(some.surface.point_fields, "x"), nullptr);
    ASSERT_NE(field(some.surface.cell_fields, "c"), nullptr);
    EXPECT_EQ(field(some.surface.cell_fields, "c")->at(0), 3);

    EXPECT_EQ(isotet({"extract", path("g.msh"), path("none.vtp"), "-f", "p", "-i", "0.5", "--with", ""}).status, 0);
    EXPECT_TRUE(read_back(path("none.vtp")).surface.point_fields.empty());
    EXPECT_EQ(isotet({"extract", path("g.msh"), path("none2.vtp"), "-f", "p", "-i", "0.5", "--with="}).status, 0);
    EXPECT_TRUE(read_back(path("none2.vtp")).surface.point_fields.empty());
}

TEST_F(Program, ExtractContoursCellFieldsAndSaysSo) {
    put_content(path("g.msh"), small_grid({{"c", {3, 5}, 0, true}}));
    const RunResult run = isotet({"extract", path("g.msh"), "-f", "c", "-i", "3.5"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("averaged to the points"), std::string::npos) << run.out;
}

TEST_F(Program, ExtractTakesThePointFieldOfTwoOfOneNameWithANote) {
    put_content(path("g.msh"), small_grid({{"a", {0, 1, 1, 1, 2}}, {"a", {30, 50}, 0, true}}));
    const RunResult point = isotet({"extract", path("g.msh"), "-f", "a", "-i", "0.5", "--json", path("p.json")});
    EXPECT_EQ(point.status, 0) << point.err;
    EXPECT_NE(point.err.find("isotet: note: "), std::string::npos);
    EXPECT_EQ(json::parse(content_of(path("p.json")))["range"][1], 2);
    EXPECT_EQ(json_of({"extract", path("g.msh"), "-f", "a", "--cell-field", "-i", "40"})["range"][1], 50);
}

TEST_F(Program, ExtractContoursCoordinates) {
    EXPECT_EQ(json_of({"extract", "make:kuhn:4", "-f", "x", "-i", "0.1"})["field"], "x");
}

TEST_F(Program, ExtractGivesTheSameBytesForEveryEngineAndThreadCount) {
    const std::vector<std::string> common{"extract", "make:perturbed:6:integer", "-i", "1,2", "--normals", "gradient",
                                          "-q"};
    std::string first;
    int number = 0;
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"-j", "1"}, {"-j", "7"}, {"--engine", "reference"}}) {
        std::vector<std::string> arguments = common;
        arguments.insert(arguments.end(), more.begin(), more.end());
        const std::string out = path(fmt::format("s{}.vtp", number++));
        arguments.push_back(out);
        EXPECT_EQ(isotet(arguments).status, 0);
        if (first.empty()) first = content_of(out);
        EXPECT_EQ(content_of(out), first) << out;
    }
    EXPECT_FALSE(first.empty());
}

TEST_F(Program, ExtractKeepsDegenerateTrianglesWhenAsked) {
    const auto triangles = [](const json& report) { return report["surfaces"][0]["triangles"].get<int>(); };
    const json merged = json_of({"extract", "make:kuhn:6:integer", "-i", "2"});
    const json kept = json_of({"extract", "make:kuhn:6:integer", "-i", "2", "--keep-degenerate"});
    EXPECT_GT(triangles(kept), triangles(merged));
}

TEST_F(Program, ExtractSaysNothingWithQuiet) {
    const RunResult run = isotet({"extract", "make:kuhn:4:sphere", "-i", "99", "-q", "--allow-empty"});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.out + run.err, "");
}

TEST_F(Program, ExtractTellsOfCoincidentPointsAndWeldsThem) {
    // The second tet has its own copies of the three points between them.
    std::string grid = small_grid({{"p", {0, 1, 1, 1, 2}}});
    const auto replace = [&](std::string_view from, std::string_view to) {
        grid.replace(grid.find(from), from.size(), to);
    };
    replace("5\n1 0 0 0", "8\n1 0 0 0");
    replace("5 1 1 1\n", "5 1 1 1\n6 1 0 0\n7 0 1 0\n8 0 0 1\n");
    replace("2 4 2 1 1 2 3 4 5", "2 4 2 1 1 6 7 8 5");
    replace("5\n1 0\n", "8\n6 1\n7 1\n8 1\n1 0\n");
    put_content(path("g.msh"), grid);
    const RunResult open = isotet({"extract", path("g.msh"), "-f", "p", "-i", "0.5"});
    EXPECT_EQ(open.status, 0) << open.err;
    EXPECT_NE(open.err.find("3 points coincide with other points"), std::string::npos) << open.err;
    const RunResult welded = isotet({"extract", path("g.msh"), "-f", "p", "-i", "0.5", "--merge-points", "0"});
    EXPECT_EQ(welded.status, 0) << welded.err;
    EXPECT_EQ(welded.err.find("coincide"), std::string::npos) << welded.err;
}

TEST_F(Program, ExtractReplacesAnOldFileAsAWhole) {
    put_content(path("s.vtp"), "old");
    EXPECT_EQ(isotet({"extract", "make:kuhn:4:sphere", path("s.vtp"), "-i", "0.5"}).status, 0);
    EXPECT_GT(read_back(path("s.vtp")).surface.triangle_count(), 0u);
    EXPECT_EQ(folder.entries(), 1u);
}

TEST_F(Program, ExtractShowsSurfacesFirstAndHowTheyWereMadeOnlyWhenVerbose) {
    const std::vector<std::string> arguments{"extract", "make:kuhn:4:sphere", path("s.vtp"), "-i", "0.5"};
    const RunResult run = isotet(arguments);
    EXPECT_TRUE(run.out.starts_with("isovalue")) << run.out;
    EXPECT_LT(run.out.find("triangles"), run.out.find("grid"));
    for (const char* detail : {"method", "memory", "predicted", "tied points"})
        EXPECT_EQ(run.out.find(detail), std::string::npos) << detail;
    std::vector<std::string> verbose = arguments;
    verbose.push_back("-v");
    const RunResult more = isotet(verbose);
    for (const char* detail : {"method", "memory", "predicted", "tied points"})
        EXPECT_NE(more.out.find(detail), std::string::npos) << detail;
}

TEST_F(Program, ExtractFailsIfEmptyWhenAskedTo) {
    const RunResult run = isotet({"extract", "make:kuhn:4:sphere", path("s.vtp"), "-i", "0.5,99", "--fail-if-empty"});
    EXPECT_EQ(run.status, 3);
    EXPECT_TRUE(is_one_error(run, "--fail-if-empty: isovalue 99 is outside the range"));
    EXPECT_EQ(folder.entries(), 0u);
    EXPECT_EQ(isotet({"extract", "make:kuhn:4:sphere", path("s.vtp"), "-i", "0.5", "--fail-if-empty"}).status, 0);
}

TEST_F(Program, ExtractRefusesIsovaluesThatAreAllOutsideTheRange) {
    const RunResult run = isotet({"extract", "make:kuhn:4:sphere", path("s.vtp"), "-i", "99,-3"});
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("isovalue 99 is outside the range of 'sphere'"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("--allow-empty"), std::string::npos) << run.err;
    EXPECT_EQ(folder.entries(), 0u);
    EXPECT_EQ(isotet({"extract", "make:kuhn:4:sphere", path("s.vtp"), "-i", "99,0.5"}).status, 0) << "one is inside";
}

TEST_F(Program, ExtractAsksWhetherACommaWasADecimalSign) {
    put_content(path("g.msh"), small_grid({{"p", {0, 0.1, 0.2, 0.3, 0.5}}}));
    const RunResult run = isotet({"extract", path("g.msh"), path("s.vtp"), "-f", "p", "-i", "0,2"});
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("did you mean 0.2? Commas separate isovalues"), std::string::npos) << run.err;
    EXPECT_EQ(isotet({"extract", path("g.msh"), "-f", "p", "-i", "0,7"}).err.find("did you mean"), std::string::npos)
        << "0.7 is outside, too";
}

TEST_F(Program, SeveralFilesAreStepsInTheOrderOfTheirNumbers) {
    for (const char* name : {"g10.vtk", "g2.vtk", "g1.vtk"}) {
        const std::string side = name[1] == '2' ? "3" : "2";
        ASSERT_EQ(isotet({"make", "kuhn", "--side", side, "--fields", "sphere", "-o", path(name)}).status, 0);
    }
    const json report = json_of(
        {"extract", path("g1.vtk"), path("g10.vtk"), path("g2.vtk"), path("s-{step}.vtp"), "-i", "0.5", "--all-steps"});
    ASSERT_EQ(report["surfaces"].size(), 3u);
    const auto triangles_of = [&](int step) { return report["surfaces"][step]["triangles"]; };
    EXPECT_EQ(triangles_of(0), triangles_of(2));
    EXPECT_NE(triangles_of(0), triangles_of(1)) << "g2 comes before g10";
    EXPECT_EQ(report["surfaces"][2]["time"], 2);
    const json info = json_of({"info", path("g1.vtk"), path("g2.vtk")});
    EXPECT_EQ(info["times"], (std::vector<double>{0, 1}));
}

TEST_F(Program, AFolderThatIsNoCaseIsRefusedWithWhatIsInIt) {
    put_content(path("b.vtu"), "<VTKFile>");
    put_content(path("run.pvd"), "<VTKFile>");
    put_content(path("notes.txt"), "");
    const RunResult run = isotet({"info", folder.path().string()});
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("is a folder, but no case of OpenFOAM; in it are 'run.pvd', 'b.vtu'"), std::string::npos)
        << run.err;
}

TEST_F(Program, ExtractExplainsAnIsovalueAtTheMinimum) {
    put_content(path("g.msh"), small_grid({{"p", {0, 1, 2, 3, 4}}}));
    const RunResult run = isotet({"extract", path("g.msh"), "-f", "p", "-i", "0"});
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.err.find("0 is the smallest value of 'p': nothing is below it, the surface is empty"),
              std::string::npos)
        << run.err;
}

TEST_F(Program, ExtractSaysWhenAnEmptySurfaceReplacesAFile) {
    put_content(path("s.vtp"), "old");
    const RunResult run = isotet({"extract", "make:kuhn:4:sphere", path("s.vtp"), "-i", "99", "--allow-empty"});
    EXPECT_NE(run.err.find("s.vtp' was replaced by an empty surface"), std::string::npos) << run.err;
    const RunResult fresh = isotet({"extract", "make:kuhn:4:sphere", path("t.vtp"), "-i", "99", "--allow-empty"});
    EXPECT_EQ(fresh.err.find("replaced"), std::string::npos) << fresh.err;
}

TEST_F(Program, ExtractReadsIsovaluesFromAFile) {
    put_content(path("levels.txt"), "# metres\n0.5, 0.75\n\n1 1.25 # the last\r\n");
    const json report = json_of({"extract", "make:kuhn:4:sphere", "-i", "@" + path("levels.txt"), "-i", "0.25"});
    std::vector<double> isovalues;
    for (const json& surface : report["surfaces"]) isovalues.push_back(surface["isovalue"]);
    EXPECT_EQ(isovalues, (std::vector<double>{0.5, 0.75, 1, 1.25, 0.25}));
}

TEST_F(Program, ExtractNamesTheLineOfAnIsovalueFileThatIsWrong) {
    const auto run = [&](const std::string& text) {
        put_content(path("levels.txt"), text);
        return isotet({"extract", "make:kuhn:4:sphere", "-i", "@" + path("levels.txt")});
    };
    const RunResult wrong = run("0.5\n0.75 0.8m\n");
    EXPECT_EQ(wrong.status, 3);
    EXPECT_TRUE(is_one_error(wrong, "line 2 has '0.8m', but must have finite numbers"));
    EXPECT_TRUE(is_one_error(run("1e999"), "line 1 has '1e999'"));
    EXPECT_TRUE(is_one_error(run("# nothing\n"), "has no number"));
    const RunResult missing = isotet({"extract", "make:kuhn:4:sphere", "-i", "@" + path("missing.txt")});
    EXPECT_EQ(missing.status, 3);
    EXPECT_TRUE(is_one_error(missing, "cannot be read"));
}

TEST_F(Program, ExtractDoesNotOverwriteTheFileOfIsovalues) {
    const std::string levels = path("levels.txt"), as_surface = path("levels.vtp");
    put_content(levels, "0.5\n");
    put_content(as_surface, "0.5\n");
    for (const std::vector<std::string>& outputs :
         {std::vector<std::string>{"-i", "@" + levels, "--json", levels},
          {as_surface, "-i", "@" + as_surface},
          {path("{time}levels.vtp"), "-i", "@" + as_surface, "--json", as_surface}}) {
        std::vector<std::string> words{"extract", "make:kuhn:4:sphere"};
        words.insert(words.end(), outputs.begin(), outputs.end());
        EXPECT_EQ(isotet(words).status, 2);
    }
    EXPECT_EQ(isotet({"render", "make:kuhn:4:sphere", "-i", "@" + levels, "--json", levels}).status, 2);
    EXPECT_EQ(isotet({"bench", "make:kuhn:4:sphere", "-i", "@" + levels, "--json", levels}).status, 2);
    EXPECT_EQ(isotet({"view", "make:kuhn:4:sphere", "-i", "@" + levels, "--json", levels}).status, 2);
    EXPECT_EQ(isotet({"view", "make:kuhn:4:sphere", "--beside", levels, "--json", levels}).status, 2);
    EXPECT_EQ(content_of(levels), "0.5\n");
    EXPECT_EQ(content_of(as_surface), "0.5\n");
}

TEST_F(Program, ExtractTakesAListOfFieldsToCarry) {
    put_content(path("g.msh"), small_grid({{"p", {0, 1, 1, 1, 2}}, {"q", {5, 6, 7, 8, 9}}, {"a,b", {1, 1, 1, 1, 1}}}));
    const std::vector<std::string> start{"extract", path("g.msh"), path("s.vtp"), "-f", "p", "-i", "0.5", "--with"};
    const auto carried = [&](const std::string& with) {
        std::vector<std::string> arguments = start;
        arguments.push_back(with);
        EXPECT_EQ(isotet(arguments).status, 0) << with;
        std::vector<std::string> names;
        for (const Field& one : read_back(path("s.vtp")).surface.point_fields) names.push_back(one.name);
        return names;
    };
    EXPECT_EQ(carried("p,q"), (std::vector<std::string>{"p", "q"}));
    EXPECT_EQ(carried("a,b"), (std::vector<std::string>{"a,b"})) << "a name with a comma is taken whole";
}

TEST_F(Program, ExtractRefusesAToleranceThatCollapsesEveryCell) {
    const std::vector<std::string> grid{"extract", "make:kuhn:4:sphere", "-i", "0.5", "--merge-points"};
    const auto merge = [&](const char* tolerance) {
        std::vector<std::string> arguments = grid;
        arguments.push_back(tolerance);
        return isotet(arguments);
    };
    const RunResult run = merge("10");
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "--merge-points: the tolerance is 10, but with it every one of the 384 cells"));
    EXPECT_EQ(merge("0.01").status, 0);
}

TEST_F(Program, ExtractTellsOfCellsThatMergingCollapses) {
    std::string grid = small_grid({{"p", {0, 1, 1, 1, 2}}});
    const std::string point = "2 1 0 0\n"; // near the first one
    grid.replace(grid.find(point), point.size(), "2 0.001 0 0\n");
    put_content(path("g.msh"), grid);
    const RunResult run = isotet({"extract", path("g.msh"), "-f", "p", "-i", "1.5", "--merge-points", "0.01"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("--merge-points 0.01 is longer than edges of 1 cell, which collapse"), std::string::npos)
        << run.err;
}

TEST_F(Program, ExtractListsFieldsForAWrongDisplacement) {
    put_content(path("g.msh"), small_grid({{"p", {0, 1, 1, 1, 2}}, {"shift", {5, 6, 7, 8, 9}}}));
    const RunResult run = isotet({"extract", path("g.msh"), "-f", "p", "-i", "0.5", "--displace", "shft"});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(
        is_one_error(run, "--displace takes a point field: there is no field 'shft': the grid has 'shift', 'p'"));
}

TEST_F(Program, PiecesAreTogetherTheSurfaceOfTheWhole) {
    for (const std::string shape : {"make:mixed:6:gyroid", "make:kuhn:6:wavelet"}) {
        const json whole = json_of({"extract", shape, path("whole.vtp"), "--levels", "1", "--edge-ends"});
        std::vector<std::string> files;
        std::uint64_t triangles = 0;
        for (const std::string piece : {"1/3", "2/3", "3/3"}) {
            files.push_back(path("part-" + piece.substr(0, 1) + ".vtp"));
            const json part =
                json_of({"extract", shape, files.back(), "--levels", "1", "--edge-ends", "--piece", piece});
            triangles += part["surfaces"][0]["triangles"].get<std::uint64_t>();
            EXPECT_EQ(part["surfaces"][0]["isovalue"], whole["surfaces"][0]["isovalue"]);
        }
        EXPECT_EQ(triangles, whole["surfaces"][0]["triangles"]);
        const json checked_whole = json_of({"check", path("whole.vtp"), "--grid", shape});
        const json together = json_of({"check", files[0], files[1], files[2], "--grid", shape});
        EXPECT_EQ(together["more_files"].size(), 2u);
        for (const char* key : {"vertices", "triangles", "boundary_edges", "components", "euler", "sound"})
            EXPECT_EQ(together[key], checked_whole[key]) << key;
        const json alone = json_of({"check", files[0]});
        EXPECT_GT(alone["boundary_edges"], 0);
    }
}

/// .vtk is an ending of grids and of surfaces.
TEST_F(Program, FilesOfLegacyVtkAreTimeStepsBesideANamedOutput) {
    const std::string steps[] = {path("s_0.vtk"), path("s_1.vtk")};
    for (const std::string& step : steps)
        std::filesystem::copy_file(source_folder() / "data/vtk/lox_post_pressure.vtk", step);
    const json report = json_of({"extract", steps[0], steps[1], "-o", path("s-{step}.vtp"), "--all-steps"});
    EXPECT_EQ(report["surfaces"].size(), 2u);
    EXPECT_EQ(isotet({"extract", steps[0], path("b.ply"), "-o", path("a.ply")}).status, 2);
}

TEST_F(Program, PiecesOfFilesAreTogetherTheSurfaceOfTheWhole) {
    const std::string data = (source_folder() / "data").string();
    const std::string files[][2] = {{data + "/vtkhdf/can_hex.hdf", "DISPL:z"},
                                    {data + "/vtu/polyhedron_two_pieces.vtu", "x"}};
    for (const auto& [file, field] : files) {
        const json whole = json_of({"extract", file, path("whole.vtp"), "-f", field, "--levels", "1", "--edge-ends"});
        std::vector<std::string> command{"check"};
        for (const std::string piece : {"1/2", "2/2"}) {
            command.push_back(path("part-" + piece.substr(0, 1) + ".vtp"));
            json_of({"extract", file, command.back(), "-f", field, "--levels", "1", "--edge-ends", "--piece", piece});
        }
        const json checked_whole = json_of({"check", path("whole.vtp")});
        const json together = json_of(command);
        for (const char* key : {"vertices", "triangles", "boundary_edges", "components", "euler", "area"})
            EXPECT_EQ(together[key], checked_whole[key]) << file << " " << key;
        EXPECT_GT(checked_whole["triangles"], 0);
    }
}

TEST_F(Program, PiecesAreCountedFromOne) {
    for (const char* piece : {"0/3", "4/3", "1", "1/", "/3", "1/3x", "-1/3", "1/0"})
        EXPECT_EQ(isotet({"extract", "make:kuhn:2:gyroid", "-i", "0", "--piece", piece}).status, 2) << piece;
}

} // namespace
} // namespace isotet::test
