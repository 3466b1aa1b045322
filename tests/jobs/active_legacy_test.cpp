// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Active cells of legacy VTK files, whose corners stand before the field: in each form that stores them.
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/jobs/extract_files.hpp>
#include <isotet/make.hpp>
#include <isotet/read.hpp>

#include "jobs/listener.hpp"
#include "support/seeds.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

enum class Form { interleaved, offsets_64, offsets_32, ascii };

template <class T>
std::string big_endian(const std::vector<T>& values) {
    std::string bytes;
    for (const T value : values) {
        char own[sizeof value];
        std::memcpy(own, &value, sizeof value);
        for (std::size_t i = 0; i < sizeof value; ++i)
            bytes += own[std::endian::native == std::endian::big ? i : sizeof value - 1 - i];
    }
    return bytes;
}

/// As VTK writes it, before version 5.1 or since then.
struct LegacyGrid {
    Form form = Form::interleaved;
    std::vector<float> points, values;
    std::vector<std::vector<std::int64_t>> cells;
    std::vector<std::int32_t> types;

    LegacyGrid(const Grid& grid, Form stored) : form(stored) {
        for (std::size_t i = 0; i < grid.points.size(); ++i)
            points.push_back(static_cast<float>(grid.points.at(i / 3, i % 3)));
        for (std::size_t i = 0; i < grid.point_fields[0].values.tuples(); ++i)
            values.push_back(static_cast<float>(grid.point_fields[0].values.at(i)));
        const std::size_t corners = grid.cells.connectivity.size() / grid.cells.count();
        for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
            cells.emplace_back();
            for (std::size_t k = 0; k < corners; ++k)
                cells.back().push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(cell * corners + k)));
            types.push_back(static_cast<std::int32_t>(grid.cells.uniform_type));
        }
    }

    template <class T>
    std::string stored(const std::vector<T>& numbers) const {
        return (form == Form::ascii ? fmt::format("{}", fmt::join(numbers, " ")) : big_endian(numbers)) + "\n";
    }

    template <class T>
    std::string offsets_and_corners(const char* type) const {
        std::vector<T> offsets{0}, corners;
        for (const auto& cell : cells) {
            for (const std::int64_t corner : cell) corners.push_back(static_cast<T>(corner));
            offsets.push_back(static_cast<T>(corners.size()));
        }
        return fmt::format("CELLS {} {}\nOFFSETS {}\n", offsets.size(), corners.size(), type) + stored(offsets) +
               fmt::format("CONNECTIVITY {}\n", type) + stored(corners);
    }

    std::string text() const {
        std::string out =
            fmt::format("# vtk DataFile Version {}\nmade\n{}\nDATASET UNSTRUCTURED_GRID\nPOINTS {} float\n",
                        form == Form::interleaved ? "4.2" : "5.1", form == Form::ascii ? "ASCII" : "BINARY",
                        points.size() / 3) +
            stored(points);
        if (form == Form::interleaved) {
            std::vector<std::int32_t> numbers;
            for (const auto& cell : cells) {
                numbers.push_back(static_cast<std::int32_t>(cell.size()));
                for (const std::int64_t corner : cell) numbers.push_back(static_cast<std::int32_t>(corner));
            }
            out += fmt::format("CELLS {} {}\n", cells.size(), numbers.size()) + stored(numbers);
        } else if (form == Form::offsets_32) out += offsets_and_corners<std::int32_t>("int");
        else out += offsets_and_corners<std::int64_t>("vtktypeint64");
        out += fmt::format("CELL_TYPES {}\n", types.size()) + stored(types);
        return out + fmt::format("POINT_DATA {}\nSCALARS gyroid float 1\nLOOKUP_TABLE default\n", values.size()) +
               stored(values);
    }
};

LegacyGrid made_legacy(const std::string& shape, std::uint64_t side, Form form) {
    return {make_grid({.shape = shape, .side = side, .fields = {"gyroid"}}).value(), form};
}

ExtractJob legacy_job(const std::string& grid, const std::string& out) {
    ExtractJob job;
    job.grid.file = grid;
    job.out = out;
    job.field.name = "gyroid";
    job.isovalues = {0.1, -0.7, 0.0};
    return job;
}

ReadOptions active_gyroid() {
    ReadOptions options;
    options.cell_fields = std::vector<std::string>{};
    options.active_cells = ReadActiveCells{"gyroid", {0.1}, {}};
    return options;
}

class ActiveCellsOfLegacyFiles : public testing::TestWithParam<Form> {
protected:
    std::string written(const LegacyGrid& grid) const { return folder_.write("grid.vtk", grid.text()); }
    test::TemporaryFolder folder_;
};

TEST_P(ActiveCellsOfLegacyFiles, GiveTheFileOfAllCells) {
    for (const char* shape : test::some_of({"shuffled", "kuhn", "hex"})) {
        SCOPED_TRACE(shape);
        const LegacyGrid grid = made_legacy(shape, 23, GetParam()); // pieces of 2^16 numbers end within cells
        const std::string file = written(grid);
        const ReadResult some = read(file, active_gyroid()).value();
        EXPECT_EQ(some.cells_in_file.has_value(), GetParam() != Form::ascii);
        if (some.cells_in_file) {
            EXPECT_LT(some.grid.cells.count(), grid.cells.size() / 2);
        }
        EXPECT_EQ(some.cells_in_file.value_or(some.grid.cells.count()), grid.cells.size());
        const ExtractJob job = legacy_job(file, folder_.file("active.vtp"));
        ExtractJob reference = legacy_job(file, folder_.file("reference.vtp"));
        reference.engine = EngineChoice::reference;
        Listener listener;
        EXPECT_EQ(extract_files(job, listener).value().cells, grid.cells.size());
        EXPECT_EQ(std::ranges::find(listener.details, "reading all cells of step 0"), listener.details.end());
        ASSERT_TRUE(extract_files(reference, listener));
        EXPECT_TRUE(test::content_of(job.out) == test::content_of(reference.out));
        ExtractJob numbered = legacy_job(file, folder_.file("active.vtp"));
        numbered.contour.source_cells = reference.contour.source_cells = true;
        numbered.isovalues = reference.isovalues = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, -0.5};
        ASSERT_TRUE(extract_files(numbered, listener));
        EXPECT_EQ(std::ranges::find(listener.details, "reading all cells of step 0"), listener.details.end());
        ASSERT_TRUE(extract_files(reference, listener));
        EXPECT_TRUE(test::content_of(numbered.out) == test::content_of(reference.out));
    }
}

TEST_P(ActiveCellsOfLegacyFiles, AreNotReadAloneWhereCellsDiffer) {
    LegacyGrid grid = made_legacy("kuhn", 6, GetParam());
    const ReadResult uniform = read(written(grid)).value();
    grid.cells[100].push_back(0); // as many numbers as before, but one cell has a corner more, and one fewer
    grid.cells[200].pop_back();
    grid.types[100] = static_cast<std::int32_t>(CellType::pyramid);
    grid.types[200] = 5; // a triangle
    const std::string file = written(grid);
    const ReadResult some = read(file, active_gyroid()).value(), all = read(file).value();
    EXPECT_FALSE(some.cells_in_file);
    EXPECT_EQ(some.grid.cells.count(), grid.cells.size());
    ASSERT_EQ(some.grid.cells.connectivity.size(), all.grid.cells.connectivity.size());
    for (std::size_t i = 0; i < all.grid.cells.connectivity.size(); ++i)
        ASSERT_EQ(some.grid.cells.connectivity.at(i), all.grid.cells.connectivity.at(i)) << i;
    EXPECT_EQ(some.grid.cells.types.at(100), 14);
    EXPECT_EQ(uniform.grid.cells.count(), all.grid.cells.count());
}

TEST_P(ActiveCellsOfLegacyFiles, ThatAreBrokenAreTheErrorsOfAllCells) {
    for (const std::int64_t corner : {std::int64_t{-1}, std::int64_t{1} << 30}) {
        LegacyGrid grid = made_legacy("kuhn", 6, GetParam());
        grid.cells[777][2] = corner;
        const std::string file = written(grid);
        const auto some = read(file, active_gyroid()), all = read(file);
        ASSERT_FALSE(some);
        ASSERT_FALSE(all);
        EXPECT_EQ(some.error().message, all.error().message);
        EXPECT_NE(all.error().message.find("777"), std::string::npos) << all.error().message;
    }
    const std::string whole = made_legacy("kuhn", 3, GetParam()).text();
    for (std::size_t length = whole.size() / 10; length < whole.size() - 8; length += whole.size() / 29) {
        const std::string file = folder_.write("cut.vtk", whole.substr(0, length));
        const auto some = read(file, active_gyroid()), all = read(file);
        ASSERT_EQ(static_cast<bool>(some), static_cast<bool>(all)) << length;
        if (!some) {
            EXPECT_EQ(some.error().message, all.error().message);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Forms, ActiveCellsOfLegacyFiles,
                         testing::Values(Form::interleaved, Form::offsets_64, Form::offsets_32, Form::ascii));

} // namespace
} // namespace isotet::jobs
