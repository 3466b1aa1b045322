// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Broken grids and wrong calls are the errors of pack() and extract(), in the same words; too little memory is told
// with the amount needed.
#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <isotet/memory.hpp>

#include "direct/direct_support.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

const std::vector<std::array<double, 3>> unit{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 5, 5}};

Grid one_tet() { return tet_grid(unit, {{0, 1, 2, 3}}); }
PointField some_field() { return field_of<float>({0, 1, 2, 3, 4}); }

template <class T>
std::string message_of(const Result<T>& result, ErrorCode code) {
    if (result) return "no error";
    EXPECT_EQ(result.error().code, code) << result.error().message;
    return result.error().message;
}

std::string refusal(const Grid& grid, const PointField& field, const std::vector<double>& isovalues,
                    const DirectOptions& options, ErrorCode code = ErrorCode::invalid_argument) {
    return message_of(extract_direct(grid, field, isovalues, options), code);
}

/// What pack() says, on both engines, with isovalues that cut and that do not.
void expect_refused_as_by_pack(const Grid& grid) {
    const PointField field = field_of(std::vector<float>(grid.points.tuples(), 0));
    const std::string expected = message_of(pack(grid, field), ErrorCode::invalid_data);
    ASSERT_NE(expected, "no error");
    for (const Engine engine : both_engines)
        for (const std::vector<double>& isovalues : {std::vector<double>{}, {0}, {7}}) {
            const auto refused = extract_direct_on(engine, grid, field, isovalues);
            EXPECT_EQ(message_of(refused, ErrorCode::invalid_data), expected);
        }
}

Grid typed_cells(std::vector<std::int64_t> connectivity, std::vector<std::int64_t> offsets,
                 std::vector<std::uint8_t> types) {
    Grid grid = one_tet();
    grid.cells.connectivity = Array::own(std::move(connectivity));
    grid.cells.offsets = Array::own(std::move(offsets));
    if (!types.empty()) grid.cells.types = Array::own(std::move(types));
    return grid;
}

TEST(BrokenGridsOnce, HavePointNumbersOutOfRange) {
    expect_refused_as_by_pack(tet_grid(unit, {{0, 1, 2, 3}, {0, 1, 2, 5}}));
    expect_refused_as_by_pack(tet_grid(unit, {{0, -1, 2, 3}}));
    Grid grid = one_tet();
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, std::numeric_limits<std::int32_t>::min()});
    expect_refused_as_by_pack(grid);
    grid.cells.connectivity = Array::own(std::vector<std::uint32_t>{0, 1, 2, 0xffffffffu});
    expect_refused_as_by_pack(grid);
    grid.cells.connectivity = Array::own(std::vector<std::uint64_t>{0, 1, 2, ~std::uint64_t{0}});
    expect_refused_as_by_pack(grid);
    expect_refused_as_by_pack(typed_cells({0, 1, 2, 3, 4, 9}, {0, 6}, {13}));
    expect_refused_as_by_pack(tet_grid({}, {{0, 0, 0, 0}}));
}

TEST(BrokenGridsOnce, NameTheFirstBrokenCellOfMany) {
    Grid grid = made_grid("shuffled", 24, {"gyroid"});
    std::vector<std::int64_t> corners;
    for (std::size_t i = 0; i < grid.cells.connectivity.size(); ++i)
        corners.push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(i)));
    corners[4 * 70000 + 1] = 99999999;
    corners[4 * 9000 + 2] = -5;
    grid.cells.connectivity = Array::own(std::move(corners));
    expect_refused_as_by_pack(grid);
}

TEST(BrokenGridsOnce, HaveABrokenCellAmongManyOfItsKind) {
    const Grid hexahedra = made_grid("hex", 16, {"gyroid"});
    const std::size_t cells = hexahedra.cells.count();
    std::vector<std::int64_t> offsets, corners;
    for (std::size_t cell = 0; cell <= cells; ++cell) offsets.push_back(static_cast<std::int64_t>(8 * cell));
    for (std::size_t i = 0; i < 8 * cells; ++i)
        corners.push_back(static_cast<std::int64_t>(hexahedra.cells.connectivity.at(i)));
    const auto with = [&](auto&& change) {
        Grid grid = hexahedra;
        auto changed_offsets = offsets;
        auto changed_corners = corners;
        change(changed_offsets, changed_corners);
        grid.cells.offsets = Array::own(std::move(changed_offsets));
        grid.cells.connectivity = Array::own(std::move(changed_corners));
        return grid;
    };
    for (const std::size_t cell :
         {std::size_t{0}, std::size_t{1023}, std::size_t{1024}, std::size_t{3000}, cells - 1}) {
        SCOPED_TRACE(cell);
        expect_refused_as_by_pack(with([&](auto&, auto& numbers) { numbers[8 * cell + 5] = -1; }));
        expect_refused_as_by_pack(with([&](auto&, auto& numbers) { numbers[8 * cell + 7] = std::int64_t{1} << 40; }));
        expect_refused_as_by_pack(with([&](auto& starts, auto&) { starts[cell + 1] += 4; }));
        expect_refused_as_by_pack(with([&](auto& starts, auto&) { starts[cell + 1] = -8; }));
    }
    expect_refused_as_by_pack(with([&](auto& starts, auto&) {
        for (std::int64_t& start : starts) start += 8; // the last cell lies outside
    }));
}

TEST(BrokenGridsOnce, HaveOffsetsThatFallOrLeadOutside) {
    for (const std::vector<std::int64_t>& offsets :
         {std::vector<std::int64_t>{0, 4, 2}, {0, 4, 9}, {0, 3, 8}, {-4, 4, 8}, {9, 4, 8}}) {
        Grid grid = tet_grid(unit, {{0, 1, 2, 3}, {1, 2, 3, 4}});
        grid.cells.offsets = Array::own(offsets);
        expect_refused_as_by_pack(grid);
    }
    expect_refused_as_by_pack(typed_cells({0, 1, 2, 3, 4, 0, 1}, {0, 7}, {12}));
    expect_refused_as_by_pack(typed_cells({0, 1, 2, 3, 4, 0, 1}, {0, 3, 9}, {10, 5}));
}

TEST(BrokenGridsOnce, HaveCoordinatesThatAreNotFiniteOrTooLarge) {
    for (const double wrong : {std::nan(""), infinity, -infinity, 0x1p91, -0x1p91})
        for (std::size_t axis = 0; axis < 3; ++axis) {
            auto points = unit;
            points[2][axis] = wrong;
            expect_refused_as_by_pack(tet_grid<double>(points, {{0, 1, 2, 3}}));
            expect_refused_as_by_pack(tet_grid<float>(points, {{0, 1, 2, 3}}));
            expect_refused_as_by_pack(
                tet_grid<float>(points, {{0, 1, 3, 4}, {2, 2, 2, 2}})); // a collapsed tet uses it, too
            Grid hexahedron = tet_grid<float>(points, {});
            hexahedron.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, 3, 4, 0, 1, 2});
            hexahedron.cells.uniform_type = CellType::hexahedron;
            expect_refused_as_by_pack(hexahedron);
            EXPECT_TRUE(extract_direct(tet_grid<float>(points, {{0, 1, 3, 4}}), some_field(), std::vector<double>{0.5}))
                << wrong;
        }
}

TEST(BrokenGridsOnce, HaveNothingToContour) {
    expect_refused_as_by_pack(tet_grid({}, {}));
    expect_refused_as_by_pack(typed_cells({0, 1, 2, 0, 1, 2, 3, 1, 2, 3}, {0, 3, 7, 10}, {5, 9, 5}));
    expect_refused_as_by_pack(tet_grid(unit, {{0, 1, 2, 2}, {1, 1, 1, 1}}));
}

TEST(BrokenGridsOnce, HaveArraysOfTheWrongTypeOrShape) {
    Grid grid = one_tet();
    grid.cells.connectivity = Array::own(std::vector<float>{0, 1, 2, 3});
    expect_refused_as_by_pack(grid);
    grid = one_tet();
    grid.points = Array::own(std::vector<float>(10, 0), 2);
    expect_refused_as_by_pack(grid);
    grid = one_tet();
    grid.cells.types = Array::own(std::vector<std::uint8_t>{10});
    expect_refused_as_by_pack(grid);
}

TEST(WrongCallsOnce, AreRefusedInWords) {
    EXPECT_EQ(refusal(one_tet(), some_field(), {0, std::nan("")}, {}), "isovalues[1] is nan, but must be finite");
    EXPECT_EQ(refusal(one_tet(), some_field(), {infinity}, {}), "the isovalue is inf, but must be finite");
    EXPECT_EQ(refusal(one_tet(), field_of<float>({0, 1, 2}, "short"), {0}, {}),
              "field 'short' has 3 values, but the grid has 5 points");
    PointField vector = field_of(std::vector<float>(15, 0), "velocity");
    vector.values = Array(ScalarType::float32, vector.values.data(), 5, 3, nullptr);
    EXPECT_EQ(refusal(one_tet(), vector, {0}, {}),
              "field 'velocity' has 3 components, but the contoured field must have 1");
    DirectOptions options;
    options.extract.point_fields = {{"p", Array::own(std::vector<float>{1, 2})}};
    EXPECT_EQ(refusal(one_tet(), some_field(), {0}, options),
              "point field 'p' has 2 tuples, but the grid has 5 points");
    options = {};
    options.extract.cell_fields = {{"c", Array::own(std::vector<float>{1, 2})}};
    EXPECT_EQ(refusal(one_tet(), some_field(), {0}, options), "cell field 'c' has 2 tuples, but the grid has 1 cells");
}

TEST(AnyNumberOfThreadsOnce, Works) {
    for (const int threads : {std::numeric_limits<int>::min(), -1, 0, 1, 5000, std::numeric_limits<int>::max()}) {
        EXPECT_EQ(surface_once(one_tet(), some_field(), 0.5, {}, {.threads = threads}).triangle_count(), 1u) << threads;
    }
}

/// Leaves this process so many bytes of address space beyond what it has and uses.
void leave_memory(std::uint64_t bytes) {
    release_memory();
    std::ifstream status("/proc/self/status");
    std::uint64_t kib = 0;
    for (std::string word; status >> word;)
        if (word == "VmSize:") status >> kib;
    const rlimit limit{1024 * kib + bytes, RLIM_INFINITY};
    if (setrlimit(RLIMIT_AS, &limit) != 0) std::exit(9);
}

/// Most of the 6 side^3 tets are cut.
void extract_with_little_memory(std::uint64_t side, std::uint64_t bytes) {
    const Grid grid = made_grid("kuhn", side, {"integer"});
    DirectOptions options;
    options.extract.ties = Ties::keep;
    if (!extract_direct(made_grid("kuhn", 2, {"integer"}), field_of(std::vector<float>(27, 0)), std::vector<double>{0},
                        options))
        std::exit(3);
    leave_memory(bytes);
    const auto result = extract_direct(grid, point_field(grid), std::vector<double>{2}, options, {.threads = 1});
    const rlimit unlimited{RLIM_INFINITY, RLIM_INFINITY}; // sanitizers need memory at the end
    setrlimit(RLIMIT_AS, &unlimited);
    if (result) std::exit(1);
    std::cerr << result.error().message << std::endl;
    std::exit(result.error().code == ErrorCode::out_of_memory ? 0 : 2);
}

class OutOfMemoryOnce : public testing::Test {
protected:
    void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};

TEST_F(OutOfMemoryOnce, IsToldWhileCellsAreLookedAt) {
    EXPECT_EXIT(extract_with_little_memory(96, 80 << 20), testing::ExitedWithCode(0),
                "^extraction may need [0-9.]+ MB for [0-9]+ active tets, but [6-8][0-9]\\.[0-9] MB are free");
}

TEST_F(OutOfMemoryOnce, IsToldBeforeTheSurfaceIsMade) {
    EXPECT_EXIT(extract_with_little_memory(72, 80 << 20), testing::ExitedWithCode(0),
                "^the surface needs [0-9.]+ MB, but [0-9.]+ MB are free");
}

} // namespace
} // namespace isotet::test
