// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTKHDF: every way to store arrays, partitions, time steps, and what is broken.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <isotet/read.hpp>

#include "vtk_readers/hdf5_writer.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

using Storage = Hdf5Writer::Storage;

void write_groups(Hdf5Writer& file, std::int64_t version) {
    for (const char* name : {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData", "/VTKHDF/FieldData"}) file.group(name);
    file.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{version, 0});
    file.attribute("/VTKHDF", "Type", "UnstructuredGrid");
}

void write_counts(Hdf5Writer& file, const std::vector<std::int64_t>& points, const std::vector<std::int64_t>& cells) {
    std::vector<std::int64_t> corners;
    for (const std::int64_t count : cells) corners.push_back(4 * count);
    file.data<std::int64_t>("/VTKHDF/NumberOfPoints", points, {points.size()});
    file.data<std::int64_t>("/VTKHDF/NumberOfCells", cells, {cells.size()});
    file.data<std::int64_t>("/VTKHDF/NumberOfConnectivityIds", corners, {corners.size()});
}

/// A strip of tets: tet i has the points i to i + 3.
struct Strip {
    std::vector<double> points, values;
    std::vector<std::int64_t> connectivity, offsets{0};
    std::vector<std::uint8_t> types;
    std::vector<float> vectors;

    explicit Strip(std::int64_t tets, std::int64_t first = 0) {
        std::mt19937 random(static_cast<unsigned>(tets));
        for (std::int64_t i = 0; i < tets + 3; ++i) {
            const auto x = static_cast<double>(first + i);
            points.insert(points.end(), {x, double((first + i) % 2), double((first + i) % 3)});
            values.push_back(x / 3 + first);
            for (int axis = 0; axis < 3; ++axis) vectors.push_back(static_cast<float>(random() % 1000) / 7);
        }
        for (std::int64_t i = 0; i < tets; ++i) {
            connectivity.insert(connectivity.end(), {i, i + 1, i + 2, i + 3});
            offsets.push_back(4 * (i + 1));
            types.push_back(10);
        }
    }
};

template <class T>
std::vector<T> joined(std::vector<T> a, const std::vector<T>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

TEST(ReadVtkhdf, GivesTheSameHoweverArraysAreStored) {
    const Strip strip(997);
    const TemporaryFolder folder;
    const Storage storages[] = {{},
                                {.chunk = {64}},
                                {.chunk = {1000}},
                                {.chunk = {5000}},
                                {.chunk = {100}, .deflated = true},
                                {.chunk = {100}, .shuffled = true},
                                {.chunk = {333}, .shuffled = true, .deflated = true},
                                {.chunk = {64}, .deflated = true, .checksums = true},
                                {.chunk = {64}, .big_endian = true},
                                {.big_endian = true}};
    for (const Storage& way : storages) {
        SCOPED_TRACE(testing::Message() << "chunks of " << (way.chunk.empty() ? 0 : way.chunk[0]) << ", shuffled "
                                        << way.shuffled << ", deflated " << way.deflated << ", big-endian "
                                        << way.big_endian);
        Storage of_vectors = way, of_halves = way;
        if (!way.chunk.empty()) {
            of_vectors.chunk = {way.chunk[0], 3};
            of_halves.chunk = {way.chunk[0], 2}; // the last column has chunks of its own
        }
        {
            Hdf5Writer file(folder.file("a.vtkhdf"));
            write_groups(file, 1);
            write_counts(file, {1000}, {997});
            file.stored("/VTKHDF/Points", strip.points, {1000, 3}, of_halves);
            file.stored("/VTKHDF/Connectivity", strip.connectivity, {4 * 997}, way);
            file.stored("/VTKHDF/Offsets", strip.offsets, {998}, way);
            file.stored("/VTKHDF/Types", strip.types, {997}, way);
            file.stored("/VTKHDF/PointData/p", strip.values, {1000}, way);
            file.stored("/VTKHDF/PointData/v", strip.vectors, {1000, 3}, of_vectors);
        }
        const auto result = read(folder.file("a.vtkhdf"));
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(numbers_of(result->grid.points), strip.points);
        EXPECT_EQ(numbers_of(result->grid.cells.connectivity),
                  std::vector<double>(strip.connectivity.begin(), strip.connectivity.end()));
        EXPECT_EQ(result->grid.cells.count(), 997u);
        ASSERT_EQ(result->grid.point_fields.size(), 2u);
        EXPECT_EQ(numbers_of(result->grid.point_fields[0].values), strip.values);
        EXPECT_EQ(numbers_of(result->grid.point_fields[1].values),
                  std::vector<double>(strip.vectors.begin(), strip.vectors.end()));
        EXPECT_EQ(result->grid.point_fields[1].values.components(), 3u);
    }
}

TEST(ReadVtkhdf, ReadsNarrowIndicesAndOtherFloats) {
    const Strip strip(7);
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_groups(file, 2);
        write_counts(file, {10}, {7});
        file.data("/VTKHDF/Points", strip.points, {10, 3});
        file.data("/VTKHDF/Connectivity",
                  std::vector<std::uint8_t>(strip.connectivity.begin(), strip.connectivity.end()), {28});
        file.data("/VTKHDF/Offsets", strip.offsets, {8});
        file.data("/VTKHDF/Types", std::vector<std::int64_t>(strip.types.begin(), strip.types.end()), {7});
        for (const hsize_t chunk : {0, 4})
            for (const bool half : {false, true}) {
                const std::string name = std::string(half ? "half" : "long") + (chunk > 0 ? " in chunks" : "");
                file.floats("/VTKHDF/PointData/" + name, strip.values, half, chunk);
            }
    }
    const auto result = read(folder.file("a.vtkhdf"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(numbers_of(result->grid.cells.connectivity),
              std::vector<double>(strip.connectivity.begin(), strip.connectivity.end()));
    ASSERT_EQ(result->grid.point_fields.size(), 4u);
    for (const Field& field : result->grid.point_fields) {
        const bool half = field.name.starts_with("half");
        EXPECT_EQ(field.values.type(), half ? ScalarType::float32 : ScalarType::float64);
        for (std::size_t i = 0; i < strip.values.size(); ++i)
            EXPECT_NEAR(field.values.at(i), strip.values[i], half ? 2e-3 : 0) << field.name;
    }
}

TEST(ReadVtkhdf, ReadsMoreIndicesThanAreReadAtOnce) {
    constexpr std::size_t tets = 300'000;
    const Strip strip(tets);
    const TemporaryFolder folder;
    for (const std::size_t chunk : {std::size_t{0}, std::size_t{70'001}, std::size_t{2'000'000}}) {
        const Storage way = chunk == 0 ? Storage{} : Storage{.chunk = {std::min(chunk, 4 * tets)}};
        {
            Hdf5Writer file(folder.file("a.vtkhdf"));
            write_groups(file, 1);
            write_counts(file, {tets + 3}, {tets});
            file.data<double>("/VTKHDF/Points", strip.points, {tets + 3, 3});
            file.stored("/VTKHDF/Connectivity", strip.connectivity, {4 * tets}, way);
            file.data<std::int64_t>("/VTKHDF/Offsets", strip.offsets, {tets + 1});
            file.data<std::uint8_t>("/VTKHDF/Types", strip.types, {tets});
        }
        const auto result = read(folder.file("a.vtkhdf"));
        ASSERT_TRUE(result) << result.error().message;
        const Array& connectivity = result->grid.cells.connectivity;
        ASSERT_EQ(connectivity.type(), ScalarType::int32);
        EXPECT_TRUE(std::ranges::equal(connectivity.as<std::int32_t>(), strip.connectivity)) << "chunks of " << chunk;
    }
}

TEST(ReadVtkhdf, KeepsOnlyActiveCellsWhereAsked) {
    constexpr std::size_t tets = 300'000;
    Strip strip(tets);
    for (std::size_t i = 0; i < tets + 3; ++i) { // on a helix, where four that follow each other are a regular tet
        const double turn = static_cast<double>(i) * std::acos(-2.0 / 3), radius = 0.3 * std::sqrt(3.0);
        strip.points[3 * i + 1] = radius * std::cos(turn);
        strip.points[3 * i + 2] = radius * std::sin(turn);
        strip.points[3 * i] /= std::sqrt(10.0);
    }
    const TemporaryFolder folder;
    const auto write = [&](const Storage& way, bool cell_field) {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_groups(file, 1);
        write_counts(file, {tets + 3}, {tets});
        file.data<double>("/VTKHDF/Points", strip.points, {tets + 3, 3});
        file.stored("/VTKHDF/Connectivity", strip.connectivity, {4 * tets}, way);
        file.data<std::int64_t>("/VTKHDF/Offsets", strip.offsets, {tets + 1});
        file.data<std::uint8_t>("/VTKHDF/Types", strip.types, {tets});
        file.data<double>("/VTKHDF/PointData/p", strip.values, {tets + 3});
        if (!cell_field) return;
        std::vector<std::int32_t> values(tets);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int32_t>(i);
        file.stored("/VTKHDF/CellData/c", values, {tets}, way);
    };
    ReadOptions active;
    active.active_cells = ReadActiveCells{"p", {70'000.1}, {}};
    constexpr std::int64_t first_cut = 210'000 - 2, last_cut = 210'000; // 70'000 is the value of point 210'000
    for (const Storage& way :
         {Storage{}, {.chunk = {70'001}, .deflated = true}, {.chunk = {999}, .big_endian = true}}) {
        write(way, true);
        const auto result = read(folder.file("a.vtkhdf"), active);
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->cells_in_file, tets);
        EXPECT_LT(result->grid.cells.count(), 20u);
        EXPECT_EQ(result->grid.points.tuples(), tets + 3);
        std::vector<double> cut; // first corners of the cells that are kept
        for (std::size_t i = 0; i < result->grid.cells.count(); ++i)
            cut.push_back(result->grid.cells.connectivity.at(4 * i));
        EXPECT_TRUE(std::ranges::is_sorted(cut));
        for (std::int64_t cell = first_cut; cell <= last_cut; ++cell)
            EXPECT_NE(std::ranges::find(cut, static_cast<double>(cell)), cut.end()) << cell;
        const Array& values = result->grid.cell_fields.at(0).values;
        ASSERT_EQ(values.tuples(), cut.size());
        for (std::size_t i = 0; i < cut.size(); ++i) EXPECT_EQ(values.at(i), cut[i]); // a tet begins with its number
    }
    strip.connectivity[4 * 777 + 1] = -5;
    write({}, false);
    const auto some = read(folder.file("a.vtkhdf"), active), all = read(folder.file("a.vtkhdf"));
    ASSERT_FALSE(some);
    EXPECT_EQ(some.error().message, all.error().message);
}

/// With a compressor that only the program that writes has.
TEST(ReadVtkhdf, NamesAFilterThatIsMissing) {
    constexpr H5Z_filter_t number = 300; // of those that HDF5 leaves to tests
    const H5Z_class2_t squeeze{
        H5Z_CLASS_T_VERS,
        number,
        1,
        1,
        "squeeze",
        nullptr,
        nullptr,
        [](unsigned, std::size_t, const unsigned*, std::size_t bytes, std::size_t*, void**) { return bytes; }};
    ASSERT_GE(H5Zregister(&squeeze), 0);
    const Strip strip(17);
    const TemporaryFolder folder;
    const auto write = [&](const std::string& name, const Storage& of_points, const Storage& of_values) {
        Hdf5Writer file(folder.file(name));
        write_groups(file, 1);
        write_counts(file, {20}, {17});
        file.stored("/VTKHDF/Points", strip.points, {20, 3}, of_points);
        file.data("/VTKHDF/Connectivity", strip.connectivity, {68});
        file.data("/VTKHDF/Offsets", strip.offsets, {18});
        file.data("/VTKHDF/Types", strip.types, {17});
        file.stored("/VTKHDF/PointData/p", strip.values, {20}, of_values);
        file.data("/VTKHDF/PointData/q", strip.values, {20});
    };
    write("field.vtkhdf", {}, {.chunk = {5}, .filter = number});
    write("points.vtkhdf", {.chunk = {5, 3}, .filter = number}, {});
    ASSERT_GE(H5Zunregister(number), 0);

    const std::string reason = "HDF5 filter 300 \"squeeze\", which is not installed: \"h5repack";
    const auto result = read(folder.file("field.vtkhdf"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.point_fields.at(0).name, "q") << "one field does not spoil the rest";
    ASSERT_EQ(result->info.left_out.size(), 1u);
    EXPECT_NE(result->info.left_out[0].reason.find(reason), std::string::npos) << result->info.left_out[0].reason;
    const auto broken = read(folder.file("points.vtkhdf"));
    ASSERT_FALSE(broken);
    EXPECT_NE(broken.error().message.find(reason), std::string::npos) << broken.error().message;
}

TEST(ReadVtkhdf, FillsInWhatWasNotWritten) {
    const Strip strip(17);
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_groups(file, 1);
        write_counts(file, {20}, {17});
        file.data("/VTKHDF/Points", strip.points, {20, 3});
        file.data("/VTKHDF/Connectivity", strip.connectivity, {68});
        file.data("/VTKHDF/Offsets", strip.offsets, {18});
        file.data("/VTKHDF/Types", strip.types, {17});
        file.stored("/VTKHDF/PointData/p", strip.values, {20}, {.chunk = {5}, .deflated = true, .unwritten = 10});
    }
    const auto result = read(folder.file("a.vtkhdf"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.point_fields.at(0).values.at(9), strip.values[9]);
    EXPECT_EQ(result->grid.point_fields.at(0).values.at(19), 0);
}

/// Two partitions that share a face's points.
TEST(ReadVtkhdf, JoinsPartitions) {
    const Strip whole(7), left(4), right(3, 4);
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_groups(file, 1);
        write_counts(file, {7, 6}, {4, 3});
        file.data("/VTKHDF/Points", joined(left.points, right.points), {13, 3});
        file.data("/VTKHDF/Connectivity", joined(left.connectivity, right.connectivity), {28});
        file.data("/VTKHDF/Offsets", joined(left.offsets, right.offsets), {9});
        file.data("/VTKHDF/Types", joined(left.types, right.types), {7});
        file.data<std::int32_t>("/VTKHDF/CellData/c", {1, 2, 3, 4, 5, 6, 7}, {7});
    }
    const auto result = read(folder.file("a.vtkhdf"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(numbers_of(result->grid.points), whole.points);
    EXPECT_EQ(numbers_of(result->grid.cells.connectivity),
              std::vector<double>(whole.connectivity.begin(), whole.connectivity.end()));
    EXPECT_EQ(numbers_of(result->grid.cell_fields.at(0).values), (std::vector<double>{1, 2, 3, 4, 5, 6, 7}));
    ReadOptions apart;
    apart.merge_pieces_by_coordinates = false;
    EXPECT_EQ(read(folder.file("a.vtkhdf"), apart).value().grid.points.tuples(), 13u);
}

TEST(ReadVtkhdf, LeavesGhostCellsOut) {
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_two_tets(file);
        file.data<std::uint8_t>("/VTKHDF/CellData/vtkGhostType", {0, 1}, {2});
    }
    const auto result = read(folder.file("a.vtkhdf"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 1u);
    EXPECT_TRUE(result->grid.cell_fields.empty());
}

/// Version 2: the same cells in all steps, points that move, a field with its own places.
TEST(ReadVtkhdf, ReadsStepsOfAMeshThatMoves) {
    const Strip strip(2);
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_groups(file, 2);
        write_counts(file, {5}, {2});
        std::vector<double> later = strip.points;
        for (double& x : later) x += 100;
        file.data("/VTKHDF/Points", joined(strip.points, later), {10, 3});
        file.data("/VTKHDF/Connectivity", strip.connectivity, {8});
        file.data("/VTKHDF/Offsets", strip.offsets, {3});
        file.data("/VTKHDF/Types", strip.types, {2});
        file.data<double>("/VTKHDF/PointData/p", {0, 1, 2, 3, 4, 10, 11, 12, 13, 14, 20, 21, 22, 23, 24}, {15});
        for (const char* name : {"/VTKHDF/Steps", "/VTKHDF/Steps/PointDataOffsets", "/VTKHDF/Steps/CellDataOffsets"})
            file.group(name);
        file.data<float>("/VTKHDF/Steps/Values", {0, 0.1F, 2}, {3});
        file.data<std::int64_t>("/VTKHDF/Steps/PartOffsets", {0, 0, 0}, {3});
        file.data<std::int64_t>("/VTKHDF/Steps/NumberOfParts", {1, 1, 1}, {3});
        file.data<std::int64_t>("/VTKHDF/Steps/PointOffsets", {0, 0, 5}, {3});
        file.data<std::int64_t>("/VTKHDF/Steps/CellOffsets", {0, 0, 0}, {3, 1});
        file.data<std::int64_t>("/VTKHDF/Steps/ConnectivityIdOffsets", {0, 0, 0}, {3, 1});
        file.data<std::int64_t>("/VTKHDF/Steps/PointDataOffsets/p", {0, 5, 10}, {3});
    }
    EXPECT_EQ(inspect(folder.file("a.vtkhdf")).value().times, (std::vector<double>{0, 0.1, 2}));
    for (const std::size_t step : {0, 1, 2}) {
        ReadOptions options;
        options.step = step;
        const auto result = read(folder.file("a.vtkhdf"), options);
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.points.at(0, 0), step == 2 ? 100 : 0);
        EXPECT_EQ(result->grid.point_fields.at(0).values.at(3), 10.0 * static_cast<double>(step) + 3);
        EXPECT_EQ(result->grid.cells.count(), 2u);
    }
    ReadOptions options;
    options.step = 3;
    EXPECT_EQ(read(folder.file("a.vtkhdf"), options).error().code, ErrorCode::invalid_argument);
}

/// Version 2: another mesh in each step.
TEST(ReadVtkhdf, ReadsStepsOfOtherMeshes) {
    const Strip first(2), second(3, 10);
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_groups(file, 2);
        write_counts(file, {5, 6}, {2, 3});
        file.data("/VTKHDF/Points", joined(first.points, second.points), {11, 3});
        file.data("/VTKHDF/Connectivity", joined(first.connectivity, second.connectivity), {20});
        file.data("/VTKHDF/Offsets", joined(first.offsets, second.offsets), {7});
        file.data("/VTKHDF/Types", joined(first.types, second.types), {5});
        file.data<float>("/VTKHDF/CellData/c", {1, 2, 3, 4, 5}, {5});
        file.group("/VTKHDF/Steps");
        file.data<double>("/VTKHDF/Steps/Values", {1, 2}, {2});
        file.data<std::int64_t>("/VTKHDF/Steps/PartOffsets", {0, 1}, {2});
        file.data<std::int64_t>("/VTKHDF/Steps/NumberOfParts", {1, 1}, {2});
        file.data<std::int64_t>("/VTKHDF/Steps/PointOffsets", {0, 5}, {2});
        file.data<std::int64_t>("/VTKHDF/Steps/CellOffsets", {0, 2}, {2, 1});
        file.data<std::int64_t>("/VTKHDF/Steps/ConnectivityIdOffsets", {0, 8}, {2, 1});
    }
    ReadOptions options;
    options.step = 1;
    const auto result = read(folder.file("a.vtkhdf"), options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(numbers_of(result->grid.points), second.points);
    EXPECT_EQ(numbers_of(result->grid.cells.connectivity),
              std::vector<double>(second.connectivity.begin(), second.connectivity.end()));
    EXPECT_EQ(numbers_of(result->grid.cell_fields.at(0).values), (std::vector<double>{3, 4, 5}));
    EXPECT_EQ(read(folder.file("a.vtkhdf")).value().grid.points.tuples(), 5u);
}

/// Writes two tets in which one data set is another one, and reads them.
std::string message_with(const std::string& name, const std::function<void(Hdf5Writer&)>& put) {
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_groups(file, 1);
        const auto unless = [&](const char* set, const auto& write) {
            if (name != set) write(std::string("/VTKHDF/") + set);
        };
        for (const char* set : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
            unless(set, [&](const std::string& path) {
                file.data<std::int64_t>(path, {set[8] == 'P' ? 5 : set[9] == 'e' ? 2 : 8}, {1});
            });
        const Strip strip(2);
        unless("Points", [&](const std::string& path) { file.data(path, strip.points, {5, 3}); });
        unless("Connectivity", [&](const std::string& path) { file.data(path, strip.connectivity, {8}); });
        unless("Offsets", [&](const std::string& path) { file.data(path, strip.offsets, {3}); });
        unless("Types", [&](const std::string& path) { file.data(path, strip.types, {2}); });
        put(file);
    }
    const auto result = read(folder.file("a.vtkhdf"));
    return result ? "read" : result.error().message;
}

TEST(ReadVtkhdf, RefusesWhatDoesNotFit) {
    EXPECT_EQ(message_with("", [](Hdf5Writer&) {}), "read");
    const auto count = [](const char* name, std::int64_t value) {
        return message_with(
            name, [&](Hdf5Writer& file) { file.data<std::int64_t>(std::string("/VTKHDF/") + name, {value}, {1}); });
    };
    const auto expect = [](const std::string& message, const std::string& part) {
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    expect(count("NumberOfPoints", 6), "\"/VTKHDF/Points\" has 5 rows, but 6 from row 0 on are needed");
    expect(count("NumberOfPoints", -1), "which is no count");
    expect(count("NumberOfCells", 3), "\"/VTKHDF/Offsets\" has 3 rows, but 4");
    expect(count("NumberOfConnectivityIds", std::int64_t{1} << 60), "which is no count");
    expect(count("NumberOfConnectivityIds", 9), "\"/VTKHDF/Connectivity\" has 8 rows, but 9");
    for (const char* name : {"NumberOfPoints", "NumberOfCells", "Points", "Connectivity", "Offsets", "Types"})
        EXPECT_NE(message_with(name, [](Hdf5Writer&) {}), "read") << name << " is not there";
    expect(message_with("Types", [](Hdf5Writer& file) { file.data<std::int64_t>("/VTKHDF/Types", {10, 256}, {2}); }),
           "\"Types\" are int64, and not all whole numbers from 0 to 255");
    expect(message_with("Connectivity",
                        [](Hdf5Writer& file) {
                            file.data<std::int64_t>("/VTKHDF/Connectivity", {0, 1, 2, 3, 1, 2, 3, 5}, {8});
                        }),
           "point 5");
    EXPECT_NE(
        message_with("Offsets", [](Hdf5Writer& file) { file.data<std::int64_t>("/VTKHDF/Offsets", {0, 4, 9}, {3}); }),
        "read");
}

TEST(ReadVtkhdf, LeavesOutArraysThatHdf5CannotOpen) {
    const Strip strip(7);
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_groups(file, 1);
        write_counts(file, {10}, {7});
        file.data("/VTKHDF/Points", strip.points, {10, 3});
        file.data("/VTKHDF/Connectivity", strip.connectivity, {28});
        file.data("/VTKHDF/Offsets", strip.offsets, {8});
        file.data("/VTKHDF/Types", strip.types, {7});
        file.data("/VTKHDF/PointData/p", strip.values, {10});
        file.data("/VTKHDF/PointData/q", strip.values, {10});
        file.data("/VTKHDF/CellData/vtkGhostType", std::vector<std::uint8_t>(7), {7});
    }
    const std::string content = content_of(folder.file("a.vtkhdf"));
    const auto without = [&](const char* name) {
        std::string broken = content;
        broken.replace(Hdf5Writer::place_of(folder.file("a.vtkhdf"), name), 8, 8, '\xff');
        return folder.write("b.vtkhdf", broken);
    };
    const std::string path = without("/VTKHDF/PointData/p");
    const auto rest = read(path);
    ASSERT_TRUE(rest) << rest.error().message;
    ASSERT_EQ(rest->grid.point_fields.size(), 1u);
    EXPECT_EQ(rest->grid.point_fields[0].name, "q");
    ASSERT_EQ(rest->info.left_out.size(), 1u);
    EXPECT_EQ(rest->info.left_out[0].what, "point field");
    EXPECT_EQ(rest->info.left_out[0].name, "p");
    ReadOptions asked;
    asked.point_fields = {"p"};
    const auto refused = read(path, asked);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("HDF5 cannot open \"/VTKHDF/PointData/p\""), std::string::npos)
        << refused.error().message;
    for (const char* needed : {"/VTKHDF/Points", "/VTKHDF/CellData", "/VTKHDF/CellData/vtkGhostType"}) {
        const auto result = read(without(needed));
        ASSERT_FALSE(result) << needed;
        EXPECT_NE(result.error().message.find("cannot be opened"), std::string::npos) << result.error().message;
    }
}

/// Two tets with a field q and something else.
Result<ReadResult> two_tets_with(const TemporaryFolder& folder, const std::function<void(Hdf5Writer&)>& put,
                                 const ReadOptions& options = {}) {
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_two_tets(file);
        file.data<double>("/VTKHDF/PointData/q", {1, 2, 3, 4, 5}, {5});
        put(file);
    }
    return read(folder.file("a.vtkhdf"), options);
}

TEST(ReadVtkhdf, LeavesOutArraysThatAreLinksToNothing) {
    const TemporaryFolder folder;
    folder.write("text.h5", "no HDF5");
    {
        Hdf5Writer other(folder.file("other.h5"));
        other.data<double>("/p", {1, 2, 3, 4, 5}, {5});
    }
    ReadOptions asked;
    asked.point_fields = {"p"};
    struct Case {
        std::function<void(Hdf5Writer&, const std::string&)> link;
        std::string reason;
    };
    const auto external = [](const char* file, const char* target) {
        return [=](Hdf5Writer& to, const std::string& name) { to.external_link(name, file, target); };
    };
    const Case cases[] = {
        {external("missing.h5", "/p"), "\"missing.h5\", which is not there"},
        {external("other.h5", "/missing"), "links to \"/missing\" in \"other.h5\", which HDF5 cannot open"},
        {external("text.h5", "/p"), "links to \"/p\" in \"text.h5\", which HDF5 cannot open"},
        {[](Hdf5Writer& to, const std::string& name) { to.soft_link(name, "/VTKHDF/missing"); },
         "is a link that leads to nothing"},
    };
    for (const Case& one : cases) {
        SCOPED_TRACE(one.reason);
        const auto p = [&](Hdf5Writer& file) { one.link(file, "/VTKHDF/PointData/p"); };
        const auto rest = two_tets_with(folder, p);
        ASSERT_TRUE(rest) << rest.error().message;
        ASSERT_EQ(rest->grid.point_fields.size(), 1u);
        EXPECT_EQ(rest->grid.point_fields[0].name, "q");
        ASSERT_EQ(rest->info.left_out.size(), 1u);
        EXPECT_EQ(rest->info.left_out[0].name, "p");
        EXPECT_NE(rest->info.left_out[0].reason.find(one.reason), std::string::npos) << rest->info.left_out[0].reason;
        EXPECT_EQ(inspect(folder.file("a.vtkhdf")).value().left_out.size(), 1u);
        const auto refused = two_tets_with(folder, p, asked);
        ASSERT_FALSE(refused);
        EXPECT_NE(refused.error().message.find(one.reason), std::string::npos) << refused.error().message;
        EXPECT_FALSE(two_tets_with(folder, [&](Hdf5Writer& file) { one.link(file, "/VTKHDF/CellData/vtkGhostType"); }))
            << "ghost cells would be shown";
    }
    EXPECT_TRUE(two_tets_with(folder, [](Hdf5Writer& file) {
                    file.soft_link("/VTKHDF/PointData/p", "/VTKHDF/PointData/q");
                    file.soft_link("/elsewhere", "/missing");
                })->info.left_out.empty());
}

TEST(ReadVtkhdf, TakesATypeThatIsPadded) {
    const TemporaryFolder folder;
    for (const std::string& type :
         {std::string("UnstructuredGrid        "), std::string("UnstructuredGrid\0\0\0", 19),
          std::string("UnstructuredGrid  \0 ", 20), "UnstructuredGrid" + std::string(400, ' ')}) {
        {
            Hdf5Writer file(folder.file("a.vtkhdf"));
            write_two_tets(file, type);
        }
        const auto result = read(folder.file("a.vtkhdf"));
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.cells.count(), 2u);
    }
}

TEST(ReadVtkhdf, ReadsCountsWithoutDimensions) {
    const Strip strip(7);
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_groups(file, 2);
        file.data<std::int64_t>("/VTKHDF/NumberOfPoints", {10}, {});
        file.data<std::int64_t>("/VTKHDF/NumberOfCells", {7}, {});
        file.data<std::int32_t>("/VTKHDF/NumberOfConnectivityIds", {28}, {});
        file.data("/VTKHDF/Points", strip.points, {10, 3});
        file.data("/VTKHDF/Connectivity", strip.connectivity, {28});
        file.data("/VTKHDF/Offsets", strip.offsets, {8});
        file.data("/VTKHDF/Types", strip.types, {7});
        file.data("/VTKHDF/PointData/p", strip.values, {10});
        file.data<double>("/VTKHDF/PointData/single", {1}, {});
        file.group("/VTKHDF/Steps");
        file.data<double>("/VTKHDF/Steps/Values", {0.5}, {});
        file.data<std::int64_t>("/VTKHDF/Steps/NumberOfParts", {1}, {});
    }
    const auto result = read(folder.file("a.vtkhdf"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.times, std::vector<double>{0.5});
    EXPECT_EQ(result->grid.cells.count(), 7u);
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(numbers_of(result->grid.point_fields[0].values), strip.values);
    ASSERT_EQ(result->info.left_out.size(), 1u);
    EXPECT_EQ(result->info.left_out[0].name, "single");
}

TEST(ReadVtkhdf, NumbersStepsThatHaveNoTimes) {
    const TemporaryFolder folder;
    const auto steps = [](Hdf5Writer& file) {
        file.data<double>("/VTKHDF/PointData/p", {0, 1, 2, 3, 4, 10, 11, 12, 13, 14}, {10});
        file.group("/VTKHDF/Steps");
        file.group("/VTKHDF/Steps/PointDataOffsets");
        file.data<std::int64_t>("/VTKHDF/Steps/PointDataOffsets/p", {0, 5}, {2});
    };
    ReadOptions second;
    second.step = 1;
    const auto told = two_tets_with(
        folder,
        [&](Hdf5Writer& file) {
            steps(file);
            file.attribute("/VTKHDF/Steps", "NSteps", std::vector<std::int64_t>{2});
        },
        second);
    ASSERT_TRUE(told) << told.error().message;
    EXPECT_EQ(told->info.times, (std::vector<double>{0, 1}));
    EXPECT_EQ(told->grid.point_fields.at(0).values.at(4), 14);
    ASSERT_EQ(told->info.left_out.size(), 1u);
    EXPECT_NE(told->info.left_out[0].reason.find("the numbers of the steps were taken"), std::string::npos);
    const auto unknown = two_tets_with(folder, steps);
    ASSERT_TRUE(unknown) << unknown.error().message;
    EXPECT_TRUE(unknown->info.times.empty());
    ASSERT_EQ(unknown->info.left_out.size(), 1u);
    EXPECT_NE(unknown->info.left_out[0].reason.find("as one without steps"), std::string::npos);
}

/// Bytes of chunks are changed: the values are right, or there is an error.
TEST(ReadVtkhdf, RefusesChunksThatAreBroken) {
    const Strip strip(997);
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        write_groups(file, 1);
        write_counts(file, {1000}, {997});
        file.data("/VTKHDF/Points", strip.points, {1000, 3});
        file.data("/VTKHDF/Connectivity", strip.connectivity, {4 * 997});
        file.data("/VTKHDF/Offsets", strip.offsets, {998});
        file.data("/VTKHDF/Types", strip.types, {997});
        file.stored("/VTKHDF/PointData/p", strip.values, {1000}, {.chunk = {250}, .shuffled = true, .deflated = true});
    }
    std::string content = content_of(folder.file("a.vtkhdf"));
    std::size_t changed = 0;
    ReadOptions asked;
    asked.point_fields = {"p"};
    for (std::size_t at = 0; at + 2 < content.size(); ++at) { // zlib's first two bytes, by this level
        if (content[at] != '\x78' || content[at + 1] != '\x5e') continue;
        std::string broken = content;
        for (std::size_t i = 20; i < 40; ++i) broken[at + i] = static_cast<char>(~broken[at + i]);
        const auto result = read(folder.write("b.vtkhdf", broken), asked);
        if (result) continue; // the two bytes stood elsewhere
        ++changed;
        EXPECT_NE(result.error().message.find("\"/VTKHDF/PointData/p\" the chunk at byte " + std::to_string(at) +
                                              " cannot be inflated"),
                  std::string::npos)
            << result.error().message;
    }
    EXPECT_EQ(changed, 4u);
}

} // namespace
} // namespace isotet::test
