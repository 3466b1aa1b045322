// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Exodus II files, alone and in parts, whole and broken.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <vtk_exodusII.h>

#include <isotet/fields.hpp>
#include <isotet/make.hpp>
#include <isotet/read.hpp>
#include <isotet/solid.hpp>

#include "support/counted_cells.hpp"
#include "support/places.hpp"
#include "pieces/partition.hpp"
#include "vtk_readers/active_cells.hpp"
#include "vtk_readers/hdf5_writer.hpp"
#include "vtk_readers/sample_exodus.hpp"
#include "vtk_readers/sample_grid.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

TEST(ExodusSideSets, AreFacesOfTheBoundary) {
    ReadOptions options;
    options.patches = true;
    const auto result = read(source_folder().string() + "/data/exodus/tension_tets_stress_3steps.e", options);
    ASSERT_TRUE(result) << result.error().message;
    const Grid& grid = result->grid;
    ASSERT_EQ(grid.patches.names.size(), 4u);
    EXPECT_EQ(grid.patches.names[3].name, "surface_4");
    EXPECT_EQ(grid.patches.count(), 234u + 234u + 46u + 50u);
    Solids solids = Solids::create({grid, find_field(grid, "x").value(), {}, {}}).value();
    const Solid whole = solids.extract(SolidRange::above(-1e30)).value();
    ASSERT_EQ(whole.patches.size(), 4u);
    EXPECT_EQ(whole.patches[2].triangles, 46u);
    EXPECT_EQ(whole.patches[3].triangles, 50u);
}

TEST(ExodusSideSets, OfMixedAndQuadraticBlocksAreFacesOfTheBoundary) {
    ReadOptions options;
    options.patches = true;
    const auto result = read(source_folder().string() + "/data/exodus/mixed_blocks_hdf5.exo", options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.patches.names.size(), 13u);
    EXPECT_TRUE(result->info.left_out.empty());
}

class ReadExodus : public testing::TestWithParam<int> {
protected:
    std::string written(ExodusSample sample = {}) const {
        sample.format = GetParam();
        write_exodus(sample, folder_.file("sample.e"));
        return folder_.file("sample.e");
    }
    TemporaryFolder folder_;
};

TEST_P(ReadExodus, SharesNodesBetweenBlocksAndDoesNotMoveThem) {
    const auto result = read(written());
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.format, "exodus");
    EXPECT_EQ(result->grid.points.tuples(), 5u);
    EXPECT_EQ(result->grid.points.at(1, 0), 1);
    ASSERT_EQ(result->grid.cells.count(), 2u);
    const std::vector<std::int64_t> corners = {0, 1, 2, 3, 0, 2, 1, 4};
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_EQ(result->grid.cells.connectivity.at(i), static_cast<double>(corners[i]));
}

TEST_P(ReadExodus, KeepsTheNamesOfVariables) {
    const auto result = read(written());
    ASSERT_TRUE(result) << result.error().message;
    std::vector<std::string> names;
    for (const Field& field : result->grid.point_fields) names.push_back(field.name);
    EXPECT_EQ(names, (std::vector<std::string>{"disp_x", "disp_y", "disp_z", "temp"}));
}

TEST_P(ReadExodus, ReadsTheStepThatIsAskedFor) {
    ReadOptions options;
    options.step = 1;
    options.point_fields = {"temp"};
    const auto result = read(written(), options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.times, (std::vector<double>{0, 0.5}));
    EXPECT_EQ(result->step, 1u);
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(result->grid.point_fields[0].values.at(4), 14);
    options.step = 2;
    const auto beyond = read(written(), options);
    ASSERT_FALSE(beyond);
    EXPECT_EQ(beyond.error().code, ErrorCode::invalid_argument);
}

TEST_P(ReadExodus, HasNaNInBlocksWithoutAVariable) {
    const auto result = read(written());
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->grid.cell_fields.size(), 1u);
    EXPECT_EQ(result->grid.cell_fields[0].values.at(0), 0);
    EXPECT_TRUE(std::isnan(result->grid.cell_fields[0].values.at(1)));
    ASSERT_EQ(result->notes.size(), 1u);
    EXPECT_NE(result->notes[0].find("cell field \"load\" is not defined in 1 of 2 element blocks"), std::string::npos);
    ExodusSample sample;
    sample.more_loads = true;
    const auto several = read(written(sample));
    ASSERT_TRUE(several) << several.error().message;
    ASSERT_EQ(several->notes.size(), 1u);
    EXPECT_NE(
        several->notes[0].find("cell fields \"load\", \"drag\", \"lift\" are not defined in 1 of 2 element blocks"),
        std::string::npos);
}

TEST_P(ReadExodus, MovesThePointsWhenAsked) {
    ReadOptions options;
    options.step = 1;
    for (const char* name : {"disp", "disp_"}) {
        options.displace = name;
        const auto result = read(written(), options);
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.points.at(1, 0), 12);
        EXPECT_EQ(result->grid.points.at(4, 2), 13);
    }
    options.displace = "nothing";
    EXPECT_FALSE(read(written(), options));
}

TEST_P(ReadExodus, KeepsSinglePrecision) {
    ExodusSample sample;
    sample.single = true;
    const auto result = read(written(sample));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.points.type(), ScalarType::float32);
    EXPECT_EQ(result->grid.point_fields.at(0).values.type(), ScalarType::float32);
}

TEST_P(ReadExodus, IsAnErrorForEveryTruncationBeforeTheEndOfTheFirstStep) {
    const std::string content = content_of(written());
    read_prefixes(content, "cut.e", content.size() / 30 + 1, [](const Result<ReadResult>& result, std::size_t length) {
        if (!result) return;
        EXPECT_NE(GetParam(), EX_NETCDF4) << "cut to " << length << " bytes";
        EXPECT_EQ(result->info.times, std::vector<double>{0}) << "cut to " << length << " bytes";
    });
}

TEST_P(ReadExodus, LeavesOutTheStepThatIsCutShort) {
    ExodusSample sample;
    sample.steps = 3;
    const std::string content = content_of(written(sample));
    const auto result = read(folder_.write("cut.e", content.substr(0, content.size() - 9)));
    if (GetParam() == EX_NETCDF4) {
        ASSERT_FALSE(result);
        return;
    }
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.times, (std::vector<double>{0, 0.5}));
    EXPECT_EQ(std::ranges::count(result->notes, "the last of 3 time steps is cut short and left out"), 1);
    ReadOptions options;
    options.step = 1;
    const auto last = read(folder_.file("cut.e"), options);
    ASSERT_TRUE(last) << last.error().message;
    EXPECT_EQ(last->grid.point_fields.at(3).values.at(4), 14);
}

TEST_P(ReadExodus, HasNaNForValuesThatWereNeverWritten) {
    for (const bool single : {false, true}) {
        ExodusSample sample;
        sample.single = single;
        sample.filled_from = 1;
        ReadOptions options;
        options.step = 1;
        const auto result = read(written(sample), options);
        ASSERT_TRUE(result) << result.error().message;
        for (std::size_t i = 0; i < 5; ++i) EXPECT_TRUE(std::isnan(result->grid.point_fields.at(3).values.at(i)));
        EXPECT_TRUE(std::isnan(result->grid.cell_fields.at(0).values.at(0)));
        for (const char* note : {"point field \"temp\" has 5 values of 5 that were never written: NaN there",
                                 "cell field \"load\" has 1 values of 2 that were never written: NaN there"})
            EXPECT_EQ(std::ranges::count(result->notes, note), 1) << note;
        EXPECT_EQ(read(written(sample))->grid.point_fields.at(3).values.at(4), 4);
    }
}

TEST_P(ReadExodus, IsAnErrorWhenAnElementHasANodeThatIsNotThere) {
    for (const int node : {0, -1, 6}) {
        ExodusSample sample;
        sample.blocks[1][2] = node;
        const auto result = read(written(sample));
        ASSERT_FALSE(result) << node;
        EXPECT_NE(result.error().message.find("block 20 has node"), std::string::npos) << result.error().message;
    }
}

/// Parts of a grid with cells of all types, a block each; the last part has none.
void write_mixed_parts(const TemporaryFolder& folder, int format, std::size_t parts = 3, std::size_t steps = 0) {
    const Grid whole = make_grid({.shape = "mixed", .side = 4, .fields = {"plane"}}).value();
    const PointField field{"plane", whole.point_fields[0].values, false, {}};
    const core::CellReader reader = core::CellReader::open(whole).value();
    std::mt19937 random(5);
    for (std::size_t part = 0; part < parts; ++part) {
        std::vector<std::uint64_t> cells;
        const std::size_t with_cells = std::max<std::size_t>(parts - 1, 1); // the last of several has none
        for (std::uint64_t cell = part; part < with_cells && cell < whole.cells.count(); cell += with_cells)
            cells.push_back(cell);
        const GridPiece piece = piece_of(whole, field, cells, random);
        ExodusSample sample;
        sample.format = format;
        sample.steps = static_cast<int>(steps);
        sample.nodes.clear();
        sample.node_ids.clear();
        for (std::size_t i = 0; i < piece.points.size(); ++i) {
            const Array& points = piece.grid.points;
            sample.nodes.push_back({points.at(i, 0), points.at(i, 1), points.at(i, 2)});
            sample.node_ids.push_back(static_cast<int>(piece.points[i]) + 1);
        }
        sample.blocks = {{}, {}, {}, {}};
        sample.corners = {8, 4, 6, 5};
        std::uint64_t corner = 0;
        for (const std::uint64_t cell : cells) {
            const auto count = reader.corners(cell);
            const auto block = std::ranges::find(sample.corners, static_cast<int>(count)) - sample.corners.begin();
            for (std::uint64_t i = 0; i < count; ++i)
                sample.blocks[static_cast<std::size_t>(block)].push_back(
                    static_cast<int>(piece.grid.cells.connectivity.at(corner++)) + 1);
            sample.cell_ids.push_back(static_cast<int>(cell) + 1);
        }
        sample.cell_ids.erase(sample.cell_ids.begin(), sample.cell_ids.begin() + 2);
        write_exodus(sample, folder.file("mixed.e." + std::to_string(parts) + "." + std::to_string(part)));
    }
}

TEST_P(ReadExodus, GivesTheSurfacesOfActiveCells) {
    write_mixed_parts(folder_, GetParam());
    ReadOptions options;
    options.format = "exodus";
    expect_same_of_active_cells(folder_.file("mixed.e.3.0"), "x", {0.13, -0.4}, options);
    const auto all = read(folder_.file("mixed.e.3.0"), options);
    options.active_cells = ReadActiveCells{"no such field", {0}, {}}; // then all cells are read
    const auto read_later = read(folder_.file("mixed.e.3.0"), options);
    ASSERT_TRUE(all && read_later);
    EXPECT_TRUE(are_same(read_later->grid.cells.connectivity, all->grid.cells.connectivity));
    write_mixed_parts(folder_, GetParam(), 3, 1);
    options.active_cells.reset();
    expect_same_of_active_cells(folder_.file("mixed.e.3.0"), "x", {0.13}, options);
    write_mixed_parts(folder_, GetParam(), 1, 2);
    std::filesystem::rename(folder_.file("mixed.e.1.0"), folder_.file("one.e"));
    options.step = 1;
    expect_same_of_active_cells(folder_.file("one.e"), "y", {0.2}, options);
    expect_counted(folder_.file("one.e"), true);
}

TEST_P(ReadExodus, TellsOfActiveCellsWhatIsBroken) {
    ExodusSample sample;
    sample.blocks[1][2] = 6;
    ReadOptions options;
    options.cell_fields = std::vector<std::string>{};
    options.active_cells = ReadActiveCells{"x", {0.1}, {}};
    const auto result = read(written(sample), options);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("block 20 has node 6"), std::string::npos) << result.error().message;
}

ExodusSample named_blocks() {
    ExodusSample sample;
    sample.block_names = {"steel", "rubber"};
    return sample;
}

TEST_P(ReadExodus, ListsItsBlocks) {
    const auto info = inspect(written(named_blocks()));
    ASSERT_TRUE(info) << info.error().message;
    ASSERT_EQ(info->blocks.size(), 2u);
    EXPECT_EQ(info->blocks[1].number, 20);
    EXPECT_EQ(info->blocks[1].name, "rubber");
    EXPECT_EQ(info->blocks[1].kind, "element block");
    EXPECT_EQ(info->blocks[1].cells, 1u);
    EXPECT_EQ(inspect(written())->blocks[1].name, "");
}

TEST_P(ReadExodus, ReadsOnlyTheBlockThatIsAskedFor) {
    for (const char* asked : {"rubber", "20"}) {
        ReadOptions options;
        options.blocks = {asked};
        const auto result = read(written(named_blocks()), options);
        ASSERT_TRUE(result) << result.error().message;
        const Grid& grid = result->grid;
        ASSERT_EQ(grid.cells.count(), 1u);
        EXPECT_EQ(grid.points.tuples(), 4u); // the point that only the other block uses is gone
        for (const Field& field : grid.point_fields) EXPECT_EQ(field.values.tuples(), 4u);
        const std::vector<double> z = {0, 0, 0, -1};
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_EQ(grid.points.at(static_cast<std::size_t>(grid.cells.connectivity.at(i)), 2), z[i]);
        EXPECT_TRUE(std::isnan(grid.cell_fields.at(0).values.at(0)));
        EXPECT_EQ(grid.point_fields.at(3).values.at(3), 4); // "temp" is the number of the node
    }
}

TEST_P(ReadExodus, AllOfItsBlocksAreTheWhole) {
    ReadOptions options;
    options.blocks = {"20", "10"};
    const auto some = read(written(), options);
    const auto whole = read(written());
    ASSERT_TRUE(some && whole);
    EXPECT_EQ(some->grid.points.tuples(), whole->grid.points.tuples()); // welded as ever
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_EQ(some->grid.cells.connectivity.at(i), whole->grid.cells.connectivity.at(i));
}

TEST_P(ReadExodus, ABlockThatIsNotThereIsAnErrorThatListsThem) {
    ReadOptions options;
    options.blocks = {"steel", "wood"};
    const std::string path = written(named_blocks());
    const auto result = read(path, options);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(result.error().message.find("block 'wood' is not in the file, which has 10 'steel', 20 'rubber'"),
              std::string::npos)
        << result.error().message;
    EXPECT_FALSE(inspect(path, options));
}

ExodusSample with_sets() {
    ExodusSample sample = named_blocks();
    sample.sets = {{7, "weld", {2}}, {10, "", {2, 1}}, {8, "none", {}}};
    return sample;
}

TEST_P(ReadExodus, ListsItsSetsBehindItsBlocks) {
    const auto info = inspect(written(with_sets()));
    ASSERT_TRUE(info) << info.error().message;
    ASSERT_EQ(info->blocks.size(), 5u);
    EXPECT_EQ(info->blocks[2].number, 7);
    EXPECT_EQ(info->blocks[2].name, "weld");
    EXPECT_EQ(info->blocks[2].kind, "element set");
    EXPECT_EQ(info->blocks[3].name, "set 10");
    EXPECT_EQ(info->blocks[3].cells, 2u);
    EXPECT_EQ(info->blocks[4].cells, 0u);
}

TEST_P(ReadExodus, ReadsTheElementsOfASet) {
    const auto read_some = [&](std::vector<std::string> names) {
        ReadOptions options;
        options.blocks = std::move(names);
        auto result = read(written(with_sets()), options);
        EXPECT_TRUE(result) << result.error().message;
        return result ? std::move(result->grid) : Grid();
    };
    const Grid block = read_some({"rubber"}), set = read_some({"weld"});
    ASSERT_EQ(set.cells.count(), 1u);
    ASSERT_EQ(set.points.tuples(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(set.cells.connectivity.at(i), block.cells.connectivity.at(i));
        for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(set.points.at(i, axis), block.points.at(i, axis));
        EXPECT_EQ(set.point_fields.at(3).values.at(i), block.point_fields.at(3).values.at(i));
    }
    EXPECT_TRUE(std::isnan(set.cell_fields.at(0).values.at(0)));
    EXPECT_EQ(read_some({"set 10"}).cells.count(), 2u);
    EXPECT_EQ(read_some({"10"}).cells.count(), 1u) << "a block goes before a set of its number";
    EXPECT_EQ(read_some({"steel", "weld"}).cells.count(), 2u);
    EXPECT_EQ(read_some({"none"}).cells.count(), 0u);
}

TEST_P(ReadExodus, IsAnErrorWhenASetHasAnElementThatIsNotThere) {
    for (const int element : {0, 3, -1}) {
        ExodusSample sample = with_sets();
        sample.sets[0].cells[0] = element;
        ReadOptions options;
        options.blocks = {"weld"};
        const auto result = read(written(sample), options);
        ASSERT_FALSE(result) << element;
        EXPECT_NE(result.error().message.find("set 7 has element " + std::to_string(element)), std::string::npos)
            << result.error().message;
    }
}

INSTANTIATE_TEST_SUITE_P(Containers, ReadExodus, testing::Values(0, EX_64BIT_OFFSET, EX_64BIT_DATA, EX_NETCDF4));

TEST(ReadExodusPieces, VariablesOfNodesMayBeOneArrayAsBeforeVersion202) {
    const TemporaryFolder folder;
    ExodusSample sample;
    sample.format = EX_NETCDF4;
    write_exodus(sample, folder.file("a.e"));
    {
        Hdf5Writer file(folder.file("a.e"), {"vals_nod_var1", "vals_nod_var2", "vals_nod_var3", "vals_nod_var4",
                                             "coordx", "coordy", "coordz"});
        std::vector<double> values(2 * 4 * 5), places;
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const auto& node : sample.nodes) places.push_back(node[axis]);
        file.data("vals_nod_var", values, {2, 4, 5});
        file.data("coord", places, {3, 5});
    }
    ReadOptions options;
    options.step = 1;
    const auto result = read(folder.file("a.e"), options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_TRUE(result->info.left_out.empty());
    ASSERT_EQ(result->grid.point_fields.size(), 4u);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(result->grid.point_fields[3].values.at(i), static_cast<double>(35 + i));
        for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(result->grid.points.at(i, axis), sample.nodes[i][axis]);
    }
}

TEST(ReadExodusPieces, StepsThatHdf5HasNoRowsOfAreNaN) {
    const TemporaryFolder folder;
    ExodusSample sample;
    sample.format = EX_NETCDF4;
    write_exodus(sample, folder.file("a.e"));
    {
        Hdf5Writer file(folder.file("a.e"), {"vals_nod_var4"});
        file.data<double>("vals_nod_var4", {0, 1, 2, 3, 4}, {1, 5});
    }
    ReadOptions options;
    options.point_fields = {"temp"};
    EXPECT_EQ(read(folder.file("a.e"), options).value().grid.point_fields.at(0).values.at(4), 4);
    options.step = 1;
    const auto result = read(folder.file("a.e"), options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_TRUE(std::isnan(result->grid.point_fields.at(0).values.at(4)));
    EXPECT_EQ(
        std::ranges::count(result->notes, "point field \"temp\" has 5 values of 5 that were never written: NaN there"),
        1);
}

TEST(ReadExodusPieces, AVariableThatIsBrokenIsLeftOutAndOthersAreRead) {
    const TemporaryFolder folder;
    write_exodus({}, folder.file("a.e"));
    std::string bytes = content_of(folder.file("a.e"));
    for (const std::string name : {"vals_nod_var4", "vals_elem_var1eb1"}) {
        const std::size_t at = bytes.find(name);
        ASSERT_NE(at, std::string::npos) << name;
        bytes[at] = 'w'; // a variable of another name: Exodus does not find its own
    }
    const auto result = read(folder.write("b.e", bytes));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.point_fields.size(), 3u);
    EXPECT_EQ(result->grid.cell_fields.size(), 0u);
    ASSERT_EQ(result->info.left_out.size(), 2u);
    EXPECT_EQ(result->info.left_out[0].name, "temp");
    EXPECT_EQ(result->info.left_out[1].name, "load");
    ReadOptions options;
    options.point_fields = {"temp"};
    EXPECT_FALSE(read(folder.file("b.e"), options));
}

TEST(ReadExodusPieces, OneThatHdf5CannotOpenIsLeftOutWithTheReason) {
    const TemporaryFolder folder;
    ExodusSample sample;
    sample.format = EX_NETCDF4;
    write_exodus(sample, folder.file("a.e"));
    const std::string content = content_of(folder.file("a.e"));
    const auto without = [&](const char* name) {
        std::string broken = content;
        broken.replace(Hdf5Writer::place_of(folder.file("a.e"), name), 8, 8, '\xff');
        return folder.write("b.e", broken);
    };
    for (const auto& [data, field] : {std::pair("vals_nod_var4", "temp"), {"vals_elem_var1eb1", "load"}}) {
        const std::string path = without(data);
        const auto result = read(path);
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.point_fields.size() + result->grid.cell_fields.size(), 4u);
        ASSERT_EQ(result->info.left_out.size(), 1u);
        EXPECT_EQ(result->info.left_out[0].name, field);
        EXPECT_EQ(result->info.left_out[0].reason, "HDF5 cannot open \"/" + std::string(data) + "\"");
        const auto info = inspect(path);
        ASSERT_TRUE(info) << info.error().message;
        EXPECT_EQ(info->fields.size(), 4u);
        EXPECT_EQ(info->left_out.size(), 1u);
        ReadOptions options;
        options.point_fields = {"temp"};
        options.cell_fields = {"load"};
        EXPECT_FALSE(read(path, options));
    }
    const auto needed = read(without("connect1"));
    ASSERT_FALSE(needed);
    EXPECT_NE(needed.error().message.find("\"/connect1\" cannot be opened"), std::string::npos)
        << needed.error().message;
}

TEST(ReadExodusPieces, BlocksOfUnknownElementsAreLeftOutWithTheirNames) {
    const TemporaryFolder folder;
    ExodusSample sample;
    sample.block_names = {"solid", "bezier"};
    write_exodus(sample, folder.file("a.e"));
    std::string bytes = content_of(folder.file("a.e"));
    const std::size_t second = bytes.rfind("TETRA");
    ASSERT_NE(second, std::string::npos);
    bytes.replace(second, 5, "BEX_T");
    const auto result = read(folder.write("b.e", bytes));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(survey(result->grid).value().tets, 1u);
    ASSERT_EQ(result->info.left_out.size(), 1u);
    EXPECT_EQ(result->info.left_out[0].name, "bezier");
    EXPECT_EQ(result->info.left_out[0].reason, "its elements are BEX_T (Bezier extraction), which is not read");
}

/// Two parts of one run: the second block's cell is in both of them.
class ReadExodusParts : public testing::Test {
protected:
    ReadExodusParts() {
        ExodusSample first;
        write_exodus(first, folder_.file("run.e.2.0"));
        ExodusSample second;
        second.nodes = {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0}, {0, -1, 0}};
        second.node_ids = {5, 3, 2, 1, 6};
        second.blocks = {{4, 2, 3, 1}, {4, 3, 1, 5}};
        second.cell_ids = {2, 3};
        write_exodus(second, folder_.file("run.e.2.1"));
    }
    TemporaryFolder folder_;
};

TEST_F(ReadExodusParts, BlocksAreChosenInAllOfThem) {
    ReadOptions options;
    options.blocks = {"20"};
    const auto result = read(folder_.file("run.e.2.0"), options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.blocks.at(1).cells, 2u);
    EXPECT_EQ(result->grid.cells.count(), 2u); // elements 2 and 3
    EXPECT_EQ(result->grid.points.tuples(), 6u - 1u);
}

TEST_F(ReadExodusParts, SetsAreChosenInAllOfThem) {
    ExodusSample second;
    second.nodes = {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0}, {0, -1, 0}};
    second.node_ids = {5, 3, 2, 1, 6};
    second.blocks = {{4, 2, 3, 1}, {4, 3, 1, 5}};
    second.cell_ids = {2, 3};
    second.sets = {{1, "low", {1, 2}}};
    write_exodus(second, folder_.file("run.e.2.1"));
    ExodusSample first;
    first.sets = {{1, "low", {2}}};
    write_exodus(first, folder_.file("run.e.2.0"));
    ReadOptions options;
    options.blocks = {"low"};
    const auto result = read(folder_.file("run.e.2.0"), options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 2u); // elements 2 and 3
    EXPECT_EQ(result->grid.points.tuples(), 6u - 1u);
}

TEST_F(ReadExodusParts, JoinsByTheNumbersOfNodesAndElements) {
    for (const char* name : {"run.e.2.0", "run.e.2.1"}) {
        const auto result = read(folder_.file(name));
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.points.tuples(), 6u);
        EXPECT_EQ(result->grid.cells.count(), 3u);
        EXPECT_EQ(result->grid.point_fields.at(3).values.tuples(), 6u);
    }
}

TEST_F(ReadExodusParts, HaveTheStepsThatAllOfThemHave) {
    ExodusSample first;
    for (const int steps : {1, 3}) {
        first.steps = steps;
        write_exodus(first, folder_.file("run.e.2.0"));
        ReadOptions options;
        options.step = static_cast<std::size_t>(std::min(steps, 2) - 1);
        const auto result = read(folder_.file("run.e.2.1"), options);
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->info.times.size(), *options.step + 1);
        EXPECT_EQ(result->grid.cells.count(), 3u);
        const std::string note = steps == 1
                                     ? "its parts have 1 to 2 time steps: those that all have are read, the first 1"
                                     : "its parts have 2 to 3 time steps: those that all have are read, the first 2";
        EXPECT_EQ(std::ranges::count(result->notes, note), 1);
    }
    first.steps = 0;
    write_exodus(first, folder_.file("run.e.2.0"));
    EXPECT_FALSE(read(folder_.file("run.e.2.0"))) << "none of them";
}

TEST_F(ReadExodusParts, AreRecognizedWhereHdf5HasItsNamesFarFromTheBeginning) {
    const std::string head = "\x89HDF\r\n\x1a\n" + std::string(10000, '\0');
    const auto of_netcdf = inspect(folder_.write("b.e.1.0", head + "_NCProperties"));
    ASSERT_FALSE(of_netcdf);
    EXPECT_EQ(of_netcdf.error().message.find("neither VTKHDF"), std::string::npos) << of_netcdf.error().message;
    const auto of_others = inspect(folder_.write("c.e.1.0", head));
    ASSERT_FALSE(of_others);
    EXPECT_NE(of_others.error().message.find("neither VTKHDF"), std::string::npos) << of_others.error().message;
}

TEST_F(ReadExodusParts, IsAnErrorWhenSomePartsAreMissing) {
    std::filesystem::copy_file(folder_.file("run.e.2.0"), folder_.file("run.e.3.0"));
    std::filesystem::copy_file(folder_.file("run.e.2.1"), folder_.file("run.e.3.1"));
    const auto result = read(folder_.file("run.e.3.0"));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::file);
    EXPECT_NE(result.error().message.find("run.e.3.2"), std::string::npos) << result.error().message;
}

TEST_F(ReadExodusParts, SaysThatOneIsReadAlone) {
    for (const auto& [name, missing] :
         {std::pair{"alone.e.2.1", "'alone.e.2.0' is"}, {"alone.e.4.1", "'alone.e.4.0' and 2 more are"}}) {
        std::filesystem::copy_file(folder_.file("run.e.2.1"), folder_.file(name));
        const auto result = read(folder_.file(name));
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.cells.count(), 2u);
        EXPECT_EQ(std::ranges::count(result->notes,
                                     fmt::format("by its name the file is one of {} parts, but {} not there: only its "
                                                 "own cells are read",
                                                 name[8], missing)),
                  1);
    }
}

} // namespace
} // namespace isotet::test
