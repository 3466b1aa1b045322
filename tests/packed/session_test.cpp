// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sessions of packed grids: from files, step after step, and what they cannot do.
#include <gtest/gtest.h>

#include <isotet/contour.hpp>
#include <isotet/packed_file.hpp>

#include "packed/packed_samples.hpp"

namespace isotet::test {
namespace {

ContourInput packed_input(const PackedGrid& packed, std::vector<PackedGrid> fields = {}) {
    ContourInput input;
    input.packed = packed;
    input.packed_fields = std::move(fields);
    return input;
}

TEST(PackedSession, GivesTheSurfacesOfASessionOfTheGrid) {
    const Grid grid = made_grid("mixed", 8, {"gyroid", "sphere"});
    ContourOptions options;
    options.method = Method::clusters;
    Contour of_grid =
        Contour::create({grid, point_field(grid), {grid.point_fields[1]}, {}}, options).value();
    const ContourResult expected = of_grid.extract(0.1).value();
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const PackedFile file =
        PackedFile::open(saved(packed, folder, 2'000, {packed.with_field(point_field(grid, 1)).value()})).value();
    Contour of_file = Contour::create(packed_input(file.grid("gyroid").value(), {file.grid("sphere").value()})).value();
    EXPECT_EQ(of_file.method(), Method::clusters);
    EXPECT_EQ(of_file.field().value().upper, packed.field().upper);
    const ContourResult result = of_file.extract(0.1).value();
    EXPECT_TRUE(bytes_of(result.surfaces[0].surface) == bytes_of(expected.surfaces[0].surface));
    EXPECT_EQ(result.method, Method::clusters);
    EXPECT_GT(result.file_bytes_read, 0u);
    EXPECT_GT(result.file_bytes_kept, 0u);
    EXPECT_EQ(of_file.extract(0.1).value().file_bytes_read, 0u);
    EXPECT_EQ(expected.file_bytes_read, 0u);
}

TEST(PackedSession, ReadsOnlyValuesOfAnotherStep) {
    const Grid grid = made_grid("kuhn", 16, {"sphere", "plane"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    SavePackedOptions options;
    options.chunk_bytes = 2'000;
    PackedWriter writer = PackedWriter::create(packed, folder.file("s.isotet"), options).value();
    std::vector<float> values(grid.point_fields[0].values.as<float>().begin(), grid.point_fields[0].values.as<float>().end());
    for (float& value : values) value += 1e-3F;
    const PackedGrid next = packed.with_field(field_of(values, "sphere")).value();
    writer.add_step(next, std::nullopt).value();
    writer.commit().value();
    const PackedFile file = PackedFile::open(folder.file("s.isotet")).value();
    Contour contour = Contour::create(packed_input(file.grid("sphere", 0).value())).value();
    const std::uint64_t first = contour.extract(0.2).value().file_bytes_read;
    const PackedGrid second = file.grid("sphere", 1).value();
    EXPECT_EQ(contour.set(packed_input(second)).value(), ContourUpdate::field);
    const ContourResult result = contour.extract(0.2).value();
    EXPECT_TRUE(bytes_of(result.surfaces[0].surface) == bytes_of(extract(next, 0.2).value().surface));
    EXPECT_LT(result.file_bytes_read, first / 4);
    EXPECT_EQ(contour.set(packed_input(second)).value(), ContourUpdate::nothing);
}

TEST(PackedSession, AsksForWhatTheSameSurfaceNeedsOfTheNextStep) {
    const Grid grid = made_grid("kuhn", 12, {"sphere"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const TemporaryFolder folder;
    const std::string path = saved(packed, folder, 2'000);
    PackedWriter::append(packed, path, 1.0).value().commit().value();
    const PackedFile file = PackedFile::open(path).value();
    EXPECT_EQ(file.read_ahead("sphere", 1), 0u) << "nothing was read yet";
    const PackedGrid first = file.grid("sphere", 0).value();
    const std::uint64_t ranges = file.read_ahead("sphere", 1);
    EXPECT_GE(ranges, 9 * first.report().clusters) << "no chunk is in memory";
    ASSERT_TRUE(extract(first, 0.2));
    const std::uint64_t some = file.read_ahead("sphere", 1);
    ASSERT_TRUE(extract(first, 0.7));
    const std::uint64_t more = file.read_ahead("sphere", 1);
    EXPECT_LT(ranges, some);
    EXPECT_LT(some, more);
    EXPECT_EQ(file.read_ahead("sphere", 2), 0u);
    EXPECT_EQ(file.read_ahead("plane", 1), 0u);
}

TEST(PackedSession, ChangesBetweenFilesAndGrids) {
    const Grid grid = made_grid("kuhn", 5, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    ContourOptions options;
    options.method = Method::clusters;
    Contour contour = Contour::create({grid, point_field(grid), {}, {}}, options).value();
    const std::string expected = bytes_of(contour.extract(0.1).value().surfaces[0].surface);
    EXPECT_EQ(contour.set(packed_input(packed)).value(), ContourUpdate::grid);
    EXPECT_TRUE(bytes_of(contour.extract(0.1).value().surfaces[0].surface) == expected);
    EXPECT_EQ(contour.set({grid, point_field(grid), {}, {}}).value(), ContourUpdate::grid);
    EXPECT_TRUE(bytes_of(contour.extract(0.1).value().surfaces[0].surface) == expected);
}

TEST(PackedSession, RefusesWhatWasNotPacked) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    const auto message = [&](const ContourOptions& options) {
        const auto contour = Contour::create(packed_input(packed), options);
        return contour ? std::string() : contour.error().message;
    };
    ContourOptions options;
    EXPECT_EQ(message(options), "");
    options.precision = Precision::float64;
    EXPECT_EQ(message(options), "the packed grid that is given is in single precision, but double was asked for");
    options = {};
    options.normals = Normals::gradient;
    EXPECT_EQ(message(options), "gradients are needed, but the packed grid that is given has none");
    options = {};
    options.source_cells = true;
    EXPECT_EQ(message(options), "source cells are needed, but the packed grid that is given has none");
    options = {};
    options.method = Method::direct;
    EXPECT_NE(message(options), "");
    options = {};
    options.exact_vertices = true;
    EXPECT_NE(message(options), "");
}

} // namespace
} // namespace isotet::test
