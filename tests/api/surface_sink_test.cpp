// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces in the caller's memory: the bytes of those in isotet's own.
#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/contour.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>
#include <isotet/surface.hpp>

#include "support/quadratic_grid.hpp"
#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

/// Memory that is counted; it knows what was asked for.
class Segment final : public SurfaceSink {
public:
    using Key = std::tuple<std::size_t, SurfaceArray, std::string>;

    std::shared_ptr<void> take(const Wanted& wanted) override {
        EXPECT_GT(wanted.bytes(), 0u);
        ++asked;
        if (asked > most) return nullptr;
        auto bytes = std::make_shared<std::vector<std::max_align_t>>(wanted.bytes() / sizeof(std::max_align_t) + 1);
        std::shared_ptr<void> given(bytes, bytes->data());
        last[{wanted.surface, wanted.array, std::string(wanted.field)}] = bytes->data();
        watched.emplace_back(given);
        order.emplace_back(wanted.surface, wanted.array, wanted.field);
        return given;
    }

    std::size_t alive() const {
        return static_cast<std::size_t>(std::ranges::count_if(watched, [](const auto& w) { return !w.expired(); }));
    }

    std::size_t asked = 0, most = 1'000'000;
    std::map<Key, const void*> last;
    std::vector<std::weak_ptr<void>> watched;
    std::vector<Key> order;
};

/// How many arrays the surface has, all of them where the sink last gave memory for them.
std::size_t arrays_in(const Segment& segment, const Surface& surface, std::size_t number) {
    std::size_t count = 0;
    core::each_array(surface, [&](const Array& array, SurfaceArray which, std::string_view field) {
        if (array.empty()) return;
        ++count;
        const auto found = segment.last.find({number, which, std::string(field)});
        ASSERT_NE(found, segment.last.end()) << static_cast<int>(which) << ' ' << field;
        EXPECT_EQ(found->second, array.data()) << static_cast<int>(which) << ' ' << field;
    });
    return count;
}

Grid grid_of(ScalarType points) {
    Grid grid = made_grid("mixed", 8, {"gyroid", "sphere"}, 3);
    if (grid.points.type() != points)
        grid.points = grid.points.visit([&](auto values) {
            if (points == ScalarType::float32) return Array::own(std::vector<float>(values.begin(), values.end()), 3);
            return Array::own(std::vector<double>(values.begin(), values.end()), 3);
        });
    return grid;
}

ExtractOptions options_of(const Grid& grid, Normals normals, bool all) {
    ExtractOptions options;
    options.normals = normals;
    options.edge_ends = options.source_cells = all;
    std::vector<std::int16_t> steps(grid.points.tuples());
    std::vector<double> numbers(2 * grid.cells.count());
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = static_cast<std::int16_t>(i % 9);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
    options.point_fields = {grid.point_fields[1], {"steps", Array::own(std::move(steps))}};
    options.cell_fields = {{"numbers", Array::own(std::move(numbers), 2)}};
    return options;
}

/// With a few arrays as an engine does not make them: of points, of a precision.
class SurfaceSinkTest : public testing::TestWithParam<std::tuple<ScalarType, Precision, Normals, bool>> {};

TEST_P(SurfaceSinkTest, HasEachArrayOfExtraction) {
    const auto [points, precision, normals, all] = GetParam();
    const Grid grid = grid_of(points);
    ExtractOptions options = options_of(grid, normals, all);
    PackOptions pack_options;
    pack_options.precision = precision;
    pack_options.gradients = pack_options.source_cells = true;
    const PackedGrid packed = pack(grid, point_field(grid), pack_options).value();
    const std::vector<double> isovalues{0.2, -0.4, 99, 0.2};
    const auto plain = extract(packed, isovalues, options).value();
    const auto segment = std::make_shared<Segment>();
    options.sink = segment;
    auto placed = extract(packed, isovalues, options).value();
    std::size_t arrays = 0;
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        EXPECT_EQ(bytes_of(placed[i].surface), bytes_of(plain[i].surface)) << i;
        arrays += arrays_in(*segment, placed[i].surface, i);
    }
    EXPECT_EQ(segment->asked, arrays);
    EXPECT_EQ(segment->alive(), arrays);
    placed.clear();
    EXPECT_EQ(segment->alive(), 0u);
}

TEST_P(SurfaceSinkTest, HasEachArrayOfDirectExtraction) {
    const auto [points, precision, normals, all] = GetParam();
    const Grid grid = grid_of(points);
    DirectOptions options;
    options.precision = precision;
    options.extract = options_of(grid, normals, all);
    const std::vector<double> isovalues{0.2, -0.4, 99, 0.2};
    const auto plain = extract_direct(grid, point_field(grid), isovalues, options).value();
    const auto segment = std::make_shared<Segment>();
    options.extract.sink = segment;
    auto placed = extract_direct(grid, point_field(grid), isovalues, options).value();
    std::size_t arrays = 0;
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        EXPECT_EQ(bytes_of(placed.surfaces[i].surface), bytes_of(plain.surfaces[i].surface)) << i;
        arrays += arrays_in(*segment, placed.surfaces[i].surface, i);
    }
    EXPECT_EQ(segment->alive(), arrays);
    placed = {};
    EXPECT_EQ(segment->alive(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SurfaceSinkTest,
                         testing::Combine(testing::Values(ScalarType::float32, ScalarType::float64),
                                          testing::Values(Precision::float32, Precision::float64),
                                          testing::Values(Normals::none, Normals::gradient, Normals::face,
                                                          Normals::vertex),
                                          testing::Bool()));

/// What is made elsewhere is copied when all surfaces are made.
TEST(SurfaceSink, GradientNormalsOfDirectExtractionAreMadeThere) {
    const Grid grid = grid_of(ScalarType::float32);
    DirectOptions options;
    options.extract.normals = Normals::gradient;
    const auto segment = std::make_shared<Segment>();
    options.extract.sink = segment;
    ASSERT_TRUE(extract_direct(grid, point_field(grid), std::vector{0.2, -0.4}, options));
    const auto when = [&](std::size_t surface, SurfaceArray array) {
        return std::ranges::find(segment->order, Segment::Key{surface, array, ""}) - segment->order.begin();
    };
    EXPECT_LT(when(0, SurfaceArray::normals), when(1, SurfaceArray::positions));
    EXPECT_EQ(segment->asked, 6u);
}

TEST(SurfaceSink, HasEdgeEndsOfNumberedPoints) {
    Grid grid = grid_of(ScalarType::float32);
    std::vector<std::int64_t> numbers(grid.points.tuples());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int64_t>(numbers.size() - i);
    grid.point_numbers = Array::own(std::move(numbers));
    DirectOptions options;
    options.extract.edge_ends = true;
    const double isovalue = 0.2;
    const auto plain = extract_direct(grid, point_field(grid), {&isovalue, 1}, options).value();
    const auto segment = std::make_shared<Segment>();
    options.extract.sink = segment;
    const auto placed = extract_direct(grid, point_field(grid), {&isovalue, 1}, options).value();
    EXPECT_EQ(bytes_of(placed.surfaces[0].surface), bytes_of(plain.surfaces[0].surface));
    EXPECT_EQ(arrays_in(*segment, placed.surfaces[0].surface, 0), 4u);
}

TEST(SurfaceSink, HasSurfacesOfSessions) {
    const Grid polyhedra = made_grid("kelvin", 4, {"sphere"});
    const Grid curved = quadratic_hexahedra(made_grid("hex", 4, {"sphere"}));
    for (const Grid* grid : {&polyhedra, &curved})
        for (const Method method : {Method::direct, Method::clusters})
            for (const bool exact : {false, true}) {
                ContourInput input{*grid, point_field(*grid), {grid->point_fields[0]}, {}};
                ContourOptions options;
                options.method = method;
                options.edge_ends = options.source_cells = true;
                options.normals = Normals::face;
                options.exact_vertices = exact;
                const std::vector<double> isovalues{0.3, 0.35};
                const auto plain = Contour::create(input, options).value().extract(isovalues).value();
                const auto segment = std::make_shared<Segment>();
                options.sink = segment;
                const auto placed = Contour::create(input, options).value().extract(isovalues).value();
                for (std::size_t i = 0; i < isovalues.size(); ++i) {
                    EXPECT_GT(plain.surfaces[i].surface.triangle_count(), 0u);
                    EXPECT_EQ(bytes_of(placed.surfaces[i].surface), bytes_of(plain.surfaces[i].surface));
                    EXPECT_EQ(arrays_in(*segment, placed.surfaces[i].surface, i), 7u);
                }
            }
}

TEST(SurfaceSink, WithoutMemoryIsAnError) {
    const Grid grid = grid_of(ScalarType::float64);
    ContourOptions options;
    options.edge_ends = true;
    for (const Method method : {Method::direct, Method::clusters}) {
        options.method = method;
        std::size_t most = 0;
        for (bool done = false; !done; ++most) {
            ASSERT_LT(most, 10u);
            const auto segment = std::make_shared<Segment>();
            segment->most = most;
            options.sink = segment;
            Contour session = Contour::create({grid, point_field(grid), {}, {}}, options).value();
            const auto result = session.extract(0.2);
            done = static_cast<bool>(result);
            if (!done) {
                EXPECT_EQ(result.error().code, ErrorCode::out_of_memory);
                EXPECT_EQ(segment->alive(), 0u);
            }
        }
        EXPECT_EQ(most, 5u) << "positions, triangles, ends and weights";
    }
}

TEST(SurfaceSink, MayThrow) {
    struct Thrower final : SurfaceSink {
        std::shared_ptr<void> take(const Wanted&) override { throw std::runtime_error("the segment is gone"); }
    };
    const Grid grid = grid_of(ScalarType::float32);
    ContourOptions options;
    options.sink = std::make_shared<Thrower>();
    const auto result = Contour::create({grid, point_field(grid), {}, {}}, options).value().extract(0.2);
    ASSERT_FALSE(static_cast<bool>(result));
    EXPECT_NE(result.error().message.find("the segment is gone"), std::string::npos);
}

} // namespace
} // namespace isotet::test
