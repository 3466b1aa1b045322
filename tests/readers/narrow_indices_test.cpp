// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells of 64-bit indices become int32 where all of them fit, and never where one does not.
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "io/files/byte_source.hpp"
#include "io/pieces/narrow_indices.hpp"
#include "io/vtk_legacy/read_legacy_vtk.hpp"
#include "io/vtk_xml/load.hpp"
#include "readers/sample_bytes.hpp"

namespace isotet::test {
namespace {

using io::ByteSource;
using io::Depth;
using io::NarrowIndices;

template <class T>
std::string stored_bytes(const std::vector<T>& values, bool swapped = false) {
    SampleBytes bytes(swapped);
    for (const T value : values) bytes.number(value);
    return bytes.str();
}

std::vector<double> as_doubles(const std::vector<std::int64_t>& values) { return {values.begin(), values.end()}; }

TEST(NarrowIndices, KeepWhatFitsAndRefuseWhatDoesNot) {
    constexpr std::int64_t largest = 0x7fffffff;
    for (const std::int64_t last : {std::int64_t{0}, largest, largest + 1, std::int64_t{1} << 32, std::int64_t{-1}}) {
        const std::vector<std::int64_t> first{3, largest}, second{last};
        NarrowIndices narrow(3);
        narrow.add(2, std::span(second));
        narrow.add(0, std::span(first));
        const auto array = std::move(narrow).to_array();
        ASSERT_EQ(array.has_value(), last >= 0 && last <= largest) << last;
        if (!array) continue;
        EXPECT_EQ(values_of(*array), (std::vector<double>{3, 0x7fffffff, double(last)}));
    }
}

/// Two tetrahedra and a pyramid, so that offsets are kept; `corner` is the pyramid's last one.
struct MixedCells {
    std::vector<std::int64_t> connectivity{0, 1, 2, 3, 1, 2, 3, 4, 0, 1, 2, 3, 4}, ends{4, 8, 13};

    explicit MixedCells(std::int64_t corner) { connectivity.back() = corner; }
};

constexpr std::int64_t beyond = (std::int64_t{1} << 32) + 4; // 4 if its upper half were lost

std::string vtu_of(const MixedCells& cells) {
    std::string data;
    const auto append = [&](const auto& values) {
        const std::size_t at = data.size();
        const std::string bytes = stored_bytes(values);
        data += stored_bytes(std::vector{static_cast<std::uint32_t>(bytes.size())}) + bytes;
        return at;
    };
    const std::size_t points = append(std::vector<float>(15, 0.5F)), connectivity = append(cells.connectivity),
                      ends = append(cells.ends), types = append(std::vector<std::uint8_t>{10, 10, 14});
    const auto array = [](const char* type, const char* name, int components, std::size_t at) {
        return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
                           "offset=\"{}\"/>",
                           type, name, components, at);
    };
    return fmt::format("<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece "
                       "NumberOfPoints=\"5\" NumberOfCells=\"3\"><Points>{}</Points><Cells>{}{}{}</Cells></Piece>"
                       "</UnstructuredGrid><AppendedData encoding=\"raw\">_{}</AppendedData></VTKFile>",
                       array("Float32", "Points", 3, points), array("Int64", "connectivity", 1, connectivity),
                       array("Int64", "offsets", 1, ends), array("UInt8", "types", 1, types), data);
}

std::string legacy_of(const MixedCells& cells) {
    std::vector<std::int64_t> offsets{0};
    offsets.insert(offsets.end(), cells.ends.begin(), cells.ends.end());
    return "# vtk DataFile Version 5.1\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n" +
           stored_bytes(std::vector<float>(15, 0.5F), true) + "\nCELLS 4 13\nOFFSETS vtktypeint64\n" +
           stored_bytes(offsets, true) + "\nCONNECTIVITY vtktypeint64\n" + stored_bytes(cells.connectivity, true) +
           "\nCELL_TYPES 3\n" + stored_bytes(std::vector<std::int32_t>{10, 10, 14}, true) + "\n";
}

Cells cells_read(const std::string& text, bool legacy) {
    const auto loaded = legacy ? io::load_legacy(ByteSource(text), {}, Depth::arrays, {})
                               : io::vtk_xml::load(ByteSource(text), "UnstructuredGrid", {}, Depth::arrays, false, {});
    EXPECT_TRUE(loaded) << loaded.error().message;
    return loaded ? loaded->pieces.at(0).grid.cells : Cells();
}

class NarrowIndicesOfAFile : public testing::TestWithParam<bool> {};

TEST_P(NarrowIndicesOfAFile, AreInt32WhereAllFit) {
    const MixedCells cells(4);
    const Cells read = cells_read(GetParam() ? legacy_of(cells) : vtu_of(cells), GetParam());
    EXPECT_EQ(read.connectivity.type(), ScalarType::int32);
    EXPECT_EQ(read.offsets.type(), ScalarType::int32);
    EXPECT_EQ(values_of(read.connectivity), as_doubles(cells.connectivity));
    EXPECT_EQ(values_of(read.offsets), (std::vector<double>{0, 4, 8, 13}));
}

TEST_P(NarrowIndicesOfAFile, KeepTheirTypeWhereOneDoesNotFit) {
    for (const std::int64_t corner : {beyond, std::int64_t{-1}}) {
        const MixedCells cells(corner);
        const Cells read = cells_read(GetParam() ? legacy_of(cells) : vtu_of(cells), GetParam());
        EXPECT_EQ(read.connectivity.type(), ScalarType::int64);
        EXPECT_EQ(values_of(read.connectivity), as_doubles(cells.connectivity));
        EXPECT_EQ(values_of(read.offsets), (std::vector<double>{0, 4, 8, 13}));
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, NarrowIndicesOfAFile, testing::Values(false, true),
                         [](const auto& format) { return format.param ? "Legacy" : "Vtu"; });

} // namespace
} // namespace isotet::test
