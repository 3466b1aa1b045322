// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Colours by values: of vertices, of triangles, on straight and logarithmic scales, and where there is no value.
#include "render/drawing.hpp"

#include <cmath>
#include <limits>

namespace isotet::test {
namespace {

class Colors : public Drawing {
protected:
    /// The colour of a square whose vertices all have one value.
    Pixel seen(float value, const ColorScale& scale) {
        scene_.surfaces.clear();
        color_by(add(square_at(0), {}), std::vector<float>(4, value), scale);
        return centre(draw());
    }
};

constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();

TEST_F(Colors, AreThoseOfTheMap) {
    for (const ColorMap map :
         {ColorMap::viridis, ColorMap::cividis, ColorMap::plasma, ColorMap::turbo, ColorMap::cool_warm})
        for (const float value : {-1.0F, 0.0F, 2.5F, 7.0F, 10.0F, 1e38F})
            EXPECT_LE(difference(seen(value, {.map = map, .lower = 0, .upper = 10}),
                                 pixel_of(color_at(map, static_cast<double>(value) / 10))),
                      1)
                << name_of(map) << " at " << value;
}

TEST_F(Colors, OfALogarithmicScaleFollowTheLogarithm) {
    const ColorScale scale{.lower = 1e-3, .upper = 1e3, .logarithmic = true};
    for (const float value : {1e-4F, 1e-3F, 0.1F, 1.0F, 100.0F, 1e9F, 0.0F, -5.0F}) {
        const double place = value > 0 ? (std::log10(static_cast<double>(value)) + 3) / 6 : 0;
        EXPECT_LE(difference(seen(value, scale), pixel_of(color_at(scale.map, place))), 1) << value;
    }
}

TEST_F(Colors, OfNoDataAreTheirOwn) {
    ColorScale scale;
    scale.no_data = {1, 0, 1, 1};
    EXPECT_LE(difference(seen(nan, scale), (Pixel{255, 0, 255, 255})), 1);
    EXPECT_LE(difference(seen(infinity, scale), pixel_of(color_at(scale.map, 1))), 1);
    EXPECT_LE(difference(seen(-infinity, scale), pixel_of(color_at(scale.map, 0))), 1);
}

TEST_F(Colors, OfTrianglesHaveSharpEdges) {
    DrawnSurface& drawn = add(square_at(0), {});
    color_by(drawn, {0, 1}, {.lower = 0, .upper = 1}, Association::cell);
    const Picture picture = draw();
    // The diagonal runs from the lower left to the upper right, seen from +x.
    EXPECT_LE(difference(picture.at(44, 40), pixel_of(color_at(ColorMap::viridis, 0))), 1);
    EXPECT_LE(difference(picture.at(20, 24), pixel_of(color_at(ColorMap::viridis, 1))), 1);
}

TEST_F(Colors, BetweenVerticesAreThoseOfTheValuesBetween) {
    DrawnSurface& drawn = add(square_at(0), {});
    color_by(drawn, {0, 1, 1, 0}, {.map = ColorMap::turbo, .lower = 0, .upper = 1});
    options_.camera.height = 2;
    const Picture picture = draw();
    for (const std::uint32_t x : {8U, 20U, 50U})
        EXPECT_LE(difference(picture.at(x, 30), pixel_of(color_at(ColorMap::turbo, (x + 0.5) / 64))), 2) << x;
}

TEST(ColorMaps, HaveNamesThatLeadBack) {
    for (const ColorMap map :
         {ColorMap::viridis, ColorMap::cividis, ColorMap::plasma, ColorMap::turbo, ColorMap::cool_warm})
        EXPECT_EQ(parse_color_map(name_of(map)), map);
    EXPECT_FALSE(parse_color_map("rainbow"));
}

TEST(ColorMaps, BeginAndEndAsPublished) {
    EXPECT_EQ(pixel_of(color_at(ColorMap::viridis, 0)), (Pixel{68, 1, 84, 255}));
    EXPECT_EQ(pixel_of(color_at(ColorMap::viridis, 1)), (Pixel{253, 231, 37, 255}));
    EXPECT_EQ(pixel_of(color_at(ColorMap::cividis, 0)), (Pixel{0, 34, 78, 255}));
    EXPECT_EQ(pixel_of(color_at(ColorMap::plasma, 0)), (Pixel{13, 8, 135, 255}));
    EXPECT_EQ(pixel_of(color_at(ColorMap::turbo, 0)), (Pixel{48, 18, 59, 255}));
    EXPECT_EQ(pixel_of(color_at(ColorMap::cool_warm, 0)), (Pixel{59, 76, 192, 255}));
    EXPECT_EQ(pixel_of(color_at(ColorMap::cool_warm, 1)), (Pixel{180, 4, 38, 255}));
}

TEST(ColorNames, AreWordsOrHexadecimal) {
    EXPECT_EQ(parse_color("white"), (Color{1, 1, 1, 1}));
    EXPECT_EQ(parse_color("transparent"), (Color{0, 0, 0, 0}));
    EXPECT_EQ(parse_color("#ff0000"), (Color{1, 0, 0, 1}));
    EXPECT_EQ(parse_color("#FF000000"), (Color{1, 0, 0, 0}));
    for (const char* wrong : {"", "#", "#fff", "#gg0000", "whitish", "#ff00000"})
        EXPECT_FALSE(parse_color(wrong)) << wrong;
}

} // namespace
} // namespace isotet::test
