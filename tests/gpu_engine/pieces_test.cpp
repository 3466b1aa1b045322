// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pieces on the device: together they give the surface of the whole, also after setting fields and points.
#include "gpu_engine/engines.hpp"
#include "pieces/partition.hpp"
#include "support/mixed_grid.hpp"

namespace isotet::test {
namespace {

class PiecesOnDevice : public Engines {
protected:
    /// Coordinates and values that single precision has to round.
    static NastyGrid large(double scale) {
        NastyGrid g = mixed_grid(3, {.side = 5, .values = 0, .moved = 0.1});
        std::vector<double> points, values;
        for (std::size_t i = 0; i < g.grid.points.size(); ++i)
            points.push_back(g.grid.points.at(i / 3, i % 3) * 1234.567 * scale + 500'000.1);
        for (std::size_t i = 0; i < g.field.values.size(); ++i)
            values.push_back(g.field.values.at(i) * 20.123 * scale + 101'325);
        g.grid.points = Array::own(std::move(points), 3);
        g.field.values = Array::own(std::move(values));
        return g;
    }

    static void expect_union(std::vector<TriangleBits> together, const NastyGrid& whole, double isovalue) {
        const auto expected =
            triangle_set(isotet::extract(pack(whole.grid, whole.field).value(), isovalue).value().surface);
        EXPECT_GT(expected.size(), 100u);
        EXPECT_TRUE(sorted(std::move(together)) == expected);
    }
};

TEST_F(PiecesOnDevice, GiveTheSurfaceOfTheWhole) {
    const NastyGrid first = large(1), later = large(1.01);
    const auto pieces = partition(first.grid, first.field, 3, 4), moved = partition(later.grid, later.field, 3, 4);
    const Frame frame = frame_of(pieces), next = frame_of(moved);
    std::vector<TriangleBits> together, again;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const PackedGrid packed = pack(pieces[i].grid, pieces[i].field, {.frame = frame}).value();
        DeviceGrid grid = DeviceGrid::upload(device(), packed).value();
        add_triangles(grid.download(grid.extract(101'326).value()).value().surface, together);
        EXPECT_EQ(grid.set_points(moved[i].grid.points).error().code, ErrorCode::invalid_argument)
            << "outside the frame";

        DeviceGrid set = DeviceGrid::upload(device(), packed.with_frame(next)).value();
        ASSERT_TRUE(set.set_points(moved[i].grid.points));
        ASSERT_TRUE(set.set_field(moved[i].field));
        add_triangles(set.download(set.extract(101'326).value()).value().surface, again);
    }
    expect_union(std::move(together), first, 101'326);
    expect_union(std::move(again), later, 101'326);
}

} // namespace
} // namespace isotet::test
