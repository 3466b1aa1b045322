// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Types and offsets go only where they say nothing, however late the cell comes that differs.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "io/files/byte_source.hpp"
#include "io/vtk_legacy/read_legacy_vtk.hpp"
#include "io/vtk_xml/codec.hpp"
#include "io/vtk_xml/load.hpp"
#include "readers/sample_bytes.hpp"

namespace isotet::test {
namespace {

constexpr std::size_t many_cells = 150'000; ///< their types and offsets are looked at in several pieces

/// Cells of one type with four corners each, but for the last one.
struct LikeCells {
    std::uint8_t type = 10, last_type = 10;
    std::size_t last_corners = 4;

    std::size_t corners() const { return 4 * (many_cells - 1) + last_corners; }
    std::vector<std::int64_t> connectivity() const {
        std::vector<std::int64_t> out;
        for (std::size_t i = 0; i < corners(); ++i) out.push_back(static_cast<std::int64_t>(i % 5));
        return out;
    }
    std::vector<std::int64_t> offsets(bool with_zero) const {
        std::vector<std::int64_t> out;
        for (std::size_t i = with_zero ? 0 : 1; i < many_cells; ++i) out.push_back(static_cast<std::int64_t>(4 * i));
        out.push_back(static_cast<std::int64_t>(corners()));
        return out;
    }
    template <class Type>
    std::vector<Type> types() const {
        std::vector<Type> out(many_cells, Type{type});
        out.back() = Type{last_type};
        return out;
    }
};

template <class T>
std::string bytes_of(const std::vector<T>& values, bool swapped) {
    SampleBytes bytes(swapped);
    for (const T value : values) bytes.number(value);
    return bytes.str();
}

enum class Form : std::uint8_t { vtu, vtu_zlib, legacy };

/// With the sizes that stand in front of it in the file.
std::string with_sizes(const std::string& bytes, Form form) {
    if (form == Form::vtu) return bytes_of(std::vector{static_cast<std::uint32_t>(bytes.size())}, false) + bytes;
    constexpr std::size_t size = 1 << 15;
    const std::size_t blocks = (bytes.size() + size - 1) / size;
    std::vector<std::uint32_t> header{static_cast<std::uint32_t>(blocks), size,
                                      static_cast<std::uint32_t>(bytes.size() % size)};
    std::string packed;
    for (std::size_t block = 0; block < blocks; ++block) {
        const std::string one = bytes.substr(block * size, size);
        const std::string deflated = io::vtk_xml::deflate(io::vtk_xml::Codec::zlib, std::as_bytes(std::span(one)));
        header.push_back(static_cast<std::uint32_t>(deflated.size()));
        packed += deflated;
    }
    return bytes_of(header, false) + packed;
}

std::string vtu_text(const LikeCells& cells, Form form) {
    std::string data, arrays;
    const auto append = [&](const auto& values, const char* type, const char* name, int components) {
        const std::string bytes = with_sizes(bytes_of(values, false), form);
        const auto element = fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
                                         "format=\"appended\" offset=\"{}\"/>",
                                         type, name, components, data.size());
        data += bytes;
        return element;
    };
    const std::string points = append(std::vector<float>(15, 0.5F), "Float32", "Points", 3);
    arrays += append(cells.connectivity(), "Int64", "connectivity", 1);
    arrays += append(cells.offsets(false), "Int64", "offsets", 1);
    arrays += append(cells.types<std::uint8_t>(), "UInt8", "types", 1);
    return fmt::format("<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"{}><UnstructuredGrid><Piece "
                       "NumberOfPoints=\"5\" NumberOfCells=\"{}\"><Points>{}</Points><Cells>{}</Cells></Piece>"
                       "</UnstructuredGrid><AppendedData encoding=\"raw\">_{}</AppendedData></VTKFile>",
                       form == Form::vtu_zlib ? " compressor=\"vtkZLibDataCompressor\"" : "", many_cells, points,
                       arrays, data);
}

std::string legacy_text(const LikeCells& cells) {
    return "# vtk DataFile Version 5.1\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n" +
           bytes_of(std::vector<float>(15, 0.5F), true) +
           fmt::format("\nCELLS {} {}\nOFFSETS vtktypeint64\n", many_cells + 1, cells.corners()) +
           bytes_of(cells.offsets(true), true) + "\nCONNECTIVITY vtktypeint64\n" +
           bytes_of(cells.connectivity(), true) + fmt::format("\nCELL_TYPES {}\n", many_cells) +
           bytes_of(cells.types<std::int32_t>(), true) + "\n";
}

Result<io::Loaded> load_vtu(const std::string& text) {
    return io::vtk_xml::load(io::ByteSource(text), "UnstructuredGrid", {}, io::Depth::arrays, false, {});
}

class CellsOfAFile : public testing::TestWithParam<Form> {
protected:
    static Cells read(const LikeCells& cells) {
        const auto loaded = GetParam() == Form::legacy
                                ? io::load_legacy(io::ByteSource(legacy_text(cells)), {}, io::Depth::arrays, {})
                                : load_vtu(vtu_text(cells, GetParam()));
        EXPECT_TRUE(loaded) << loaded.error().message;
        Cells out = loaded ? loaded->pieces.at(0).grid.cells : Cells();
        const auto expected = cells.connectivity();
        EXPECT_EQ(values_of(out.connectivity), (std::vector<double>{expected.begin(), expected.end()}));
        return out;
    }

    static void expect_kept(const LikeCells& cells) {
        const Cells found = read(cells);
        const auto types = cells.types<std::uint8_t>();
        const auto offsets = cells.offsets(true);
        EXPECT_EQ(values_of(found.types), (std::vector<double>{types.begin(), types.end()}));
        EXPECT_EQ(values_of(found.offsets), (std::vector<double>{offsets.begin(), offsets.end()}));
    }
};

TEST_P(CellsOfAFile, HaveNeitherTypesNorOffsetsWhereAllAreTetrahedra) {
    const Cells found = read({});
    EXPECT_TRUE(found.types.empty());
    EXPECT_TRUE(found.offsets.empty());
    EXPECT_EQ(found.uniform_type, CellType::tetrahedron);
    EXPECT_EQ(found.count(), many_cells);
}

TEST_P(CellsOfAFile, KeepBothWhereTheLastTypeDiffers) { expect_kept({.last_type = 9}); }
TEST_P(CellsOfAFile, KeepBothWhereTheLastCellIsLonger) { expect_kept({.last_type = 14, .last_corners = 5}); }
TEST_P(CellsOfAFile, KeepBothWhereOnlyTheLastOffsetDiffers) { expect_kept({.last_corners = 5}); }
TEST_P(CellsOfAFile, KeepBothWhereTheOneTypeIsNotContoured) { expect_kept({.type = 9, .last_type = 9}); }

/// The last block of types, one byte of it another.
std::string with_changed_byte(std::size_t from_end) {
    std::string text = vtu_text({}, Form::vtu_zlib);
    const std::size_t at = text.find("</AppendedData>") - from_end;
    text[at] = static_cast<char>(text[at] ^ 1);
    return text;
}

TEST(CellsOfZlib, AreErrorsWhereAChecksumIsNotThatOfTheBlock) {
    for (std::size_t from_end = 1; from_end <= io::vtk_xml::checksum_bytes; ++from_end) {
        const auto loaded = load_vtu(with_changed_byte(from_end));
        ASSERT_FALSE(loaded) << from_end;
        EXPECT_NE(loaded.error().message.find("cannot be inflated"), std::string::npos) << loaded.error().message;
    }
}

TEST(CellsOfZlib, AreKnownByChecksumsWhereABlockIsBrokenBeforeIts) {
    const auto loaded = load_vtu(with_changed_byte(io::vtk_xml::checksum_bytes + 3));
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->pieces.at(0).grid.cells.count(), many_cells);
}

TEST(LegacyCells, WithoutTypesTakeNothingOfWhatFollows) {
    const std::string text = "# vtk DataFile Version 5.1\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n" +
                             bytes_of(std::vector<float>(15, 0.5F), true) +
                             "\nCELL_TYPES 0\nPOINT_DATA 5\nSCALARS f float 1\nLOOKUP_TABLE default\n" +
                             bytes_of(std::vector<float>{1, 2, 3, 4, 5}, true) + "\n";
    for (const io::Depth depth : {io::Depth::arrays, io::Depth::description}) {
        const auto loaded = io::load_legacy(io::ByteSource(text), {}, depth, {});
        ASSERT_TRUE(loaded) << loaded.error().message;
        ASSERT_EQ(loaded->info.fields.size(), 1u);
        EXPECT_EQ(loaded->info.fields[0].name, "f");
        if (depth == io::Depth::description) continue;
        EXPECT_EQ(values_of(loaded->pieces.at(0).grid.point_fields.at(0).values), (std::vector<double>{1, 2, 3, 4, 5}));
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, CellsOfAFile, testing::Values(Form::vtu, Form::vtu_zlib, Form::legacy),
                         [](const auto& format) {
                             return format.param == Form::vtu        ? "Vtu"
                                    : format.param == Form::vtu_zlib ? "VtuZlib"
                                                                     : "Legacy";
                         });

} // namespace
} // namespace isotet::test
