// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What must be true of any picture: shapes, places, light, backgrounds.
#include "render/drawing.hpp"

#include <numbers>

namespace isotet::test {
namespace {

class Pictures : public Drawing {};

double covered(const Picture& picture) {
    double sum = 0;
    for (const Pixel& pixel : picture.pixels) sum += pixel[3] / 255.0;
    return sum;
}

TEST_F(Pictures, ASphereCoversTheAreaOfItsShadow) {
    add(sphere(), blue);
    options_.background = {0, 0, 0, 0};
    options_.width = options_.height = 200;
    options_.camera.height = 1.25;
    const double pixels_per_length = 200 / 1.25;
    const double area = std::numbers::pi * 0.25 * pixels_per_length * pixels_per_length;
    EXPECT_NEAR(covered(draw()) / area, 1, 0.01);
}

TEST_F(Pictures, ASurfaceSeenAtARightAngleHasJustItsColour) {
    add(sphere(), blue);
    EXPECT_LE(difference(centre(draw()), pixel_of(blue)), 1);
}

TEST_F(Pictures, BothSidesAreLitAlike) {
    add(square_at(0), blue);
    const Picture front = draw();
    scene_.surfaces.clear();
    add(square_at(0, true), blue);
    EXPECT_TRUE(draw().pixels == front.pixels);
    EXPECT_LE(difference(centre(front), pixel_of(blue)), 1);
}

TEST_F(Pictures, WhatIsNearerHidesWhatIsFarther) {
    add(square_at(0.5), red);
    add(square_at(-0.5), blue);
    EXPECT_LE(difference(centre(draw()), pixel_of(red)), 1);
    options_.camera = camera_of(View::minus_x, Projection::perspective);
    options_.camera.distance = 6;
    EXPECT_LE(difference(centre(draw()), pixel_of(blue)), 1);
}

TEST_F(Pictures, NothingGivesTheBackground) {
    for (const Color& background :
         {Color{1, 1, 1, 1}, Color{0, 0, 0, 1}, Color{0, 0, 0, 0}, Color{0.2F, 0.4F, 0.6F, 0.5F}}) {
        options_.background = background;
        const Picture picture = draw();
        for (const Pixel& pixel : picture.pixels) ASSERT_LE(difference(pixel, pixel_of(background)), 1);
    }
}

TEST_F(Pictures, ATransparentBackgroundLetsEverythingThrough) {
    add(square_at(0), blue);
    options_.background = {0, 0, 0, 0};
    const Picture picture = draw();
    EXPECT_EQ(picture.at(0, 0)[3], 0);
    EXPECT_EQ(centre(picture)[3], 255);
}

TEST_F(Pictures, AreTheSameEveryTime) {
    add(sphere(), blue);
    scene_.lines.push_back(outline_of(scene_.bounds));
    const Picture first = draw();
    EXPECT_TRUE(draw().pixels == first.pixels);
    renderer_.emplace(Renderer::create(*device_).value());
    EXPECT_TRUE(draw().pixels == first.pixels);
}

TEST_F(Pictures, MirroredThingsHaveMirroredPictures) {
    Surface lopsided = square_at(0), mirrored = square_at(0, true);
    lopsided.positions =
        Array::own(std::vector<float>{0, -0.3F, -1, 0.4F, 0.9F, -0.5F, -0.2F, 0.4F, 0.8F, 0.1F, -0.7F, 0.6F}, 3);
    mirrored.positions =
        Array::own(std::vector<float>{0, 0.3F, -1, 0.4F, -0.9F, -0.5F, -0.2F, -0.4F, 0.8F, 0.1F, 0.7F, 0.6F}, 3);
    add(lopsided, blue);
    const Picture one = draw();
    scene_.surfaces.clear();
    add(mirrored, blue);
    const Picture other = draw();
    int differing = 0;
    for (std::uint32_t y = 0; y < one.height; ++y)
        for (std::uint32_t x = 0; x < one.width; ++x)
            differing += difference(one.at(x, y), other.at(one.width - 1 - x, y)) > 2;
    EXPECT_EQ(differing, 0);
}

TEST_F(Pictures, LargeOnesAreDrawnInPartsThatFitTogether) {
    add(sphere(8), blue);
    options_.width = 3000; // 3000 x 20 x 64 samples an axis and pixel are within one part, x 120 are not
    options_.height = 120;
    options_.samples = 8;
    options_.camera.height = 0.4;
    const Picture all = draw();
    EXPECT_GT(renderer_->work().submissions, 1u);
    // The sphere fills the middle of every row; a seam would show as a row that is unlike both neighbours.
    for (std::uint32_t y = 1; y + 1 < all.height; ++y)
        EXPECT_LE(difference(all.at(1500, y), all.at(1500, y + 1)), 6) << y;
}

TEST_F(Pictures, SizesFromHugeToTinyLookAlike) {
    Picture first;
    for (const float scale : {1.0F, 1e30F, 1e-30F}) {
        scene_.surfaces.clear();
        Surface square = square_at(0);
        std::vector<float> positions;
        for (const float x : square.positions.as<float>()) positions.push_back(x * scale);
        square.positions = Array::own(std::move(positions), 3);
        add(square, blue);
        scene_.bounds = {{-scale, -scale, -scale}, {scale, scale, scale}};
        options_.camera.height = 2.5 * static_cast<double>(scale);
        options_.camera.distance = 4 * static_cast<double>(scale);
        const Picture picture = draw();
        if (first.pixels.empty()) first = picture;
        EXPECT_TRUE(picture.pixels == first.pixels) << scale;
    }
}

TEST_F(Pictures, LinesAreAsWideAsTheyShallBe) {
    options_.background = {1, 1, 1, 0};
    options_.samples = 4;
    for (const double width : {1.0, 3.0}) {
        scene_.lines = {{.lines = {{{{0, -2, 0}, {0, 2, 0}}}}, .color = {0, 0, 0, 1}, .width = width}};
        EXPECT_NEAR(covered(draw()) / options_.width, width, 0.05);
    }
}

} // namespace
} // namespace isotet::test
