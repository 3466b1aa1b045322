// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Places that are shaded together have the shades that they have alone.
#include "render/cpu/shade.hpp"

#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "render/color/color_places.hpp"

namespace isotet::render {
namespace {

/// Triangles anywhere, with all that shades follow from.
Sheet random_sheet(std::mt19937& random, bool normals, Coloring coloring, bool translucent, bool lit = true) {
    std::uniform_real_distribution<float> number(-1, 1);
    constexpr std::size_t triangles = 40;
    Sheet sheet;
    sheet.vertices = core::Buffer<PlacedVertex>(3 * triangles);
    sheet.triangles = core::Buffer<std::uint32_t>(3 * triangles);
    for (std::uint32_t i = 0; i < 3 * triangles; ++i) {
        sheet.vertices[i] = {40.0 * number(random),
                             40.0 * number(random),
                             1.5 + number(random),
                             {number(random), number(random), number(random)}};
        sheet.triangles[i] = i;
    }
    for (std::size_t i = 0; i < 3; ++i) sheet.vertices[i] = sheet.vertices[0]; // no area
    if (normals) {
        sheet.normals = core::Buffer<float>(9 * triangles);
        for (float& part : sheet.normals) part = number(random);
    }
    if (coloring != Coloring::one_color) {
        sheet.values = core::Buffer<float>(3 * triangles);
        for (float& value : sheet.values) value = number(random);
        sheet.values[7] = NAN;
        sheet.table = core::Buffer<float>(std::size_t{3} * entries_per_map);
        for (float& light : sheet.table) light = number(random);
    }
    sheet.coloring = coloring;
    sheet.color = {0.25F, 0.5F, 0.75F};
    sheet.no_data = {0.5F, 0.5F, 0.5F};
    sheet.log_transparency = translucent ? -0.5F : 0;
    sheet.translucent = translucent;
    sheet.lit = lit;
    return sheet;
}

TEST(Shade, OfAPlaceDoesNotDependOnOthers) {
    std::mt19937 random(3);
    std::vector<Sheet> sheets;
    for (const Coloring coloring : {Coloring::one_color, Coloring::by_vertex, Coloring::by_triangle})
        for (const bool normals : {false, true})
            for (const bool translucent : {false, true})
                sheets.push_back(random_sheet(random, normals, coloring, translucent));
    sheets.push_back(random_sheet(random, false, Coloring::one_color, false, false));
    std::vector<ShadedPlace> places;
    for (std::size_t i = 0; i < 1003; ++i)
        places.push_back({&sheets[random() % sheets.size()], static_cast<std::uint32_t>(random() % 40),
                          static_cast<double>(random() % 100), static_cast<double>(random() % 100)});
    for (const bool parallel : {false, true}) {
        Sight sight;
        sight.eye = {2, 3, 1};
        sight.up = {0, 0, 1};
        sight.parallel = parallel;
        std::vector<Shade> together(places.size());
        shade(places, sight, together);
        for (std::size_t i = 0; i < places.size(); ++i) {
            Shade alone;
            shade(std::span(places).subspan(i, 1), sight, std::span(&alone, 1));
            EXPECT_EQ(alone.color, together[i].color) << i;
            EXPECT_EQ(alone.opacity, together[i].opacity) << i;
            const Sheet& sheet = *places[i].sheet;
            EXPECT_TRUE(sheet.translucent || alone.opacity == 1);
            EXPECT_TRUE(sheet.lit || alone.color == sheet.color);
        }
    }
}

} // namespace
} // namespace isotet::render
