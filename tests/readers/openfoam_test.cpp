// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// OpenFOAM cases: every encoding, polyhedra, decomposed cases, values on patches, and files that are broken.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <sys/stat.h>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <libdeflate.h>

#include <isotet/fields.hpp>
#include <isotet/contour.hpp>
#include <isotet/pieces.hpp>
#include <isotet/read.hpp>

#include "io/foam/field_file.hpp"
#include "pieces/partition.hpp"
#include "readers/foam_sample.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

bool in_the_middle(int x, int y, int z) { return x == 1 && y == 1 && z == 1; }
double wave(const std::array<double, 3>& p) { return std::sin(p[0]) + std::cos(1.3 * p[1]) + p[2] * p[2]; }

void write_case(const TemporaryFolder& folder, const FoamFiles& files) {
    for (const auto& [name, content] : files) folder.write(name, content);
}

ReadOptions last_step() {
    ReadOptions options;
    options.step = 1;
    return options;
}

Grid read_whole(const std::string& path) {
    auto result = read(path, last_step());
    EXPECT_TRUE(result) << result.error().message;
    return result ? std::move(result->grid) : Grid{};
}

const Array& field_of(const std::vector<Field>& fields, const std::string& name) {
    for (const Field& field : fields)
        if (field.name == name) return field.values;
    ADD_FAILURE() << name;
    static const Array none;
    return none;
}

void expect_same(const Array& a, const Array& b) {
    ASSERT_EQ(a.tuples(), b.tuples());
    ASSERT_EQ(a.components(), b.components());
    for (std::size_t i = 0; i < a.tuples(); ++i)
        for (std::size_t k = 0; k < a.components(); ++k) ASSERT_EQ(a.at(i, k), b.at(i, k)) << i;
}

void expect_same_grid(const Grid& a, const Grid& b) {
    expect_same(a.points, b.points);
    expect_same(a.cells.connectivity, b.cells.connectivity);
    expect_same(a.cells.types, b.cells.types);
    for (const char* name : {"T", "U"}) {
        expect_same(field_of(a.point_fields, name), field_of(b.point_fields, name));
        expect_same(field_of(a.cell_fields, name), field_of(b.cell_fields, name));
    }
}

class ReadOpenfoamCase : public testing::Test {
protected:
    TemporaryFolder folder_;
    FoamBox box_ = foam_box(3, in_the_middle);
};

TEST_F(ReadOpenfoamCase, MayHaveFilesThatAWindowsEditorSaved) {
    const FoamFiles files = foam_case(box_, wave, {});
    const TemporaryFolder windows;
    write_case(folder_, files);
    for (const auto& [name, content] : files) {
        std::string text = "\xef\xbb\xbf";
        for (const char c : content) text += c == '\n' ? "\r\n" : std::string(1, c);
        windows.write(name, text);
    }
    expect_same_grid(read_whole(folder_.file("")), read_whole(windows.file("")));
}

TEST_F(ReadOpenfoamCase, HasThePatchesOfTheWholeAlsoWhenItIsDecomposed) {
    ReadOptions options = last_step();
    options.patches = true;
    for (const int processors : {0, 3}) {
        const TemporaryFolder folder;
        write_case(folder, foam_case(box_, wave, {}, processors));
        const BoundaryPatches patches = read(folder.file(""), options).value().grid.patches;
        ASSERT_EQ(patches.names.size(), 2u);
        for (const FoamBox::Patch& patch : box_.patches) {
            const auto name = std::ranges::find(patches.names, patch.name, &PatchName::name);
            ASSERT_NE(name, patches.names.end());
            EXPECT_EQ(std::ranges::count(patches.numbers.as<std::int64_t>(), name->number),
                      static_cast<std::ptrdiff_t>(patch.count));
        }
    }
}

TEST_F(ReadOpenfoamCase, HasHexahedraAndTransitionsAsPolyhedra) {
    write_case(folder_, foam_case(box_, wave, {}));
    const Grid grid = read_whole(folder_.file(""));
    const auto report = survey(grid);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->cells, 26u + 8u);
    EXPECT_EQ(report->cells_by_type.at(12), 8u + 8u) << "the fine ones, and those in the corners of the box";
    EXPECT_EQ(report->cells_by_type.at(42), 18u) << "beside a face or an edge of the fine ones";
    EXPECT_EQ(report->cells_left_out, 0u);
    EXPECT_EQ(report->negative_tets, 0u);
    EXPECT_EQ(report->duplicate_points, 0u);
}

TEST_F(ReadOpenfoamCase, IsNamedWhereAPartOfItIsGiven) {
    write_case(folder_, foam_case(box_, wave, {}));
    for (const char* part : {"constant", "constant/polyMesh", "constant/polyMesh/points"}) {
        const auto result = inspect(folder_.file(part));
        ASSERT_FALSE(result) << part;
        EXPECT_NE(result.error().message.find("is a part of a case of OpenFOAM, which is read as a whole: /"),
                  std::string::npos)
            << result.error().message;
    }
}

TEST_F(ReadOpenfoamCase, IsTheSameInEveryEncoding) {
    const TemporaryFolder text;
    write_case(text, foam_case(box_, wave, {}));
    const Grid expected = read_whole(text.file("system/controlDict"));
    for (const FoamStyle style : {FoamStyle{true, 32, 64}, FoamStyle{true, 64, 64}, FoamStyle{false, 64, 64}}) {
        const TemporaryFolder folder;
        write_case(folder, foam_case(box_, wave, style));
        expect_same_grid(read_whole(folder.write("any.foam", "")), expected);
    }
}

TEST_F(ReadOpenfoamCase, KeepsFloat32) {
    for (const bool binary : {false, true}) {
        const TemporaryFolder folder;
        write_case(folder, foam_case(box_, wave, {binary, 32, 32}));
        const Grid grid = read_whole(folder.file(""));
        EXPECT_EQ(grid.points.type(), ScalarType::float32);
        const Array& t = field_of(grid.cell_fields, "T");
        ASSERT_EQ(t.type(), ScalarType::float32);
        for (std::size_t i = 0; i < t.tuples(); ++i) EXPECT_EQ(t.at(i), static_cast<float>(wave(box_.centres[i])));
    }
}

TEST_F(ReadOpenfoamCase, MakesWedgesPyramidsAndTetsOfTheirFaces) {
    FoamBox box;
    box.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},   {1, 0, 1},
                  {0, 1, 1}, {1, 1, 0}, {1, 1, 1}, {2, .5, .5}, {.3, .3, 2}};
    // A wedge, a tet on its top, and a pyramid beside its slanted face.
    box.faces = {{3, 4, 5}, {1, 2, 5, 4}, {0, 2, 1}, {0, 3, 5, 2}, {0, 1, 4, 3}, {3, 4, 9},
                 {4, 5, 9}, {5, 3, 9},    {1, 8, 2}, {2, 8, 5},    {5, 8, 4},    {4, 8, 1}};
    box.owner = {0, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2};
    box.neighbour = {1, 2, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
    box.centres = {{.3, .3, .5}, {.3, .3, 1.3}, {.8, .5, .5}};
    box.patches = {{"sides", "patch", 2, 10}};
    write_case(folder_, foam_case(box, wave, {}));
    const auto report = survey(read_whole(folder_.file("")));
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->cells_by_type, (std::map<std::uint8_t, std::size_t>{{10, 1}, {13, 1}, {14, 1}}));
    EXPECT_EQ(report->negative_tets, 0u);
}

TEST_F(ReadOpenfoamCase, APointOnAWallHasTheValueOfTheWall) {
    const auto linear = [](const std::array<double, 3>& p) { return 10 + 4 * p[2]; };
    write_case(folder_, foam_case(box_, linear, {}));
    const Grid grid = read_whole(folder_.file(""));
    const Array& t = field_of(grid.point_fields, "T");
    const Array& u = field_of(grid.point_fields, "U");
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) {
        const double z = grid.points.at(i, 2);
        if (z == 0) {
            EXPECT_EQ(t.at(i), 10);
            EXPECT_EQ(u.at(i, 2), 30);
        } else if (z == 3) {
            EXPECT_NEAR(t.at(i), 10 + 4 * 2.5, 1e-12) << "no gradient: the cell's value";
        }
    }
    ReadOptions cells_only = last_step();
    cells_only.point_fields.emplace();
    EXPECT_TRUE(read(folder_.file(""), cells_only)->grid.point_fields.empty());
}

TEST_F(ReadOpenfoamCase, PatchesWithoutValuesOfTheirOwnAreLeftOut) {
    FoamFiles files = foam_case(box_, wave, {});
    for (const char* type : {"empty", "cyclic", "processor", "wedge", "zeroGradient"}) {
        std::string broken = files["0.5/T"];
        broken.replace(broken.find("fixedValue"), 10, type);
        files["0.5/T"] = broken;
        const TemporaryFolder folder;
        write_case(folder, files);
        const Grid grid = read_whole(folder.file(""));
        // The corner of the box: one cell.
        EXPECT_EQ(field_of(grid.point_fields, "T").at(0), field_of(grid.cell_fields, "T").at(0)) << type;
        files = foam_case(box_, wave, {});
    }
}

TEST_F(ReadOpenfoamCase, ValuesOfAPatchThatAreNoneAreNotUsed) {
    for (const std::string word : {"1e5", "calculated", "uniform", "#calc \"1 + 1\"", "$nothing", "nonuniform (1 x)"}) {
        FoamFiles files = foam_case(box_, wave, {});
        std::string& field = files["0.5/T"];
        const std::size_t value = field.find("value");
        ASSERT_NE(value, std::string::npos);
        field.replace(value, field.find(';', value) - value, "value " + word);
        write_case(folder_, files);
        const auto result = read(folder_.file(""), last_step());
        ASSERT_TRUE(result) << word << ": " << result.error().message;
        ASSERT_FALSE(result->notes.empty()) << word;
        EXPECT_NE(result->notes.back().find("/T: "), std::string::npos) << result->notes.back();
        EXPECT_TRUE(result->notes.back().ends_with(": it is not used")) << result->notes.back();
        EXPECT_TRUE(std::ranges::any_of(result->grid.point_fields, [](const Field& one) { return one.name == "T"; }));
    }
}

TEST_F(ReadOpenfoamCase, ValuesOfAPatchThatDoNotFitAreNotUsed) {
    FoamFiles files = foam_case(box_, wave, {});
    std::string& field = files["0.5/T"];
    const std::size_t value = field.find("value");
    ASSERT_NE(value, std::string::npos);
    field.replace(value, field.find(';', value) - value, "value nonuniform List<scalar> 0()");
    write_case(folder_, files);
    const auto result = read(folder_.file(""), last_step());
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_FALSE(result->notes.empty());
    EXPECT_EQ(result->notes.back(), "the value of patch 'heated' in T has 0 values, but 9 are wanted: it is not used");
}

TEST_F(ReadOpenfoamCase, HeadersMayHaveDictionaries) {
    FoamFiles files = foam_case(box_, wave, {});
    for (const char* name : {"constant/polyMesh/points", "0.5/T"}) {
        std::string& text = files[name];
        text.insert(text.find('}'), "meta { names (a b); inner { c 1; } }\n");
    }
    write_case(folder_, files);
    EXPECT_EQ(read_whole(folder_.file("")).cells.count(), box_.centres.size());
}

TEST_F(ReadOpenfoamCase, UnderstandsPatternsGroupsAndMacros) {
    FoamFiles files = foam_case(box_, wave, {});
    const auto wall_value = [&](const std::string& body) {
        files["0/T"] = foam_file("volScalarField", "T", {}, body);
        write_case(folder_, files);
        const auto result = read(folder_.file(""));
        EXPECT_TRUE(result) << result.error().message;
        return result ? field_of(result->grid.point_fields, "T").at(0) : 0;
    };
    const std::string known = "{ type fixedValue; value uniform 7; }";
    EXPECT_EQ(wall_value("internalField uniform 3; boundaryField { heated " + known + " }"), 7);
    EXPECT_EQ(wall_value("internalField uniform 3; boundaryField { \"(cooled|hea.*)\" " + known + " }"), 7);
    EXPECT_EQ(wall_value("internalField uniform 3; boundaryField { wall " + known + " }"), 7);
    EXPECT_EQ(wall_value("internalField uniform 3; boundaryField { \"cold.*\" " + known + " }"), 3);
    EXPECT_EQ(
        wall_value("hot 7; internalField uniform 3; boundaryField { heated { type fixedValue; value uniform $hot; } }"),
        7);
    EXPECT_EQ(
        wall_value("internalField uniform 3; boundaryField { heated { type fixedValue; value $internalField; } }"), 3);
    EXPECT_EQ(wall_value("internalField uniform 3; boundaryField { heated { type noSlip; } }"), 0);
    files["0/include/walls"] = "hot 7;\n";
    EXPECT_EQ(
        wall_value("#include \"include/walls\"\ninternalField uniform 3; boundaryField { heated { type fixedValue; "
                   "value uniform $hot; } }"),
        7);
}

TEST_F(ReadOpenfoamCase, SkipsTheTypesOfConstraintPatches) {
    FoamFiles files = foam_case(box_, wave, {});
    std::string& patches = files["constant/polyMesh/boundary"];
    const std::string without = patches;
    const auto wall = [&](const std::string& patch_type, const std::string& entries) {
        patches = without;
        patches.replace(patches.find("wall"), 4, patch_type);
        files["0.5/T"] =
            foam_file("volScalarField", "T", {}, "internalField uniform 3;\nboundaryField\n{\n" + entries + "\n}\n");
        const TemporaryFolder folder;
        write_case(folder, files);
        const auto result = read(folder.file(""), last_step());
        EXPECT_TRUE(result) << result.error().message;
        if (!result) return std::pair<double, std::size_t>();
        EXPECT_NE(result->notes.empty() ? 0 : result->notes[0].find("was not read"), std::string::npos);
        return std::pair(field_of(result->grid.point_fields, "T").at(0), result->notes.size());
    };
    const std::string etc = "#includeEtc \"caseDicts/setConstraintTypes\"\n",
                      all = "{ type fixedValue; value uniform 7; }";
    using Read = std::pair<double, std::size_t>;
    EXPECT_EQ(wall("wall", etc + "heated " + all), Read(7, 1));
    EXPECT_EQ(wall("wall", "\"hea.*\" " + all + etc), Read(7, 1));
    EXPECT_EQ(wall("symmetry", "\"hea.*\" " + all), Read(7, 0));
    for (const char* type :
         {"symmetry", "symmetryPlane", "empty", "wedge", "cyclicAMI", "processor", "nonConformalCyclic"})
        EXPECT_EQ(wall(type, etc + "\"hea.*\" " + all), Read(3, 1)) << type << ": its own entry comes before patterns";
    EXPECT_EQ(wall("symmetry", etc + "heated " + all), Read(7, 1));
    EXPECT_EQ(wall("wall", "#sincludeEtc \"caseDicts/mine\"\nheated " + all), Read(7, 1));
    EXPECT_EQ(wall("wall", "#include \"<etc>/caseDicts/setConstraintTypes\"\nheated " + all), Read(7, 1));
    EXPECT_EQ(wall("wall", "#includeIfPresent \"<etc>/caseDicts/mine\"\nheated " + all), Read(7, 1));
    EXPECT_EQ(wall("wall", "#includeIfPresent \"missing\"\nheated " + all), Read(7, 0));
    EXPECT_EQ(wall("wall", "heated { #includeEtc \"caseDicts/wall\"\n type fixedValue; value uniform 7; }"),
              Read(7, 1));
    EXPECT_EQ(wall("wall", "heated { #includeEtc \"caseDicts/wall\"\n }"), Read(3, 1));
    files["0.5/include/patches"] = etc + "heated " + all;
    EXPECT_EQ(wall("wall", "#include \"include/patches\""), Read(7, 1));
}

TEST_F(ReadOpenfoamCase, TellsOnceWhatItsFieldsInclude) {
    FoamFiles files = foam_case(box_, wave, {}, 2);
    for (auto& [name, text] : files)
        if (const std::size_t at = text.find("boundaryField"); at != std::string::npos)
            text.insert(text.find('{', at) + 1, "\n#includeEtc \"caseDicts/setConstraintTypes\"\n");
    write_case(folder_, files);
    const auto result = read(folder_.file(""), last_step());
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->notes.size(), 2u) << "the first is of the folders";
    EXPECT_EQ(result->notes[1],
              "'caseDicts/setConstraintTypes' of an OpenFOAM installation, which T, U include, was not "
              "read: a point on a patch without values has the mean of the cells around it");
}

TEST(FoamPatterns, FitWholeNames) {
    using io::foam::fits_pattern;
    for (const auto& [pattern, name] :
         std::vector<std::pair<const char*, const char*>>{{".*", "inlet"},
                                                          {"in.*", "inlet"},
                                                          {"(inlet|outlet)", "outlet"},
                                                          {"(in|out)let[0-9]+", "inlet12"},
                                                          {"a?b", "b"},
                                                          {"(ab)*c", "ababc"},
                                                          {"x\\.y", "x.y"},
                                                          {"[^a]b", "cb"}})
        EXPECT_TRUE(fits_pattern(pattern, name)) << pattern;
    for (const auto& [pattern, name] : std::vector<std::pair<const char*, const char*>>{{"in", "inlet"},
                                                                                        {"(inlet|outlet)", "outlets"},
                                                                                        {"[0-9]+", ""},
                                                                                        {"(a", "a"},
                                                                                        {"x\\.y", "xzy"},
                                                                                        {"[a", "a"}})
        EXPECT_FALSE(fits_pattern(pattern, name)) << pattern;
    EXPECT_FALSE(fits_pattern("(a*)*(a*)*(a*)*b", std::string(60, 'a'))) << "ends, at least";
}

class DecomposedCase : public ReadOpenfoamCase {};

TEST_F(DecomposedCase, IsTheWholeCaseByGlobalNumbers) {
    write_case(folder_, foam_case(box_, wave, {}));
    const Grid whole = read_whole(folder_.file(""));
    for (const int processors : {2, 3, 4})
        for (const bool binary : {false, true}) {
            const TemporaryFolder folder;
            write_case(folder, foam_case(box_, wave, {binary, 32, 64}, processors));
            expect_same_grid(read_whole(folder.file("")), whole);
        }
}

TEST_F(DecomposedCase, WithoutGlobalNumbersIsJoinedByCoordinates) {
    write_case(folder_, foam_case(box_, wave, {}));
    const auto whole = survey(read_whole(folder_.file("")));
    const TemporaryFolder folder;
    write_case(folder, foam_case(box_, wave, {true, 32, 64, false}, 3));
    const auto report = survey(read_whole(folder.file("")));
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->points, whole->points);
    EXPECT_EQ(report->cells_by_type, whole->cells_by_type);
    EXPECT_EQ(report->boundary_faces, whole->boundary_faces);
}

TEST_F(DecomposedCase, MayHaveProcessorsWithoutCells) {
    write_case(folder_, foam_case(box_, wave, {}));
    const Grid whole = read_whole(folder_.file(""));
    const FoamBox nothing = part_of(box_, std::vector<int>(box_.centres.size(), 0), 1);
    for (const bool addressing : {true, false}) {
        const FoamStyle style{false, 32, 64, addressing};
        FoamFiles files = foam_case(box_, wave, style, 2);
        add_mesh(files, "processor2/", nothing, style);
        for (const char* time : {"0/", "0.5/"})
            add_fields(files, std::string("processor2/") + time, nothing, wave, style);
        const TemporaryFolder folder;
        write_case(folder, files);
        const Grid grid = read_whole(folder.file(""));
        EXPECT_EQ(grid.cells.count(), whole.cells.count());
    }
}

Surface surface_of(const ContourInput& input, double isovalue, const ContourOptions& options) {
    return Contour::create(input, options).value().extract(isovalue).value().surfaces[0].surface;
}

TEST_F(DecomposedCase, PiecesGiveTheSurfaceOfTheWhole) {
    for (const bool addressing : {true, false}) {
        const TemporaryFolder folder;
        write_case(folder, foam_case(box_, wave, {true, 32, 64, addressing}, 4));
        const Grid grid = read_whole(folder.file(""));
        const ContourInput whole{grid, find_field(grid, "T").value(), {}, {}};
        for (const double isovalue : {1.5, 2.5, 5.0}) {
            std::vector<TriangleBits> together;
            for (std::size_t k = 0; k < 4; ++k) {
                const auto piece = take_piece(whole, {k, 4}).value();
                ContourOptions options;
                options.frame = piece.frame;
                add_triangles(surface_of(piece.input, isovalue, options), together);
            }
            const auto expected = triangle_set(surface_of(whole, isovalue, {}));
            EXPECT_GT(expected.size(), 20u);
            EXPECT_TRUE(sorted(std::move(together)) == expected) << isovalue;
        }
    }
}

TEST_F(DecomposedCase, IsReadWhereItHasLaterTimes) {
    FoamFiles files = foam_case(box_, wave, {}, 2);
    add_mesh(files, "", box_, {});
    add_fields(files, "0/", box_, wave, {});
    write_case(folder_, files);
    EXPECT_EQ(inspect(folder_.file(""))->times, (std::vector<double>{0, 0.5}));
    add_fields(files, "0.5/", box_, [](const auto&) { return 42.0; }, {});
    write_case(folder_, files);
    EXPECT_EQ(field_of(read_whole(folder_.file("")).cell_fields, "T").at(0), 42) << "the case's own is as complete";
}

TEST_F(DecomposedCase, HasNoDataWhereAProcessorLacksAField) {
    for (const int lacking : {1, 2}) {
        const TemporaryFolder folder;
        write_case(folder, foam_case(box_, wave, {}, 3));
        ReadOptions options = last_step();
        const auto whole = read(folder.file(""), options).value().grid;
        const std::string part = "processor" + std::to_string(lacking);
        ASSERT_TRUE(std::filesystem::remove(folder.file(part + "/0.5/T")));
        options.cell_fields = {"T"};
        const ReadResult result = read(folder.file(""), options).value();
        EXPECT_EQ(result.notes.at(1), part + " has no T at this time: there is no data");
        const Array &values = field_of(result.grid.cell_fields, "T"), &before = field_of(whole.cell_fields, "T");
        std::size_t missing = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            missing += std::isnan(values.at(i));
            EXPECT_TRUE(std::isnan(values.at(i)) || values.at(i) == before.at(i)) << i;
        }
        EXPECT_GT(missing, 0u);
        EXPECT_LT(missing, values.size() / 2);
    }
}

TEST_F(DecomposedCase, AMissingProcessorIsAnError) {
    write_case(folder_, foam_case(box_, wave, {}, 3));
    std::filesystem::remove_all(folder_.file("processor1"));
    const auto result = read(folder_.file(""));
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("processor1"), std::string::npos) << result.error().message;
}

class CollatedFoam : public ReadOpenfoamCase {
protected:
    std::string message_of(const FoamFiles& files) {
        const TemporaryFolder folder;
        write_case(folder, files);
        ReadOptions options = last_step();
        options.cell_fields = {"T"};
        const auto result = read(folder.file(""), options);
        return result ? "read" : result.error().message;
    }
};

TEST_F(CollatedFoam, IsTheWholeCase) {
    write_case(folder_, foam_case(box_, wave, {}));
    const Grid whole = read_whole(folder_.file(""));
    for (const bool binary : {false, true})
        for (const std::vector<int>& groups : {std::vector<int>{2}, {4}, {3, 1}, {1, 1, 2}}) {
            const TemporaryFolder folder;
            const int processors = std::accumulate(groups.begin(), groups.end(), 0);
            SCOPED_TRACE(
                fmt::format("{} processors in {} folders{}", processors, groups.size(), binary ? ", binary" : ""));
            write_case(folder,
                       collated(foam_case(box_, wave, {binary, 32, 64}, processors), groups, groups.size() > 1));
            expect_same_grid(read_whole(folder.file("")), whole);
            const auto info = inspect(folder.write("a.foam", ""));
            ASSERT_TRUE(info) << info.error().message;
            EXPECT_EQ(info->times, (std::vector<double>{0, 0.5}));
            EXPECT_EQ(info->fields.size(), 4u);
        }
}

TEST_F(CollatedFoam, PlainFoldersGoFirst) {
    FoamFiles files = foam_case(box_, wave, {}, 2);
    for (const auto& [name, content] : collated(files, {2}, false)) files[name] = name.ends_with("/T") ? "" : content;
    write_case(folder_, files);
    EXPECT_EQ(read_whole(folder_.file("")).cells.count(), 34u);
}

TEST_F(CollatedFoam, ANameAloneTakesNoTimeOrMemory) {
    write_case(folder_, foam_case(box_, wave, {}));
    std::filesystem::create_directories(folder_.file("processors1000000/constant"));
    const auto result = read(folder_.file(""));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->notes.front(), "1000000 processor folders were not read: the case's own folder is as complete");
    std::filesystem::remove_all(folder_.file("constant"));
    EXPECT_NE(read(folder_.file("")).error().message.find("a case has its mesh in constant/polyMesh"),
              std::string::npos);
}

TEST_F(CollatedFoam, FoldersThatLackProcessorsAreErrors) {
    const FoamFiles files = collated(foam_case(box_, wave, {}, 4), {1, 1, 2}, true);
    for (const char* missing : {"processors4_0-0", "processors4_1-1", "processors4_2-3"}) {
        FoamFiles some;
        for (const auto& [name, content] : files)
            if (!name.starts_with(missing)) some[name] = content;
        EXPECT_NE(message_of(some).find("processor"), std::string::npos) << missing;
    }
    FoamFiles twice = files;
    for (const auto& [name, content] : collated(foam_case(box_, wave, {}, 2), {2}, false)) twice[name] = content;
    EXPECT_NE(message_of(twice).find("another number of processors"), std::string::npos) << message_of(twice);
}

TEST_F(CollatedFoam, BrokenBlocksAreErrorsThatNameTheFile) {
    const FoamFiles files = collated(foam_case(box_, wave, {true, 32, 64}, 3), {3}, false);
    for (const char* name : {"processors3/constant/polyMesh/points", "processors3/0.5/T"}) {
        FoamFiles changed = files;
        std::string& content = changed.at(name);
        const std::string whole = content;
        for (std::size_t length = 20; length < whole.size() - 2; length += whole.size() / 40 + 1) {
            content = whole.substr(0, length);
            EXPECT_NE(message_of(changed).find(name), std::string::npos)
                << name << " cut to " << length << ": " << message_of(changed);
        }
        content = whole + "\n0\n";
        EXPECT_NE(message_of(changed).find("more blocks"), std::string::npos) << message_of(changed);
        content = whole.substr(0, whole.find("// Processor2"));
        EXPECT_NE(message_of(changed).find("fewer blocks"), std::string::npos) << message_of(changed);
        content = whole;
        content.insert(content.find("// Processor1") + 15, "99999999999");
        EXPECT_NE(message_of(changed).find("bytes"), std::string::npos) << message_of(changed);
    }
}

class BrokenOpenfoam : public ReadOpenfoamCase {
protected:
    /// Of a field file: where that field is asked for.
    std::string message_of(const std::string& name, const std::string& content, ReadOptions options = last_step()) {
        folder_.write(name, content);
        if (name.starts_with("0.5/")) options.cell_fields = {name.substr(4)};
        const auto result = read(folder_.file(""), options);
        if (result) return "read";
        EXPECT_TRUE(result.error().code == ErrorCode::invalid_data || result.error().code == ErrorCode::file);
        return result.error().message;
    }
};

TEST_F(BrokenOpenfoam, EveryTruncationIsAnErrorThatNamesTheFile) {
    for (const bool binary : {false, true}) {
        const FoamFiles files =
            foam_case(foam_box(2, [](int x, int y, int z) { return x + y + z == 0; }), wave, {binary, 32, 64});
        write_case(folder_, files);
        for (const char* name : {"constant/polyMesh/points", "constant/polyMesh/faces", "constant/polyMesh/owner",
                                 "constant/polyMesh/neighbour", "constant/polyMesh/boundary", "0.5/T", "0.5/U"}) {
            const std::string& content = files.at(name);
            const std::size_t end = content.find_last_not_of(" \n");
            const std::size_t first = content.find("FoamFile") + 8;
            for (std::size_t length = first; length < end; length += 1 + content.size() / 40) {
                const std::string message = message_of(name, content.substr(0, length));
                ASSERT_NE(message.find(name), std::string::npos) << name << " cut to " << length << ": " << message;
            }
            folder_.write(name, content);
        }
        EXPECT_TRUE(read(folder_.file(""), last_step()));
    }
}

TEST_F(BrokenOpenfoam, AFieldThatCannotBeReadLeavesTheOthers) {
    for (const int processors : {0, 2}) {
        const TemporaryFolder folder;
        const FoamFiles files = foam_case(box_, wave, {}, processors);
        write_case(folder, files);
        std::filesystem::remove_all(folder.file(processors ? "constant" : "none"));
        const std::string name = processors ? "processor1/0.5/T" : "0.5/T";
        const std::string& content = files.at(name);
        const std::size_t header = content.find("class"), end = content.find_last_not_of(" \n");
        for (const std::size_t length : {std::size_t{0}, header, content.find("internalField") + 5, end - 1}) {
            folder.write(name, content.substr(0, length));
            const auto result = read(folder.file(""), last_step());
            ASSERT_TRUE(result) << result.error().message;
            EXPECT_EQ(field_of(result->grid.cell_fields, "U").tuples(), box_.centres.size());
            ASSERT_EQ(result->info.left_out.size(), 1u) << length;
            EXPECT_EQ(result->info.left_out[0].name, "T");
            EXPECT_NE(result->info.left_out[0].reason.find(name), std::string::npos) << result->info.left_out[0].reason;
            ReadOptions options = last_step();
            options.point_fields = {"U"};
            EXPECT_TRUE(read(folder.file(""), options));
            options.point_fields = {"T"};
            const auto refused = read(folder.file(""), options);
            ASSERT_FALSE(refused);
            EXPECT_NE(refused.error().message.find(name), std::string::npos) << refused.error().message;
        }
    }
}

TEST_F(BrokenOpenfoam, AFieldOfAnotherTimeIsNotTold) {
    const FoamFiles files = foam_case(box_, wave, {});
    write_case(folder_, files);
    folder_.write("0.25/T", files.at("0.5/T").substr(0, 30));
    ReadOptions options;
    options.step = 2;
    const auto sound = read(folder_.file(""), options);
    ASSERT_TRUE(sound) << sound.error().message;
    EXPECT_TRUE(sound->info.left_out.empty());
    EXPECT_EQ(field_of(sound->grid.cell_fields, "T").tuples(), box_.centres.size());
    options.step = 1;
    const auto other = read(folder_.file(""), options);
    ASSERT_TRUE(other) << other.error().message;
    ASSERT_EQ(other->info.left_out.size(), 1u);
    EXPECT_NE(other->info.left_out[0].reason.find("0.25/T"), std::string::npos);
}

TEST_F(BrokenOpenfoam, ChangedBytesAreErrorsOrAGridThatIsConsistent) {
    std::mt19937 random(7);
    for (const int processors : {0, 2})
        for (const bool binary : {false, true}) {
            const FoamFiles files =
                foam_case(foam_box(2, [](int x, int, int) { return x == 0; }), wave, {binary, 32, 64}, processors);
            write_case(folder_, files);
            std::filesystem::remove_all(folder_.file(processors ? "constant" : "none"));
            for (int trial = 0; trial < 50; ++trial) {
                auto file = files.begin();
                std::advance(file, random() % files.size());
                std::string content = file->second;
                for (int k = 0; k < 2; ++k) content[random() % content.size()] = "0123456789-(){}; \xff"[random() % 18];
                folder_.write(file->first, content);
                const auto result = read(folder_.file(""), last_step());
                if (!result) {
                    EXPECT_NE(result.error().code, ErrorCode::internal) << result.error().message;
                }
                folder_.write(file->first, file->second);
            }
        }
}

TEST_F(BrokenOpenfoam, HugeCountsTakeNoMemory) {
    write_case(folder_, foam_case(box_, wave, {}));
    const auto list = [](const char* type, const char* body) { return foam_file(type, "x", {}, body); };
    EXPECT_NE(message_of("constant/polyMesh/points", list("vectorField", "2000000000\n((0 0 0))")), "read");
    EXPECT_NE(message_of("constant/polyMesh/points", list("vectorField", "2000000000{(0 0 0)}")), "read");
    write_case(folder_, foam_case(box_, wave, {}));
    EXPECT_NE(message_of("constant/polyMesh/owner", list("labelList", "2000000000{0}")), "read");
    std::string faces;
    for (std::size_t i = 0; i < box_.faces.size(); ++i) faces += "2000000000 ";
    EXPECT_NE(message_of("constant/polyMesh/owner", list("labelList", ("(" + faces + ")").c_str())), "read");
    write_case(folder_, foam_case(box_, wave, {}));
    EXPECT_NE(message_of("0.5/T", list("volScalarField", "internalField nonuniform List<scalar> 2000000000{0};")),
              "read");
}

TEST_F(BrokenOpenfoam, NothingIsRunAndNothingOutsideIsRead) {
    const FoamFiles files = foam_case(box_, wave, {});
    write_case(folder_, files);
    const TemporaryFolder other;
    const std::string secret = other.write("secret", "hot 7;\n");
    const std::string rest = "\ninternalField uniform 3;\nboundaryField { }\n";
    const auto field = [&](const std::string& body) {
        return message_of("0.5/T", foam_file("volScalarField", "T", {}, body));
    };
    EXPECT_NE(field("#include \"" + secret + "\"" + rest).find("`allow_outside`"), std::string::npos);
    EXPECT_NE(field("#include \"../../secret\"" + rest).find("`allow_outside`"), std::string::npos);
    for (const std::string word : {"#includeEtc \"", "#sincludeEtc \"", "#include \"<etc>/"})
        EXPECT_NE(
            field(word + "caseDicts/values\"" + rest).find("outside of boundaryField, where it may define values"),
            std::string::npos);
    EXPECT_NE(field("#includeIfPresent \"../../secret\"" + rest).find("`allow_outside`"), std::string::npos);
    EXPECT_NE(field("internalField uniform #calc \"1+1\";").find("nothing in a file is run"), std::string::npos);
    EXPECT_NE(field("#codeStream { code #{ x #}; }" + rest).find("nothing in a file is run"), std::string::npos);
    EXPECT_NE(field("#include \"T\"" + rest).find("in one another"), std::string::npos);
    EXPECT_NE(field("internalField $internalField;").find("not defined"), std::string::npos);
    ReadOptions outside = last_step();
    outside.allow_outside = true;
    folder_.write("0.5/T", foam_file("volScalarField", "T", {}, "#include \"" + secret + "\"" + rest));
    EXPECT_TRUE(read(folder_.file(""), outside));
    folder_.write("0.5/T", foam_file("volScalarField", "T", {}, "#includeEtc \"caseDicts/values\"" + rest));
    EXPECT_TRUE(read(folder_.file(""), outside));
    write_case(folder_, files);
    std::filesystem::remove(folder_.file("constant/polyMesh/owner"));
    const std::string owner = other.write("owner", files.at("constant/polyMesh/owner"));
    std::filesystem::create_symlink(owner, folder_.file("constant/polyMesh/owner"));
    const auto linked = read(folder_.file(""), last_step());
    ASSERT_FALSE(linked);
    EXPECT_NE(linked.error().message.find("`allow_outside`"), std::string::npos) << linked.error().message;
    EXPECT_TRUE(read(folder_.file(""), outside));
}

TEST_F(BrokenOpenfoam, APipeIsAnErrorAndNotWaitedFor) {
    write_case(folder_, foam_case(box_, wave, {}));
    std::filesystem::remove(folder_.file("constant/polyMesh/owner"));
    ASSERT_EQ(::mkfifo(folder_.file("constant/polyMesh/owner").c_str(), 0600), 0);
    const auto result = read(folder_.file(""));
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("owner"), std::string::npos) << result.error().message;
}

std::string gzip(const std::string& text) {
    libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
    std::string out(libdeflate_gzip_compress_bound(compressor, text.size()), '\0');
    out.resize(libdeflate_gzip_compress(compressor, text.data(), text.size(), out.data(), out.size()));
    libdeflate_free_compressor(compressor);
    return out;
}

TEST_F(ReadOpenfoamCase, TakesPackedFiles) {
    const FoamFiles files = foam_case(box_, wave, {});
    write_case(folder_, files);
    const Grid expected = read_whole(folder_.file(""));
    const TemporaryFolder packed;
    for (const auto& [name, content] : files) packed.write(name + ".gz", gzip(content));
    expect_same_grid(read_whole(packed.file("")), expected);
    const std::string owner = gzip(files.at("constant/polyMesh/owner"));
    for (std::size_t length = 1; length < owner.size(); length += 9) {
        packed.write("constant/polyMesh/owner.gz", owner.substr(0, length));
        EXPECT_FALSE(read(packed.file(""))) << length;
    }
}

TEST_F(ReadOpenfoamCase, RegionsAreJoined) {
    FoamFiles files;
    FoamBox beside = box_;
    double width = 0;
    for (const auto& point : box_.points) width = std::max(width, point[0]);
    std::size_t shared = 0;
    for (auto& point : beside.points) {
        shared += point[0] == 0;
        point[0] += width;
    }
    for (const auto& [region, box] : {std::pair<const char*, const FoamBox*>("air", &box_), {"iron", &beside}})
        for (const auto& [name, content] : foam_case(*box, wave, {})) {
            const std::size_t slash = name.find('/');
            files[name.substr(0, slash + 1) + region + name.substr(slash)] = content;
        }
    write_case(folder_, files);
    const Grid grid = read_whole(folder_.file(""));
    EXPECT_EQ(grid.points.tuples(), 2 * box_.points.size() - shared);
    EXPECT_EQ(grid.cells.count(), 2 * box_.centres.size());
    EXPECT_EQ(field_of(grid.cell_fields, "T").tuples(), 2 * box_.centres.size());
}

TEST_F(ReadOpenfoamCase, RegionsAreBlocks) {
    FoamFiles files;
    const FoamBox large = foam_box(4, in_the_middle);
    for (const auto& [region, box] : {std::pair<const char*, const FoamBox*>("air", &box_), {"iron", &large}})
        for (const auto& [name, content] : foam_case(*box, wave, {})) {
            const std::size_t slash = name.find('/');
            files[name.substr(0, slash + 1) + region + name.substr(slash)] = content;
        }
    write_case(folder_, files);
    const auto info = inspect(folder_.file(""));
    ASSERT_TRUE(info) << info.error().message;
    ASSERT_EQ(info->blocks.size(), 2u);
    EXPECT_EQ(info->blocks[1].name, "iron");
    EXPECT_EQ(info->blocks[1].number, 2);
    for (const char* asked : {"iron", "2"}) {
        ReadOptions options = last_step();
        options.blocks = {asked};
        const auto iron = read(folder_.file(""), options);
        ASSERT_TRUE(iron) << iron.error().message;
        EXPECT_EQ(iron->grid.cells.count(), large.centres.size());
        EXPECT_EQ(iron->info.blocks[1].cells, large.centres.size());
    }
    ReadOptions wrong;
    wrong.blocks = {"steel"};
    const auto refused = read(folder_.file(""), wrong);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("1 'air', 2 'iron'"), std::string::npos) << refused.error().message;
}

} // namespace
} // namespace isotet::test
