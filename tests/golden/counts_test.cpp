// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces of the real grids in data/ have the counts and vertex positions that they had when VTK agreed with them. The
// hash is of the set of positions, bit for bit: it is the same on every machine and for every way of packing.
#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <isotet/fields.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "golden/golden_files.hpp"
#include "support/places.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {
namespace {

/// FNV-1a over the positions in ascending order.
std::uint64_t hash_of(const Surface& surface) {
    std::vector<PositionBits> positions;
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
        const auto p = position_of(surface, v);
        positions.push_back(bits_of(p[0], p[1], p[2]));
    }
    std::sort(positions.begin(), positions.end());
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const PositionBits& position : positions)
        for (const std::uint64_t bits : position)
            for (unsigned shift = 0; shift < 64; shift += 8) hash = (hash ^ (bits >> shift & 0xff)) * 0x100000001b3u;
    return hash;
}

/// One line for each surface: field, isovalue, mode, counts, hash.
std::string lines_of(const Grid& grid) {
    std::string lines;
    for (const std::string& name : fields_to_contour(grid)) {
        const PointField field = find_field(grid, name).value();
        const PackedGrid packed = pack(grid, field).value();
        const double isovalue = packed.field().lower + 0.375 * (packed.field().upper - packed.field().lower);
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            ExtractOptions options;
            options.ties = ties;
            const Surface surface = extract(packed, isovalue, options).value().surface;
            lines += fmt::format("{} = {} {}: {} vertices, {} triangles, {:016x}\n", name, isovalue,
                                 ties == Ties::merge ? "merge" : "keep", surface.vertex_count(),
                                 surface.triangle_count(), hash_of(surface));
        }
    }
    return lines;
}

class GoldenCounts : public testing::TestWithParam<GoldenFile> {};

std::vector<GoldenFile> files_that_can_be_read() {
    std::vector<GoldenFile> files;
    for (const GoldenFile& file : golden_files)
        if (!file.reader_process || ISOTET_GOLDEN_VTK) files.push_back(file);
    return files;
}

std::string file_name(const char* path) {
    std::string name = path;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(Data, GoldenCounts, testing::ValuesIn(files_that_can_be_read()),
                         [](const auto& file) { return file_name(file.param.path); });

TEST_P(GoldenCounts, AreThoseOfTheRecord) {
    auto read = read_golden(GetParam().path);
    ASSERT_TRUE(read) << read.error().message;
    const std::string path = source_folder().string() + "/tests/golden/record/" + file_name(GetParam().path) + ".txt";
    std::ifstream file(path);
    const std::string expected((std::istreambuf_iterator<char>(file)), {});
    EXPECT_EQ(lines_of(read->grid), expected) << "differs from " << path;
}

TEST(GoldenFiles, AreAllThatDataHolds) {
    namespace fs = std::filesystem;
    const fs::path data = source_folder() / "data";
    // Read through another file, held to an error below, or in tests of levels: solver_files_test.cpp and,
    // of amr/, vtkhdf_amr_test.cpp.
    const std::set<std::string> others{"README.md",
                                       ".gitattributes",
                                       "tetgen/ellipsoid_16k.ele",
                                       "xdmf/no_checkpoint.h5",
                                       "xdmf/tet4_vertex.h5",
                                       "pvtu/monodomain/monodomain3d_0.vtu",
                                       "pvtu/monodomain/monodomain3d_1.vtu",
                                       "vtk/mfem_levels_tet.vtk",
                                       "vtu/dealii_refined_ball.vtu",
                                       "vtu/mfem_levels_hex.vtu",
                                       "vtu/mfem_levels_wedge.vtu",
                                       "vtu/quadratic_tets_96.vtu"};
    std::set<std::string> listed;
    for (const GoldenFile& file : golden_files) listed.insert(file.path);
    for (const auto& entry : fs::recursive_directory_iterator(data)) {
        const std::string path = entry.path().lexically_relative(data).generic_string();
        const bool elsewhere = path.starts_with("licences/") || path.starts_with("amr/") || others.contains(path);
        if (!entry.is_regular_file() || elsewhere) continue;
        EXPECT_EQ(listed.erase(path), 1u) << path << " is in data/, but in no test";
    }
    EXPECT_EQ(listed, std::set<std::string>{}) << "tested, but not in data/";
}

TEST(GoldenErrors, NameWhatIsNotContouredYet) {
    if constexpr (ISOTET_GOLDEN_VTK) {
        auto read = read_golden("vtu/quadratic_tets_96.vtu");
        ASSERT_TRUE(read) << read.error().message;
        const auto packed = pack(read->grid, find_field(read->grid, "x").value());
        ASSERT_FALSE(packed);
        EXPECT_NE(packed.error().message.find("96 x quadratic tetrahedron"), std::string::npos)
            << packed.error().message;
    }
    EXPECT_FALSE(read_golden("README.md"));
    EXPECT_FALSE(read_golden("no such file.vtu"));
}

TEST(GmshVersions, HoldTheSameSurface) {
    const auto surface_of = [](const char* path) {
        const Grid grid = read_golden(path).value().grid;
        return hash_of(extract(pack(grid, find_field(grid, "x").value()).value(), 0.1).value().surface);
    };
    const std::uint64_t expected = surface_of("msh/inclusions_v22_ascii.msh");
    EXPECT_EQ(surface_of("msh/inclusions_v41_ascii.msh"), expected);
    EXPECT_EQ(surface_of("msh/inclusions_v41_binary.msh"), expected);
}

} // namespace
} // namespace isotet::test
