// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Arrays as other programs have them: structs, columns, strides; and positions in the caller's memory.
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/contour.hpp>
#include <isotet/grid.hpp>
#include <isotet/surface.hpp>

#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

struct Node {
    std::uint8_t kind;
    double place[3];
    float pressure;
};

template <class T>
std::vector<T> values_of(const Array& array) {
    EXPECT_EQ(array.type(), scalar_type_of<T>());
    const auto all = array.as<T>();
    return {all.begin(), all.end()};
}

TEST(Interleave, TakesMembersOfStructs) {
    const std::vector<Node> nodes{{1, {0, 1, 2}, 10}, {2, {3, 4, 5}, 11}, {3, {6, 7, 8}, 12}};
    const auto of = [&](const auto& member) { return StridedScalars::of(&member, sizeof(Node)); };
    const std::array places{of(nodes[0].place[0]), of(nodes[0].place[1]), of(nodes[0].place[2])};
    const Array points = interleave(places, 3).value();
    EXPECT_EQ(points.components(), 3u);
    EXPECT_EQ(values_of<double>(points), (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
    EXPECT_EQ(values_of<float>(interleave(std::array{of(nodes[0].pressure)}, 3).value()),
              (std::vector<float>{10, 11, 12}));
    EXPECT_EQ(values_of<std::uint8_t>(interleave(std::array{of(nodes[0].kind)}, 3).value()),
              (std::vector<std::uint8_t>{1, 2, 3}));
}

TEST(Interleave, TakesColumnsBackwardsAndOneScalarForAll) {
    const std::vector<std::int16_t> x{1, 2, 3, 4};
    const std::int16_t nine = 9;
    const Array made =
        interleave(std::array{StridedScalars::of(x.data() + 3, -2), StridedScalars::of(&nine, 0)}, 4).value();
    EXPECT_EQ(values_of<std::int16_t>(made), (std::vector<std::int16_t>{4, 9, 3, 9, 2, 9, 1, 9}));
}

TEST(Interleave, TakesScalarsAtOddPlaces) {
    std::vector<char> bytes(1 + 3 * 9);
    for (int i = 0; i < 3; ++i) {
        const double value = i + 0.5;
        std::memcpy(bytes.data() + 1 + 9 * i, &value, sizeof(value));
    }
    const StridedScalars column{ScalarType::float64, bytes.data() + 1, 9};
    EXPECT_EQ(values_of<double>(interleave({&column, 1}, 3).value()), (std::vector<double>{0.5, 1.5, 2.5}));
}

TEST(Interleave, IsAGridLikeAnyOther) {
    const Grid grid = made_grid("mixed", 6, {"gyroid"});
    const std::size_t count = grid.points.tuples();
    std::vector<float> columns[3];
    for (std::size_t i = 0; i < 3 * count; ++i)
        columns[i % 3].push_back(static_cast<float>(grid.points.at(i / 3, i % 3)));
    Grid gathered = grid;
    gathered.points =
        interleave(std::array{StridedScalars::of(columns[0].data()), StridedScalars::of(columns[1].data()),
                              StridedScalars::of(columns[2].data())},
                   count)
            .value();
    const Array values = grid.point_fields[0].values;
    EXPECT_TRUE(bytes_of(contour(gathered.points, grid.cells, values, 0.1).value()) ==
                bytes_of(contour(grid.points, grid.cells, values, 0.1).value()));
}

TEST(Interleave, RefusesColumnsThatDoNotFit) {
    const float single = 1;
    const double other = 2;
    EXPECT_EQ(interleave({}, 3).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(interleave(std::array{StridedScalars::of(&single), StridedScalars::of(&other)}, 1).error().message,
              "column 1 is float64, but column 0 is float32");
    EXPECT_EQ(interleave(std::array{StridedScalars{}}, 1).error().message, "column 0 is null");
    EXPECT_EQ(interleave(std::array{StridedScalars{}}, 0).value().tuples(), 0u);
}

TEST(WritePositions, AreRelativeToAnOriginAndRoundedOnce) {
    Surface surface;
    surface.positions = Array::own(std::vector<double>{4e6 + 0.001, 2, 3, 4e6 + 0.002, -5, 6}, 3);
    std::vector<float> out(6);
    ASSERT_TRUE(write_positions(surface, {4e6, 1, 0}, out));
    EXPECT_EQ(out, (std::vector<float>{static_cast<float>(4e6 + 0.001 - 4e6), 1, 3,
                                       static_cast<float>(4e6 + 0.002 - 4e6), -6, 6}));
    surface.positions = Array::own(std::vector<float>{1, 2, 3}, 3);
    out.resize(3);
    ASSERT_TRUE(write_positions(surface, {0, 0, 0}, out));
    EXPECT_EQ(out, (std::vector<float>{1, 2, 3}));
}

TEST(WritePositions, RefusesMemoryOfAnotherSize) {
    Surface surface;
    surface.positions = Array::own(std::vector<float>{1, 2, 3}, 3);
    std::vector<float> out(4);
    EXPECT_EQ(write_positions(surface, {0, 0, 0}, out).error().message,
              "there is room for 4 numbers, but the surface has 1 vertices of 3");
    out.resize(3);
    EXPECT_EQ(write_positions(surface, {0, std::nan(""), 0}, out).error().code, ErrorCode::invalid_argument);
}

} // namespace
} // namespace isotet::test
