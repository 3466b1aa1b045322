// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Zones of cells in OpenFOAM cases: every encoding, whole and decomposed cases, regions, and files that are broken.
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "readers/foam_sample.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

double number_of(const std::array<double, 3>& p) { return p[0] + 10 * p[1] + 100 * p[2]; }

class ReadOpenfoamZones : public testing::Test {
protected:
    void SetUp() override {
        box_.zones = {{"rotor", {}}, {"porous", {}}, {"none", {}}};
        for (std::size_t cell = 0; cell < box_.centres.size(); ++cell) {
            const auto& centre = box_.centres[cell];
            if (centre[0] < 1) box_.zones[0].cells.push_back(static_cast<std::int64_t>(cell));
            if (centre[1] > 1) box_.zones[1].cells.push_back(static_cast<std::int64_t>(cell));
        }
    }

    static Result<ReadResult> read_zones(const FoamFiles& files, const std::vector<std::string>& zones) {
        const TemporaryFolder folder;
        for (const auto& [name, content] : files) folder.write(name, content);
        ReadOptions options;
        options.step = 1;
        options.blocks = zones;
        return read(folder.file(""), options);
    }

    /// That the grid has the cells whose centres `inside` accepts, in their order, each with its values.
    template <class Inside>
    void expect_cells(const Result<ReadResult>& result, const Inside& inside) const {
        ASSERT_TRUE(result) << result.error().message;
        std::vector<double> expected;
        for (const auto& centre : box_.centres)
            if (inside(centre)) expected.push_back(number_of(centre));
        const Grid& grid = result->grid;
        ASSERT_EQ(grid.cells.count(), expected.size());
        ASSERT_EQ(grid.cell_fields.size(), 2u);
        const Array& values = grid.cell_fields[grid.cell_fields[0].name == "T" ? 0 : 1].values;
        for (std::size_t cell = 0; cell < expected.size(); ++cell) EXPECT_EQ(values.at(cell), expected[cell]) << cell;
        std::vector<bool> used(grid.points.tuples());
        for (std::size_t i = 0; i < grid.cells.connectivity.size(); ++i)
            used.at(static_cast<std::size_t>(grid.cells.connectivity.at(i))) = true;
        for (const bool one : used) EXPECT_TRUE(one);
        for (const Field& field : grid.point_fields) EXPECT_EQ(field.values.tuples(), grid.points.tuples());
    }

    static std::string message_of(const FoamFiles& files, const std::vector<std::string>& zones) {
        const auto result = read_zones(files, zones);
        EXPECT_FALSE(result);
        return result ? "" : result.error().message;
    }

    FoamBox box_ = foam_box(3, [](int x, int y, int z) { return x == 1 && y == 1 && z == 1; });
};

bool in_rotor(const std::array<double, 3>& centre) { return centre[0] < 1; }
bool in_porous(const std::array<double, 3>& centre) { return centre[1] > 1; }

TEST_F(ReadOpenfoamZones, AreReadAloneInEveryEncoding) {
    for (const FoamStyle style :
         {FoamStyle{false, 32, 64}, FoamStyle{true, 32, 64}, FoamStyle{true, 64, 64}, FoamStyle{false, 64, 64}}) {
        SCOPED_TRACE(fmt::format("{} {}", style.binary ? "binary" : "ascii", style.label));
        const FoamFiles files = foam_case(box_, number_of, style);
        expect_cells(read_zones(files, {"rotor"}), in_rotor);
        expect_cells(read_zones(files, {"2"}), in_porous);
        expect_cells(read_zones(files, {"rotor", "porous"}),
                     [](const auto& centre) { return in_rotor(centre) || in_porous(centre); });
        expect_cells(read_zones(files, {}), [](const auto&) { return true; });
    }
}

TEST_F(ReadOpenfoamZones, AreReadFromDecomposedCases) {
    for (const bool binary : {false, true}) {
        const FoamFiles files = foam_case(box_, number_of, {binary, 32, 64}, 4);
        expect_cells(read_zones(files, {"porous"}), in_porous);
        expect_cells(read_zones(collated(files, {4}, false), {"porous"}), in_porous);
    }
}

TEST_F(ReadOpenfoamZones, AreListedWithTheirCounts) {
    for (const int processors : {0, 3}) {
        const TemporaryFolder folder;
        for (const auto& [name, content] : foam_case(box_, number_of, {}, processors)) folder.write(name, content);
        const auto info = inspect(folder.file(""));
        ASSERT_TRUE(info) << info.error().message;
        ASSERT_EQ(info->blocks.size(), 2u) << "the third has no cells";
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(info->blocks[i].name, box_.zones[i].name);
            EXPECT_EQ(info->blocks[i].number, static_cast<std::int64_t>(i + 1));
            EXPECT_EQ(info->blocks[i].kind, "zone");
            EXPECT_EQ(info->blocks[i].cells, box_.zones[i].cells.size());
        }
    }
}

TEST_F(ReadOpenfoamZones, StandBehindTheRegionsThatTheyAreIn) {
    FoamFiles files;
    for (const char* region : {"air", "iron"})
        for (const auto& [name, content] : foam_case(box_, number_of, {})) {
            const std::size_t slash = name.find('/');
            files[name.substr(0, slash + 1) + region + name.substr(slash)] = content;
        }
    const auto refused = message_of(files, {"steel"});
    EXPECT_NE(refused.find("1 'air', 2 'iron', 3 'air/rotor', 4 'air/porous'"), std::string::npos) << refused;
    expect_cells(read_zones(files, {"iron/rotor"}), in_rotor);
    expect_cells(read_zones(files, {"iron", "iron/rotor"}), [](const auto&) { return true; });
    const auto both = read_zones(files, {"rotor"}); // of both regions
    ASSERT_TRUE(both) << both.error().message;
    EXPECT_EQ(both->grid.cells.count(), box_.zones[0].cells.size()) << "the regions lie at one place";
}

TEST_F(ReadOpenfoamZones, MayHaveNoCells) {
    expect_cells(read_zones(foam_case(box_, number_of, {}), {"none"}), [](const auto&) { return false; });
}

TEST_F(ReadOpenfoamZones, ThatAreBrokenAreErrorsOnlyWhereTheyAreAskedFor) {
    const std::string name = "constant/polyMesh/cellZones";
    for (const bool binary : {false, true}) {
        FoamFiles files = foam_case(box_, number_of, {binary, 32, 64});
        const std::string whole = files.at(name);
        const std::size_t end = whole.rfind(')');
        for (std::size_t length = 0; length <= end; length += 7) {
            files[name] = whole.substr(0, length);
            const TemporaryFolder folder;
            for (const auto& [file, content] : files) folder.write(file, content);
            const auto rest = read(folder.file(""));
            ASSERT_TRUE(rest) << "cut to " << length << ": " << rest.error().message;
            EXPECT_EQ(rest->grid.cells.count(), box_.centres.size());
            ASSERT_EQ(rest->info.left_out.size(), 1u);
            EXPECT_NE(rest->notes.back().find("cellZones"), std::string::npos) << rest->notes.back();
            ReadOptions options;
            options.blocks = {box_.zones.back().name};
            if (std::ranges::find(rest->info.blocks, options.blocks[0], &BlockInfo::name) != rest->info.blocks.end()) {
                EXPECT_TRUE(read(folder.file(""), options)) << "zones before the fault are sound";
            } else if (!box_.zones.back().cells.empty()) {
                EXPECT_NE(message_of(files, options.blocks).find("cellZones"), std::string::npos)
                    << "cut to " << length << ": " << message_of(files, options.blocks);
            }
        }
    }
    for (const std::int64_t cell : {std::int64_t{-1}, std::int64_t(box_.centres.size())}) {
        FoamBox box = box_;
        box.zones[1].cells.push_back(cell);
        const std::string message = message_of(foam_case(box, number_of, {}), {"porous"});
        EXPECT_NE(message.find("cellZones"), std::string::npos) << message;
        EXPECT_NE(message.find("porous"), std::string::npos) << message;
    }
}

} // namespace
} // namespace isotet::test
