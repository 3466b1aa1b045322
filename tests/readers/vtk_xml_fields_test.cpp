// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Fields of VTK's XML files: those of all pieces count, and one that is broken leaves the others as they are.
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "io/files/byte_source.hpp"
#include "io/files/time_values.hpp"
#include "io/pieces/common_type.hpp"
#include "io/pieces/join/join.hpp"
#include "io/vtk_xml/base64.hpp"
#include "io/vtk_xml/load.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

using io::ByteSource;
using io::Depth;
using Names = std::vector<std::string>;

std::string array_of(std::string_view type, std::string_view name, std::string_view values,
                     std::string_view more = "format=\"ascii\"") {
    return fmt::format("<DataArray type=\"{}\" Name=\"{}\" {}>{}</DataArray>\n", type, name, more, values);
}

/// One tet: the pieces lie side by side along x.
struct Tet {
    int x = 0;
    std::string point_data = {}, cell_data = {};
    std::string count = "1", connectivity = array_of("Int32", "connectivity", "0 1 2 3"),
                offsets = array_of("Int32", "offsets", "4"), types = array_of("UInt8", "types", "10");
    std::string points = {};

    std::string piece() const {
        const std::string places =
            points.empty() ? array_of("Float64", "Points", fmt::format("{0} 0 0 {1} 0 0 {0} 1 0 {0} 0 1", x, x + 1),
                                      "NumberOfComponents=\"3\"")
                           : points;
        return fmt::format("<Piece NumberOfPoints=\"4\" NumberOfCells=\"{}\"><PointData>{}</PointData>"
                           "<CellData>{}</CellData><Points>{}</Points><Cells>{}{}{}</Cells></Piece>\n",
                           count, point_data, cell_data, places, connectivity, offsets, types);
    }
};

/// As ranks without cells write it: arrays of nothing, or none at all.
const std::string empty_piece = "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"><PointData>" +
                                array_of("Float32", "T", "") +
                                "</PointData><Cells><DataArray type=\"UInt8\" Name=\"types\"/></Cells></Piece>\n",
                  bare_piece = "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>\n";

std::string vtu(const std::string& pieces, std::string_view root = "type=\"UnstructuredGrid\"",
                std::string_view behind = "") {
    return fmt::format("<?xml version=\"1.0\"?>\n<VTKFile {}><UnstructuredGrid>{}</UnstructuredGrid>{}</VTKFile>\n",
                       root, pieces, behind);
}

ReadOptions reading(Names point_fields, std::optional<Names> cell_fields = {}) {
    ReadOptions options;
    options.point_fields = std::move(point_fields);
    options.cell_fields = std::move(cell_fields);
    return options;
}

io::Loaded loaded(const std::string& text, const ReadOptions& options = {}) {
    auto result = io::vtk_xml::load(ByteSource(text), "UnstructuredGrid", options, Depth::arrays, false, {});
    EXPECT_TRUE(result) << result.error().message << "\n" << text;
    return result ? std::move(*result) : io::Loaded{};
}

ReadResult joined(const std::string& text) {
    auto result = io::join(loaded(text), {});
    EXPECT_TRUE(result) << result.error().message << "\n" << text;
    return result ? std::move(*result) : ReadResult{};
}

std::string error_of_grid(const std::string& text, const ReadOptions& options = {}) {
    const auto result = io::vtk_xml::load(ByteSource(text), "UnstructuredGrid", options, Depth::arrays, false, {});
    return result ? "no error" : result.error().message;
}

const Field* find(const std::vector<Field>& fields, std::string_view name) {
    for (const Field& field : fields)
        if (field.name == name) return &field;
    return nullptr;
}

std::vector<double> values_of(const Field* field) {
    std::vector<double> values;
    for (std::size_t i = 0; field && i < field->values.tuples(); ++i)
        for (std::size_t c = 0; c < field->values.components(); ++c) values.push_back(field->values.at(i, c));
    return values;
}

std::vector<double> point_values(const ReadResult& file, std::string_view name) {
    return values_of(find(file.grid.point_fields, name));
}

std::vector<double> point_values(const io::Loaded& file, std::string_view name) {
    return file.pieces.empty() ? std::vector<double>() : values_of(find(file.pieces[0].grid.point_fields, name));
}

Names names_of(const FileInfo& info) {
    Names names;
    for (const FieldInfo& field : info.fields) names.push_back(field.name);
    return names;
}

std::string reasons_of(const FileInfo& info) {
    std::string all;
    for (const LeftOut& item : info.left_out)
        all += fmt::format("{}{} {}: {}", all.empty() ? "" : "; ", item.what, item.name, item.reason);
    return all;
}

const std::string good = array_of("Float32", "T", "1 2 3 4");

TEST(VtkXmlFields, OneThatIsBrokenLeavesTheOthers) {
    for (const auto& [bad, reason] :
         {std::pair{array_of("Foo", "q", "1 2 3 4"), "point field q: its type is 'Foo', which is not known"},
          {"<DataArray Name=\"q\">1 2 3 4</DataArray>", "point field q: its type is '', which is not known"},
          {array_of("Float32", "q", "1 true 3 4"), "point field q: 'true', number 1 of 4, is not float32"},
          {array_of("Float32", "q", "1"), "point field q: the array 'q' should have 4 numbers, but"},
          {array_of("Float32", "q", "1 2 3  "), "point field q: the array 'q' has 3 numbers, not 4"},
          {array_of("Int8", "q", "1 2 3 1000"), "point field q: '1000', number 3 of 4, is not int8"},
          {array_of("Float32", "q", "AAAA*AAA", "format=\"binary\""), "point field q: its base64 data is broken"},
          {array_of("Float32", "q", "", "format=\"binary\""), "point field q: "},
          {array_of("Float32", "q", "1 2", "format=\"packed\""),
           "point field q: its format is 'packed', not ascii, binary or appended"},
          {array_of("Float32", "q", "", "format=\"appended\" offset=\"7\""), "point field q: offset 7 lies behind"},
          {array_of("Float32", "q", "1 2 3 4", "NumberOfComponents=\"-1\""),
           "point field q: it has '-1' components, not 1 to"},
          {array_of("Float32", "q", "1 2 3 4", "NumberOfComponents=\"2\""), "point field q: "},
          {"<Array type=\"String\" Name=\"q\">97 0 98 0 99 0 100 0</Array>",
           "point field q: it holds text, not numbers"}}) {
        for (const bool first : {true, false}) {
            const std::string text = vtu(Tet{.point_data = first ? bad + good : good + bad}.piece());
            const io::Loaded file = loaded(text);
            EXPECT_EQ(point_values(file, "T"), (std::vector<double>{1, 2, 3, 4})) << bad;
            EXPECT_EQ(find(file.pieces.at(0).grid.point_fields, "q"), nullptr) << bad;
            EXPECT_TRUE(reasons_of(file.info).starts_with(reason)) << reasons_of(file.info);
            const io::Loaded named = loaded(text, reading({"T"}));
            EXPECT_EQ(point_values(named, "T"), (std::vector<double>{1, 2, 3, 4})) << bad;
        }
    }
}

/// Of a symmetric tensor, for one cell.
std::string named_tensor(std::string_view type, std::string_view values, const std::vector<std::string>& names,
                         std::string_view form = "ascii") {
    std::string more = fmt::format("NumberOfComponents=\"6\" format=\"{}\"", form);
    for (std::size_t i = 0; i < names.size(); ++i) more += fmt::format(" ComponentName{}=\"{}\"", i, names[i]);
    return array_of(type, "S", values, more);
}

TEST(VtkXmlFields, SymmetricTensorsOfAnotherOrderGetVtks) {
    using Values = std::vector<double>;
    const Values as_vtk{11, 22, 33, 12, 23, 13};
    const Names rows{"XX", "XY", "XZ", "YY", "YZ", "ZZ"};
    const std::string of_rows = "11 12 13 22 23 33";
    for (const auto& [values, names] : {std::pair{of_rows, rows},
                                        {of_rows, Names{"xx", "yx", "zx", "yy", "zy", "zz"}},
                                        {of_rows, Names{"S11", "S12", "S13", "S22", "S23", "S33"}},
                                        {"11 12 22 13 23 33", Names{"s_xx", "s_xy", "s_yy", "s_xz", "s_yz", "s_zz"}},
                                        {"11 22 33 12 23 13", Names{"XX", "YY", "ZZ", "XY", "YZ", "XZ"}},
                                        {"11 22 33 12 23 13", Names{}},
                                        {"11 22 33 12 23 13", Names{"XX", "XY", "XZ", "YY", "YZ", "XX"}},
                                        {"11 22 33 12 23 13", Names{"x", "y", "z", "rx", "ry", "rz"}}}) {
        for (const char* const type : {"Float32", "Float64", "Int8"}) {
            const io::Loaded file = loaded(vtu(Tet{.cell_data = named_tensor(type, values, names)}.piece()));
            EXPECT_EQ(values_of(find(file.pieces.at(0).grid.cell_fields, "S")), as_vtk) << names.size() << values;
        }
    }
    // Pieces of other orders and types; base64
    const io::Loaded file =
        loaded(vtu(Tet{.cell_data = named_tensor("Float64", of_rows, rows)}.piece() +
                   Tet{.x = 1, .cell_data = named_tensor("Float32", "11 22 33 12 23 13", {})}.piece() +
                   Tet{.x = 2, .cell_data = named_tensor("UInt8", "BgAAAAsMDRYXIQ==", rows, "binary")}.piece()));
    Values all;
    for (const io::Piece& piece : file.pieces) {
        const Values values = values_of(find(piece.grid.cell_fields, "S"));
        all.insert(all.end(), values.begin(), values.end());
    }
    ASSERT_EQ(all.size(), 18U);
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], as_vtk[i % 6]) << i;
}

TEST(VtkXmlFields, OneThatIsBrokenIsAnErrorWhereItIsNamed) {
    const TemporaryFolder folder;
    for (const auto& [bad, reason] : {std::pair{array_of("Foo", "q", "1 2 3 4"), "its type is 'Foo'"},
                                      {array_of("Float32", "q", "1 true 3 4"), "'true', number 1 of 4"}}) {
        const std::string path = folder.write("bad.vtu", vtu(Tet{.point_data = good + bad}.piece()));
        const auto all = read(path);
        ASSERT_TRUE(all) << all.error().message;
        ASSERT_EQ(all->notes.size(), 1u);
        EXPECT_NE(all->notes[0].find("point field 'q' is left out: " + std::string(reason)), std::string::npos)
            << all->notes[0];
        const auto named = read(path, reading({"q"}));
        ASSERT_FALSE(named);
        EXPECT_EQ(named.error().code, ErrorCode::invalid_data);
        EXPECT_NE(named.error().message.find(reason), std::string::npos) << named.error().message;
    }
}

TEST(VtkXmlFields, OfCellsThatAreBrokenLeaveTheOthers) {
    const io::Loaded file =
        loaded(vtu(Tet{.cell_data = array_of("Float32", "q", "no") + array_of("Float32", "m", "7")}.piece()));
    EXPECT_EQ(values_of(find(file.pieces.at(0).grid.cell_fields, "m")), std::vector<double>{7});
    EXPECT_EQ(reasons_of(file.info), "cell field q: 'no', number 0 of 1, is not float32");
}

TEST(VtkXmlFields, GhostMarksOfCellsMustBeSound) {
    EXPECT_EQ(error_of_grid(vtu(Tet{.cell_data = array_of("UInt8", "vtkGhostType", "x")}.piece())),
              "the array 'vtkGhostType': 'x', number 0 of 1, is not uint8");
    EXPECT_EQ(error_of_grid(vtu(Tet{.cell_data = array_of("Foo", "vtkGhostType", "0")}.piece())),
              "the array 'vtkGhostType': its type is 'Foo', which is not known");
}

TEST(VtkXmlFields, WithoutANameGetOneAndOfTwoOfANameTheFirstCounts) {
    const io::Loaded file =
        loaded(vtu(Tet{.point_data = good + array_of("Float32", "", "5 6 7 8") + array_of("Float32", "T", "0 0 0 0") +
                                     "<DataArray type=\"Int8\">1 1 1 1</DataArray>"}
                       .piece()));
    EXPECT_EQ(names_of(file.info), (Names{"T", "unnamed", "unnamed_2"}));
    EXPECT_EQ(point_values(file, "T"), (std::vector<double>{1, 2, 3, 4}));
    EXPECT_EQ(point_values(file, "unnamed"), (std::vector<double>{5, 6, 7, 8}));
    EXPECT_EQ(point_values(file, "unnamed_2"), (std::vector<double>{1, 1, 1, 1}));
    EXPECT_EQ(file.notes, (Names{"a point field without a name is called 'unnamed'",
                                 "a point field without a name is called 'unnamed_2'",
                                 "point field 'T' is there more than once: the first is read"}));
}

TEST(VtkXmlFields, OfPiecesHaveATypeThatHoldsAllValues) {
    for (const auto& [first, second, type] : {std::tuple{"Float64", "Float32", ScalarType::float64},
                                              {"Int32", "Int64", ScalarType::int64},
                                              {"UInt8", "Int8", ScalarType::int16},
                                              {"UInt32", "Int64", ScalarType::int64},
                                              {"UInt64", "Int8", ScalarType::float64},
                                              {"Int16", "Float32", ScalarType::float64},
                                              {"UInt16", "UInt16", ScalarType::uint16}}) {
        const std::string a = Tet{.point_data = array_of(first, "T", "1 2 3 4")}.piece(),
                          b = Tet{.x = 3, .point_data = array_of(second, "T", "5 6 7 8")}.piece();
        for (const auto& pieces : {a + b, empty_piece + a + b, a + bare_piece + b, a + b + empty_piece}) {
            const ReadResult file = joined(vtu(pieces));
            EXPECT_EQ(point_values(file, "T"), (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8}));
            EXPECT_EQ(find(file.grid.point_fields, "T")->values.type(), type) << first << " " << second;
            EXPECT_EQ(file.info.fields.at(0).type, type);
            EXPECT_EQ(file.grid.cells.count(), 2u);
        }
    }
}

TEST(VtkXmlFields, OfSomePiecesAreNoDataInTheOthers) {
    for (const char* type : {"Int32", "Float32"}) {
        const std::string with = array_of(type, "q", "5 6 7 8");
        for (const bool first : {true, false}) {
            const ReadResult file = joined(vtu(Tet{.point_data = first ? good + with : good}.piece() +
                                               Tet{.x = 3, .point_data = first ? good : good + with}.piece()));
            const std::vector<double> values = point_values(file, "q");
            ASSERT_EQ(values.size(), 8u);
            for (std::size_t i = 0; i < 4; ++i) {
                EXPECT_EQ(values[first ? i : i + 4], 5.0 + static_cast<double>(i));
                EXPECT_TRUE(std::isnan(values[first ? i + 4 : i]));
            }
            EXPECT_EQ(file.notes.at(0), "point field 'q' is in 1 of 2 pieces only: NaN in the others");
            EXPECT_EQ(point_values(file, "T").size(), 8u);
        }
    }
}

TEST(VtkXmlFields, WithOtherComponentsInAnotherPieceAreLeftOut) {
    const std::string of_3 = array_of("Float32", "q", "0 0 0 0 0 0 0 0 0 0 0 0", "NumberOfComponents=\"3\""),
                      of_1 = array_of("Float32", "q", "0 0 0 0");
    const ReadResult file =
        joined(vtu(Tet{.point_data = of_1 + good}.piece() + Tet{.x = 3, .point_data = good + of_3}.piece()));
    EXPECT_EQ(names_of(file.info), Names{"T"});
    EXPECT_EQ(reasons_of(file.info), "point field q: it has 1 component in one piece and 3 in another");
    EXPECT_EQ(point_values(file, "T").size(), 8u);
}

TEST(VtkXmlFields, OfFilesInPiecesAreThoseOfAllPieces) {
    const TemporaryFolder folder;
    folder.write("empty.vtu", vtu(bare_piece));
    folder.write("a.vtu", vtu(Tet{.point_data = good}.piece()));
    folder.write("b.vtu", vtu(Tet{.x = 1, .point_data = good + array_of("Float32", "q", "5 6 7 8")}.piece()));
    const auto index = [&](const Names& files) {
        std::string text = "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><PPointData/>";
        for (const std::string& file : files) text += fmt::format("<Piece Source=\"{}\"/>", file);
        return folder.write("i.pvtu", text + "</PUnstructuredGrid></VTKFile>");
    };
    for (const Names& files : {Names{"empty.vtu", "a.vtu", "b.vtu"}, Names{"a.vtu", "empty.vtu", "b.vtu"},
                               Names{"b.vtu", "a.vtu", "empty.vtu"}}) {
        const std::string path = index(files);
        const auto info = inspect(path);
        ASSERT_TRUE(info) << info.error().message;
        EXPECT_EQ(names_of(*info).size(), 2u);
        for (const char* name : {"T", "q"}) {
            const auto result = read(path, reading({name}, Names{}));
            ASSERT_TRUE(result) << result.error().message;
            EXPECT_EQ(result->grid.cells.count(), 2u);
            EXPECT_EQ(result->grid.point_fields.size(), 1u);
        }
    }
}

TEST(VtkXmlFields, HaveOneComponentWhereNoneAreStated) {
    for (const char* more : {"NumberOfComponents=\"0\"", "NumberOfComponents=\"\"", "NumberOfComponents=\"1\""})
        EXPECT_EQ(point_values(loaded(vtu(Tet{.point_data = array_of("Float32", "T", "1 2 3 4", more)}.piece())), "T"),
                  (std::vector<double>{1, 2, 3, 4}))
            << more;
}

TEST(VtkXmlFields, AreReadInEverySpelling) {
    const std::vector<double> expected{1, 2, 3, 4};
    const auto read_as = [&](const std::string& values, const std::string& more = "format=\"ascii\"") {
        return point_values(loaded(vtu(Tet{.point_data = array_of("Float32", "T", values, more)}.piece())), "T");
    };
    EXPECT_EQ(read_as("1 2 3 4", "format=\"ASCII\""), expected);
    EXPECT_EQ(read_as("1 2 3 4", "format=''"), expected);
    EXPECT_EQ(read_as("<!-- four values --> 1 2 3 4"), expected);
    EXPECT_EQ(read_as("1 2 <!-- two more > --> 3 4"), expected);
    EXPECT_EQ(read_as("1 2 3 4<!-- 5 -->"), expected);
    EXPECT_EQ(read_as("\n<![CDATA[ 1 2 3 4 ]]>\n"), expected);
    EXPECT_EQ(read_as("1 2 <![CDATA[3 4]]>"), expected);
    const std::string key = "<InformationKey name=\"L2_NORM_RANGE\" location=\"vtkDataArray\" length=\"2\">"
                            "<Value index=\"0\">7</Value><Value index=\"1\">8</Value></InformationKey>";
    EXPECT_EQ(read_as(key + "\n1 2 3 4"), expected);
    EXPECT_EQ(read_as("1 2 3 4" + key), expected);
    EXPECT_EQ(read_as("1 2" + key + " 3 4"), expected);
    const std::string bytes("\x10\0\0\0\0\0\x80\x3f\0\0\0\x40\0\0\x40\x40\0\0\x80\x40", 20),
        digits = "EAAAAAAAgD8AAABAAABAQAAAgEA=";
    EXPECT_EQ(read_as(digits, "format=\"binary\""), expected);
    EXPECT_EQ(read_as("\n " + digits + "\n ", "format=\"Binary\""), expected);
    EXPECT_EQ(read_as("<!-- packed -->" + digits, "format=\"BINARY\""), expected);
    const std::string appended = array_of("Float32", "T", "", "format=\"Appended\" offset=\"0\"");
    for (const auto& [encoding, data] : {std::pair{"", digits},
                                         {"encoding=\"base64\"", digits},
                                         {"encoding=\"Base64\"", digits},
                                         {"encoding=\"raw\"", bytes}}) {
        const std::string text = vtu(Tet{.point_data = appended}.piece(), "type=\"UnstructuredGrid\"",
                                     fmt::format("<AppendedData {}>_{}</AppendedData>", encoding, data));
        EXPECT_EQ(point_values(loaded(text), "T"), expected) << encoding;
    }
}

TEST(VtkXmlFields, OfFilesWithAnyHead) {
    const std::string piece = Tet{.point_data = good}.piece();
    const TemporaryFolder folder;
    for (const auto& text :
         {vtu(piece, ""), vtu(piece, "version=\"1.0\" type = 'UnstructuredGrid'"),
          vtu(piece, "type=\"UnstructuredGrid\" byte_order=\"littleendian\""),
          "<!DOCTYPE VTKFile [ <!ENTITY a \"b>\"> ]>\n" + vtu(piece).substr(22),
          "<!DOCTYPE VTKFile SYSTEM \"vtk.dtd\">" + vtu(piece).substr(22),
          "<?xml version=\"1.0\"?>\n<!-- " + std::string(5000, '-') + ">-->" + vtu(piece).substr(22)}) {
        const auto result = read(folder.write("a.vtu", text));
        ASSERT_TRUE(result) << result.error().message << text.substr(0, 200);
        EXPECT_EQ(values_of(find(result->grid.point_fields, "T")), (std::vector<double>{1, 2, 3, 4}));
    }
}

TEST(VtkXmlFields, MayShareTheirBytes) {
    const auto at = [](std::string_view type, std::string_view name, std::size_t offset, std::string_view more = "") {
        return array_of(type, name, "", fmt::format("format=\"appended\" offset=\"{}\" {}", offset, more));
    };
    const std::string zeros = std::string("\x60\0\0\0", 4) + std::string(96, '\0');
    const auto text = [&](std::size_t offset) {
        return vtu(Tet{.point_data = at("Float32", "T", 0) + at("Float64", "q", 0) + at("Int8", "r", offset),
                       .points = at("Float64", "Points", 0, "NumberOfComponents=\"3\"")}
                       .piece(),
                   "type=\"UnstructuredGrid\"", "<AppendedData encoding=\"raw\">_" + zeros + "</AppendedData>");
    };
    const io::Loaded file = loaded(text(0));
    EXPECT_EQ(file.pieces.at(0).grid.point_fields.size(), 3u);
    EXPECT_EQ(reasons_of(file.info), "");
    EXPECT_EQ(reasons_of(loaded(text(4)).info), "point field r: it has 0 bytes, but 4 int8 take 4");
}

TEST(VtkXmlFields, WhoseLengthIsWrongAreReadWhereTheyFit) {
    // 16 as a float in front of four floats, as GetFEM writes it.
    const std::string bytes("\0\0\x80\x41\0\0\x80\x3f\0\0\0\x40\0\0\x40\x40\0\0\x80\x40", 20);
    const std::string digits = "AACAQQAAgD8AAABAAABAQAAAgEA=";
    const io::Loaded file =
        loaded(vtu(Tet{.point_data = array_of("Float32", "T", digits, "format=\"binary\"")}.piece()));
    EXPECT_EQ(point_values(file, "T"), (std::vector<double>{1, 2, 3, 4}));
    ASSERT_EQ(file.notes.size(), 1u);
    EXPECT_TRUE(file.notes[0].starts_with("the stated length of 'T' is wrong")) << file.notes[0];
    const io::Loaded short_one =
        loaded(vtu(Tet{.point_data = array_of("Float32", "T", digits.substr(0, 24), "format=\"binary\"")}.piece()));
    EXPECT_NE(reasons_of(short_one.info).find("bytes are announced"), std::string::npos) << reasons_of(short_one.info);
}

TEST(VtkXmlCells, MayHaveIndicesOfFloats) {
    for (const char* type : {"Float32", "Float64", "Int8", "UInt64"}) {
        const Tet tet{.connectivity = array_of(type, "connectivity", "0 1 2 3"),
                      .offsets = array_of(type, "offsets", "4"),
                      .types = array_of(type, "types", "10")};
        EXPECT_EQ(loaded(vtu(tet.piece())).pieces.at(0).grid.cells.count(), 1u) << type;
    }
    EXPECT_EQ(error_of_grid(vtu(Tet{.connectivity = array_of("Float32", "connectivity", "0 1 2 2.5")}.piece())),
              "Cells 'connectivity' is float32, and not all of its values are whole numbers");
    EXPECT_EQ(error_of_grid(vtu(Tet{.types = array_of("Float32", "types", "10.5")}.piece())),
              "a cell type is not a whole number between 0 and 255");
}

TEST(VtkXmlCells, MustBeAsManyAsAreAnnounced) {
    const auto tet = [](const char* count, const char* offsets, const char* types) {
        return vtu(Tet{.count = count,
                       .connectivity = array_of("Int32", "connectivity", "0 1 2 3 0 1 2 3"),
                       .offsets = array_of("Int32", "offsets", offsets),
                       .types = array_of("UInt8", "types", types)}
                       .piece());
    };
    EXPECT_EQ(error_of_grid(tet("2", "4 8", "10 10")), "no error");
    EXPECT_EQ(error_of_grid(tet("1", "4 8", "10")),
              "the array 'offsets': it holds more than the 1 values that are announced");
    EXPECT_EQ(error_of_grid(tet("1", "4", "10 10")),
              "the array 'types': it holds more than the 1 values that are announced");
    EXPECT_EQ(error_of_grid(tet("0", "4 8", "10 10")), "NumberOfCells is 0, but the array 'types' holds values");
    const auto packed = [](const char* count) {
        return vtu(Tet{.count = count,
                       .connectivity = array_of("Int32", "connectivity", "0 1 2 3 0 1 2 3"),
                       .offsets = array_of("Int32", "offsets", "4 8"),
                       .types = array_of("UInt8", "types", "AgAAAAoK", "format=\"binary\"")}
                       .piece());
    };
    EXPECT_EQ(error_of_grid(packed("2")), "no error");
    EXPECT_EQ(error_of_grid(packed("1")),
              "NumberOfCells is 1: the array 'types': it holds 2 values, but 1 are announced");
}

TEST(VtkXmlFields, AreSaidToHoldMoreThanIsAnnounced) {
    const std::string too_many = array_of("Float32", "T", "1 2 3 4 5 6 7 8 9 10 11 12");
    const std::string points = array_of("Float32", "Points", "0 0 0 1 0 0 0 1 0 0 0 1 7", "NumberOfComponents=\"3\"");
    const io::Loaded file = loaded(vtu(Tet{.point_data = too_many, .points = points}.piece()));
    EXPECT_EQ(point_values(file, "T"), (std::vector<double>{1, 2, 3, 4}));
    EXPECT_EQ(file.notes, Names{"there are more values of points, 'T' than are announced: the first ones were read"});
    const std::string five_bytes = array_of("UInt8", "T", "BQAAAAECAwQF", "format=\"binary\"");
    EXPECT_EQ(loaded(vtu(Tet{.point_data = five_bytes}.piece())).notes.size(), 1u);
    const std::string four_bytes = array_of("UInt8", "T", "BAAAAAECAwQ=", "format=\"binary\"");
    EXPECT_EQ(loaded(vtu(Tet{.point_data = four_bytes}.piece())).notes.size(), 0u);
}

TEST(VtkXmlCells, PointsMayBeOfAnyType) {
    for (const auto& [type, read_as] : {std::pair{"Int32", ScalarType::float64},
                                        {"UInt8", ScalarType::float64},
                                        {"Int64", ScalarType::float64},
                                        {"Float32", ScalarType::float32}}) {
        const Tet tet{.points = array_of(type, "Points", "0 0 0 1 0 0 0 1 0 0 0 1", "NumberOfComponents=\"3\"")};
        const Grid grid = loaded(vtu(tet.piece())).pieces.at(0).grid;
        EXPECT_EQ(grid.points.type(), read_as);
        EXPECT_EQ(grid.points.at(3, 2), 1);
    }
    EXPECT_EQ(error_of_grid(vtu(
                  Tet{.points = array_of("Float32", "Points", "0 0 1 0 0 1 1 1", "NumberOfComponents=\"2\"")}.piece())),
              "the points have 2 components, not 3");
}

TEST(VtkXmlCells, WithoutAPieceAreNone) {
    const io::Loaded nothing = loaded(vtu(""));
    EXPECT_EQ(nothing.info.cells, 0u);
    ASSERT_EQ(nothing.pieces.size(), 1u);
    EXPECT_EQ(nothing.pieces[0].grid.points.components(), 3u);
}

TEST(TimeValues, AreTakenAsTheyWereWritten) {
    EXPECT_EQ(io::time_values(Array::own(std::vector<float>{0.1F, 1e30F, 2097152.5F, -0.3F})),
              (std::vector<double>{0.1, 1e30, 2097152.5, -0.3}));
    const std::vector<double> doubles{static_cast<double>(0.1F), 1.0 / 3};
    EXPECT_EQ(io::time_values(Array::own(std::vector<double>(doubles))), doubles);
    EXPECT_EQ(io::time_values(Array::own(std::vector<std::int32_t>{7, -1})), (std::vector<double>{7, -1}));
    EXPECT_TRUE(std::isnan(io::time_values(Array::own(std::vector<float>{NAN})).at(0)));
}

TEST(CommonType, HoldsTheValuesOfBothWhateverTheirOrder) {
    using enum ScalarType;
    for (const auto& [a, b, both] : {std::tuple{int8, uint8, int16},
                                     {uint16, int32, int32},
                                     {uint32, int32, int64},
                                     {int64, uint64, float64},
                                     {uint8, uint32, uint32},
                                     {float32, float64, float64},
                                     {int8, float32, float64},
                                     {float32, float32, float32}}) {
        EXPECT_EQ(io::common_type(a, b), both);
        EXPECT_EQ(io::common_type(b, a), both);
    }
}

} // namespace
} // namespace isotet::test
