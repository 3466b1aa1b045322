// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Translucent surfaces: blended in linear light, nearest in front, whatever the order in which they are drawn.
#include "render/drawing.hpp"

#include <algorithm>
#include <cmath>

namespace isotet::test {
namespace {

class Blending : public Drawing {};

double light(double part) { return part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4); }
double coded(double part) { return part <= 0.0031308 ? part * 12.92 : 1.055 * std::pow(part, 1 / 2.4) - 0.055; }

/// `front`, with an opacity, over what is opaque.
Color over(const Color& front, double opacity, const Color& back) {
    const auto mixed = [&](float f, float b) {
        return static_cast<float>(
            coded(opacity * light(static_cast<double>(f)) + (1 - opacity) * light(static_cast<double>(b))));
    };
    return {mixed(front.red, back.red), mixed(front.green, back.green), mixed(front.blue, back.blue), 1};
}

TEST_F(Blending, IsThatOfLight) {
    add(square_at(0.5), red, 0.25);
    add(square_at(-0.5), blue);
    EXPECT_LE(difference(centre(draw()), pixel_of(over(red, 0.25, blue))), 2);
}

TEST_F(Blending, PutsTheNearestInFront) {
    add(square_at(-0.5), green, 0.5);
    add(square_at(0.5), red, 0.5);
    EXPECT_LE(difference(centre(draw()), pixel_of(over(red, 0.5, over(green, 0.5, {1, 1, 1, 1})))), 2);
}

TEST_F(Blending, LeavesOutWhatIsBehindSomethingOpaque) {
    add(square_at(0.5), blue);
    add(square_at(-0.5), red, 0.5);
    EXPECT_LE(difference(centre(draw()), pixel_of(blue)), 1);
}

TEST_F(Blending, DoesNotDependOnTheOrderOfDrawing) {
    // Two of them are in one place.
    add(sphere(12), red, 0.3);
    add(square_at(0), green, 0.4);
    add(square_at(0, true), blue, 0.5);
    add(square_at(0.2F), blue, 0.2);
    const Picture first = draw();
    std::reverse(scene_.surfaces.begin(), scene_.surfaces.end());
    EXPECT_TRUE(draw().pixels == first.pixels);
    std::swap(scene_.surfaces[0], scene_.surfaces[2]);
    EXPECT_TRUE(draw().pixels == first.pixels);
}

TEST_F(Blending, TakesAnyNumberOfSheets) {
    // More fragments than there was room for at first: they are counted, and drawn again.
    Color expected{1, 1, 1, 1};
    for (int i = 0; i < 40; ++i) {
        const Color& color = i % 2 ? red : green;
        add(square_at(-0.9F + 0.04F * static_cast<float>(i)), color, 0.05);
        expected = over(color, 0.05, expected);
    }
    EXPECT_LE(difference(centre(draw()), pixel_of(expected)), 2);
    EXPECT_EQ(renderer_->work().submissions, 2u);
    draw();
    EXPECT_EQ(renderer_->work().submissions, 1u) << "the room that was made stays";
}

TEST_F(Blending, OverATransparentBackgroundKeepsColourAndOpacityApart) {
    add(square_at(0), red, 0.5);
    options_.background = {0, 0, 0, 0};
    Color half = red;
    half.opacity = 0.5F;
    EXPECT_LE(difference(centre(draw()), pixel_of(half)), 2);
}

TEST_F(Blending, AnOpacityOfNothingDrawsNothing) {
    add(square_at(0), red, 0);
    EXPECT_EQ(centre(draw()), (Pixel{255, 255, 255, 255}));
}

} // namespace
} // namespace isotet::test
