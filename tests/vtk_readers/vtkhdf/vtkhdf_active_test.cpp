// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTKHDF in partitions of which active cells only are read: points, fields, notes and surfaces of all cells.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <isotet/fields.hpp>
#include <isotet/make.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/read.hpp>

#include "pieces/partition.hpp"
#include "support/counted_cells.hpp"
#include "support/seeds.hpp"
#include "support/temporary_folder.hpp"
#include "vtk_readers/active_cells.hpp"
#include "vtk_readers/hdf5_writer.hpp"

namespace isotet::test {
namespace {

using Integers = std::vector<std::int64_t>;

struct PartsOf {
    std::string shape = "mixed";
    Hdf5Writer::Storage storage = {};
    bool narrow = false;  ///< int32 corners and offsets
    bool marked = false;  ///< each part has cells of others, as ghost cells,
    bool doubled = false; ///< or not
    std::string group = "/VTKHDF";
};

/// The arrays of all parts, one after another.
struct PartArrays {
    Integers points, cells, corners, connectivity, offsets;
    std::vector<float> places, values;
    std::vector<std::uint8_t> types, ghosts;
};

template <class T>
void append(std::vector<T>& to, const Array& values) {
    values.visit([&](auto from) {
        for (const auto value : from) to.push_back(static_cast<T>(value));
    });
}

/// Parts with cells at random; the third has none, and the last one points only.
PartArrays parts_of(const PartsOf& what, std::uint32_t seed) {
    std::mt19937 random(seed);
    const Grid whole = make_grid({.shape = what.shape, .side = 5, .fields = {"gyroid"}}).value();
    const PointField field{"gyroid", whole.point_fields[0].values, false, {}};
    PartArrays all;
    std::vector<std::vector<std::uint64_t>> lists(6);
    for (std::uint64_t cell = 0; cell < whole.cells.count(); ++cell)
        lists[std::array{0, 1, 3, 4}[random() % 4]].push_back(cell);
    for (std::size_t p = 0; p < lists.size(); ++p) {
        const std::size_t own = lists[p].size();
        if (own > 0 && (what.marked || what.doubled))
            for (const std::uint64_t cell : lists[p == 0 ? 1 : 0])
                if (random() % 4 == 0) lists[p].push_back(cell);
        const GridPiece piece = piece_of(whole, field, lists[p], random);
        const std::size_t points = p == 5 ? 4 : piece.points.size();
        for (int i = 0; p == 5 && i < 4; ++i) {
            all.places.insert(all.places.end(), {7.5F, 0, static_cast<float>(i)});
            all.values.push_back(0);
        }
        append(all.places, piece.grid.points);
        append(all.values, piece.field.values);
        append(all.connectivity, piece.grid.cells.connectivity);
        const core::CellReader reader = core::CellReader::open(whole).value();
        all.offsets.push_back(0);
        for (std::size_t i = 0; i < lists[p].size(); ++i) {
            all.offsets.push_back(all.offsets.back() + static_cast<std::int64_t>(reader.corners(lists[p][i])));
            all.types.push_back(reader.type(lists[p][i]));
            all.ghosts.push_back(i < own ? 0 : 1);
        }
        all.points.push_back(static_cast<std::int64_t>(points));
        all.cells.push_back(static_cast<std::int64_t>(lists[p].size()));
        all.corners.push_back(all.offsets.back());
    }
    return all;
}

void write_integers(Hdf5Writer& file, const std::string& name, const Integers& values, const PartsOf& what) {
    if (what.narrow)
        file.stored(name, std::vector<std::int32_t>(values.begin(), values.end()), {values.size()}, what.storage);
    else file.stored(name, values, {values.size()}, what.storage);
}

/// Two steps of the same parts, the second with the values of the first behind one another in reverse.
void write_partitions(Hdf5Writer& file, const PartsOf& what, const PartArrays& all) {
    for (const char* name : {"", "/PointData", "/CellData", "/FieldData", "/Steps", "/Steps/PointDataOffsets"})
        file.group(what.group + name);
    file.attribute(what.group, "Version", Integers{2, 0});
    file.attribute(what.group, "Type", "UnstructuredGrid");
    const auto name = [&](const char* set) { return what.group + "/" + set; };
    file.data(name("NumberOfPoints"), all.points, {all.points.size()});
    file.data(name("NumberOfCells"), all.cells, {all.cells.size()});
    file.data(name("NumberOfConnectivityIds"), all.corners, {all.corners.size()});
    Hdf5Writer::Storage of_points = what.storage;
    if (!of_points.chunk.empty()) of_points.chunk.push_back(3);
    file.stored(name("Points"), all.places, {all.values.size(), 3}, of_points);
    file.stored(name("Types"), all.types, {all.types.size()}, what.storage);
    write_integers(file, name("Connectivity"), all.connectivity, what);
    write_integers(file, name("Offsets"), all.offsets, what);
    std::vector<float> values = all.values;
    values.insert(values.end(), all.values.rbegin(), all.values.rend());
    file.stored(name("PointData/gyroid"), values, {values.size()}, what.storage);
    std::vector<double> numbers(all.types.size());
    std::vector<std::int32_t> vectors(3 * all.types.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = 0.5 * static_cast<double>(i);
    for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i] = static_cast<std::int32_t>(i);
    file.stored(name("CellData/number"), numbers, {numbers.size()}, what.storage);
    file.stored(name("CellData/vector"), vectors, {numbers.size(), 3}, of_points);
    if (what.marked) file.stored(name("CellData/vtkGhostType"), all.ghosts, {all.ghosts.size()}, what.storage);
    const auto parts = static_cast<std::int64_t>(all.points.size());
    file.data<double>(name("Steps/Values"), {0, 1}, {2});
    file.data(name("Steps/PartOffsets"), Integers{0, 0}, {2});
    file.data(name("Steps/NumberOfParts"), Integers{parts, parts}, {2});
    for (const char* set : {"Steps/PointOffsets", "Steps/CellOffsets", "Steps/ConnectivityIdOffsets"})
        file.data(name(set), Integers{0, 0}, {2});
    const auto rows = static_cast<std::int64_t>(all.values.size());
    file.data(name("Steps/PointDataOffsets/gyroid"), Integers{0, rows}, {2});
}

const std::vector<PartsOf>& ways_of_parts() {
    static const std::vector<PartsOf> all{{},
                                          {.storage = {.chunk = {100}, .shuffled = true, .deflated = true}},
                                          {.shape = "kuhn", .storage = {.chunk = {64}}, .narrow = true},
                                          {.storage = {.chunk = {999}, .big_endian = true}},
                                          {.shape = "hex", .storage = {.big_endian = true}, .marked = true},
                                          {.storage = {.chunk = {7}, .deflated = true}, .doubled = true},
                                          {.narrow = true, .marked = true}};
    return all;
}

TEST(ActiveCellsOfVtkhdf, AreThoseOfAllPartitions) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.vtkhdf");
    for (const std::uint32_t seed : Seeds(0, 12)) {
        const PartsOf& what = ways_of_parts()[seed % ways_of_parts().size()];
        {
            Hdf5Writer file(path);
            write_partitions(file, what, parts_of(what, seed));
        }
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> draw(-0.6, 0.6);
        ReadOptions options;
        for (const std::size_t step : {0, 1}) {
            options.step = step;
            expect_same_of_active_cells(path, "gyroid", {draw(random), draw(random)}, options);
            expect_counted(path, !what.doubled, options);
        }
    }
}

TEST(ActiveCellsOfVtkhdf, AreThoseOfAllGridsOfACollection) {
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        file.group("/VTKHDF");
        file.attribute("/VTKHDF", "Version", Integers{2, 1});
        file.attribute("/VTKHDF", "Type", "PartitionedDataSetCollection");
        for (const char* name : {"/VTKHDF/left", "/VTKHDF/right"}) {
            const PartsOf what{.shape = name[8] == 'l' ? "wedge" : "hex", .group = name};
            PartArrays all = parts_of(what, 5);
            if (name[8] == 'r')
                for (std::size_t i = 0; i < all.places.size(); i += 3) all.places[i] += 2; // beside the other
            write_partitions(file, what, all);
        }
    }
    expect_same_of_active_cells(folder.file("a.vtkhdf"), "gyroid", {0.2});
}

TEST(ActiveCellsOfVtkhdf, MayBeOfAFileLargerThanMemory) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.vtkhdf");
    {
        Hdf5Writer file(path);
        write_partitions(file, {}, parts_of({}, 3));
    }
    std::filesystem::resize_file(path, std::uintmax_t{1} << 36); // a hole
    ReadOptions options;
    options.active_cells = ReadActiveCells{"gyroid", {0.1}, {}};
    options.memory_limit = std::uint64_t{1} << 33;
    const auto result = read(path, options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_TRUE(result->cells_in_file);
}

TEST(ActiveCellsOfVtkhdf, AreOfIsovaluesThatFollowFromTheValues) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.vtkhdf");
    {
        Hdf5Writer file(path);
        write_partitions(file, {.marked = true}, parts_of({.marked = true}, 3));
    }
    const Grid all = read(path).value().grid;
    const PointField field = find_field(all, "gyroid").value();
    const RangeLevels levels{2, LevelRounding::short_decimals};
    ReadOptions options;
    options.active_cells = ReadActiveCells{"gyroid", {}, {}};
    options.active_cells->options.extract.source_cells = true;
    options.active_cells->choose = levels;
    const ReadResult some = read(path, options).value();
    ASSERT_TRUE(some.cells_in_file);
    DirectOptions direct;
    direct.extract.source_cells = true;
    const std::vector<double> isovalues = levels(field).value();
    ASSERT_EQ(isovalues.size(), 2u);
    const auto expected = extract_direct(all, field, isovalues, direct).value();
    direct.active_cells_only = true;
    const auto found = extract_direct(some.grid, field, isovalues, direct).value();
    const auto numbers = some.cell_numbers.as<std::uint64_t>();
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        const Surface &a = found.surfaces[i].surface, &b = expected.surfaces[i].surface;
        EXPECT_TRUE(are_same(a.positions, b.positions));
        ASSERT_EQ(a.source_cells.tuples(), b.source_cells.tuples());
        for (std::size_t k = 0; k < a.source_cells.tuples(); ++k)
            ASSERT_EQ(static_cast<double>(numbers[static_cast<std::size_t>(a.source_cells.at(k))]),
                      b.source_cells.at(k));
    }
    options.active_cells->choose = [&](const PointField& values) { return levels(values); }; // which is no such type
    EXPECT_FALSE(read(path, options).value().cells_in_file);
}

TEST(ActiveCellsOfVtkhdf, TellWhichPartIsBroken) {
    const TemporaryFolder folder;
    PartArrays all = parts_of({}, 3);
    all.connectivity[all.connectivity.size() / 2] = 98765;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_partitions(file, {}, all);
    }
    ReadOptions options;
    options.active_cells = ReadActiveCells{"gyroid", {0.1}, {}};
    const auto some = read(folder.file("a.vtkhdf"), options), whole = read(folder.file("a.vtkhdf"));
    ASSERT_FALSE(some);
    ASSERT_FALSE(whole);
    EXPECT_EQ(some.error().message, whole.error().message);
    EXPECT_NE(some.error().message.find("98765"), std::string::npos) << some.error().message;
}

} // namespace
} // namespace isotet::test
