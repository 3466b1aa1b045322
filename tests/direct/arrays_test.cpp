// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The same bytes however the cells are written, for any number of threads, instruction set and width of numbers.
#include <gtest/gtest.h>

#include "cpu/direct/direct.hpp"
#include "cpu/extract.hpp"
#include "cpu/level.hpp"
#include "direct/direct_support.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

template <class T>
Array as_type(const Array& array) {
    std::vector<T> values;
    for (std::size_t i = 0; i < array.size(); ++i) values.push_back(static_cast<T>(array.at(i)));
    return Array::own(std::move(values));
}

TEST(CellsOnce, GiveTheSameBytesWhateverTypeTheirNumbersHave) {
    const NastyGrid g = nasty_grid(3, {.side = 9, .values = 4, .no_data = 0.02, .missing = 0.1});
    const DirectOptions options = with_everything(Ties::merge, Precision::float32);
    const std::string expected = bytes_of(surface_once(g.grid, g.field, 0, options));
    std::vector<std::int64_t> offsets;
    for (std::size_t cell = 0; cell <= g.grid.cells.count(); ++cell)
        offsets.push_back(static_cast<std::int64_t>(4 * cell));
    for (const Array& numbers :
         {as_type<std::int32_t>(g.grid.cells.connectivity), as_type<std::uint32_t>(g.grid.cells.connectivity),
          as_type<std::int64_t>(g.grid.cells.connectivity), as_type<std::uint64_t>(g.grid.cells.connectivity)}) {
        Grid grid = g.grid;
        grid.cells.connectivity = numbers;
        EXPECT_TRUE(bytes_of(surface_once(grid, g.field, 0, options)) == expected) << name_of(numbers.type());
        grid.cells.offsets = Array::own(offsets);
        EXPECT_TRUE(bytes_of(surface_once(grid, g.field, 0, options)) == expected)
            << name_of(numbers.type()) << " with offsets";
        grid.cells.types = Array::own(std::vector<std::uint8_t>(grid.cells.count(), 10));
        EXPECT_TRUE(bytes_of(surface_once(grid, g.field, 0, options)) == expected)
            << name_of(numbers.type()) << " with types";
    }
}

/// The cells of a mixed grid, all of a kind one after another, with a triangle in the middle where one is wanted.
Grid by_kind(const Grid& mixed, bool with_triangle) {
    std::vector<std::int64_t> connectivity, offsets{0};
    std::vector<std::uint8_t> types;
    const auto add = [&](std::uint8_t type, std::size_t from, std::size_t count) {
        for (std::size_t k = 0; k < count; ++k)
            connectivity.push_back(static_cast<std::int64_t>(mixed.cells.connectivity.at(from + k)));
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        types.push_back(type);
    };
    for (const int type : {12, 10, 13, 14}) {
        for (std::size_t cell = 0; cell < mixed.cells.count(); ++cell) {
            if (mixed.cells.types.at(cell) != type) continue;
            const auto from = static_cast<std::size_t>(mixed.cells.offsets.at(cell));
            add(static_cast<std::uint8_t>(type), from,
                static_cast<std::size_t>(mixed.cells.offsets.at(cell + 1)) - from);
            if (with_triangle && types.size() == 1500) add(5, 0, 3);
        }
    }
    Grid grid = mixed;
    grid.cells.connectivity = Array::own(std::move(connectivity));
    grid.cells.offsets = Array::own(std::move(offsets));
    grid.cells.types = Array::own(std::move(types));
    return grid;
}

TEST(CellsOnce, OfOneKindInARowAreTakenTogetherWithoutADifference) {
    const Grid mixed = made_grid("mixed", 16, {"integer", "gyroid"});
    for (const bool with_triangle : some_of({true, false})) {
        const Grid grid = by_kind(mixed, with_triangle);
        ASSERT_GT(grid.cells.count(), 8000u);
        for (const std::size_t field : {0, 1}) {
            std::string expected;
            for (const auto& [corners, offsets] :
                 {std::pair{as_type<std::int64_t>(grid.cells.connectivity), as_type<std::uint32_t>(grid.cells.offsets)},
                  {as_type<std::int32_t>(grid.cells.connectivity), as_type<std::int64_t>(grid.cells.offsets)},
                  {as_type<std::uint64_t>(grid.cells.connectivity), as_type<std::int32_t>(grid.cells.offsets)}}) {
                Grid written = grid;
                written.cells.connectivity = corners;
                written.cells.offsets = offsets;
                const DirectExtraction found = extract_on_both(written, point_field(written, field), {0.5, 1},
                                                               with_everything(Ties::merge, Precision::float32));
                ASSERT_GT(found.surfaces[0].surface.triangle_count(), 1000u);
                const std::string bytes = bytes_of(found.surfaces[0].surface) + bytes_of(found.surfaces[1].surface);
                if (expected.empty()) expected = bytes;
                EXPECT_TRUE(bytes == expected);
            }
        }
    }
}

TEST(ThreadsOnce, DoNotMatter) {
    const Grid shuffled = made_grid("shuffled", 24, {"gyroid"}), mixed = made_grid("mixed", 16, {"wavelet", "integer"});
    for (const auto& [grid, field, isovalue] :
         {std::tuple{shuffled, point_field(shuffled), 0.1}, {mixed, point_field(mixed, 1), 2.0}})
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            std::string expected;
            for (const int threads : {1, 2, 7, 64, 7, 2}) {
                DirectOptions options = with_everything(ties, Precision::float32);
                options.extract.point_fields = grid.point_fields;
                const std::string bytes = bytes_of(surface_once(grid, field, isovalue, options, {.threads = threads}));
                if (expected.empty()) expected = bytes;
                ASSERT_TRUE(bytes == expected) << threads << " threads";
            }
        }
}

TEST(InstructionLevelsOnce, GiveTheSameBytes) {
    for (const std::uint32_t seed : Seeds(1, 6)) {
        const NastyGrid g = nasty_grid(
            seed, {.side = 9, .values = int(seed % 2) * 5, .missing = 0.05, .inverted = 0.1, .wide = seed % 3 == 0});
        const DirectOptions options = with_everything(Ties::merge, Precision::float32);
        for (const double isovalue : {-0.5, 0.0, 0.25, 1.5}) {
            std::string expected;
            for (int level = 0; level <= int(cpu::best_level()); ++level) {
                cpu::force_level(cpu::Level(level));
                const std::string bytes = bytes_of(surface_once(g.grid, g.field, isovalue, options));
                cpu::force_level({});
                if (expected.empty()) expected = bytes;
                ASSERT_TRUE(bytes == expected) << isovalue << ", " << cpu::name_of(cpu::Level(level));
            }
        }
    }
}

/// Lowers limits for one test.
class WideNumbersOnce : public testing::Test {
protected:
    void TearDown() override {
        cpu::direct::wide_points_from = direct_limit_;
        cpu::wide_from = limit_;
    }

private:
    const std::uint64_t direct_limit_ = cpu::direct::wide_points_from, limit_ = cpu::wide_from;
};

TEST_F(WideNumbersOnce, OfPointsAndEdgesGiveTheSameBytes) {
    const NastyGrid g = nasty_grid(9, {.side = 8, .values = 3, .no_data = 0.02, .wide = true});
    for (const Precision precision : {Precision::float32, Precision::float64})
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            const DirectOptions options = with_everything(ties, precision);
            const std::string narrow = bytes_of(surface_once(g.grid, g.field, 0.5, options));
            cpu::direct::wide_points_from = 1; // points
            EXPECT_TRUE(bytes_of(surface_once(g.grid, g.field, 0.5, options)) == narrow);
            cpu::direct::wide_points_from = g.grid.points.tuples() + 1; // edges
            EXPECT_TRUE(bytes_of(surface_once(g.grid, g.field, 0.5, options)) == narrow);
        }
}

TEST_F(WideNumbersOnce, OfVerticesGiveTheSameTriangles) {
    const NastyGrid g = nasty_grid(9, {.side = 8, .values = 3});
    const DirectOptions options = with_everything(Ties::merge, Precision::float32);
    const Surface narrow = surface_once(g.grid, g.field, 0.5, options);
    cpu::wide_from = narrow.vertex_count();
    Surface wide = surface_once(g.grid, g.field, 0.5, options);
    cpu::wide_from = narrow.vertex_count() + 1;
    EXPECT_EQ(surface_once(g.grid, g.field, 0.5, options).triangles.type(), ScalarType::uint32);
    ASSERT_EQ(wide.triangles.type(), ScalarType::uint64);
    const auto indices = wide.triangles.as<std::uint64_t>();
    wide.triangles = Array::own(std::vector<std::uint32_t>(indices.begin(), indices.end()), 3);
    EXPECT_TRUE(bytes_of(narrow) == bytes_of(wide));
}

} // namespace
} // namespace isotet::test
