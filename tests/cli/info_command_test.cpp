// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet info`, `isotet FILE`, `isotet formats` and `isotet --version`.
#include "program.hpp"
#include "support/places.hpp"
#include "small_grid.hpp"

namespace isotet::test {
namespace {

using nlohmann::json;

TEST_F(Program, InfoTellsCellsFieldsAndRanges) {
    put_content(path("g.msh"), small_grid({{"p", {1, 2, 3, 4, 9}}, {"c", {-5, 7}, 0, true}}));
    const json report = json_of({"info", path("g.msh")});
    EXPECT_EQ(report["schema"], 4);
    EXPECT_EQ(report["points"], 5);
    EXPECT_EQ(report["cells"], 2);
    EXPECT_EQ(report["tets"], 2);
    EXPECT_EQ(report["cells_by_type"]["tetrahedron"], 2);
    EXPECT_EQ(report["bounds"]["upper"], json::array({1, 1, 1}));
    std::map<std::string, json> fields;
    for (const json& field : report["fields"]) fields[field["name"]] = field;
    ASSERT_TRUE(fields.contains("p") && fields.contains("c"));
    EXPECT_EQ(fields["p"]["association"], "point");
    EXPECT_EQ(fields["p"]["range"], json::array({json::array({1, 9})}));
    EXPECT_EQ(fields["c"]["association"], "cell");
    EXPECT_EQ(fields["c"]["range"], json::array({json::array({-5, 7})}));
}

TEST_F(Program, InfoShowsFewDigitsAndAsManyAsTellTheRangeApart) {
    put_content(path("g.msh"), small_grid({{"p", {0.1 + 0.2, 1, 2, 3, 4.000000000000001}},
                                           {"q", {101325.125, 101325.25, 101325.5, 101325.75, 101326}}}));
    const std::string out = isotet({"info", path("g.msh")}).out;
    EXPECT_NE(out.find("0.3 to 4\n"), std::string::npos) << out;
    EXPECT_NE(out.find("101325.125 to 101326\n"), std::string::npos) << out;
}

TEST_F(Program, InfoTellsFilesWhoseNamesDifferInMoreThanNumbersOneByOne) {
    put_content(path("pump.msh"), small_grid({{"p", {1, 2, 3, 4, 9}}}));
    put_content(path("valve.msh"), small_grid({{"q", {-1, 2, 3, 4, 5}}}));
    const std::vector<std::string> files{path("pump.msh"), path("none.msh"), path("valve.msh")};
    const RunResult run = isotet({"info", files[0], files[1], files[2]});
    EXPECT_EQ(run.status, 3);
    EXPECT_TRUE(is_one_error(run, "none.msh")) << run.err;
    EXPECT_NE(run.out.find("1 to 9"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("-1 to 5"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("time steps"), std::string::npos) << run.out;
    const json report = json_of({"info", files[0], files[1], files[2], "--quiet"}, 3);
    ASSERT_EQ(report["files"].size(), 3u);
    EXPECT_TRUE(report["files"][0].contains("error")) << "in the order of their names";
    EXPECT_EQ(report["files"][2]["fields"][0]["name"], "q");
}

TEST_F(Program, InfoCountsFacesAndPlacesOnlyInASurvey) {
    const std::vector<std::string> of_survey{"repeated_tets",      "duplicate_points", "boundary_faces",
                                             "quads_on_triangles", "hanging_points",   "hanging"};
    const json quick = json_of({"info", "make:kuhn:3"});
    const json survey = json_of({"info", "make:kuhn:3", "--survey"});
    for (const std::string& key : of_survey) {
        EXPECT_FALSE(quick.contains(key)) << key;
        EXPECT_TRUE(survey.contains(key)) << key;
    }
    EXPECT_EQ(survey["boundary_faces"], 6 * 3 * 3 * 2);
    json rest = survey;
    for (const std::string& key : of_survey) rest.erase(key);
    EXPECT_EQ(rest, quick);
    EXPECT_EQ(isotet({"info", "make:kuhn:3"}).out.find("boundary faces"), std::string::npos);
    EXPECT_NE(isotet({"info", "make:kuhn:3", "--survey"}).out.find("boundary faces  108"), std::string::npos);
}

TEST_F(Program, InfoOfHeadsTellsWhatTheFileAnnounces) {
    ASSERT_EQ(isotet({"make", "mixed", "--side", "3", "--fields", "sphere,integer", "-o", path("m.vtu")}).status, 0);
    const json whole = json_of({"info", path("m.vtu")}), heads = json_of({"info", path("m.vtu"), "--heads"});
    EXPECT_EQ(heads["cells"], whole["cells"]);
    EXPECT_EQ(heads["format"], "vtu");
    ASSERT_EQ(heads["fields"].size(), whole["fields"].size());
    for (std::size_t i = 0; i < heads["fields"].size(); ++i)
        for (const char* key : {"name", "association", "type", "components"})
            EXPECT_EQ(heads["fields"][i][key], whole["fields"][i][key]);
    const RunResult run = isotet({"info", path("m.vtu"), "--heads"});
    EXPECT_NE(run.out.find("field  integer  point  int32"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("bounds"), std::string::npos) << "for which points are read";
    EXPECT_EQ(isotet({"info", path("m.vtu"), "--heads", "--survey"}).status, 2);
    put_content(path("cut.vtu"), content_of(path("m.vtu")).substr(0, content_of(path("m.vtu")).size() - 300));
    EXPECT_NE(isotet({"info", path("cut.vtu"), "--heads"}).status, 0);
}

TEST_F(Program, InfoCountsValuesThatAreNoNumber) {
    std::string grid = small_grid({{"p", {1, 2, 3, 4, 9}}});
    grid.replace(grid.find("3 3\n"), 4, "3 nan\n");
    put_content(path("g.msh"), grid);
    const RunResult run = isotet({"info", path("g.msh"), "--json", path("r.json")});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("no data 1"), std::string::npos) << run.out;
    for (const json& field : json::parse(content_of(path("r.json")))["fields"]) {
        if (field["name"] == "p") {
            EXPECT_EQ(field["nan"], json::array({1}));
        }
    }
}

TEST_F(Program, InfoChartsAreaAndVolumeAgainstTheIsovalue) {
    const json chart = json_of({"info", "make:kuhn:16:sphere", "--chart", "4"})["chart"];
    EXPECT_EQ(chart["field"], "sphere");
    EXPECT_EQ(chart["tets"], 6 * 16 * 16 * 16);
    EXPECT_EQ(chart["volume_below"][0], 0);
    EXPECT_NEAR(chart["volume"].get<double>(), 8, 1e-5);
    ASSERT_EQ(chart["isovalues"].size(), 5u);
    const double radius = chart["isovalues"][2];
    EXPECT_NEAR(chart["area"][2].get<double>(), 4 * 3.14159265 * radius * radius, 0.1);
    const std::string table = isotet({"info", "make:kuhn:16:sphere", "--chart", "4"}).out;
    EXPECT_NE(table.find("volume below"), std::string::npos) << table;
    EXPECT_FALSE(json_of({"info", "make:kuhn:3"}).contains("chart"));
}

TEST_F(Program, InfoListsBlocksAndBlockChoosesOne) {
    const std::string file = (source_folder() / "data/exodus/mixed_blocks_hdf5.exo").string();
    const json whole = json_of({"info", file});
    ASSERT_GT(whole["blocks"].size(), 1u) << whole["blocks"];
    std::uint64_t cells = 0;
    for (const json& block : whole["blocks"]) cells += block["cells"].get<std::uint64_t>();
    EXPECT_EQ(whole["cells"], cells);
    const json one = json_of({"info", file, "--block", "2"});
    EXPECT_EQ(one["cells"], whole["blocks"][1]["cells"]);
    EXPECT_EQ(one["blocks"], whole["blocks"]);
    EXPECT_EQ(one["unused_points"], 0);
    const json two = json_of({"info", file, "--block", "2", "--block", "line_weld_block_1"});
    EXPECT_EQ(two["cells"], one["cells"].get<int>() + 22);
    EXPECT_NE(isotet({"info", file}).out.find("element block"), std::string::npos);
    const RunResult unknown = isotet({"info", file, "--block", "none such"});
    EXPECT_NE(unknown.status, 0);
    EXPECT_NE(unknown.err.find("block 'none such' is not in the file, which has "), std::string::npos) << unknown.err;
    EXPECT_NE(isotet({"info", "make:kuhn:3", "--block", "1"}).status, 0);
}

TEST_F(Program, InfoTellsCellsAndRangesOfEachBlock) {
    const std::string file = (source_folder() / "data/exodus/mixed_blocks_hdf5.exo").string();
    const json whole = json_of({"info", file, "--each-block"});
    for (const std::size_t i : {std::size_t{0}, whole["blocks"].size() / 2, whole["blocks"].size() - 1}) {
        const json& block = whole["blocks"][i];
        const json alone = json_of({"info", file, "--block", std::to_string(block["number"].get<int>())});
        EXPECT_EQ(block["cells_by_type"], alone["cells_by_type"]) << block["name"];
        EXPECT_EQ(block["fields"], alone["fields"]) << block["name"];
    }
    EXPECT_FALSE(json_of({"info", file})["blocks"][0].contains("fields"));
    EXPECT_NE(isotet({"info", file, "--each-block"}).out.find("\nelement block 1"), std::string::npos);
    const RunResult none = isotet({"info", "make:kuhn:3", "--each-block"});
    EXPECT_EQ(none.status, 2);
    EXPECT_TRUE(is_one_error(none, "--each-block: the file has no blocks")) << none.err;
}

TEST_F(Program, InfoTellsWhatASurfaceHas) {
    EXPECT_EQ(isotet({"extract", "make:kuhn:4:sphere", path("s.vtp"), "-i", "0.5", "--with", "sphere"}).status, 0);
    const json surface = json_of({"check", path("s.vtp")});
    const json report = json_of({"info", path("s.vtp"), "--survey"});
    EXPECT_EQ(report["format"], "vtp");
    EXPECT_EQ(report["points"], surface["vertices"]);
    EXPECT_EQ(report["cells_by_type"]["triangle"], surface["triangles"]);
    EXPECT_EQ(report["tets"], 0);
    EXPECT_FALSE(report.contains("duplicate_points")) << "nothing is counted";
    EXPECT_EQ(report["fields"][0]["name"], "sphere");
}

TEST_F(Program, FlatCellsAreToldAndDrawnAndHaveNoIsosurface) {
    put_content(path("plate.vtk"), R"(# vtk DataFile Version 3.0
plate
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 float
0 0 0 2 0 0 2 1 0 0 1 0 3 0.5 0
CELLS 2 9
4 0 1 2 3
3 1 4 2
CELL_TYPES 2
9 5
POINT_DATA 5
SCALARS T float 1
LOOKUP_TABLE default
1 2 4 3 7
)");
    const json report = json_of({"info", path("plate.vtk"), "--survey"});
    EXPECT_EQ(report["cells_by_type"], (json{{"quad", 1}, {"triangle", 1}}));
    EXPECT_EQ(report["bounds"]["upper"], json::array({3, 1, 0}));
    EXPECT_EQ(report["fields"][0]["range"], json::array({json::array({1, 7})}));
    EXPECT_EQ(report["first_view"]["draw"], "field_on_boundary");
    EXPECT_EQ(report["first_view"]["field"], "T");
    const RunResult picture = isotet({"render", path("plate.vtk"), path("plate.png")});
    EXPECT_EQ(picture.status, 0) << picture.err;
    EXPECT_NE(picture.out.find("boundary     3 faces"), std::string::npos) << picture.out;
    const RunResult surface = isotet({"extract", path("plate.vtk"), path("s.vtp"), "-i", "2"});
    EXPECT_EQ(surface.status, 3);
    EXPECT_TRUE(is_one_error(surface, "no cell that can be contoured (1 x triangle, 1 x quad)")) << surface.err;
}

TEST_F(Program, BareFileIsInfo) {
    put_content(path("g.msh"), small_grid({{"p", {1, 2, 3, 4, 9}}}));
    const RunResult bare = isotet({path("g.msh")});
    EXPECT_EQ(bare.status, 0) << bare.err;
    EXPECT_EQ(bare.out, isotet({"info", path("g.msh")}).out);
    EXPECT_EQ(isotet({"-q", path("g.msh")}).out, "");
}

TEST_F(Program, FormatsListsWhatCanBeWritten) {
    const json report = json_of({"formats"});
    std::vector<std::string> surfaces;
    for (const json& format : report["formats"]) {
        if (format["writes_surface"].get<bool>()) surfaces.push_back(format["name"]);
    }
    std::sort(surfaces.begin(), surfaces.end());
    EXPECT_EQ(surfaces, (std::vector<std::string>{"3mf", "glb", "obj", "ply", "stl", "ts", "usda", "vtk", "vtp"}));
    EXPECT_NE(isotet({"formats"}).out.find(".vtp"), std::string::npos);
}

TEST_F(Program, VersionTellsTheFactsOfTheBuild) {
    const RunResult run = isotet({"--version"});
    EXPECT_EQ(run.status, 0);
    for (const char* fact : {"isotet", "commit", "compiler", "isotet-reader", "oneTBB"}) {
        EXPECT_NE(run.out.find(fact), std::string::npos) << fact << " is not in " << run.out;
    }
}

} // namespace
} // namespace isotet::test
