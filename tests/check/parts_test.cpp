// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/fields.hpp>
#include <isotet/surface.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <isotet/contour.hpp>
#include <isotet/solid.hpp>

#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

/// Three balls of radius 0.3, 0.2 and 0.1, and what the field is away from them.
Surface three_balls(const Run& run = {}) {
    Grid grid = made_grid("kuhn", 40, {"sphere"});
    std::vector<float> values(grid.points.tuples()), x(grid.points.tuples());
    const double centres[3][4] = {{-0.5, -0.5, 0, 0.3}, {0.5, 0.4, 0, 0.2}, {0.5, -0.6, 0.3, 0.1}};
    for (std::size_t i = 0; i < values.size(); ++i) {
        double nearest = 10;
        for (const auto& c : centres)
            nearest = std::min(nearest, std::hypot(grid.points.at(i, 0) - c[0], grid.points.at(i, 1) - c[1],
                                                   grid.points.at(i, 2) - c[2]) -
                                            c[3]);
        values[i] = static_cast<float>(nearest);
        x[i] = static_cast<float>(grid.points.at(i, 0));
    }
    ContourInput input{
        grid, {"distance", Array::own(std::move(values)), false, {}}, {{"x", Array::own(std::move(x))}}, {}};
    Solids solids = Solids::create(std::move(input), {}, run).value();
    return solids.extract(SolidRange::below(0), run).value().surface;
}

TEST(PartChoice, IsReadAndWritten) {
    for (const char* text :
         {"largest", "3", "area>0.5", "volume>1e-30", "touching:boundary", "touching:x=1:2", "parts:0,2", "not:7"}) {
        const auto choice = parse_part_choice(text);
        ASSERT_TRUE(choice) << text;
        EXPECT_EQ(to_text(*choice), text);
    }
    EXPECT_EQ(to_text(parse_part_choice("parts:2,0,2").value()), "parts:0,2");
    EXPECT_EQ(to_text(parse_part_choice("1").value()), "largest");
    for (const char* text : {"", "0", "-1", "1.5", "some", "area>", "area>-1", "area>nan", "volume>inf",
                             "touching:", "parts:", "parts:1,", "not:-1", "parts:1 ", "not:99999999999999999999"})
        EXPECT_FALSE(parse_part_choice(text)) << text;
}

TEST(PartChoice, ByNumberTakesTheseOrAllOthers) {
    const Surface surface = three_balls();
    const SurfaceParts found = find_parts(surface).value();
    const auto chosen = [&](const char* text) {
        return chosen_parts(surface, found, parse_part_choice(text).value(), PartsOf::solid).value();
    };
    EXPECT_EQ(chosen("parts:2,0,9"), (std::vector<std::uint64_t>{0, 2}));
    EXPECT_EQ(chosen("not:1"), (std::vector<std::uint64_t>{0, 2}));
    EXPECT_EQ(chosen("2"), (std::vector<std::uint64_t>{0, 1}));
    EXPECT_EQ(chosen("touching:boundary"), std::vector<std::uint64_t>());
    EXPECT_FALSE(chosen_parts(surface, found, parse_part_choice("touching:material=2").value(), PartsOf::solid));
    const Surface kept = keep_parts(surface, parse_part_choice("not:0").value(), PartsOf::solid).value();
    EXPECT_EQ(kept.triangle_count(), found.parts[1].triangles + found.parts[2].triangles);
    EXPECT_EQ(kept.cell_fields.size(), surface.cell_fields.size()) << "no field is added";
}

TEST(Parts, AreMeasuredLargestFirst) {
    const Surface surface = three_balls();
    const SurfaceParts found = find_parts(surface).value();
    ASSERT_EQ(found.parts.size(), 3u);
    const double radii[] = {0.3, 0.2, 0.1}, xs[] = {-0.5, 0.5, 0.5}, ys[] = {-0.5, 0.4, -0.6};
    ASSERT_EQ(found.fields, (std::vector<std::string>{"x", "boundary"}));
    std::uint64_t triangles = 0, vertices = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const SurfacePart& part = found.parts[i];
        EXPECT_TRUE(part.closed);
        EXPECT_NEAR(part.area, 4 * std::numbers::pi * radii[i] * radii[i], 0.02);
        EXPECT_NEAR(part.volume, 4.0 / 3 * std::numbers::pi * std::pow(radii[i], 3), 0.003);
        EXPECT_NEAR(part.centre[0], xs[i], 1e-3);
        EXPECT_NEAR(part.centre[1], ys[i], 1e-3);
        EXPECT_NEAR(part.means[0], xs[i], 1e-3);
        EXPECT_EQ(part.means[1], 0);
        EXPECT_NEAR(part.lower[0], xs[i] - radii[i], 0.01);
        EXPECT_NEAR(part.upper[1], ys[i] + radii[i], 0.01);
        triangles += part.triangles;
        vertices += part.vertices;
    }
    EXPECT_EQ(triangles, surface.triangle_count());
    EXPECT_EQ(vertices, surface.vertex_count());
}

TEST(Parts, AreTheSameForAnyThreads) {
    const Surface surface = three_balls();
    const SurfaceParts one = find_parts(surface, {.threads = 1}).value(),
                       seven = find_parts(surface, {.threads = 7}).value();
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(one.parts[i].area, seven.parts[i].area);
        EXPECT_EQ(one.parts[i].volume, seven.parts[i].volume);
        EXPECT_EQ(one.parts[i].means, seven.parts[i].means);
    }
}

TEST(Parts, ThatAreKeptAreWholeAndHaveTheirNumbers) {
    const Surface surface = three_balls();
    const SurfaceParts found = find_parts(surface).value();
    const Surface kept = keep_parts(surface, found, {0, 2}).value();
    EXPECT_EQ(kept.triangle_count(), found.parts[0].triangles + found.parts[2].triangles);
    EXPECT_EQ(kept.vertex_count(), found.parts[0].vertices + found.parts[2].vertices);
    ASSERT_EQ(kept.cell_fields.back().name, "part");
    for (const std::uint32_t part : kept.cell_fields.back().values.as<std::uint32_t>()) EXPECT_NE(part, 1u);
    const SurfaceParts again = find_parts(kept).value();
    ASSERT_EQ(again.parts.size(), 2u);
    EXPECT_EQ(again.parts[0].area, found.parts[0].area);
    EXPECT_TRUE(again.parts[1].closed);
    EXPECT_EQ(keep_parts(surface, found, {0, 1, 2}).value().triangle_count(), surface.triangle_count());
    EXPECT_EQ(keep_parts(surface, found, {}).value().vertex_count(), 0u);
}

TEST(Parts, OfASurfaceThatEndsAtTheBoundaryAreOpen) {
    const Grid grid = made_grid("hex", 8, {"plane"});
    Contour contour = Contour::create({grid, find_field(grid, "plane").value(), {}, {}}).value();
    const ContourResult result = contour.extract(0.1).value();
    const SurfaceParts found = find_parts(result.surfaces[0].surface).value();
    ASSERT_EQ(found.parts.size(), 1u);
    EXPECT_FALSE(found.parts[0].closed);
}

TEST(Parts, TouchARegionWhereATriangleIsInACellOfIt) {
    Surface surface = three_balls();
    const SurfaceParts found = find_parts(surface).value();
    const auto part = found.numbers.as<std::uint32_t>();
    std::vector<std::int16_t> material(2 * surface.triangle_count(), 1);
    const auto first_of = [&](std::uint32_t wanted) {
        return static_cast<std::size_t>(std::ranges::find(part, wanted) - part.begin());
    };
    material[2 * first_of(2)] = 7;
    material[2 * first_of(0) + 1] = 8;
    surface.cell_fields.push_back({"material", Array::own(std::move(material), 2)});
    const auto touching = [&](double lower, double upper) {
        return parts_touching(surface, found, {"material", lower, upper}).value();
    };
    EXPECT_EQ(touching(7, 7), (std::vector<std::uint64_t>{2}));
    EXPECT_EQ(touching(7, 8), (std::vector<std::uint64_t>{0, 2}));
    EXPECT_EQ(touching(1, 1), (std::vector<std::uint64_t>{0, 1, 2}));
    EXPECT_TRUE(touching(7.1, 7.9).empty());
    EXPECT_TRUE(parts_touching(surface, found, {"boundary", 1, 1}).value().empty());
    for (const Region& region : {Region{"materials", 1, 1}, Region{"material", 2, 1}, Region{"material", NAN, NAN}})
        EXPECT_EQ(parts_touching(surface, found, region).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(parts_touching(Surface{}, found, {"material", 1, 1}).error().code, ErrorCode::invalid_argument);
}

TEST(Parts, OfTrianglesWithACornerTwiceAreParts) {
    Surface surface; // a triangle, one that hangs on it, and two that are alone, of one vertex and of two
    surface.positions = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5, 6, 5, 5, 7, 7, 7}, 3);
    surface.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2, 2, 2, 4, 3, 3, 4, 5, 5, 5}, 3);
    const SurfaceParts found = find_parts(surface).value();
    ASSERT_EQ(found.parts.size(), 3u);
    EXPECT_EQ(found.parts[0].triangles, 2u);
    EXPECT_EQ(found.parts[0].area, 0.5);
    EXPECT_EQ(found.parts[1].area, 0);
    EXPECT_EQ(keep_parts(surface, found, {0}).value().triangle_count(), 2u);
    EXPECT_EQ(keep_parts(surface, found, {1, 2}).value().triangle_count(), 2u);
}

TEST(Parts, OfNothingAreNone) { EXPECT_TRUE(find_parts(Surface{}).value().parts.empty()); }

TEST(Parts, AskedForThatAreNotThereAreErrors) {
    const Surface surface = three_balls();
    const SurfaceParts found = find_parts(surface).value();
    EXPECT_EQ(keep_parts(surface, found, {3}).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(keep_parts(Surface{}, found, {0}).error().code, ErrorCode::invalid_argument);
}

} // namespace
} // namespace isotet::test
