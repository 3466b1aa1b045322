// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cell fields of packed files: the user's arrays, on surfaces and on unpacked cells.
#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <span>

#include <gtest/gtest.h>

#include <isotet/packed_file.hpp>
#include <isotet/read.hpp>

#include "io/packed/directory.hpp"
#include "packed/packed_samples.hpp"
#include "packed/right_checksums.hpp"
#include "support/places.hpp"
#include "support/run_program.hpp"

namespace isotet::test {
namespace {

/// Numbers of the cells, and three components.
struct CellFieldsCase {
    Grid grid = made_grid("mixed", 4, {"gyroid"});
    PackedGrid packed = pack(grid, point_field(grid), packing_of_all(Precision::float32)).value();
    Field number{"number", {}}, vector{"v", {}};
    TemporaryFolder folder;
    std::string path = folder.file("grid.isotet");

    CellFieldsCase() {
        std::vector<std::int32_t> numbers(grid.cells.count());
        std::iota(numbers.begin(), numbers.end(), 0);
        std::vector<double> vectors(3 * grid.cells.count());
        std::iota(vectors.begin(), vectors.end(), 0.5);
        number.values = Array::own(std::move(numbers));
        vector.values = Array::own(std::move(vectors), 3);
    }
    PackedWriter writer() const { return PackedWriter::create(packed, path).value(); }
    void save() const {
        PackedWriter out = writer();
        for (const Field* field : {&number, &vector}) out.add_cell_field(*field).value();
        out.commit().value();
    }
};

TEST(PackedCellFields, AreCarriedAsThoseOfTheUser) {
    const CellFieldsCase one;
    one.save();
    const PackedFile file = PackedFile::open(one.path).value();
    ASSERT_EQ(file.info().cell_fields.size(), 2u);
    EXPECT_EQ(file.info().cell_fields[1].components, 3u);
    EXPECT_TRUE(file.check());
    ExtractOptions from_file, from_user;
    from_user.cell_fields = {one.number, one.vector};
    for (const char* name : {"number", "v"}) from_file.cell_fields.push_back(file.cell_field(name).value());
    EXPECT_TRUE(bytes_of(extract(file.grid().value(), 0.1, from_file).value().surface) ==
                bytes_of(extract(one.packed, 0.1, from_user).value().surface));
}

TEST(PackedCellFields, AreThoseOfTheUnpackedCells) {
    const CellFieldsCase one;
    one.save();
    const Grid unpacked = read(one.path).value().grid;
    ASSERT_EQ(unpacked.cell_fields.size(), 2u);
    const auto corners_of = [](const Cells& cells, std::size_t cell) {
        std::multiset<double> corners;
        for (auto at = static_cast<std::size_t>(cells.offsets.at(cell));
             at < static_cast<std::size_t>(cells.offsets.at(cell + 1)); ++at)
            corners.insert(cells.connectivity.at(at));
        return corners;
    };
    std::set<double> numbers;
    for (std::size_t cell = 0; cell < unpacked.cells.count(); ++cell) {
        const double number = unpacked.cell_fields[0].values.at(cell);
        numbers.insert(number);
        EXPECT_EQ(unpacked.cell_fields[1].values.at(cell, 2), 3 * number + 2.5);
        EXPECT_EQ(corners_of(unpacked.cells, cell), corners_of(one.grid.cells, static_cast<std::size_t>(number)));
    }
    EXPECT_EQ(numbers.size(), one.grid.cells.count());
    ReadOptions options;
    options.cell_fields = {"v"};
    EXPECT_EQ(read(one.path, options).value().grid.cell_fields.size(), 1u);
    options.some_cells = 20;
    EXPECT_FALSE(read(one.path, options).value().cells_in_file) << "cell fields that are named need all cells";
    options.cell_fields.reset();
    EXPECT_TRUE(read(one.path, options).value().grid.cell_fields.empty());
}

TEST(PackedCellFields, HoldFromTheirStepOn) {
    const CellFieldsCase one;
    PackedWriter writer = one.writer();
    writer.add_cell_field(one.number).value();
    writer.add_step(one.packed, 1.0).value();
    writer.add_cell_field(one.number).value(); // the same: nothing is written
    writer.add_step(one.packed, 2.0).value();
    Field other = one.number;
    other.values = Array::own(std::vector<std::int32_t>(one.grid.cells.count(), 9));
    writer.add_cell_field(other).value();
    EXPECT_FALSE(writer.add_cell_field(one.number)) << "the step has one";
    writer.commit().value();
    const PackedFile file = PackedFile::open(one.path).value();
    ASSERT_EQ(file.info().cell_fields.size(), 2u);
    EXPECT_EQ(file.info().cell_fields[1].step, 2u);
    EXPECT_EQ(file.cell_field("number", 1).value().values.at(3), 3);
    EXPECT_EQ(file.cell_field("number", 2).value().values.at(3), 9);
    EXPECT_FALSE(file.cell_field("number", 3));
    EXPECT_EQ(file.cell_field("other").error().message,
              "cell field 'other' is not in the file at step 0, which has 'number'");
}

TEST(PackedCellFields, NeedSourceCellsAndAValueForEach) {
    const CellFieldsCase one;
    PackedWriter writer = one.writer();
    EXPECT_FALSE(writer.add_cell_field({"short", Array::own(std::vector<float>(3))}));
    PackedWriter without =
        PackedWriter::create(pack(one.grid, point_field(one.grid)).value(), one.folder.file("without.isotet")).value();
    EXPECT_EQ(without.add_cell_field(one.number).error().message,
              "cell field 'number' needs a grid that was packed with source cells, but this one was not");
}

TEST(PackedCellFields, OfAWrongDirectoryAreAnErrorOrReadable) {
    const CellFieldsCase one;
    one.save();
    const std::string whole = content_of(one.path);
    const auto slot = io::decode_packed_header(std::as_bytes(std::span(whole)), whole.size()).value();
    const std::size_t name = whole.rfind("CELLFLD ");
    ASSERT_GT(name, slot.offset);
    std::mt19937 random(3);
    for (std::size_t at = name - 300; at < whole.size(); at += 1 + random() % 2) {
        std::string changed = whole;
        changed[at] = static_cast<char>(random() % 2 ? random() : 255);
        const auto file = PackedFile::open(one.folder.write("wrong.isotet", with_right_directory_checksum(changed)));
        if (!file) {
            EXPECT_NE(file.error().code, ErrorCode::internal) << file.error().message;
            continue;
        }
        for (const char* field : {"number", "v"}) {
            const auto values = file->cell_field(field);
            EXPECT_TRUE(!values || values->values.tuples() == file->info().user_cells);
        }
    }
}

TEST(PackedCellFields, AreReadByAnotherReader) {
    if (run_program({"/usr/bin/env", "python3", "-c", "0"}).status != 0) GTEST_SKIP() << "there is no Python";
    const CellFieldsCase one;
    one.save();
    const std::string script = (source_folder() / "tests/packed/read_packed.py").string();
    const RunResult run = run_program({"/usr/bin/env", "python3", script, one.path});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(run.out.starts_with("number of cells 1\nv of cells 3\n")) << run.out;
}

TEST(PackedCellFields, ThatAreBrokenAreAnError) {
    const CellFieldsCase one;
    one.save();
    std::string content = content_of(one.path);
    const auto all = std::as_bytes(std::span(content));
    const auto slot = io::decode_packed_header(all, content.size()).value();
    const auto directory = io::decode_directory(all.subspan(slot.offset, slot.bytes), content.size()).value();
    content[directory.cell_fields[0].offset + 5] ^= 1;
    const PackedFile file = PackedFile::open(one.folder.write("broken.isotet", content)).value();
    EXPECT_EQ(file.cell_field("number").error().message,
              one.folder.file("broken.isotet") + ": cell field 'number' is broken: the checksum of block 0 differs");
    EXPECT_FALSE(file.check());
    EXPECT_TRUE(file.cell_field("v"));
}

} // namespace
} // namespace isotet::test
