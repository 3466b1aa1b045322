// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/pack_file.hpp>
#include <isotet/make.hpp>
#include <isotet/memory.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "jobs/read_here.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

/// Grids of one piece, of which every number that the head tells is in memory at the end.
std::vector<std::string> grids_of_one_piece(const test::TemporaryFolder& folder) {
    std::vector<std::string> files;
    for (const char* shape : {"kuhn", "mixed", "tet10", "kelvin"})
        for (const char* name : {"raw.vtu", "packed.vtu", "binary.vtk"}) {
            if (std::string(shape) == "kelvin" && std::string(name) == "binary.vtk") continue; // not written
            files.push_back(folder.file(std::string(shape) + name));
            const auto packed = std::string(name) == "packed.vtu" ? Compression::zlib : Compression::none;
            EXPECT_TRUE(
                write_grid(make_grid({.shape = shape, .side = 5}).value(), files.back(), {.compression = packed}));
        }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test::source_folder() / "data"))
        if (entry.is_regular_file() && test::is_read_here(entry.path().string()))
            files.push_back(entry.path().string());
    return files;
}

TEST(LeastCounts, AreNoMoreThanWhatIsRead) {
    const test::TemporaryFolder folder;
    std::set<std::string> told;
    for (const std::string& file : grids_of_one_piece(folder)) {
        SCOPED_TRACE(file);
        const auto info = inspect(file);
        if (!info || info->blocks.size() > 1 || info->files.size() > 4) continue;
        const auto read = isotet::read(file);
        if (!read || !read->notes.empty()) continue; // joined, or some is left out
        const Grid& grid = read->grid;
        const LeastCounts& least = info->least;
        EXPECT_LE(least.points, grid.points.tuples());
        EXPECT_LE(least.cells, grid.cells.count());
        EXPECT_LE(least.corners, grid.cells.connectivity.size());
        if (least.points > 0) {
            EXPECT_LE(size_of(least.coordinates), size_of(grid.points.type()));
        }
        if (least.points == grid.points.tuples() && least.corners == grid.cells.connectivity.size())
            told.insert(info->format);
    }
    for (const char* format : {"vtu", "vtk"}) EXPECT_TRUE(told.contains(format)) << format;
    if (!test::is_read_here("a.e")) return;
    for (const char* format : {"exodus", "vtkhdf", "cgns", "xdmf"}) EXPECT_TRUE(told.contains(format)) << format;
}

std::uint64_t number_in(const char* path, const std::string& name) {
    std::ifstream file(path);
    std::uint64_t number = 0;
    for (std::string word; file >> word;)
        if (word == name) file >> number;
    return number;
}

/// Bytes that this process has read.
std::uint64_t bytes_read() { return number_in("/proc/self/io", "rchar:"); }

/// Ends with 0 where lack of memory was told before the arrays were read.
using Work = std::function<Result<void>(const std::string& file, const std::string& out, Listener& listener)>;
[[noreturn]] void with_little_memory(std::uint64_t bytes, const Work& work) {
    const test::TemporaryFolder folder;
    const std::string file = folder.file("grid.vtu");
    const Grid grid = make_grid({.shape = "kuhn", .side = 70}).value(); // 2 million tets
    if (!write_grid(grid, file)) std::exit(9);
    release_memory();
    rlimit limit{};
    limit.rlim_cur = 1024 * number_in("/proc/self/status", "VmSize:") + bytes;
    limit.rlim_max = RLIM_INFINITY;
    if (setrlimit(RLIMIT_AS, &limit) != 0) std::exit(9);
    Listener listener;
    const std::uint64_t before = bytes_read();
    const Result<void> result = work(file, folder.file("out"), listener);
    const std::uint64_t read = bytes_read() - before;
    if (result) std::exit(1);
    std::cerr << result.error().message << std::endl;
    if (result.error().code != ErrorCode::out_of_memory) std::exit(2);
    std::exit(read < 2'000'000 ? 0 : 3);
}

[[noreturn]] void extract_all_cells(std::uint64_t bytes) {
    with_little_memory(bytes, [](const std::string& file, const std::string& out, Listener& listener) -> Result<void> {
        ExtractJob job;
        job.grid.file = file;
        job.out = out + ".vtp";
        job.field.name = "gyroid";
        job.isovalues = {0.1};
        job.snap = true; // by all values
        const auto numbers = extract_files(job, listener);
        return numbers ? Result<void>() : numbers.error();
    });
}

[[noreturn]] void pack_all(std::uint64_t bytes) {
    with_little_memory(bytes, [](const std::string& file, const std::string& out, Listener& listener) -> Result<void> {
        PackJob job;
        job.grid.file = file;
        job.out = out + ".isotet";
        const auto numbers = pack_file(job, listener);
        return numbers ? Result<void>() : numbers.error();
    });
}

class RoomForGrid : public testing::Test {
protected:
    void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};

TEST_F(RoomForGrid, IsAskedForBeforeArraysAreRead) {
    EXPECT_EXIT(
        extract_all_cells(30 << 20), testing::ExitedWithCode(0),
        "^reading .*grid.vtu needs (3[89]|4[0-9])\\.[0-9] MB at least, 4\\.[0-9] MB for points, 3[0-9]\\.[0-9] MB for "
        "cells, .* for values of fields, but [0-9.]+ MB are free; .* needs? less");
}

TEST_F(RoomForGrid, IsAskedForWithWhatPackingTakesBeside) {
    EXPECT_EXIT(
        pack_all(45 << 20), testing::ExitedWithCode(0),
        "^reading .*grid.vtu needs 5[0-9]\\.[0-9] MB at least, .* for values of fields, 1[0-9]\\.[0-9] MB for packing");
}

} // namespace
} // namespace isotet::jobs
