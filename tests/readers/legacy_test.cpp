// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Legacy VTK files as VTK and others write them: polyhedra, metadata, types, and one array that is broken beside others.
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/vtk_legacy/read_legacy_vtk.hpp"
#include "readers/sample_bytes.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

/// A file that grows at its end; numbers are ascii or big-endian.
class LegacyText {
public:
    explicit LegacyText(bool binary, bool little = false) : binary_(binary), bytes_(!little) {}

    LegacyText& text(std::string_view text) {
        bytes_.text(text);
        return *this;
    }
    template <class T>
    LegacyText& numbers(std::initializer_list<double> values) {
        for (const double value : values)
            if (binary_) bytes_.number(static_cast<T>(value));
            else bytes_.text(fmt::format("{} ", value));
        return text("\n");
    }
    /// The points of the cube of sample_bytes.hpp, behind the header.
    LegacyText& start(std::string_view version) {
        text(fmt::format("# vtk DataFile Version {}\ntitle\n{}\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n", version,
                         binary_ ? "BINARY" : "ASCII"));
        for (const double coordinate : cube_points)
            if (binary_) bytes_.number(coordinate);
            else bytes_.text(fmt::format("{} ", coordinate));
        return text("\n");
    }
    /// A tetrahedron.
    LegacyText& tet() {
        text("CELLS 1 5\n").numbers<std::int32_t>({4, 0, 1, 3, 4});
        return text("CELL_TYPES 1\n").numbers<std::int32_t>({10});
    }
    /// Nine tuples, of numbers that count up.
    LegacyText& nine(double first, int components = 1) {
        for (int i = 0; i < 9 * components; ++i)
            if (binary_) bytes_.number(static_cast<float>(first + i));
            else bytes_.text(fmt::format("{} ", first + i));
        return text("\n");
    }
    /// An array of a FIELD with the values 10 to 18.
    LegacyText& sound_array(std::string_view name) { return text(fmt::format("{} 1 9 float\n", name)).nine(10); }
    std::string str() const { return bytes_.str(); }

private:
    bool binary_;
    SampleBytes bytes_;
};

io::Loaded load(const std::string& bytes, io::Depth depth = io::Depth::arrays) {
    auto loaded = io::load_legacy(io::ByteSource(bytes), {}, depth, {});
    EXPECT_TRUE(loaded) << (loaded ? "" : loaded.error().message);
    return loaded ? *std::move(loaded) : io::Loaded{};
}

std::string error_in_legacy(const std::string& bytes) {
    const auto loaded = io::load_legacy(io::ByteSource(bytes), {}, io::Depth::arrays, {});
    return loaded ? "no error" : loaded.error().message;
}

const Grid& grid_of(const io::Loaded& loaded) {
    static const Grid none;
    EXPECT_EQ(loaded.pieces.size(), 1U);
    return loaded.pieces.empty() ? none : loaded.pieces.front().grid;
}

/// "name: reason" of all that is left out.
std::vector<std::string> left_out(const io::Loaded& loaded) {
    std::vector<std::string> all;
    for (const LeftOut& item : loaded.info.left_out)
        all.push_back(fmt::format("{} {}: {}", item.what, item.name, item.reason));
    return all;
}

/// The sound array is there with its values, and nothing else but what is left out.
void expect_sound(const std::string& bytes, const std::vector<std::string>& expected_left_out) {
    for (const io::Depth depth : {io::Depth::description, io::Depth::arrays}) {
        const io::Loaded loaded = load(bytes, depth);
        EXPECT_EQ(left_out(loaded), expected_left_out);
        ASSERT_EQ(loaded.info.fields.size(), 1U);
        EXPECT_EQ(loaded.info.fields[0].name, "sound");
        if (depth == io::Depth::description) continue;
        const Field* field = find(grid_of(loaded).point_fields, "sound");
        ASSERT_NE(field, nullptr);
        EXPECT_EQ(values_of(field->values), (std::vector<double>{10, 11, 12, 13, 14, 15, 16, 17, 18}));
    }
}

class ReadLegacyForm : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Forms, ReadLegacyForm, testing::Bool(),
                         [](const auto& form) { return form.param ? "Binary" : "Ascii"; });

const std::vector<double> cube_faces{6, 4, 0, 3, 2, 1, 4, 4, 5, 6, 7, 4, 0, 1, 5, 4,
                                     4, 1, 2, 6, 5, 4, 2, 3, 7, 6, 4, 3, 0, 4, 7};

void expect_polyhedra(const Grid& grid) {
    EXPECT_EQ(types_of(grid.cells), (std::vector<int>{10, 42, 14}));
    EXPECT_EQ(values_of(grid.cells.connectivity),
              (std::vector<double>{0, 1, 3, 4, 0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 8}));
    EXPECT_EQ(values_of(grid.cells.offsets), (std::vector<double>{0, 4, 12, 17}));
    EXPECT_EQ(values_of(grid.cells.faces), cube_faces);
    EXPECT_EQ(values_of(grid.cells.face_offsets), (std::vector<double>{0, 0, 31, 31}));
    EXPECT_TRUE(check(grid));
}

TEST_P(ReadLegacyForm, HasPolyhedraAsFacesAmongOtherCells) {
    const std::string bytes =
        LegacyText(GetParam())
            .start("4.2")
            .text("CELLS 3 43\n")
            .numbers<std::int32_t>({4, 0, 1, 3, 4, 31, 6, 4, 0, 3, 2, 1, 4, 4, 5, 6, 7, 4, 0, 1, 5, 4,
                                    4, 1, 2, 6, 5, 4,  2, 3, 7, 6, 4, 3, 0, 4, 7, 5, 4, 5, 6, 7, 8})
            .text("\nCELL_TYPES 3\n")
            .numbers<std::int32_t>({10, 42, 14})
            .str();
    expect_polyhedra(grid_of(load(bytes)));
    EXPECT_EQ(error_in_legacy(replaced(bytes, "CELLS 3 43", "CELLS 3 42")).substr(0, 6), "cells:");
}

TEST_P(ReadLegacyForm, HasPolyhedraInConnectivitySinceVersion5) {
    const std::string bytes = LegacyText(GetParam())
                                  .start("5.1")
                                  .text("CELLS 4 40\nOFFSETS vtktypeint64\n")
                                  .numbers<std::int64_t>({0, 4, 35, 40})
                                  .text("CONNECTIVITY vtktypeint64\n")
                                  .numbers<std::int64_t>({0, 1, 3, 4, 6, 4, 0, 3, 2, 1, 4, 4, 5, 6, 7, 4, 0, 1, 5, 4,
                                                          4, 1, 2, 6, 5, 4, 2, 3, 7, 6, 4, 3, 0, 4, 7, 4, 5, 6, 7, 8})
                                  .text("CELL_TYPES 3\n")
                                  .numbers<std::int32_t>({10, 42, 14})
                                  .str();
    expect_polyhedra(grid_of(load(bytes)));
}

TEST_P(ReadLegacyForm, MayHaveNothingButPolyhedraOfOneSize) {
    const std::string bytes = LegacyText(GetParam())
                                  .start("2.0")
                                  .text("CELLS 2 36\n")
                                  .numbers<std::int32_t>({17, 4, 3, 0, 1, 2, 3, 0, 1, 4, 3, 0, 2, 4, 3, 1, 2, 4,
                                                          17, 4, 3, 4, 5, 6, 3, 4, 5, 8, 3, 4, 6, 8, 3, 5, 6, 8})
                                  .text("CELL_TYPES 2\n")
                                  .numbers<std::int32_t>({42, 42})
                                  .str();
    ReadOptions options;
    options.active_cells = ReadActiveCells{};
    for (const ReadOptions& each : {ReadOptions(), options}) {
        const auto loaded = io::load_legacy(io::ByteSource(bytes), each, io::Depth::arrays, {});
        ASSERT_TRUE(loaded) << loaded.error().message;
        const Grid& grid = grid_of(*loaded);
        EXPECT_EQ(values_of(grid.cells.connectivity), (std::vector<double>{0, 1, 2, 4, 4, 5, 6, 8}));
        EXPECT_EQ(values_of(grid.cells.face_offsets), (std::vector<double>{0, 17, 34}));
    }
}

TEST_P(ReadLegacyForm, RefusesPolyhedraWhoseNumbersAreNoFaces) {
    for (const double wrong : {5.0, 3.0, 0.0, -1.0, 2e9}) {
        const std::string bytes =
            LegacyText(GetParam())
                .start("4.2")
                .text("CELLS 1 18\n")
                .numbers<std::int32_t>({17, wrong, 3, 0, 1, 2, 3, 0, 1, 4, 3, 0, 2, 4, 3, 1, 2, 4})
                .text("CELL_TYPES 1\n")
                .numbers<std::int32_t>({42})
                .str();
        EXPECT_EQ(error_in_legacy(bytes),
                  "cell 0 is a polyhedron, but its 17 numbers are not the number of its faces and, "
                  "for each face, its number of points and these points")
            << wrong;
    }
}

TEST_P(ReadLegacyForm, ComponentNamesOfMetadataPutTensorsIntoVtksOrder) {
    const std::string names = "METADATA\nCOMPONENT_NAMES\nXX\nXY\nXZ\nYY\nYZ\nZZ\nINFORMATION 0\n\n";
    const std::string bytes = LegacyText(GetParam())
                                  .start("4.2")
                                  .tet()
                                  .text("POINT_DATA 9\nFIELD FieldData 3\nS 6 9 float\n")
                                  .nine(0, 6)
                                  .text(names)
                                  .text("plain 6 9 float\n")
                                  .nine(0, 6)
                                  .text("vector 3 9 float\n")
                                  .nine(0, 3)
                                  .text("METADATA\nCOMPONENT_NAMES\nXX\nXY\nXZ\n\n")
                                  .text("TENSORS6 T float\n")
                                  .nine(0, 6)
                                  .text(names)
                                  .str();
    const io::Loaded loaded = load(bytes);
    const auto of_point_1 = [&](const char* name) {
        const Field* const field = find(grid_of(loaded).point_fields, name);
        std::vector<double> values;
        for (std::size_t c = 0; field && c < field->values.components(); ++c) values.push_back(field->values.at(1, c));
        return values;
    };
    EXPECT_EQ(of_point_1("S"), (std::vector<double>{6, 9, 11, 7, 10, 8}));
    EXPECT_EQ(of_point_1("T"), (std::vector<double>{6, 9, 11, 7, 10, 8}));
    EXPECT_EQ(of_point_1("plain"), (std::vector<double>{6, 7, 8, 9, 10, 11}));
    EXPECT_EQ(of_point_1("vector"), (std::vector<double>{3, 4, 5}));
}

TEST_P(ReadLegacyForm, StepsOverMetadataOfEveryKind) {
    for (const char* metadata :
         {"METADATA\nCOMPONENT_NAMES\n\nINFORMATION 0\n\n", "METADATA\nCOMPONENT_NAMES\n\n\n",
          "METADATA\nCOMPONENT_NAMES\na%20b\n\n", "METADATA\nINFORMATION 0\n\n", "METADATA\n\n",
          "METADATA\nCOMPONENT_NAMES\n\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1 \n\n",
          "METADATA\nCOMPONENT_NAMES\nINFORMATION%202\nINFORMATION 2\nNAME UNITS LOCATION me\nDATA 2\nm\n\n"
          "NAME ID LOCATION me\nDATA 7\n\n"}) {
        const std::string bytes = LegacyText(GetParam())
                                      .start("4.2")
                                      .text("METADATA\nCOMPONENT_NAMES\n\ny\n\nINFORMATION 0\n\n")
                                      .tet()
                                      .text("POINT_DATA 9\nFIELD FieldData 3\na 1 9 float\n")
                                      .nine(0)
                                      .text(metadata)
                                      .text("b 1 9 float\n")
                                      .nine(1)
                                      .text(metadata)
                                      .sound_array("sound")
                                      .text(metadata)
                                      .text("SCALARS c float\nLOOKUP_TABLE default\n")
                                      .nine(2)
                                      .text(metadata)
                                      .str();
        const io::Loaded loaded = load(bytes);
        EXPECT_EQ(loaded.info.fields.size(), 4U) << metadata;
        EXPECT_TRUE(left_out(loaded).empty()) << metadata;
        ASSERT_NE(find(grid_of(loaded).point_fields, "c"), nullptr) << metadata;
        EXPECT_EQ(find(grid_of(loaded).point_fields, "c")->values.at(8), 10) << metadata;
    }
}

TEST_P(ReadLegacyForm, KnowsTheTypesOfVtkOfAnyAge) {
    for (const char* line :
         {"Scalars  Label int1", "SCALARS Label of a Region int1", "SCALARS Label of a Region int1 1"}) {
        const std::string freefem = LegacyText(GetParam())
                                        .start("2.0")
                                        .tet()
                                        .text(fmt::format("CELL_DATA 1\n{}\nLOOKUP_TABLE t\n", line))
                                        .numbers<std::int32_t>({3})
                                        .str();
        const io::Loaded labelled = load(freefem);
        ASSERT_EQ(grid_of(labelled).cell_fields.size(), 1U) << line;
        EXPECT_TRUE(grid_of(labelled).cell_fields[0].name.starts_with("Label")) << line;
        EXPECT_EQ(values_of(grid_of(labelled).cell_fields[0].values), (std::vector<double>{3})) << line;
    }
    for (const char* type : {"long_long", "long", "vtktypeint64", "vtkTypeInt64", "__int64", "int64"}) {
        const std::string bytes = LegacyText(GetParam())
                                      .start("3.0")
                                      .tet()
                                      .text(fmt::format("CELL_DATA 1\nSCALARS s {} 2\nLOOKUP_TABLE default\n", type))
                                      .numbers<std::int64_t>({-5, 7})
                                      .str();
        const io::Loaded loaded = load(bytes);
        ASSERT_EQ(grid_of(loaded).cell_fields.size(), 1U) << type;
        EXPECT_EQ(grid_of(loaded).cell_fields[0].values.type(), ScalarType::int64) << type;
        EXPECT_EQ(values_of(grid_of(loaded).cell_fields[0].values), (std::vector<double>{-5, 7})) << type;
    }
    for (const char* type : {"unsigned_long_long", "unsigned_long", "vtktypeuint64"})
        EXPECT_EQ(load(LegacyText(GetParam())
                           .start("3.0")
                           .tet()
                           .text(fmt::format("CELL_DATA 1\nFIELD f 1\ns 1 1 {}\n", type))
                           .numbers<std::uint64_t>({7})
                           .str())
                      .info.fields.at(0)
                      .type,
                  ScalarType::uint64)
            << type;
}

/// NGSolve writes names as they are.
TEST_P(ReadLegacyForm, TakesBlanksInNames) {
    LegacyText file(GetParam());
    file.start("3.0").tet().text("POINT_DATA 9\nSCALARS u float 1\nLOOKUP_TABLE default\n").nine(1);
    file.text("SCALARS grad  u float 3\nLOOKUP_TABLE default\n")
        .nine(2, 3)
        .text("VECTORS two words float\n")
        .nine(3, 3);
    file.text("FIELD a 2\n").text("T in K 1 9 float\n").nine(10).sound_array("last");
    file.text("CELL_DATA 1\nSCALARS of a cell double\nLOOKUP_TABLE default\n").numbers<double>({5});
    const io::Loaded loaded = load(file.str());
    const Grid& grid = grid_of(loaded);
    ASSERT_EQ(grid.point_fields.size(), 5U);
    const std::pair<const char*, std::size_t> expected[] = {
        {"u", 1}, {"grad u", 3}, {"two words", 3}, {"T in K", 1}, {"last", 1}};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(grid.point_fields[i].name, expected[i].first);
        EXPECT_EQ(grid.point_fields[i].values.components(), expected[i].second);
    }
    EXPECT_EQ(grid.point_fields[1].values.at(0), 2);
    ASSERT_EQ(grid.cell_fields.size(), 1U);
    EXPECT_EQ(grid.cell_fields[0].name, "of a cell");
    EXPECT_TRUE(loaded.info.left_out.empty());
}

TEST_P(ReadLegacyForm, LeavesOutAnArrayOfUnknownTypeAlone) {
    const std::string type = "its type 'quad' is not known";
    const auto field = [&] {
        return LegacyText(GetParam()).start("3.0").tet().text("POINT_DATA 9\nFIELD FieldData 2\n");
    };
    expect_sound(field().text("odd 2 9 quad\n").nine(1, 2).sound_array("sound").str(), {"point field odd: " + type});
    expect_sound(field().sound_array("sound").text("odd 1 9 quad\n").nine(1).str(), {"point field odd: " + type});
    expect_sound(LegacyText(GetParam())
                     .start("3.0")
                     .tet()
                     .text("POINT_DATA 9\nSCALARS odd quad\nLOOKUP_TABLE default\n")
                     .nine(1)
                     .text("SCALARS sound float 1\nLOOKUP_TABLE default\n")
                     .nine(10)
                     .text("CELL_DATA 1\nVECTORS v quad\n")
                     .numbers<double>({1, 2, 3})
                     .str(),
                 {"point field odd: " + type, "cell field v: " + type});
}

TEST_P(ReadLegacyForm, LeavesOutArraysOfAnotherLengthOrWithoutName) {
    const auto file = [&] { return LegacyText(GetParam()).start("3.0").tet(); };
    expect_sound(file()
                     .text("POINT_DATA 9\nFIELD f 3\nshort 1 2 float\n")
                     .numbers<float>({1, 2})
                     .sound_array("sound")
                     .text(" 1 9 float\n")
                     .nine(1)
                     .str(),
                 {"point field short: it has 2 values, but the grid has 9 points", "point field : it has no name"});
    expect_sound(file()
                     .text("CELL_DATA 2\nSCALARS c float\nLOOKUP_TABLE default\n")
                     .numbers<float>({1, 2})
                     .text("POINT_DATA 9\nVECTORS  float\n")
                     .nine(0, 3)
                     .text("SCALARS sound float\nLOOKUP_TABLE default\n")
                     .nine(10)
                     .text("POINT_DATA 0\nFIELD empty 1\nnothing 1 0 float\n\n")
                     .str(),
                 {"cell field c: it has 2 values, but the grid has 1 cells", "point field : it has no name",
                  "point field nothing: it has 0 values, but the grid has 9 points"});
}

TEST_P(ReadLegacyForm, LeavesOutAnArrayThatTheFileCutsShort) {
    const std::string bytes = LegacyText(GetParam())
                                  .start("3.0")
                                  .tet()
                                  .text("POINT_DATA 9\nFIELD f 3\n")
                                  .sound_array("sound")
                                  .text("cut 1 9 double\n")
                                  .numbers<double>({1, 2, 3})
                                  .str();
    const auto reasons = left_out(load(bytes));
    ASSERT_EQ(reasons.size(), 1U);
    expect_sound(bytes, reasons);
    EXPECT_TRUE(reasons[0].starts_with("point field cut: 'cut'")) << reasons[0];
}

TEST_P(ReadLegacyForm, TakesTheLastOfTwoArraysOfOneName) {
    const std::string bytes = LegacyText(GetParam())
                                  .start("3.0")
                                  .tet()
                                  .text("POINT_DATA 9\nFIELD f 3\nsound 1 9 double\n")
                                  .numbers<double>({1, 2, 3, 4, 5, 6, 7, 8, 9})
                                  .sound_array("sound")
                                  .text("sound 1 1 float\n")
                                  .numbers<float>({1})
                                  .str();
    expect_sound(bytes, {"point field sound: it has 1 values, but the grid has 9 points"});
    const io::Loaded loaded = load(bytes);
    EXPECT_EQ(loaded.notes,
              std::vector<std::string>{"point field 'sound' occurs twice: the values of the last one were taken"});
    EXPECT_EQ(loaded.info.fields[0].type, ScalarType::float32);
}

TEST_P(ReadLegacyForm, MayHaveDataBeforeCellsAndUnknownSections) {
    expect_sound(LegacyText(GetParam())
                     .start("3.0")
                     .text("POINT_DATA 9\nSCALARS sound float\nLOOKUP_TABLE default\n")
                     .nine(10)
                     .text("CELL_TYPES 1\n")
                     .numbers<std::int32_t>({10})
                     .text("CELLS 1 5\n")
                     .numbers<std::int32_t>({4, 0, 1, 3, 4})
                     .text("EXTRA 3\n1 2 3\n")
                     .str(),
                 {"section extra: it is not known"});
}

TEST(ReadLegacyAscii, GoesOnBehindAnArrayWithTooFewOrTooManyOrOddNumbers) {
    const std::string head = LegacyText(false).start("3.0").tet().text("POINT_DATA 9\n").str();
    const std::string sound = "SCALARS sound float\nLOOKUP_TABLE default\n10 11 12 13 14 15 16 17 18\n";
    const std::string odd = "SCALARS odd float\nLOOKUP_TABLE default\n";
    expect_sound(head + odd + "1 2 3 4 5 6 7 8\n" + sound,
                 {"point field odd: 'odd': 'SCALARS', number 8 of 9, is not float32"});
    expect_sound(head + odd + "1 2 3 4 x 6 7 8 9\n" + sound,
                 {"point field odd: 'odd': 'x', number 4 of 9, is not float32"});
    expect_sound(head + odd + "1 2 3 4 5 6 7 8 9\n10\n" + sound,
                 {"point field odd: '10' stands behind its 9 x 1 values, where a section should begin"});
    expect_sound(head + "FIELD f 2\nodd 1 9 float\n1 2 3 4 5 6 7 8 9 10\nsound 1 9 float\n" +
                     "10 11 12 13 14 15 16 17 18\n",
                 {"point field odd: '10' stands behind its 9 x 1 values, where a section should begin"});
    expect_sound(head + "FIELD f 2\nodd 1 9 float\n1 2 3 4 5 6 7 8\nsound 1 9 float\n10 11 12 13 14 15 16 17 18\n",
                 {"point field odd: 'odd': 'sound', number 8 of 9, is not float32"});
    expect_sound(head + sound + "VECTORS v float\n", {"point field v: 'v': 9 x 3 numbers were announced, but only 1 "
                                                      "bytes are left"});
}

TEST(ReadLegacyBinary, DoesNotGuessWhatFollowsAnArrayOfUnknownLength) {
    // Behind an array of an unknown type of 3 bytes nothing can be found again.
    const std::string bytes = LegacyText(true)
                                  .start("3.0")
                                  .tet()
                                  .text("POINT_DATA 9\nFIELD f 3\n")
                                  .sound_array("sound")
                                  .text("odd 1 9 triple\n")
                                  .text("123456789123456789123456789\n")
                                  .sound_array("lost")
                                  .str();
    expect_sound(bytes, {"point field odd: its type 'triple' is not known"});
    ASSERT_EQ(load(bytes).notes.size(), 1U);
    EXPECT_TRUE(load(bytes).notes[0].starts_with("what follows byte ")) << load(bytes).notes[0];
}

TEST(ReadLegacyBinary, OfLittleEndianNumbersIsNamed) {
    const std::string message =
        " make sense only as little-endian ones, but binary legacy VTK files are big-endian: the "
        "program that wrote it has to swap the bytes";
    EXPECT_EQ(error_in_legacy(LegacyText(true, true).start("3.0").tet().str()), "the numbers of cells" + message);
    EXPECT_EQ(error_in_legacy(LegacyText(true, true)
                                  .start("5.1")
                                  .text("CELLS 2 4\nOFFSETS vtktypeint64\n")
                                  .numbers<std::int64_t>({0, 4})
                                  .text("CONNECTIVITY vtktypeint64\n")
                                  .numbers<std::int64_t>({0, 1, 3, 4})
                                  .text("CELL_TYPES 1\n")
                                  .numbers<std::int32_t>({10})
                                  .str()),
              "the numbers of cells" + message);
    EXPECT_EQ(error_in_legacy(LegacyText(true)
                                  .start("3.0")
                                  .text("CELLS 1 5\n")
                                  .numbers<std::int32_t>({4, 0, 1, 3, 4})
                                  .text("CELL_TYPES 1\n")
                                  .numbers<std::int32_t>({10 << 24})
                                  .str()),
              "the numbers of CELL_TYPES" + message);
}

TEST(ReadLegacyCells, TakesOffsetsAndCornersOfAnyType) {
    const auto file = [](const std::string& type, const char* corners) {
        return "# vtk DataFile Version 5.1\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 "
               "1\n"
               "CELLS 2 4\nOFFSETS " +
               type + "\n0 4\nCONNECTIVITY " + type + "\n" + corners + "\nCELL_TYPES 1\n10\n";
    };
    for (const char* type : {"char", "unsigned_char", "short", "unsigned_short", "float", "double"})
        EXPECT_EQ(error_in_legacy(file(type, "0 1 2 3")), "no error") << type;
    EXPECT_EQ(error_in_legacy(file("float", "0 1 2.5 3")), "cells: 2.5 is no offset or corner");
    EXPECT_EQ(error_in_legacy(file("short", "0 1 -2 3")), "cells: -2 is no offset or corner");
}

TEST(ReadLegacyStructured, TakesAnExtentInPlaceOfDimensions) {
    const TemporaryFolder folder;
    const std::string head = "# vtk DataFile Version 5.1\nx\nASCII\nDATASET STRUCTURED_POINTS\n";
    const auto points_of = [&](const std::string& dataset) {
        Result<ReadResult> result = read(folder.write("e.vtk", head + dataset + "ORIGIN -1 0 0\nSPACING 0.5 1 2\n"));
        if (result) return result->grid.points;
        ADD_FAILURE() << result.error().message;
        return Array();
    };
    const Array points = points_of("EXTENT 2 4 -1 1 0 1\n");
    ASSERT_EQ(points.tuples(), 18U);
    EXPECT_EQ(points.at(0, 0), 0) << "the origin has the index 0";
    EXPECT_EQ(points.at(0, 1), -1);
    EXPECT_EQ(points.at(17, 0), 1);
    EXPECT_EQ(points.at(17, 1), 1);
    EXPECT_EQ(points.at(17, 2), 2);
    for (const char* broken : {"EXTENT 2 4 -1 1 0\n", "EXTENT 4 2 0 1 0 1\n", "EXTENT 0 99999999999 0 1 0 1\n"})
        EXPECT_NE(error_in_legacy(head + broken + "ORIGIN 0 0 0\n").find("EXTENT is not three pairs"),
                  std::string::npos)
            << broken;
    const std::string grid = "# vtk DataFile Version 5.1\nx\nASCII\nDATASET ";
    const std::string axes = "X_COORDINATES 2 float\n0 1\nY_COORDINATES 2 float\n0 1\nZ_COORDINATES 2 float\n0 1\n";
    EXPECT_EQ(error_in_legacy(grid + "RECTILINEAR_GRID\nEXTENT 2 4 0 1 0 1\n" + axes),
              "there are 2 coordinates along axis x, but EXTENT is of 3 x 2 x 2");
    EXPECT_EQ(error_in_legacy(grid + "RECTILINEAR_GRID\nDIMENSIONS 2 2 3\n" + axes),
              "there are 2 coordinates along axis z, but DIMENSIONS are 2 x 2 x 3");
    EXPECT_EQ(error_in_legacy(grid + "STRUCTURED_GRID\nEXTENT 0 1 0 0 0 0\nPOINTS 1 float\n0 0 0\n"),
              "there are 1 points, but EXTENT is of 2 x 1 x 1");
    EXPECT_NE(error_in_legacy(grid + "STRUCTURED_POINTS\nEXTENT 0 99999999 0 99999999 0 99999999\n")
                  .find("EXTENT is of 100000000 x 100000000 x 100000000"),
              std::string::npos);
}

TEST(ReadLegacy, PassesOverArraysWithoutValues) {
    const std::string file =
        "# vtk DataFile Version 4.2\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nFIELD FieldData 1\nA 0 0 double\n"
        "POINTS 0 float\nCELLS 0 0\nCELL_TYPES 0\n";
    EXPECT_EQ(error_in_legacy(file), error_in_legacy(replaced(file, "FIELD FieldData 1\nA 0 0 double\n", "")));
}

TEST(ReadLegacyPlanes, AreQuadrilaterals) {
    const TemporaryFolder folder;
    const auto grid_of = [&](std::string_view dataset) {
        return read(folder.write("flat.vtk", fmt::format("# vtk DataFile Version 3.0\nx\nASCII\n{}\n", dataset)));
    };
    const auto plane =
        grid_of("DATASET RECTILINEAR_GRID\nDIMENSIONS 3 4 1\nX_COORDINATES 3 float\n0 1 2\nY_COORDINATES 4 float\n"
                "0 1 2 3\nZ_COORDINATES 1 float\n0\nCELL_DATA 6\nSCALARS c int\nLOOKUP_TABLE default\n1 2 3 4 5 6")
            .value();
    EXPECT_EQ(plane.notes, (std::vector<std::string>{"a plane of 3 x 4 points was read as 6 quadrilaterals"}));
    ASSERT_EQ(plane.grid.cells.count(), 6u);
    EXPECT_EQ(plane.grid.cells.types.at(5), 9);
    ASSERT_EQ(plane.grid.cell_fields.size(), 1u);
    EXPECT_EQ(plane.grid.cell_fields[0].values.at(5), 6);
    const auto corners = [](const ReadResult& result, std::size_t cell) {
        std::vector<double> out;
        for (std::size_t k = 0; k < 4; ++k) out.push_back(result.grid.cells.connectivity.at(4 * cell + k));
        return out;
    };
    EXPECT_EQ(corners(plane, 3), (std::vector<double>{4, 5, 8, 7}));
    const auto across_y = grid_of("DATASET STRUCTURED_POINTS\nDIMENSIONS 2 1 3\nORIGIN 0 0 0\nSPACING 1 1 1").value();
    EXPECT_EQ(corners(across_y, 1), (std::vector<double>{2, 3, 5, 4}));
    const auto across_x = grid_of("DATASET STRUCTURED_POINTS\nDIMENSIONS 1 3 2\nORIGIN 0 0 0\nSPACING 1 1 1").value();
    EXPECT_EQ(corners(across_x, 1), (std::vector<double>{1, 2, 5, 4}));
    const auto message = [&](std::string_view dataset) {
        const auto result = grid_of(dataset);
        return result ? "no error" : result.error().message.substr(folder.file("flat.vtk").size());
    };
    EXPECT_EQ(message("DATASET STRUCTURED_POINTS\nDIMENSIONS 1 5 1\nORIGIN 0 0 0\nSPACING 1 1 1"),
              ": a line of 5 points has no cells with an area");
    EXPECT_EQ(message("DATASET STRUCTURED_POINTS\nDIMENSIONS 1 1 1\nORIGIN 0 0 0\nSPACING 1 1 1"),
              ": a single point has no cells with an area");
}

TEST(ReadLegacyStructured, WhoseOnlyFieldIsShorterThanItsDimensionsIsRefused) {
    EXPECT_EQ(error_in_legacy("# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 60000 60000 "
                              "60000\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 2\nSCALARS s float\n1 2\n"),
              "point field 's' cannot be read: it has 2 values, but the grid has 216000000000000 points");
}

TEST(ReadLegacyNotes, NameWhatIsLeftOutAndAskingForItIsAnErrorWithTheReason) {
    const TemporaryFolder folder;
    const std::string path = folder.write("odd.vtk", LegacyText(false)
                                                         .start("3.0")
                                                         .tet()
                                                         .text("POINT_DATA 9\nFIELD f 2\nodd 1 9 quad\n")
                                                         .nine(1)
                                                         .sound_array("sound")
                                                         .str());
    const auto whole = read(path);
    ASSERT_TRUE(whole) << whole.error().message;
    EXPECT_EQ(whole->notes, std::vector<std::string>{"point field 'odd' is left out: its type 'quad' is not known"});
    ReadOptions options;
    options.point_fields = {"odd"};
    const auto asked = read(path, options);
    ASSERT_FALSE(asked);
    EXPECT_EQ(asked.error().message, "point field 'odd' cannot be read: its type 'quad' is not known");
}

std::string blanked_grid(std::string_view marks) {
    return fmt::format("# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_GRID\nDIMENSIONS 2 2 3\nBLANKING {}\n"
                       "POINTS 12 float\n0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1 0 0 2 1 0 2 0 1 2 1 1 2\n"
                       "POINT_DATA 12\nSCALARS f float\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7 8 9 10 11\n",
                       marks);
}

TEST(ReadLegacy, LeavesOutCellsOfBlankedPoints) {
    const io::Loaded loaded = load(blanked_grid("12 unsigned_char\n1 1 1 1 1 1 1 1 0 1 1 1"));
    ASSERT_EQ(loaded.pieces.size(), 1U);
    EXPECT_EQ(loaded.pieces.front().left_out, (std::vector<std::uint8_t>{0, 1}));
    EXPECT_EQ(loaded.pieces.front().grid.point_fields.size(), 1U);
    EXPECT_TRUE(load(blanked_grid("12 int\n1 1 1 1 1 1 1 1 1 1 1 1")).pieces.front().left_out.empty());
    EXPECT_EQ(error_in_legacy(blanked_grid("3 int\n1 1 1")), "BLANKING has 3 marks, but the grid 2 x 2 x 3 points");
}

TEST_P(ReadLegacyForm, MarksTheScalarsOfPointsAndOfCells) {
    LegacyText file(GetParam());
    file.start("3.0").tet().text("CELL_DATA 1\nSCALARS mat int\nLOOKUP_TABLE default\n").numbers<std::int32_t>({5});
    file.text("POINT_DATA 9\nVECTORS U float\n")
        .nine(1, 3)
        .text("SCALARS T%20(K) float\nLOOKUP_TABLE default\n")
        .nine(1);
    std::vector<std::string> active;
    for (const FieldInfo& field : load(file.str()).info.fields)
        if (field.active) active.push_back(field.name);
    EXPECT_EQ(active, (std::vector<std::string>{"mat", "T (K)"}));
}

/// As VisIt writes it.
TEST_P(ReadLegacyForm, HasTheTimeOfTheFile) {
    LegacyText file(GetParam());
    file.text(fmt::format("# vtk DataFile Version 3.0\ntitle\n{}\nDATASET UNSTRUCTURED_GRID\nFIELD FieldData 1\n"
                          "TIME 1 1 double\n",
                          GetParam() ? "BINARY" : "ASCII"));
    file.numbers<double>({2.5}).text("POINTS 4 float\n").numbers<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}).tet();
    EXPECT_EQ(load(file.str()).info.times, std::vector<double>{2.5});
}

TEST(ReadLegacy, TellsOfArraysOfText) {
    LegacyText file(false);
    file.start("3.0").tet().text("POINT_DATA 9\nFIELD a 2\nnames 1 9 string\na\nb\nc\nd\ne\nf\ng\nh\ni\n").sound_array("sound");
    expect_sound(file.str(), {"point field names: it holds text, not numbers"});
}

} // namespace
} // namespace isotet::test
