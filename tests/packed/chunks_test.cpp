// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces from packed files: the same bytes as from memory, whatever the limit and the threads, and no more read than needed.
#include <algorithm>
#include <atomic>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include <isotet/boundary.hpp>
#include <isotet/grid.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/slice.hpp>

#include "io/packed/chunk_cache.hpp"
#include "io/packed/piece_reader.hpp"
#include "packed/packed_samples.hpp"
#include "packed/right_checksums.hpp"
#include "support/places.hpp"

namespace isotet::test {
namespace {

std::string bytes_of_all(const PackedGrid& packed, const std::vector<double>& isovalues, const ExtractOptions& options,
                         int threads) {
    std::string bytes;
    for (const Extraction& extraction : extract(packed, isovalues, options, {.threads = threads}).value()) {
        const ExtractReport& report = extraction.report;
        bytes += bytes_of(extraction.surface) + std::to_string(report.tied_points) + " " +
                 std::to_string(report.selected_clusters) + " " + std::to_string(report.near_tie);
    }
    return bytes;
}

TEST(PackedChunks, GiveTheSurfacesOfTheGridInMemory) {
    for (const PackedSample& sample : packed_samples()) {
        SCOPED_TRACE(sample.name);
        const TemporaryFolder folder;
        const std::string path = saved(sample.packed, folder);
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            const std::string expected = bytes_of_all(sample.packed, sample.isovalues, with_all(ties), 2);
            for (const std::uint64_t memory : {std::uint64_t{1}, std::uint64_t{200'000}, std::uint64_t{1} << 30})
                for (const int threads : {1, 7}) {
                    if (memory == 1 && threads == 7) continue;
                    const PackedFile file = PackedFile::open(path, {memory}).value();
                    const PackedGrid grid = file.grid().value();
                    for (int again = 0; again < 2; ++again)
                        ASSERT_TRUE(bytes_of_all(grid, sample.isovalues, with_all(ties), threads) == expected)
                            << memory << " bytes, " << threads << " threads";
                }
        }
        const PackedGrid grid = PackedFile::open(path, {100'000}).value().grid().value();
        EXPECT_TRUE(bytes_of_all(grid, sample.isovalues, {}, 3) ==
                    bytes_of_all(sample.packed, sample.isovalues, {}, 3));
    }
}

/// What was not brought cannot be read: any other read ends the process.
TEST(PackedChunks, AreAllThatIsRead) {
    io::guard_address_space(true);
    for (const PackedSample& sample : packed_samples(6)) {
        SCOPED_TRACE(sample.name);
        const TemporaryFolder folder;
        SavePackedOptions options;
        options.chunk_bytes = 1'000;
        PackedWriter writer = PackedWriter::create(sample.packed, folder.file("a.isotet"), options).value();
        writer.add_step(sample.packed, std::nullopt).value();
        writer.commit().value();
        for (const std::uint64_t memory : {std::uint64_t{1}, std::uint64_t{100'000}, std::uint64_t{1} << 30}) {
            const PackedFile file = PackedFile::open(folder.file("a.isotet"), {memory}).value();
            const PackedGrid grid = file.grid().value(), between = file.interpolated("", 0, 0.25).value(),
                             sliced = file.sliced(Plane{{1, 2, 3}, 0.1}).value();
            for (const int threads : {1, 5})
                for (const Ties ties : {Ties::merge, Ties::keep}) {
                    ExtractOptions all = with_all(ties);
                    all.packed_fields = {grid};
                    EXPECT_TRUE(bytes_of_all(grid, sample.isovalues, with_all(ties), threads) ==
                                bytes_of_all(sample.packed, sample.isovalues, with_all(ties), 2));
                    EXPECT_TRUE(extract(grid, sample.isovalues, all, {.threads = threads}));
                    all.normals = Normals::none;
                    EXPECT_TRUE(extract(between, sample.isovalues, all, {.threads = threads}));
                    EXPECT_TRUE(extract(sliced, 0.1, all, {.threads = threads}));
                }
            EXPECT_TRUE(boundary_of(grid, {grid, between, sliced}));
            EXPECT_TRUE(unpack_field(between));
            EXPECT_TRUE(unpack_sample(sliced, 100));
        }
    }
    io::guard_address_space(false);
}

TEST(PackedChunks, TellTiesAsTheGridInMemoryWhereValuesAreUnchanged) {
    const Grid grid = made_grid("kuhn", 6, {"integer"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const PackedGrid from_file = PackedFile::open(saved(packed, folder), {1}).value().grid().value();
    for (const double isovalue : {1.0, 1.2, 2.0}) {
        const ExtractReport a = extract(packed, isovalue).value().report,
                            b = extract(from_file, isovalue).value().report;
        EXPECT_EQ(a.tied_points, b.tied_points);
        EXPECT_EQ(a.false_ties, b.false_ties);
        EXPECT_EQ(a.near_tie, b.near_tie);
    }
}

TEST(PackedChunks, CarryFieldsOfTheFile) {
    const Grid grid = made_grid("mixed", 6, {"gyroid", "sphere", "integer"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    std::vector<PackedGrid> others;
    for (const std::size_t i : {1, 2}) others.push_back(packed.with_field(point_field(grid, i)).value());
    const TemporaryFolder folder;
    const PackedFile file = PackedFile::open(saved(packed, folder, 2'000, others), {150'000}).value();
    ExtractOptions by_user, by_memory, by_file;
    by_user.point_fields = {grid.point_fields[1], grid.point_fields[2]};
    by_memory.packed_fields = others;
    by_file.packed_fields = {file.grid("sphere").value(), file.grid("integer").value()};
    const std::string expected = bytes_of(extract(packed, 0.1, by_user).value().surface);
    EXPECT_TRUE(bytes_of(extract(packed, 0.1, by_memory).value().surface) == expected);
    const PackedGrid gyroid = file.grid("gyroid").value();
    EXPECT_TRUE(bytes_of(extract(gyroid, 0.1, by_file).value().surface) == expected);
    EXPECT_TRUE(bytes_of(extract(gyroid, 0.1, by_user).value().surface) == expected) << "arrays of the user";
    EXPECT_EQ(extract(packed, 0.1, by_file).error().code, ErrorCode::invalid_argument) << "of other cells";
}

/// Chunks with hit clusters, and those with points that these borrow, and all.
struct ChunksTouched {
    std::set<std::size_t> hit, beside;
};

ChunksTouched touched(const PackedGrid& grid, const io::ChunkPlaces& places, float isovalue) {
    const core::Packed& packed = grid.data();
    ChunksTouched out;
    for (std::uint32_t c = 0; c < packed.clusters(); ++c) {
        const auto range = packed.as<float>().ranges[c];
        if (!(range.lower <= isovalue && isovalue <= range.upper)) continue;
        out.hit.insert(places.chunk_of(c));
        for (const core::Neighbour& neighbour : packed.cluster_links(c).neighbours)
            out.beside.insert(places.chunk_of(neighbour.cluster));
    }
    for (const std::size_t chunk : out.hit) out.beside.erase(chunk);
    return out;
}

TEST(PackedChunks, AreReadOnlyWhereTheyAreNeeded) {
    const Grid grid = made_grid("kuhn", 24, {"sphere", "gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const PackedGrid gyroid = packed.with_field(point_field(grid, 1)).value();
    const TemporaryFolder folder;
    const std::string path = saved(packed, folder, 1, {gyroid});
    const auto source = io::PackedSource::open(path).value();
    const auto places = io::ChunkPlaces::compact(source->directory);
    const PackedFile file = PackedFile::open(path, {std::uint64_t{1} << 30}).value();
    const PackedGrid sphere = file.grid("sphere").value();
    EXPECT_EQ(file.residency().pieces_read, 0u) << "a grid reads tables only";

    const ChunksTouched chunks = touched(packed, places, 0.1F);
    ASSERT_LT(chunks.hit.size() + chunks.beside.size(), file.info().chunks / 2);
    extract(sphere, 0.1).value();
    const ResidencyReport first = file.residency();
    EXPECT_EQ(first.pieces_read, 3 * chunks.hit.size() + 2 * chunks.beside.size());
    EXPECT_LE(first.reads, 2 + 2 + 2 * (chunks.hit.size() + chunks.beside.size()) + 2);
    extract(sphere, 0.1).value();
    EXPECT_EQ(file.residency().reads, first.reads) << "all is in memory";

    const ChunksTouched others = touched(gyroid, places, 1.4F);
    std::size_t known = 0;
    for (const std::size_t chunk : others.hit) known += 2 * chunks.hit.count(chunk) + chunks.beside.count(chunk);
    for (const std::size_t chunk : others.beside) known += chunks.hit.count(chunk) + chunks.beside.count(chunk);
    extract(file.grid("gyroid").value(), 1.4).value();
    EXPECT_EQ(file.residency().pieces_read - first.pieces_read,
              3 * others.hit.size() + 2 * others.beside.size() - known)
        << "cells and points that are there are not read again for another field";
}

TEST(PackedChunks, StayWithinTheLimit) {
    const Grid grid = made_grid("kuhn", 20, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const std::string path = saved(packed, folder, 4'000);
    constexpr std::uint64_t limit = 400'000;
    const PackedFile file = PackedFile::open(path, {limit}).value();
    const PackedGrid from_file = file.grid().value();
    EXPECT_TRUE(bytes_of(extract(from_file, 0).value().surface) == bytes_of(extract(packed, 0).value().surface));
    const ResidencyReport report = file.residency();
    EXPECT_GT(report.pieces_dropped, 0u);
    EXPECT_LE(report.bytes, limit);
    EXPECT_LE(report.peak_bytes, limit);
}

TEST(PackedChunks, AreReadOnceForPositionsAlone) {
    const Grid grid = made_grid("kuhn", 20, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const std::string path = saved(packed, folder, 4'000);
    const auto pieces_read = [&](bool edge_ends) {
        const PackedFile file = PackedFile::open(path, {300'000}).value();
        ExtractOptions options;
        options.edge_ends = edge_ends;
        EXPECT_TRUE(bytes_of(extract(file.grid().value(), 0.013, options).value().surface) ==
                    bytes_of(extract(packed, 0.013, options).value().surface));
        return file.residency().pieces_read;
    };
    EXPECT_LT(static_cast<double>(pieces_read(false)), 0.6 * static_cast<double>(pieces_read(true)));
}

TEST(PackedChunks, ServeManyThreadsWhileTheyComeAndGo) {
    const Grid grid = made_grid("mixed", 10, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const PackedFile file = PackedFile::open(saved(packed, folder, 2'000), {100'000}).value();
    const PackedGrid from_file = file.grid().value();
    std::vector<std::string> expected;
    for (int i = 0; i < 6; ++i) expected.push_back(bytes_of(extract(packed, 0.2 * i - 0.5).value().surface));
    std::atomic<int> wrong{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 6; ++t)
        threads.emplace_back([&, t] {
            for (int k = 0; k < 12; ++k) {
                const int i = (t + k) % 6;
                const auto out = extract(from_file, 0.2 * i - 0.5, {}, {.threads = 2});
                wrong += !out || bytes_of(out->surface) != expected[static_cast<std::size_t>(i)];
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_LE(file.residency().bytes, 100'000u);
}

TEST(PackedChunks, AreCancelledAndGoOn) {
    const Grid grid = made_grid("kuhn", 10, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const PackedGrid from_file = PackedFile::open(saved(packed, folder)).value().grid().value();
    const std::atomic<bool> cancel{true};
    isotet::Run run;
    run.progress.cancel = &cancel;
    EXPECT_EQ(extract(from_file, 0, {}, run).error().code, ErrorCode::cancelled);
    EXPECT_TRUE(extract(from_file, 0));
}

TEST(PackedChunks, AreBroughtForWhatNeedsTheWholeGrid) {
    const Grid grid = made_grid("kuhn", 6, {"gyroid", "sphere"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const PackedGrid from_file = PackedFile::open(saved(packed, folder), {1}).value().grid().value();
    EXPECT_TRUE(bytes_of(from_file.with_field(point_field(grid, 1)).value()) ==
                bytes_of(packed.with_field(point_field(grid, 1)).value()));
    EXPECT_TRUE(bytes_of(from_file.with_points(grid.points).value()) == bytes_of(packed));
    EXPECT_EQ(unpack(from_file).value().cells.count(), grid.cells.count());
}

std::string points_and_values(const Grid& grid) {
    std::string bytes;
    append_bytes(bytes, grid.points);
    append_bytes(bytes, grid.point_fields.at(0).values);
    return bytes;
}

TEST(PackedChunks, GiveASampleOfCellsWithAllPointsAndValues) {
    for (const PackedSample& sample : packed_samples()) {
        SCOPED_TRACE(sample.name);
        const TemporaryFolder folder;
        const PackedFile file = PackedFile::open(saved(sample.packed, folder), {1}).value();
        const PackedGrid from_file = file.grid().value();
        const Grid all = unpack(sample.packed).value();
        const UnpackedSample every = unpack_sample(from_file, all.cells.count()).value();
        EXPECT_EQ(every.cells, all.cells.count());
        EXPECT_EQ(every.grid.cells.count(), all.cells.count()) << "there are few";
        EXPECT_EQ(survey(every.grid).value().boundary_faces, survey(all).value().boundary_faces);
        EXPECT_TRUE(points_and_values(every.grid) == points_and_values(all));
        const UnpackedSample some = unpack_sample(from_file, 10).value();
        EXPECT_LE(some.grid.cells.count(), 10u);
        EXPECT_GT(some.grid.cells.count(), 5u);
        EXPECT_EQ(some.cells, all.cells.count());
        EXPECT_TRUE(points_and_values(some.grid) == points_and_values(all));
    }
}

TEST(PackedChunks, OfASampleOfManyCellsAreFew) {
    const Grid grid = made_grid("hex", 52, {"gyroid"}); // more clusters than are looked at
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const PackedFile file = PackedFile::open(saved(packed, folder)).value();
    const UnpackedSample some = unpack_sample(file.grid().value(), 1'000).value();
    EXPECT_LE(some.grid.cells.count(), 1'000u);
    EXPECT_GT(some.grid.cells.count(), 900u);
    EXPECT_EQ(some.cells, grid.cells.count());
    EXPECT_LT(file.residency().pieces_read, 3 * file.info().chunks) << "points and values of all, topology of some";
    double below = 0;
    for (std::size_t i = 0; i < some.grid.cells.connectivity.size(); ++i)
        below += some.grid.points.at(static_cast<std::size_t>(some.grid.cells.connectivity.at(i)), 0) < 0 ? 1 : 0;
    EXPECT_NEAR(below / static_cast<double>(some.grid.cells.connectivity.size()), 0.5, 0.1) << "they are everywhere";
}

TEST(PackedChunks, HaveTheBoundaryOfTheGridForAnyLimit) {
    for (const PackedSample& sample : packed_samples(5)) {
        const std::string expected = bytes_of(boundary_of(sample.packed, {sample.packed}).value());
        EXPECT_EQ(boundary_of(sample.packed).value().triangle_count(),
                  boundary_of(sample.packed, {sample.packed}).value().triangle_count());
        const TemporaryFolder folder;
        const std::string path = saved(sample.packed, folder);
        const PackedFile file = PackedFile::open(path).value();
        const PackedGrid grid = file.grid().value();
        EXPECT_TRUE(bytes_of(boundary_of(grid, {grid}).value()) == expected) << sample.name;
        EXPECT_EQ(file.residency().pieces_read, 0u) << "the file has it";
        const std::string old = folder.write("old.isotet", without_boundary(content_of(path)));
        for (const std::uint64_t memory : {1, 20'000, 1'000'000'000}) {
            const PackedGrid in_parts = PackedFile::open(old, {memory}).value().grid().value();
            EXPECT_TRUE(bytes_of(boundary_of(in_parts, {in_parts}).value()) == expected)
                << sample.name << ", " << memory;
        }
    }
}

TEST(PackedChunks, HaveValuesAtTheBoundaryOfTheirGridOnly) {
    const Grid grid = made_grid("mixed", 3, {"gyroid", "integer"});
    const PackedGrid packed = pack(grid, point_field(grid)).value(),
                     other = packed.with_field(point_field(grid, 1)).value();
    const TemporaryFolder folder;
    const PackedFile file = PackedFile::open(saved(packed, folder, 2'000, {other})).value();
    const Surface boundary = boundary_of(file.grid("gyroid").value(), {file.grid("integer").value()}).value();
    ASSERT_EQ(boundary.point_fields.size(), 1u);
    EXPECT_EQ(boundary.point_fields[0].values.type(), ScalarType::int32);
    EXPECT_TRUE(bytes_of(boundary) == bytes_of(boundary_of(packed, {other}).value()));
    const auto refused = boundary_of(file.grid("gyroid").value(), {packed});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "field 'gyroid' is of another packed grid than the boundary");
}

/// Written by these versions: `isotet pack make:mixed:2:gyroid --source-cells --gradients`.
TEST(PackedChunks, OfAnOldVersionAreReadAndAddedTo) {
    const Grid grid = made_grid("mixed", 2, {"gyroid"});
    PackOptions options;
    options.source_cells = options.gradients = true;
    const PackedGrid packed = pack(grid, point_field(grid), options).value();
    const TemporaryFolder folder;
    for (const std::uint32_t minor : {0U, 1U})
        for (const std::size_t steps : {1, 2}) {
            const auto name = "version_1_" + std::to_string(minor) + ".isotet";
            const std::string path = folder.file(name);
            if (steps == 1) folder.write(name, content_of((source_folder() / "tests/packed/data" / name).string()));
            const PackedFile file = PackedFile::open(path).value();
            ASSERT_EQ(file.info().steps, steps);
            EXPECT_EQ(file.info().minor, minor);
            EXPECT_TRUE(file.check());
            const PackedGrid last = file.grid({}, steps - 1).value();
            EXPECT_TRUE(bytes_of(boundary_of(last).value()) == bytes_of(boundary_of(packed).value()));
            EXPECT_TRUE(bytes_of(extract(last, 0.1, with_all(Ties::merge)).value().surface) ==
                        bytes_of(extract(packed, 0.1, with_all(Ties::merge)).value().surface));
            if (steps == 1) PackedWriter::append(packed, path, 1.0).value().commit().value();
        }
}

} // namespace
} // namespace isotet::test
