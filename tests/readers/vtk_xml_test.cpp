// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK's XML and legacy grids, broken on purpose: an error with a sentence, and no memory for what cannot be there.
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "base/system/memory.hpp"
#include "io/files/byte_source.hpp"
#include "io/files/number_text.hpp"
#include "io/files/text_scanner.hpp"
#include "io/vtk_legacy/read_legacy_vtk.hpp"
#include "io/vtk_xml/base64.hpp"
#include "io/vtk_xml/columns.hpp"
#include "io/vtk_xml/load.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

using io::ByteSource;
using io::Depth;

std::string raw_block(std::string_view bytes) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    return std::string(reinterpret_cast<const char*>(&size), 4) + std::string(bytes);
}

template <class T>
std::string bytes_of(std::vector<T> values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// The attributes of one tetrahedron's file that tests change.
struct TetFile {
    std::string points = "4", cells = "1", root = "", connectivity = "0 1 2 3", offsets = "4", types = "10",
                more_pieces = "";

    std::string text() const {
        const auto array = [](std::string_view type, std::string_view name, std::string_view values) {
            return fmt::format("<DataArray type=\"{}\" Name=\"{}\" format=\"ascii\">{}</DataArray>\n", type, name,
                               values);
        };
        return fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" "
                           "{}>\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" "
                           "NumberOfCells=\"{}\">\n<PointData>{}</PointData>\n<Points><DataArray type=\"Float64\" "
                           "NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 "
                           "1</DataArray></Points>\n<Cells>\n{}{}{}</Cells>\n</Piece>{}\n"
                           "</UnstructuredGrid>\n</VTKFile>\n",
                           root, points, cells, array("Float32", "p", "1 2 3 4"),
                           array("Int32", "connectivity", connectivity), array("Int32", "offsets", offsets),
                           array("UInt8", "types", types), more_pieces);
    }
};

std::string error_of(std::string_view text, std::string_view type = "UnstructuredGrid") {
    const auto loaded = io::vtk_xml::load(ByteSource(text), type, {}, Depth::arrays, false, {});
    return loaded ? "no error" : loaded.error().message;
}

TEST(VtkXml, ReadsATetrahedron) {
    const std::string text = TetFile().text();
    const auto loaded = io::vtk_xml::load(ByteSource(text), "UnstructuredGrid", {}, Depth::arrays, false, {});
    ASSERT_TRUE(loaded) << loaded.error().message;
    const Grid& grid = loaded->pieces.at(0).grid;
    EXPECT_EQ(grid.cells.count(), 1U);
    EXPECT_TRUE(grid.cells.types.empty()) << "tetrahedra one after another need no types";
    EXPECT_EQ(grid.points.at(3, 2), 1);
    EXPECT_EQ(grid.point_fields.at(0).values.at(3), 4);
}

TEST(VtkXml, NamesWhatIsWrong) {
    EXPECT_EQ(error_of(TetFile{.points = "x"}.text()), "NumberOfPoints is 'x', not a count");
    EXPECT_EQ(error_of(TetFile{.points = " 4\n"}.text()), "no error") << "blanks around numbers are none of them";
    EXPECT_EQ(error_of(TetFile{.points = "5"}.text()),
              "the array '' should have 15 numbers, but there are only 23 characters");
    EXPECT_EQ(error_of(TetFile{.connectivity = "0 1 2 3 x"}.text()), "no error") << "behind what the offsets need";
    EXPECT_EQ(error_of(TetFile{.types = "10 x"}.text()),
              "the array 'types': it holds more than the 1 values that are announced");
    EXPECT_EQ(error_of(TetFile{.types = "x"}.text()), "the array 'types': 'x', number 0 of 1, is not uint8");
    EXPECT_EQ(error_of(TetFile{.connectivity = "0 1 2"}.text()),
              "the array 'connectivity' should have 4 numbers, but there are only 5 characters");
    EXPECT_EQ(error_of(TetFile{.offsets = "-4"}.text()), "the last of the offsets is -4");
    EXPECT_EQ(error_of(TetFile{.root = "compressor=\"zip\""}.text()), "the compressor 'zip' is not known");
    EXPECT_EQ(error_of(TetFile{.root = "byte_order=\"Middle\""}.text()), "the byte order 'Middle' is not known");
    EXPECT_EQ(error_of(TetFile{.root = "header_type=\"UInt16\""}.text()),
              "the header type 'UInt16' is not UInt32 or UInt64");
    EXPECT_EQ(error_of(TetFile().text().substr(0, 400)), "the tag at byte 391: it never ends");
    EXPECT_EQ(error_of(TetFile().text(), "ImageData"),
              "this is a VTK file of type 'UnstructuredGrid', not 'ImageData'");
    EXPECT_EQ(error_of("<!DOCTYPE x [<!ENTITY a \"b\">]>" + TetFile().text().substr(22)), "no error");
    EXPECT_EQ(error_of("<!DOCTYPE x [<!ENTITY a \"b\">]"), "the tag at byte 0: it never ends");
    EXPECT_EQ(error_of("<!ENTITY x>"), "the tag at byte 0: a declaration that is none of XML's");
}

TEST(VtkXml, TakesNoMemoryForWhatCannotBeThere) {
    for (const char* count : {"1000000000", "1000000000000", "18446744073709551615"}) {
        EXPECT_NE(error_of(TetFile{.points = count}.text()), "no error") << count;
        EXPECT_NE(error_of(TetFile{.cells = count}.text()), "no error") << count;
    }
    EXPECT_NE(error_of(TetFile{.offsets = "2147483647"}.text()), "no error");
    const std::string image =
        "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 2000000000 0 2000000000 0 1\"/></VTKFile>";
    EXPECT_NE(error_of(image, "ImageData"), "no error");
}

/// A file with one appended array for the points, of a size that the header in front of it states.
std::string appended(std::string_view root, std::string_view encoding, std::string_view data) {
    return fmt::format(
        "<VTKFile type=\"UnstructuredGrid\" {}><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"0\">"
        "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points>"
        "</Piece></UnstructuredGrid><AppendedData encoding=\"{}\">\n _{}\n</AppendedData></VTKFile>",
        root, encoding, data);
}

TEST(VtkXml, ChecksTheSizesInFrontOfBlocks) {
    const std::string places(96, '\0');
    EXPECT_EQ(error_of(appended("", "raw", raw_block(places))), "no error");
    EXPECT_EQ(error_of(appended("", "raw", raw_block(places.substr(8)))),
              "the array '': it has 88 bytes, but 12 float64 take 96");
    EXPECT_EQ(error_of(appended("", "raw", raw_block(places).substr(0, 60))),
              "the array '': 96 bytes are announced, but only 57 are left: the file is cut short or broken");
    const auto packed = [&](std::vector<std::uint32_t> sizes) {
        return error_of(
            appended("compressor=\"vtkZLibDataCompressor\"", "raw", bytes_of(sizes) + std::string(40, 'x')));
    };
    EXPECT_EQ(packed({4000000000U, 96, 0}), "the array '': 4000000000 blocks are announced in 53 bytes");
    EXPECT_EQ(packed({1, 96, 97, 40}), "the array '': its last block has 97 bytes, the others 96");
    EXPECT_EQ(packed({1, 4000000000U, 0, 40}), "the array '': 40 bytes of zlib cannot become 4000000000 bytes");
    EXPECT_EQ(packed({1, 96, 0, 400}),
              "the array '': block 0 of 1 has 400 bytes, but only 41 are left: the file is cut short or broken");
    EXPECT_EQ(packed({1, 96, 0, 40}), "the array '': block 0 of 40 bytes of zlib cannot be inflated to 96 bytes");
    EXPECT_EQ(error_of(appended("", "base64", "AAAA*AAA")), "the array '': its base64 data is broken");
}

TEST(VtkXml, PiecesMustCoverAStructuredGrid) {
    const auto image = [](std::string_view pieces) {
        return fmt::format(
            "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 2 0 1 0 1\">{}</ImageData></VTKFile>", pieces);
    };
    EXPECT_EQ(error_of(image("<Piece Extent=\"0 2 0 1 0 1\"/>"), "ImageData"), "no error");
    EXPECT_EQ(error_of(image("<Piece Extent=\"0 1 0 1 0 1\"/><Piece Extent=\"1 2 0 1 0 1\"/>"), "ImageData"),
              "no error");
    EXPECT_EQ(error_of(image("<Piece Extent=\"0 1 0 1 0 1\"/>"), "ImageData"),
              "the pieces have 8 of the 12 points of the whole extent");
    EXPECT_EQ(error_of(image("<Piece Extent=\"0 1 0 1 0 1\"/><Piece Extent=\"0 1 0 1 0 1\"/>"), "ImageData"),
              "the pieces have 8 of the 12 points of the whole extent");
    EXPECT_EQ(error_of(image("<Piece Extent=\"0 3 0 1 0 1\"/>"), "ImageData"),
              "a piece reaches out of the whole extent");
}

/// A box of points from `first` to `last` along z, 0 to 3 else, with a cell field that is `value`.
std::string image_piece(int first, int last, int value) {
    std::string values;
    for (int i = 0; i < 9 * std::max(last - first, 1); ++i) values += fmt::format("{} ", value);
    return fmt::format("<Piece Extent=\"0 3 0 3 {} {}\"><PointData/><CellData><DataArray type=\"Float32\" Name=\"c\" "
                       "format=\"ascii\">{}</DataArray></CellData></Piece>",
                       first, last, values);
}

std::string image_file(int first, int last, std::string_view pieces) {
    return fmt::format("<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 3 0 3 {} {}\" Origin=\"0 0 0\" "
                       "Spacing=\"1 1 1\">{}</ImageData></VTKFile>",
                       first, last, pieces);
}

TEST(VtkXml, PlanesHaveQuadrilateralsWithTheirFields) {
    const TemporaryFolder folder;
    const auto plane = read(folder.write("plane.vti", image_file(2, 2, image_piece(2, 2, 7)))).value();
    ASSERT_EQ(plane.grid.cells.count(), 9u);
    EXPECT_EQ(plane.grid.cells.types.at(8), 9);
    ASSERT_EQ(plane.grid.cell_fields.size(), 1u);
    EXPECT_EQ(plane.grid.cell_fields[0].values.at(8), 7);
}

/// A flat piece has points of the box, and none of its cells.
TEST(VtkXml, PlanesInABoxTakeNoneOfItsCells) {
    const TemporaryFolder folder;
    for (const int at : {0, 1, 3})
        for (const bool before : {false, true}) {
            const std::string solid = image_piece(0, 3, 1), flat = image_piece(at, at, 9);
            const auto box =
                read(folder.write("box.vti", image_file(0, 3, before ? flat + solid : solid + flat))).value();
            ASSERT_EQ(box.grid.cells.count(), 27u);
            for (std::size_t cell = 0; cell < 27; ++cell) EXPECT_EQ(box.grid.cell_fields[0].values.at(cell), 1);

            folder.write("solid.vti", image_file(0, 3, solid));
            folder.write("flat.vti", image_file(at, at, flat));
            const std::string solid_piece = "<Piece Extent=\"0 3 0 3 0 3\" Source=\"solid.vti\"/>",
                              flat_piece = fmt::format("<Piece Extent=\"0 3 0 3 {0} {0}\" Source=\"flat.vti\"/>", at);
            const auto joined =
                read(folder.write("box.pvti",
                                  fmt::format("<VTKFile type=\"PImageData\"><PImageData WholeExtent=\"0 3 0 3 0 3\" "
                                              "GhostLevel=\"0\" Origin=\"0 0 0\" Spacing=\"1 1 1\"><PPointData/>"
                                              "<PCellData><PDataArray type=\"Float32\" Name=\"c\"/></PCellData>"
                                              "{}{}</PImageData></VTKFile>",
                                              before ? flat_piece : solid_piece, before ? solid_piece : flat_piece)))
                    .value();
            std::size_t volumes = 0;
            const Cells& cells = joined.grid.cells;
            for (std::size_t cell = 0; cell < cells.count(); ++cell)
                volumes += cells.types.empty() || cells.types.at(cell) == 12;
            EXPECT_EQ(volumes, 27u) << at;
            EXPECT_EQ(cells.count(), 36u) << at;
        }
}

TEST(VtkXml, GhostRanksOfGeosMarkGhostCells) {
    std::vector<std::uint8_t> left_out;
    io::vtk_xml::mark_left_out(Array::own(std::vector<std::int32_t>{-2, -1, 0, 3}), "ghostRank", left_out);
    EXPECT_EQ(left_out, (std::vector<std::uint8_t>{0, 0, 1, 1}));
    left_out.clear();
    io::vtk_xml::mark_left_out(Array::own(std::vector<std::int32_t>{0, 0, 1}), "ghostRank", left_out);
    EXPECT_TRUE(left_out.empty()) << "a field of that name with another meaning";
}

TEST(VtkXml, PiecesOfOneFileAreToldApart) {
    TetFile file;
    const std::string one = file.text();
    const auto begin = one.find("<Piece"), end = one.find("</Piece>") + 8;
    file.more_pieces = one.substr(begin, end - begin);
    const std::string two = file.text();
    const auto loaded = io::vtk_xml::load(ByteSource(two), "UnstructuredGrid", {}, Depth::arrays, false, {});
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_EQ(loaded->pieces.size(), 2U);
    for (const io::Piece& piece : loaded->pieces) {
        EXPECT_EQ(piece.grid.points.tuples(), 4U);
        EXPECT_EQ(piece.grid.cells.count(), 1U);
        EXPECT_EQ(piece.grid.cells.connectivity.at(3), 3);
        EXPECT_EQ(piece.grid.point_fields.at(0).values.at(3), 4);
    }
}

TEST(VtkXml, PointsOfPiecesOfOneFileAreJoinedByTheRoundingsOfTheTypesStored) {
    const TemporaryFolder folder;
    TetFile file;
    std::string one = file.text();
    one.replace(one.find("0 0 0 1 0 0"), 11, "0.1 0 0 1 0 0");
    const auto begin = one.find("<Piece"), end = one.find("</Piece>") + 8;
    for (const bool single : {false, true}) {
        std::string other = one.substr(begin, end - begin);
        other.replace(other.find("0.1 0 0"), 3, "0.10000000149011612"); // 0.1 as float32
        if (single) other.replace(other.find("Float64"), 7, "Float32");
        const std::string path = folder.write("a.vtu", one.substr(0, end) + other + one.substr(end));
        const auto result = read(path);
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.points.tuples(), single ? 4U : 5U);
        EXPECT_EQ(result->grid.points.type(), ScalarType::float64);
    }
}

TEST(VtkXml, ReadsBase64WithLineBreaks) {
    std::string block = raw_block(bytes_of<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}));
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    block.resize((block.size() + 2) / 3 * 3);
    std::string text;
    for (std::size_t i = 0; i < block.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = (group << 8U) | static_cast<unsigned char>(block[i + k]);
        for (unsigned k = 0; k < 4; ++k) text += digits[(group >> (18U - 6U * k)) & 63U];
        if (i % 12 == 9) text += "\n  ";
    }
    std::string file = TetFile().text();
    const std::string ascii = ">0 0 0 1 0 0 0 1 0 0 0 1<";
    file.replace(file.find(ascii), ascii.size(), " format=\"binary\">\n  " + text + "\n<");
    EXPECT_EQ(error_of(file), "no error");
}

TEST(VtkXml, IsAnErrorForPipesAndFolders) {
    const TemporaryFolder folder;
    ASSERT_EQ(::mkfifo(folder.file("pipe.vtu").c_str(), 0600), 0);
    ReadOptions options;
    for (const char* format : {"vtu", "pvtu", "vti", "vtk", "pvd"}) {
        options.format = format;
        EXPECT_FALSE(read(folder.file("pipe.vtu"), options)) << format;
        EXPECT_FALSE(read(folder.file("."), options)) << format;
    }
}

TEST(ByteSource, OfAFileThatBecameShorterIsAnError) {
    const TemporaryFolder folder;
    const auto source = ByteSource::open(folder.write("file", std::string(1000, 'x')));
    ASSERT_TRUE(source);
    std::vector<std::byte> room(1000);
    EXPECT_TRUE(source->read(0, room));
    std::filesystem::resize_file(folder.file("file"), 500);
    const auto shorter = source->read(0, room);
    ASSERT_FALSE(shorter);
    EXPECT_EQ(shorter.error().code, ErrorCode::file);
    EXPECT_FALSE(source->read(999, std::span(room).first(2))) << "behind the end";
}

TEST(VtkXml, StopsOnCancel) {
    const std::string text = TetFile().text();
    const std::atomic<bool> cancel = true;
    Progress progress;
    progress.cancel = &cancel;
    const auto loaded = io::vtk_xml::load(ByteSource(text), "UnstructuredGrid", {}, Depth::arrays, false, progress);
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().code, ErrorCode::cancelled);
}

TEST(VtkXml, IsAnErrorForEveryTruncation) {
    const std::string whole = TetFile().text(), raw = appended("", "raw", raw_block(std::string(96, '\0')));
    for (const std::string& text : {whole, raw})
        for (std::size_t length = 0; length + 12 < text.size(); ++length) {
            const std::vector<char> cut(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(length));
            EXPECT_NE(error_of({cut.data(), cut.size()}), "no error") << length;
        }
}

TEST(Base64, DecodesWhatWasEncodedAndRefusesEverythingElse) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::mt19937 random(7);
    for (std::size_t groups = 1; groups < 60; ++groups) {
        std::string text, bytes;
        for (std::size_t i = 0; i < groups; ++i) {
            const std::uint32_t group = random() & 0xFFFFFFU;
            for (unsigned k = 0; k < 3; ++k) bytes += static_cast<char>(group >> (16U - 8U * k));
            for (unsigned k = 0; k < 4; ++k) text += digits[(group >> (18U - 6U * k)) & 63U];
        }
        std::vector<std::byte> to(io::vtk_xml::decoded_room(text.size()));
        const auto size = io::vtk_xml::decode_base64(text, to.data());
        ASSERT_TRUE(size);
        EXPECT_EQ(std::string(reinterpret_cast<const char*>(to.data()), *size), bytes);
        for (int c = 0; c < 256; ++c) {
            std::string changed = text;
            const std::size_t at = random() % text.size();
            changed[at] = static_cast<char>(c);
            const bool last_padding = c == '=' && at + 1 == text.size();
            EXPECT_EQ(io::vtk_xml::decode_base64(changed, to.data()).has_value(),
                      digits.find(static_cast<char>(c)) != std::string_view::npos || last_padding);
        }
        EXPECT_FALSE(io::vtk_xml::decode_base64(text.substr(1), to.data()));
    }
}

TEST(NumberText, IsReadAcrossChunks) {
    std::string text;
    std::vector<double> expected;
    std::mt19937 random(3);
    while (text.size() < 3000000) {
        expected.push_back(static_cast<double>(random()) / 64);
        text += fmt::format("{}{}", expected.back(), random() % 5 ? " " : "\n   \t");
    }
    std::vector<double> numbers(expected.size());
    auto* const to = reinterpret_cast<std::byte*>(numbers.data());
    const auto end =
        io::read_numbers(ByteSource(text), 0, text.size(), ScalarType::float64, expected.size(), "x", to, {});
    ASSERT_TRUE(end) << end.error().message;
    EXPECT_EQ(numbers, expected);

    const std::size_t some = expected.size() / 2;
    const auto middle = io::read_numbers(ByteSource(text), 0, text.size(), ScalarType::float64, some, "x", to, {});
    ASSERT_TRUE(middle);
    io::TextScanner scanner(text);
    scanner.seek(*middle);
    double next = 0;
    ASSERT_TRUE(scanner.number(next));
    EXPECT_EQ(next, expected[some]);

    const auto more =
        io::read_numbers(ByteSource(text), 0, text.size(), ScalarType::float64, expected.size() + 1, "x", to, {});
    ASSERT_FALSE(more);
    EXPECT_EQ(more.error().message, fmt::format("x has {} numbers, not {}", expected.size(), expected.size() + 1));
}

std::string legacy_error(std::string_view text) {
    const auto loaded = io::load_legacy(ByteSource(text), {}, Depth::arrays, {});
    return loaded ? "no error" : loaded.error().message;
}

TEST(LegacyVtkGrid, NamesWhatIsWrong) {
    const std::string beginning =
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n";
    EXPECT_EQ(legacy_error(beginning + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"), "no error");
    EXPECT_EQ(legacy_error(beginning + "CELLS 2 5\n4 0 1 2 3\nCELL_TYPES 2\n10 10\n"),
              "cells: cell 1 of 2 does not fit into the 5 numbers");
    EXPECT_EQ(legacy_error(beginning + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 2\n10 10\n"),
              "there are 1 cells, but 2 cell types");
    EXPECT_EQ(legacy_error(beginning + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n256\n"),
              "CELL_TYPES: a type is not between 0 and 255");
    EXPECT_EQ(legacy_error(beginning + "CELLS 1 500000000000\n4 0 1 2 3\n"),
              "cells: 500000000000 x 1 numbers were announced, but only 11 bytes are left");
    EXPECT_EQ(
        legacy_error("# vtk DataFile Version 3.0\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4000000000 double\n"),
        "POINTS: 4000000000 x 3 double were announced, but only 0 bytes are left");
    EXPECT_EQ(
        legacy_error(
            "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2000000000 2000000000 2\n"
            "POINT_DATA 1\nSCALARS s float\nLOOKUP_TABLE default\n1\n"),
        "point field 's' cannot be read: it has 1 values, but the grid has 8000000000000000000 points");
}

TEST(ReadPvd, NotesDataSetsWithoutATimeBesideOthers) {
    const TemporaryFolder folder;
    folder.write("a.vtu", R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid>
<Piece NumberOfPoints="4" NumberOfCells="1">
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">4</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)");
    const auto notes_of = [&](const std::string& time) {
        const auto result = read(folder.write("a.pvd", "<VTKFile type=\"Collection\"><Collection><DataSet " + time +
                                                           " file=\"a.vtu\"/><DataSet file=\"a.vtu\"/>"
                                                           "</Collection></VTKFile>"));
        EXPECT_TRUE(result) << result.error().message;
        std::string all;
        for (const std::string& note : result->notes) all += note + "\n";
        return all;
    };
    EXPECT_NE(notes_of("timestep=\"1\"").find("1 of 2 data sets of the collection has no timestep"), std::string::npos);
    EXPECT_EQ(notes_of("").find("no timestep"), std::string::npos);
}

} // namespace
} // namespace isotet::test
