// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight Gold in all its forms, whole, and cut or changed: an error, never zeros.
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "support/temporary_folder.hpp"
#include "vtk_readers/gold_text.hpp"
#include "vtk_readers/whole_or_error.hpp"

namespace isotet::test {
namespace {

/// Two tetrahedra and a pyramid in two parts, with a scalar and a vector of nodes and a scalar of elements.
class EnsightFiles : public testing::TestWithParam<GoldForm> {
protected:
    static std::string geometry() {
        GoldText file(GetParam(), true);
        file.line("two parts").line("for a test").line("node id given").line("element id off");
        file.line("part").integers({1}).line("solid").line("coordinates").integers({5}).integers({1, 2, 3, 4, 5});
        for (const auto& axis : {std::vector<float>{0, 1, 0, 0, 0}, {0, 0, 1, 0, 0}, {0, 0, 0, 1, -1}})
            file.floats(axis);
        file.line("tetra4").integers({2}).integers({1, 2, 3, 4, 1, 3, 2, 5}, 4);
        file.line("part").integers({2}).line("roof").line("coordinates").integers({5}).integers({1, 2, 3, 4, 5});
        for (const auto& axis : {std::vector<float>{5, 6, 6, 5, 5}, {0, 0, 1, 1, 0}, {0, 0, 0, 0, 1}})
            file.floats(axis);
        file.line("pyramid5").integers({1}).integers({1, 2, 3, 4, 5}, 5);
        return file.text();
    }
    static std::string of_nodes(std::size_t components) {
        GoldText file(GetParam());
        file.line("of nodes");
        for (int part = 1; part <= 2; ++part) {
            file.line("part").integers({part}).line("coordinates");
            for (std::size_t c = 0; c < components; ++c) file.floats({1, 2, 3, 4, 5});
        }
        return file.text();
    }
    static std::string of_elements() {
        GoldText file(GetParam());
        file.line("of elements");
        file.line("part").integers({1}).line("tetra4").floats({7, 8});
        return file.line("part").integers({2}).line("pyramid5").floats({9}).text();
    }

    Result<ReadResult> read_with(const std::string& name, const std::string& text) {
        folder_.write("grid.geo", geometry());
        folder_.write("t.scl", of_nodes(1));
        folder_.write("v.vec", of_nodes(3));
        folder_.write("e.scl", of_elements());
        if (!name.empty()) folder_.write(name, text);
        return whole(read(folder_.write("a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nVARIABLE\n"
                                                  "scalar per node: t t.scl\nvector per node: v v.vec\n"
                                                  "scalar per element: e e.scl\n")));
    }

    TemporaryFolder folder_;
};

TEST_P(EnsightFiles, AreReadWhole) {
    const auto result = read_with("", "");
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 3u);
    EXPECT_EQ(result->grid.point_fields.size(), 2u);
    ASSERT_EQ(result->grid.cell_fields.size(), 1u);
    EXPECT_EQ(result->grid.cell_fields[0].values.at(2), 9);
}

TEST(EnsightText, MayHaveByteOrderMarksAndWindowsLineEnds) {
    const TemporaryFolder folder;
    const auto write = [&](const std::string& name, const std::string& text) {
        std::string windows = "\xef\xbb\xbf";
        for (const char c : text) windows += c == '\n' ? "\r\n" : std::string(1, c);
        return folder.write(name, windows);
    };
    const std::string step = "BEGIN TIME STEP\n", end = "END TIME STEP\n";
    std::string grid = "two lines\nof text\nnode id off\nelement id off\npart\n1\nsolid\ncoordinates\n4\n";
    for (const char* axis : {"0\n1\n0\n0\n", "0\n0\n1\n0\n", "0\n0\n0\n1\n"}) grid += axis;
    grid += "tetra4\n1\n1 2 3 4\n";
    write("a.geo", step + grid + end);
    write("a.n", step + "of nodes\npart\n1\ncoordinates\n5\n6\n7\n8\n" + end);
    write("times", "0.25\n0.5\n");
    const auto result = read(write("a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: a.geo\nVARIABLE\n"
                                             "scalar per node: 1 1 n a.n\nTIME\ntime set: 1\nnumber of steps: 1\n"
                                             "time values file: times\nFILE\nfile set: 1\nnumber of steps: 1\n"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.times, std::vector<double>{0.25});
    ASSERT_EQ(result->grid.cells.count(), 1u);
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(result->grid.point_fields[0].values.at(3), 8);
}

TEST_P(EnsightFiles, MayHaveQuotesAndBlanksInNamesAndFilesThatAreMissing) {
    folder_.write("the grid.geo", geometry());
    folder_.write("t 1.scl", of_nodes(1));
    folder_.write("e.scl", of_elements());
    folder_.write("cut.scl", of_nodes(1).substr(0, 200));
    const std::string path = folder_.write(
        "a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: 1 \"the grid.geo\"\nVARIABLE\n"
                  "scalar per node: 1 wall temperature \"t *.scl\"\nscalar per node: gone gone.scl\n"
                  "vector per node: 'cut' cut.scl\nscalar per element: 1 \"e\" \"e.scl\"\n"
                  "TIME\ntime set: 1\nnumber of steps: 2\nfilename start number: 1\nfilename increment: 1\n"
                  "time values: 0.05\n   0.1\n");
    const auto result = read(path);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.times, (std::vector<double>{0.05, 0.1})) << "as they are in the case";
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(result->grid.point_fields[0].name, "wall temperature");
    ASSERT_EQ(result->grid.cell_fields.size(), 1u);
    EXPECT_EQ(result->grid.cell_fields[0].values.at(2), 9);
    ASSERT_EQ(result->info.left_out.size(), 2u);
    EXPECT_EQ(result->info.left_out[0].name, "gone");
    EXPECT_NE(result->info.left_out[0].reason.find("gone.scl: there is no such file"), std::string::npos);
    EXPECT_EQ(result->info.left_out[1].name, "cut");
    ReadOptions asked;
    asked.point_fields = {"gone"};
    const auto error = read(path, asked);
    ASSERT_FALSE(error);
    EXPECT_NE(error.error().message.find("gone.scl"), std::string::npos) << error.error().message;
}

TEST_P(EnsightFiles, MayHaveEmptyPartsAndSectionsThatAreNotRead) {
    GoldText file(GetParam(), true);
    file.line("a").line("b").line("node id off").line("element id off").line("part").integers({3}).line("nothing");
    file.line("part").integers({1}).line("solid").line("coordinates").integers({4});
    for (const auto& axis : {std::vector<float>{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}) file.floats(axis);
    file.line("tetra4").integers({1}).integers({1, 2, 3, 4}, 4);
    folder_.write("grid.geo", file.line("part").integers({2}).line("nothing").text());
    for (const char* number : {"3", "5"}) {
        GoldText values(GetParam());
        values.line("t").line("part").integers({1}).line("coordinates");
        folder_.write(std::string("t") + number, values.floats(std::vector<float>(4, number[0] == '3' ? 3 : 5)).text());
    }
    folder_.write("numbers", "3\n5\n");
    folder_.write("times", "0\n1.5e-1\n");
    const std::string path = folder_.write(
        "a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nVARIABLE\nscalar per node: 1 t t*\n"
                  "MATERIAL\nmaterial set number: 1 m\nmaterial id count: 2\nBLOCK CONTINUATION\nnumber of sets: 1\n"
                  "TIME\ntime set: 1\nnumber of steps: 2\nfilename numbers file: numbers\ntime values file: times\n"
                  "SCRIPTS\nmetadata: x.xml\n");
    ReadOptions last;
    last.step = 1;
    const auto result = read(path, last);
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_FALSE(result->info.left_out.empty()) << "which is told";
    EXPECT_EQ(result->info.left_out.front().name, "MATERIAL");
    EXPECT_EQ(result->info.left_out.back().name, "SCRIPTS");
    EXPECT_EQ(result->info.times, (std::vector<double>{0, 0.15}));
    EXPECT_EQ(result->grid.cells.count(), 1u);
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(result->grid.point_fields[0].values.at(3), 5);
    const std::string outside = folder_.write(
        "b.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nTIME\ntime set: 1\nnumber of steps: 1\n"
                  "filename start number: 1\nfilename increment: 1\ntime values file: /etc/hostname\n");
    EXPECT_FALSE(read(outside));
}

TEST_P(EnsightFiles, MayHaveRecordsWithoutValues) {
    GoldText file(GetParam(), true), values(GetParam());
    file.line("a").line("b").line("node id given").line("element id given");
    values.line("t");
    const std::vector<std::int32_t> nothing;
    for (const std::int32_t part : {1, 2, 3}) {
        file.line("part").integers({part}).line("p").line("coordinates").integers({part == 2 ? 4 : 0});
        values.line("part").integers({part}).line("coordinates");
        if (part == 2) {
            file.integers({5, 6, 7, 8});
            for (const auto& axis : {std::vector<float>{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}) file.floats(axis);
            file.line("tetra4").integers({1}).integers({9}).integers({1, 2, 3, 4}, 4);
            values.floats({1, 2, 3, 4});
            continue;
        }
        file.integers(nothing).floats({}).floats({}).floats({}); // for Fortran a record each
        file.line("tetra4").integers({0}).integers(nothing).integers(nothing);
        values.floats({});
    }
    folder_.write("grid.geo", file.text());
    folder_.write("t", values.text());
    const auto result = whole(read(folder_.write(
        "a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nVARIABLE\nscalar per node: t t\n")));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 1u);
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(result->grid.point_fields[0].values.at(3), 4);
}

TEST_P(EnsightFiles, VariablesThatAreCutAreErrorsThatNameTheFile) {
    for (const auto& [name, whole] :
         {std::pair("t.scl", of_nodes(1)), {"v.vec", of_nodes(3)}, {"e.scl", of_elements()}}) {
        const std::size_t second_part = whole.find("part", whole.find("part") + 1);
        const std::size_t first_end = second_part - (GetParam() == GoldForm::fortran ? 4 : 0);
        std::vector<std::size_t> lengths{first_end + 3, whole.size() - 6};
        if (whole == of_nodes(1)) lengths.insert(lengths.end(), {0, 3, first_end - 3, whole.size() - 2});
        for (const std::size_t length : lengths) {
            const auto result = read_with(name, whole.substr(0, length));
            ASSERT_FALSE(result) << name << " cut to " << length << " of " << whole.size() << " bytes";
            EXPECT_NE(result.error().message.find(name), std::string::npos) << result.error().message;
        }
    }
}

TEST_P(EnsightFiles, GeometryThatIsCutIsAnErrorThatNamesTheFile) {
    const std::string whole = geometry();
    const std::size_t cells = whole.find("tetra4");
    for (const std::size_t length :
         {std::size_t{3}, cells / 2, cells - 6, cells + 3, whole.size() - 6, whole.size() - 2}) {
        const auto result = read_with("grid.geo", whole.substr(0, length));
        ASSERT_FALSE(result) << "cut to " << length << " of " << whole.size() << " bytes";
        EXPECT_NE(result.error().message.find("grid.geo"), std::string::npos)
            << "cut to " << length << " of " << whole.size() << " bytes: " << result.error().message;
    }
}

TEST_P(EnsightFiles, CountsThatDoNotFitAreErrors) {
    for (const std::int32_t count : {-1, 6, 2'000'000'000}) {
        GoldText nodes(GetParam(), true), elements(GetParam(), true);
        for (GoldText* file : {&nodes, &elements})
            file->line("a").line("b").line("node id off").line("element id off").line("part").integers({1}).line("c");
        nodes.line("coordinates").integers({count}).floats({0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1});
        nodes.line("tetra4").integers({1}).integers({1, 2, 3, 4}, 4);
        elements.line("coordinates").integers({4});
        for (const auto& axis : {std::vector<float>{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}) elements.floats(axis);
        elements.line("tetra4").integers({count}).integers({1, 2, 3, 4}, 4);
        EXPECT_FALSE(read_with("grid.geo", nodes.text())) << count << " nodes";
        EXPECT_FALSE(read_with("grid.geo", elements.text())) << count << " elements";
    }
}

TEST_P(EnsightFiles, AreErrorsWhereverAFileIsCut) {
    expect_whole_or_error({{"grid.geo", geometry()},
                           {"t.scl", of_nodes(1)},
                           {"v.vec", of_nodes(3)},
                           {"e.scl", of_elements()},
                           {"a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nVARIABLE\n"
                                      "scalar per node: t t.scl\nvector per node: v v.vec\n"
                                      "scalar per element: e e.scl\n"}});
}

TEST_P(EnsightFiles, WithElementsThatHaveNoValuesAreErrors) {
    GoldText file(GetParam());
    file.line("of elements").line("part").integers({1}).line("tetra4").floats({7, 8});
    EXPECT_TRUE(read_with("e.scl", file.text())) << "values of one part";
    GoldText geometry(GetParam(), true);
    geometry.line("a").line("b").line("node id off").line("element id off").line("part").integers({1}).line("c");
    geometry.line("coordinates").integers({5});
    for (const auto& axis : {std::vector<float>{0, 1, 1, 0, 0}, {0, 0, 1, 1, 0}, {0, 0, 0, 0, 1}})
        geometry.floats(axis);
    geometry.line("tetra4").integers({1}).integers({1, 2, 3, 5}, 4).line("pyramid5").integers({1});
    folder_.write("grid.geo", geometry.integers({1, 2, 3, 4, 5}, 5).text());
    folder_.write("e.scl", GoldText(GetParam()).line("e").line("part").integers({1}).line("tetra4").floats({7}).text());
    const auto result = whole(read(folder_.write("b.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\n"
                                                           "VARIABLE\nscalar per element: e e.scl\n")));
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("1 elements \"pyramid5\", but there are no values"), std::string::npos)
        << result.error().message;
}

TEST_P(EnsightFiles, BlocksAndComplexVariablesAreReadWhole) {
    const auto numbered = [](int count) {
        std::vector<float> values;
        for (int i = 0; i < count; ++i) values.push_back(static_cast<float>(i));
        return values;
    };
    for (const std::string kind : {"block uniform", "block rectilinear", "block", "block iblanked"}) {
        GoldText geometry(GetParam(), true), nodes(GetParam()), cells(GetParam());
        geometry.line("a").line("b").line("node id off").line("element id off").line("part").integers({1}).line("c");
        geometry.line(kind).integers({4, 3, 3}, 3);
        if (kind == "block uniform") {
            geometry.floats({0, 0, 0}).floats({1, 1, 1});
        } else if (kind == "block rectilinear") {
            geometry.floats({0, 1, 2, 3}).floats({0, 1, 2}).floats({0, 1, 2});
        } else {
            std::vector<float> axes[3];
            for (int i = 0; i < 36; ++i) {
                axes[0].push_back(static_cast<float>(i % 4));
                axes[1].push_back(static_cast<float>(i / 4 % 3));
                axes[2].push_back(static_cast<float>(i / 12));
            }
            for (const auto& axis : axes) geometry.floats(axis);
        }
        if (kind == "block iblanked") geometry.integers(std::vector<std::int32_t>(36, 1));
        nodes.line("n").line("part").integers({1}).line("block").floats(numbered(36));
        cells.line("c").line("part").integers({1}).line("block").floats(numbered(12));
        const EnsightFolder files{{"grid.geo", geometry.text()},
                                  {"n", nodes.text()},
                                  {"c", cells.text()},
                                  {"a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nVARIABLE\n"
                                             "scalar per node: n n\nscalar per element: c c\n"
                                             "complex scalar per node: z n n 1.0\n"}};
        expect_whole_or_error(files);
        const auto result = read_ensight(folder_, files);
        ASSERT_TRUE(result) << kind << ": " << result.error().message;
        EXPECT_EQ(result->grid.cells.count(), 12u);
        EXPECT_EQ(result->grid.points.at(35, 0), 3);
        EXPECT_EQ(result->grid.point_fields.at(0).values.at(35), 35);
        EXPECT_EQ(result->grid.point_fields.at(1).values.at(35, 1), 35);
        EXPECT_EQ(result->grid.cell_fields.at(0).values.at(11), 11);
    }
}

TEST_P(EnsightFiles, BlocksOfOneLayerOfPointsAreQuadrilaterals) {
    GoldText geometry(GetParam(), true), cells(GetParam());
    geometry.line("a").line("b").line("node id off").line("element id off").line("part").integers({1}).line("c");
    geometry.line("block uniform").integers({4, 3, 1}, 3).floats({0, 0, 0}).floats({1, 1, 1});
    cells.line("c").line("part").integers({1}).line("block").floats({0, 1, 2, 3, 4, 5});
    const auto result = read_ensight(folder_, {{"grid.geo", geometry.text()},
                                               {"c", cells.text()},
                                               {"a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\n"
                                                          "VARIABLE\nscalar per element: c c\n"}});
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->grid.cells.count(), 6u);
    EXPECT_EQ(result->grid.cells.types.at(5), 9);
    EXPECT_EQ(result->grid.cell_fields.at(0).values.at(5), 5);
}

TEST_P(EnsightFiles, CellsOfBlocksThatAreBlankedOrGhostsAreLeftOut) {
    for (const std::string kind : {"block uniform iblanked", "block uniform with_ghost", "block uniform range"}) {
        GoldText geometry(GetParam(), true), cells(GetParam());
        geometry.line("a").line("b").line("node id off").line("element id off").line("part").integers({1}).line("c");
        const bool range = kind.ends_with("range");
        geometry.line(kind).integers({range ? 9 : 4, 2, 2}, 3);
        if (range) geometry.integers({3, 6, 1, 2, 1, 2}, 6);
        geometry.floats({0, 0, 0}).floats({1, 1, 1});
        if (kind.ends_with("iblanked")) geometry.integers({1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
        if (kind.ends_with("with_ghost")) geometry.line("ghost_flags").integers({0, 0, 1});
        geometry.line("part").integers({2}).line("d").line("coordinates").integers({4});
        for (const auto& axis : {std::vector<float>{9, 10, 9, 9}, {0, 0, 1, 0}, {0, 0, 0, 1}}) geometry.floats(axis);
        geometry.line("tetra4").integers({1}).integers({1, 2, 3, 4}, 4);
        cells.line("c").line("part").integers({1}).line("block").floats({1, 2, 3});
        cells.line("part").integers({2}).line("tetra4").floats({4});
        const auto result = read_ensight(folder_, {{"grid.geo", geometry.text()},
                                                   {"c", cells.text()},
                                                   {"a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\n"
                                                              "VARIABLE\nscalar per element: c c\n"}});
        ASSERT_TRUE(result) << kind << ": " << result.error().message;
        ASSERT_EQ(result->grid.cells.count(), range ? 4u : 3u) << kind;
        for (const std::size_t i : {0u, 1u}) EXPECT_EQ(result->grid.cell_fields.at(0).values.at(i), i + 1.0);
        EXPECT_EQ(result->grid.cell_fields.at(0).values.at(range ? 3 : 2), 4);
    }
}

TEST_P(EnsightFiles, GhostElementsAreLeftOutWithOrWithoutTheirValues) {
    for (const bool valued : {true, false}) {
        GoldText geometry(GetParam(), true), values(GetParam());
        geometry.line("a").line("b").line("node id off").line("element id off").line("part").integers({1}).line("c");
        geometry.line("coordinates").integers({5});
        for (const auto& axis : {std::vector<float>{0, 1, 0, 0, 0}, {0, 0, 1, 0, 0}, {0, 0, 0, 1, -1}})
            geometry.floats(axis);
        geometry.line("g_tetra4").integers({1}).integers({1, 2, 3, 4}, 4);
        geometry.line("tetra4").integers({1}).integers({1, 3, 2, 5}, 4);
        values.line("e").line("part").integers({1});
        if (valued) values.line("g_tetra4").floats({7});
        values.line("tetra4").floats({8});
        const auto result = read_ensight(folder_, {{"grid.geo", geometry.text()},
                                                   {"e.scl", values.text()},
                                                   {"a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\n"
                                                              "VARIABLE\nscalar per element: e e.scl\n"}});
        ASSERT_TRUE(result) << result.error().message;
        ASSERT_EQ(result->grid.cells.count(), 1u);
        EXPECT_EQ(result->grid.cell_fields.at(0).values.at(0), 8);
    }
}

TEST_P(EnsightFiles, PartsWithoutNodesAreNoHindrance) {
    for (const char* kind : {"", "coordinates"}) {
        GoldText geometry(GetParam(), true), values(GetParam());
        geometry.line("a").line("b").line("node id off").line("element id off");
        values.line("values");
        for (const int part : {1, 2}) {
            geometry.line("part").integers({part}).line("c").line("coordinates").integers({part == 1 ? 4 : 0});
            if (part == 1)
                for (const auto& axis : {std::vector<float>{0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}})
                    geometry.floats(axis);
            if (part == 1) geometry.line("tetra4").integers({1}).integers({1, 2, 3, 4}, 4);
            values.line("part").integers({part});
            if (part == 1) values.line("coordinates").floats({1, 2, 3, 4});
            else if (*kind != '\0') values.line(kind);
        }
        folder_.write("grid.geo", geometry.text());
        folder_.write("t.scl", values.text());
        const auto result = read(folder_.write("b.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\n"
                                                         "VARIABLE\nscalar per node: t t.scl\n"));
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.point_fields.at(0).values.at(3), 4);
    }
}

TEST_P(EnsightFiles, VariablesOfOtherElementsOrPartsAreErrors) {
    GoldText other(GetParam());
    other.line("of elements").line("part").integers({1}).line("hexa8").floats({7, 8});
    const auto elements = read_with("e.scl", other.text());
    ASSERT_FALSE(elements);
    EXPECT_NE(elements.error().message.find("part 1 has no elements 'hexa8'"), std::string::npos)
        << elements.error().message;
    GoldText unknown(GetParam());
    unknown.line("of elements").line("part").integers({3}).line("tetra4").floats({7, 8});
    const auto part = read_with("e.scl", unknown.text());
    ASSERT_FALSE(part);
    EXPECT_NE(part.error().message.find("the geometry has no part 3"), std::string::npos) << part.error().message;
}

std::string name_of_form(const testing::TestParamInfo<GoldForm>& form) {
    constexpr const char* names[] = {"Ascii", "C", "CSwapped", "Fortran"};
    return names[static_cast<std::size_t>(form.param)];
}

INSTANTIATE_TEST_SUITE_P(Forms, EnsightFiles,
                         testing::Values(GoldForm::ascii, GoldForm::c, GoldForm::c_swapped, GoldForm::fortran),
                         name_of_form);

TEST(EnsightText, OfGoldMustHaveItsNumbersOnLinesOfTheirOwn) {
    const TemporaryFolder folder;
    const std::string geometry =
        "a\n\nnode id off\nelement id off\npart\n1\nc\ncoordinates\n4\n0\n1\n0\n0\n0\n0\n1\n0\n"
        "0\n0\n0\n1\ntetra4\n1\n1 2 3 4\n";
    const auto error = [&](const std::string& grid, const std::string& values) {
        folder.write("grid.geo", grid);
        folder.write("t", values);
        return message_of(
            whole(read(folder.write("a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nVARIABLE\n"
                                              "scalar per node: t t\n"))));
    };
    const std::string head = "t\npart\n1\ncoordinates\n";
    EXPECT_EQ(error(geometry, head + "1\n2\n3\n4\n"), "read");
    EXPECT_EQ(error(geometry, head + "1\n# a comment\n\n2\n3\n 4.00000e+00"), "read");
    EXPECT_EQ(error(geometry, head + "1\n2\n" + std::string(300, ' ') + "3\n1.0D+05\n"), "read");
    EXPECT_EQ(error(geometry + "bar2\n1\n         1         2", head + "1\n2\n3\n4\n"), "read");
    for (const char* values : {"1 2 3 4\n", "1\n2\n3\n4 5\n", "1\n2\n3\nx\n", "1\n2\n3\n1.0E+\n", "1\n2\n3\n4"})
        EXPECT_NE(error(geometry, head + values).find("/t: "), std::string::npos) << values;
    std::string rows = geometry;
    rows.replace(rows.find("1 2 3 4"), 7, "1 2\n3 4");
    EXPECT_NE(error(rows, head + "1\n2\n3\n4\n").find("grid.geo: "), std::string::npos);
}

TEST(EnsightSteps, AreLookedAtInTheFilesOfTheStep) {
    const TemporaryFolder folder;
    const std::string geometry =
        "a\nb\nnode id off\nelement id off\npart\n1\nc\ncoordinates\n4\n0\n1\n0\n0\n0\n0\n1\n0\n"
        "0\n0\n0\n1\ntetra4\n1\n1 2 3 4\n";
    folder.write("grid.geo", geometry);
    folder.write("t.005", "t\npart\n1\ncoordinates\n1\n2\n3\n4\n");
    folder.write("t.007", "t\npart\n1\ncoordinates\n1\n2\n");
    const std::string path = folder.write(
        "a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nVARIABLE\nscalar per node: 1 t t.***\nTIME\n"
                  "time set: 1\nnumber of steps: 2\nfilename start number: 5\nfilename increment: 2\n"
                  "time values: 0 1\n");
    ReadOptions options;
    options.step = 0;
    const auto sound = whole(read(path, options));
    ASSERT_TRUE(sound) << sound.error().message;
    options.step = 1;
    const auto cut = whole(read(path, options));
    ASSERT_FALSE(cut);
    EXPECT_NE(cut.error().message.find("t.007"), std::string::npos) << cut.error().message;
}

} // namespace
} // namespace isotet::test
