// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Slices of packed files: those of the grid in memory, for any limit.
#include <gtest/gtest.h>

#include <isotet/boundary.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/slice.hpp>

#include "packed/packed_samples.hpp"

namespace isotet::test {
namespace {

std::vector<SliceShape> sample_shapes() {
    return {Plane{{0, 0, 1}, 0.3}, Plane{{1, -2, 0.5}, 0.1}, Sphere{{0.1, 0, 0}, 0.7},
            Cylinder{{1, 1, 0}, {0, 0, 0}, 0.4}};
}

TEST(PackedSlices, AreThoseOfTheGridInMemory) {
    for (const PackedSample& sample : packed_samples(6)) {
        SCOPED_TRACE(sample.name);
        const TemporaryFolder folder;
        const std::string path = saved(sample.packed, folder);
        const Array points = unpack(sample.packed).value().points;
        for (const SliceShape& shape : sample_shapes()) {
            const PackedGrid expected = sample.packed.with_field(slice_field(points, shape).value()).value();
            ExtractOptions carry_memory, carry_file;
            carry_memory.edge_ends = carry_memory.source_cells = true;
            carry_file = carry_memory;
            carry_memory.packed_fields = {sample.packed};
            const std::string surface =
                bytes_of(extract(expected, slice_isovalue(shape), carry_memory).value().surface);
            for (const std::uint64_t memory : {std::uint64_t{1}, std::uint64_t{200'000}, std::uint64_t{1} << 30})
                for (const int threads : {1, 5}) {
                    if (memory == 1 && threads == 5) continue;
                    const PackedFile file = PackedFile::open(path, {memory}).value();
                    const PackedGrid sliced = file.sliced(shape, 0, {.threads = threads}).value();
                    carry_file.packed_fields = {file.grid().value()};
                    EXPECT_EQ(sliced.field().name, expected.field().name);
                    EXPECT_EQ(sliced.field().lower, expected.field().lower);
                    EXPECT_EQ(sliced.field().upper, expected.field().upper);
                    EXPECT_EQ(sliced.field().scale, expected.field().scale);
                    EXPECT_EQ(sliced.field().offset, expected.field().offset);
                    ASSERT_TRUE(bytes_of(extract(sliced, slice_isovalue(shape), carry_file).value().surface) == surface)
                        << memory << " bytes, " << threads << " threads";
                }
            const PackedGrid sliced = PackedFile::open(path, {1}).value().sliced(shape).value();
            std::string whole, of_expected;
            append_bytes(whole, unpack(sliced).value().point_fields[0].values);
            append_bytes(of_expected, unpack(expected).value().point_fields[0].values);
            EXPECT_TRUE(whole == of_expected);
            EXPECT_TRUE(bytes_of(boundary_of(sliced, {sliced}).value()) ==
                        bytes_of(boundary_of(expected, {expected}).value()));
            EXPECT_EQ(sliced.field().flushed, expected.field().flushed);
        }
    }
}

TEST(PackedSlices, ReadAllOnceWhereAllFits) {
    const Grid grid = made_grid("kuhn", 16, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const PackedFile file = PackedFile::open(saved(packed, folder)).value();
    const PackedGrid sliced = file.sliced(Plane{{0, 0, 1}, 0.5}).value();
    EXPECT_EQ(file.residency().pieces_read, 2 * file.info().chunks);
    EXPECT_GT(extract(sliced, 0.5).value().surface.triangle_count(), 0u);
    EXPECT_EQ(file.residency().pieces_read, 2 * file.info().chunks);
}

TEST(PackedSlices, OfNoShapeOrStepAreErrors) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    const TemporaryFolder folder;
    const PackedFile file = PackedFile::open(saved(pack(grid, point_field(grid)).value(), folder)).value();
    EXPECT_EQ(file.sliced(Plane{{0, 0, 0}, 0}).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(file.sliced(Plane{{0, 0, 1}, 0}, 1).error().message,
              "step 1 is not there, but the file has 1 step, counted from 0");
}

} // namespace
} // namespace isotet::test
