// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packed files give back what was saved; they are described well enough for another reader.
#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/pieces.hpp>
#include <isotet/read.hpp>

#include "io/files/crc32c.hpp"
#include "packed/packed_samples.hpp"
#include "support/places.hpp"
#include "support/run_program.hpp"

namespace isotet::test {
namespace {

TEST(Crc32c, IsThatOfTheStandardOnEveryPath) {
    const std::string digits = "123456789";
    EXPECT_EQ(io::crc32c(std::as_bytes(std::span(digits))), 0xe3069283u);
    std::mt19937 random(1);
    std::string text;
    for (int i = 0; i < 1'000; ++i) text += static_cast<char>(random());
    const auto bytes = std::as_bytes(std::span(text));
    for (const std::size_t cut : {0, 1, 7, 8, 9, 500, 1'000}) {
        const std::uint32_t whole = io::portable_crc32c(bytes);
        EXPECT_EQ(io::crc32c(bytes.subspan(cut), io::crc32c(bytes.first(cut))), whole);
        EXPECT_EQ(io::portable_crc32c(bytes.subspan(cut), io::portable_crc32c(bytes.first(cut))), whole);
    }
}

TEST(PackedFile, GivesBackTheBytesThatWereSaved) {
    for (const PackedSample& sample : packed_samples()) {
        SCOPED_TRACE(sample.name);
        const TemporaryFolder folder;
        for (const std::uint32_t chunk_bytes : {1u, 2'000u, 65'536u}) {
            const std::string path = saved(sample.packed, folder, chunk_bytes);
            const PackedGrid loaded = PackedFile::open(path).value().load().value();
            ASSERT_TRUE(bytes_of(loaded) == bytes_of(sample.packed));
            EXPECT_EQ(loaded.report().tets, sample.packed.report().tets);
            EXPECT_EQ(loaded.report().bytes, sample.packed.report().bytes);
            EXPECT_EQ(loaded.field().name, sample.packed.field().name);
            EXPECT_EQ(loaded.field().no_data, sample.packed.field().no_data);
            EXPECT_EQ(loaded.user_cell_count(), sample.packed.user_cell_count());
            PackedFile::open(path).value().check().value();
        }
    }
}

TEST(PackedFile, HasTheSameBytesForAnyThreadsAndFromAnotherFile) {
    const PackedSample sample = packed_samples().front();
    const TemporaryFolder folder;
    const std::string first = content_of(saved(sample.packed, folder));
    const std::string copy = folder.file("copy.isotet");
    for (const int threads : {1, 7}) {
        const PackedGrid grid = PackedFile::open(folder.file("grid.isotet")).value().grid().value();
        SavePackedOptions options;
        options.chunk_bytes = 2'000;
        save_packed(grid, copy, options, {.threads = threads}).value();
        EXPECT_TRUE(content_of(copy) == first) << threads;
    }
}

TEST(PackedFile, KeepsTheFrameOfAPiece) {
    const Grid grid = made_grid("kuhn", 4, {"gyroid"});
    const PointField field = point_field(grid);
    const Survey survey = survey_piece(grid, field).value();
    PackOptions options;
    options.frame = make_frame(std::array{survey}).value();
    const TemporaryFolder folder;
    const PackedGrid loaded =
        PackedFile::open(saved(pack(grid, field, options).value(), folder)).value().load().value();
    ASSERT_NE(loaded.frame(), nullptr);
    EXPECT_EQ(*loaded.frame(), *options.frame);
}

TEST(PackedFile, HoldsAnEmptyPiece) {
    const Grid whole = made_grid("kuhn", 2, {"gyroid"});
    const Survey survey = survey_piece(whole, point_field(whole)).value();
    Grid none = tet_grid({{0, 0, 0}}, {});
    PackOptions options;
    options.frame = make_frame(std::array{survey}).value();
    const TemporaryFolder folder;
    const PackedGrid packed = pack(none, field_of(std::vector<float>{1}, "gyroid"), options).value();
    const PackedFile file = PackedFile::open(saved(packed, folder)).value();
    EXPECT_EQ(extract(file.grid().value(), 0).value().surface.triangle_count(), 0u);
    EXPECT_TRUE(bytes_of(file.load().value()) == bytes_of(packed));
}

TEST(PackedFile, TellsWhatItHoldsFromTheDirectoryAlone) {
    const Grid grid = made_grid("hex", 12, {"gyroid", "integer"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const PackedFile file =
        PackedFile::open(saved(packed, folder, 2'000, {packed.with_field(point_field(grid, 1)).value()})).value();
    const PackedFileInfo& info = file.info();
    EXPECT_EQ(info.user_cells, 12u * 12 * 12);
    EXPECT_EQ(info.report.hexahedra, 12u * 12 * 12);
    ASSERT_EQ(info.fields.size(), 2u);
    EXPECT_EQ(info.fields[1].report.name, "integer");
    EXPECT_EQ(info.fields[1].type, ScalarType::int32);
    EXPECT_EQ(info.lower, (std::array<double, 3>{-1, -1, -1}));
    EXPECT_EQ(info.upper, (std::array<double, 3>{1, 1, 1}));
    EXPECT_GE(info.chunks, 10u);
    EXPECT_LT(file.residency().bytes_read, 4'096 + 40 * info.chunks + 40 * info.chunks + 1'000);
}

TEST(PackedFile, SaysWhichFieldsThereAre) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid", "integer"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const PackedFile file =
        PackedFile::open(saved(packed, folder, 2'000, {packed.with_field(point_field(grid, 1)).value()})).value();
    EXPECT_EQ(file.grid("gyroit").error().message,
              "field 'gyroit' is not in the file at step 0, which has 'gyroid', 'integer'");
    EXPECT_EQ(file.grid("").error().message, "no field was named, but the file has 'gyroid', 'integer'");
    EXPECT_EQ(file.grid("gyroid", 2).error().message, "step 2 is not there, but the file has 1 step, counted from 0");
}

TEST(PackedWriter, RefusesFieldsOfOtherCells) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value(), other = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    SavePackedOptions options;
    options.more_fields = {other};
    EXPECT_EQ(save_packed(packed, folder.file("a.isotet"), options).error().code, ErrorCode::invalid_argument);
    options.more_fields = {packed};
    EXPECT_EQ(save_packed(packed, folder.file("a.isotet"), options).error().message,
              "step 0 has field 'gyroid' already");
    EXPECT_EQ(content_of(folder.file("a.isotet")), "");
}

TEST(PackedWriter, SavesStepsOfTheSameCells) {
    const Grid grid = made_grid("kuhn", 5, {"gyroid", "sphere", "integer"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    SavePackedOptions options;
    options.chunk_bytes = 2'000;
    options.time = 0.5;
    PackedWriter writer = PackedWriter::create(packed, folder.file("s.isotet"), options).value();
    const PackedGrid second = packed.with_field({"gyroid", grid.point_fields[1].values, false, {}}).value();
    writer.add_step(second, 1.5).value();
    writer.add_field(packed.with_field(point_field(grid, 2)).value()).value();
    writer.commit().value();
    const PackedFile file = PackedFile::open(folder.file("s.isotet")).value();
    EXPECT_EQ(file.info().times, (std::vector<double>{0.5, 1.5}));
    EXPECT_EQ(file.info().fields[2].step, 1u);
    for (const double isovalue : {0.1, 0.4}) {
        EXPECT_TRUE(bytes_of(extract(file.grid("gyroid", 0).value(), isovalue).value().surface) ==
                    bytes_of(extract(packed, isovalue).value().surface));
        EXPECT_TRUE(bytes_of(extract(file.grid("gyroid", 1).value(), isovalue).value().surface) ==
                    bytes_of(extract(second, isovalue).value().surface));
    }
}

TEST(PackedWriter, AddsStepsToAFile) {
    const Grid grid = made_grid("mixed", 5, {"gyroid", "sphere"});
    PackOptions options;
    options.gradients = true;
    const PackedGrid packed = pack(grid, point_field(grid), options).value();
    const TemporaryFolder folder;
    const std::string path = saved(packed, folder);
    const PointField next{"gyroid", grid.point_fields[1].values, false, {}};
    const PackedFile before = PackedFile::open(path).value();
    for (const PackedGrid& second :
         {before.load().value().with_field(next).value(), pack(grid, next, options).value()}) {
        PackedWriter::append(second, path, 2.5).value(); // without commit(): as if it was killed
        EXPECT_EQ(PackedFile::open(path).value().info().steps, 1u);
        const std::size_t step = PackedFile::open(path).value().info().steps;
        PackedWriter writer = PackedWriter::append(second, path, 2.5).value();
        EXPECT_EQ(PackedWriter::append(second, path, 3).error().message, path + " is being written by another program");
        writer.commit().value();
        const PackedFile file = PackedFile::open(path).value();
        file.check().value();
        EXPECT_TRUE(bytes_of(file.load("gyroid", step).value()) == bytes_of(second));
        EXPECT_TRUE(bytes_of(before.load().value()) == bytes_of(packed)) << "who has the file open sees it as it was";
        std::filesystem::copy_file(path, folder.file("kept.isotet"), std::filesystem::copy_options::overwrite_existing);
        save_packed(packed, path, {{}, {}, 2'000}).value();
    }
    const PackedGrid second = pack(grid, next, options).value();
    for (const std::string file : {"grid.isotet", "kept.isotet"}) { // the second slot, then the first again
        PackedWriter writer = PackedWriter::append(second, folder.file(file), {}).value();
        writer.commit().value();
        PackedFile::open(folder.file(file)).value().check().value();
    }
    EXPECT_EQ(PackedFile::open(folder.file("kept.isotet")).value().info().steps, 3u);
}

TEST(PackedWriter, RefusesStepsOfOtherCells) {
    const Grid grid = made_grid("kuhn", 5, {"gyroid"}), smaller = made_grid("kuhn", 4, {"gyroid"});
    const TemporaryFolder folder;
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const std::string path = saved(packed, folder), content = content_of(path);
    const auto message = [&](const PackedGrid& step) { return PackedWriter::append(step, path, {}).error().message; };
    Grid renumbered = grid; // the same cells and places, by other numbers
    const std::size_t last = grid.points.tuples() - 1;
    const auto mirrored = [&](const Array& array) {
        std::vector<float> out;
        for (std::size_t i = 0; i <= last; ++i)
            for (std::size_t c = 0; c < array.components(); ++c)
                out.push_back(static_cast<float>(array.at(last - i, c)));
        return Array::own(std::move(out), array.components());
    };
    renumbered.points = mirrored(grid.points);
    renumbered.point_fields[0].values = mirrored(grid.point_fields[0].values);
    std::vector<std::int64_t> corners;
    for (std::size_t i = 0; i < grid.cells.connectivity.size(); ++i)
        corners.push_back(static_cast<std::int64_t>(last) - static_cast<std::int64_t>(grid.cells.connectivity.at(i)));
    renumbered.cells.connectivity = Array::own(std::move(corners));
    EXPECT_NE(message(pack(renumbered, point_field(renumbered)).value())
                  .find("so steps of this grid do not go into the file"),
              std::string::npos);
    EXPECT_TRUE(message(pack(smaller, point_field(smaller)).value()).starts_with("the file has 216 packed points"));
    EXPECT_TRUE(content_of(path) == content);
}

TEST(Unpack, GivesTheCellsAndValuesWithTheUsersNumbers) {
    const Grid grid = made_grid("kuhn", 4, {"gyroid", "integer"});
    const PackedGrid packed = pack(grid, point_field(grid, 1)).value();
    const Grid again = unpack(packed).value();
    EXPECT_EQ(again.cells.count(), grid.cells.count());
    std::string before, after;
    append_bytes(before, grid.points);
    append_bytes(before, grid.point_fields[1].values);
    append_bytes(after, again.points);
    append_bytes(after, again.point_fields[0].values);
    EXPECT_TRUE(before == after);
    EXPECT_EQ(again.point_fields[0].name, "integer");
    const auto total = [](const Grid& g) { return survey(g).value(); };
    EXPECT_EQ(total(again).tets, total(grid).tets);
    EXPECT_EQ(total(again).boundary_faces, total(grid).boundary_faces);
    EXPECT_EQ(total(again).repeated_tets, 0u);
}

TEST(Unpack, LeavesUnusedPointsWithoutDataInsideTheBounds) {
    const Grid grid = tet_grid({{9, 9, 9}, {1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}}, {{1, 2, 3, 4}});
    const Grid again = unpack(pack(grid, field_of(std::vector<float>{7, 1, 2, 3, 4})).value()).value();
    EXPECT_TRUE(std::isnan(again.point_fields[0].values.at(0)));
    EXPECT_EQ(again.point_fields[0].values.at(3), 3);
    EXPECT_LT(again.points.at(0, 0), 3);
}

TEST(PackedFile, IsReadAsAGrid) {
    const Grid grid = made_grid("mixed", 5, {"gyroid", "integer"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const std::string path = saved(packed, folder, 2'000, {packed.with_field(point_field(grid, 1)).value()});
    const FileInfo info = inspect(path).value();
    EXPECT_EQ(info.format, "isotet");
    ASSERT_EQ(info.fields.size(), 2u);
    ReadOptions options;
    options.point_fields = {"integer"};
    const ReadResult result = read(path, options).value();
    ASSERT_EQ(result.grid.point_fields.size(), 1u);
    EXPECT_EQ(result.grid.point_fields[0].values.type(), ScalarType::int32);
    EXPECT_EQ(survey(result.grid).value().boundary_faces, survey(grid).value().boundary_faces);
    EXPECT_EQ(survey(result.grid).value().cells_by_type, survey(grid).value().cells_by_type);
}

TEST(PackedFile, GivesSomeOfItsCellsToReadersThatNeedNoMore) {
    const Grid grid = made_grid("mixed", 5, {"gyroid", "integer"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const std::string path = saved(packed, folder, 2'000, {packed.with_field(point_field(grid, 1)).value()});
    ReadOptions options;
    options.some_cells = 20;
    const ReadResult some = read(path, options).value();
    EXPECT_EQ(some.cells_in_file, grid.cells.count());
    EXPECT_LE(some.grid.cells.count(), 20u);
    ASSERT_EQ(some.grid.point_fields.size(), 2u);
    EXPECT_EQ(some.grid.point_fields[1].values.type(), ScalarType::int32);
    EXPECT_FALSE(read(path).value().cells_in_file);
    options.point_fields.emplace();
    EXPECT_TRUE(read(path, options).value().grid.point_fields.empty());
}

TEST(PackedFile, IsReadByAnotherReaderWrittenFromItsDescription) {
    const std::string script = (source_folder() / "tests/packed/read_packed.py").string();
    if (run_program({"/usr/bin/env", "python3", "-c", "0"}).status != 0) GTEST_SKIP() << "there is no Python";
    const std::vector<PackedSample> samples = packed_samples(4);
    for (const std::size_t which : {0, 2, 8}) { // tets and mixed cells, single and double precision
        const PackedSample& sample = samples[which];
        const TemporaryFolder folder;
        const std::string path = saved(sample.packed, folder);
        const Grid grid = unpack(sample.packed).value();
        std::string expected = std::to_string(grid.points.tuples()) + " points\n";
        for (const auto& [type, count] : survey(grid, {.faces = false}).value().cells_by_type)
            expected += std::to_string(type) + ": " + std::to_string(count) + "\n";
        double corners = 0, values = 0;
        for (std::size_t i = 0; i < grid.cells.connectivity.size(); ++i) {
            const auto point = static_cast<std::size_t>(grid.cells.connectivity.at(i));
            corners += static_cast<double>(point + 1);
            const double value = grid.point_fields[0].values.at(point);
            if (!std::isnan(value)) values += value;
        }
        const RunResult run = run_program({"/usr/bin/env", "python3", script, path});
        EXPECT_EQ(run.status, 0) << sample.name << run.err;
        const std::string first = run.out.substr(0, run.out.find("sums"));
        EXPECT_EQ(first, expected) << sample.name;
        std::istringstream sums(run.out.substr(run.out.find("sums") + 4));
        double read_corners = 0, read_values = 0;
        sums >> read_corners >> read_values;
        EXPECT_EQ(read_corners, corners) << sample.name;
        EXPECT_NEAR(read_values, values, 1e-9 * std::abs(values) + 1e-6) << sample.name;
        const Surface boundary = boundary_of(sample.packed, {sample.packed}).value();
        std::string word;
        std::size_t points = 0, triangles = 0;
        double area = 0, boundary_values = 0, expected_values = 0;
        sums >> word >> points >> triangles >> area >> boundary_values;
        EXPECT_EQ(points, boundary.vertex_count()) << sample.name;
        EXPECT_EQ(triangles, boundary.triangle_count()) << sample.name;
        EXPECT_NEAR(area, check(boundary).value().area, 1e-5 * area) << sample.name;
        for (std::size_t i = 0; i < points; ++i)
            if (const double value = boundary.point_fields[0].values.at(i); !std::isnan(value))
                expected_values += value;
        EXPECT_NEAR(boundary_values, expected_values, 1e-9 * std::abs(expected_values) + 1e-6) << sample.name;
    }
}

} // namespace
} // namespace isotet::test
