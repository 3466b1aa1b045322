// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Scales, legends and captions: round ticks, room for the scene, text that can be seen, whatever it holds. No device.
#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include <isotet/render.hpp>

#include "render/text.hpp"
#include "render/ticks.hpp"

namespace isotet::test {
namespace {

using render::number_label;
using render::Tick;
using render::ticks_of;

std::vector<std::string> labels(double lower, double upper, std::size_t most = 6, bool logarithmic = false) {
    std::vector<std::string> all;
    for (const Tick& tick : ticks_of({.lower = lower, .upper = upper, .logarithmic = logarithmic}, most))
        all.push_back(tick.label);
    return all;
}

using Labels = std::vector<std::string>;

TEST(Ticks, AreRoundNumbersWithinTheRange) {
    EXPECT_EQ(labels(0, 1), (Labels{"0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
    EXPECT_EQ(labels(-5.4, 369), (Labels{"0", "100", "200", "300"}));
    EXPECT_EQ(labels(-1, 1, 5), (Labels{"−1.0", "−0.5", "0", "0.5", "1.0"}));
    EXPECT_EQ(labels(101324, 101326, 3), (Labels{"101324", "101325", "101326"}));
    EXPECT_EQ(labels(101325, 101325.7, 5), (Labels{"101325.0", "101325.2", "101325.4", "101325.6"}));
    EXPECT_EQ(labels(0, 2e5, 3), (Labels{"0", "1×10⁵", "2×10⁵"}));
    EXPECT_EQ(labels(0, 3e-7, 4), (Labels{"0", "1×10⁻⁷", "2×10⁻⁷", "3×10⁻⁷"}));
}

TEST(Ticks, OfLogarithmsArePowersOfTen) {
    EXPECT_EQ(labels(1e-3, 1e3, 8, true), (Labels{"0.001", "0.01", "0.1", "1", "10", "100", "1000"}));
    EXPECT_EQ(labels(1e-9, 1e9, 4, true), (Labels{"10⁻⁹", "10⁻⁴", "10", "10⁶"}));
    EXPECT_EQ(labels(2, 60, 6, true), (Labels{"2", "5", "10", "20", "50"}));
}

TEST(Ticks, AreFewInsideAndAscendingOnAnyScale) {
    for (const double lower : {-1e300, -7.3, -1e-12, 0.0, 1e-300, 3.0, 5e8}) {
        for (const double width : {1e-9, 0.37, 12.0, 9e17, 1e299}) {
            const ColorScale scale{.lower = lower, .upper = lower + width};
            if (!(scale.lower < scale.upper)) continue;
            const std::vector<Tick> ticks = ticks_of(scale, 6);
            EXPECT_GE(ticks.size(), 1u) << lower << " " << width;
            EXPECT_LE(ticks.size(), 6u) << lower << " " << width;
            for (std::size_t i = 0; i < ticks.size(); ++i) {
                EXPECT_GE(scale.place_of(ticks[i].value), -1e-6);
                EXPECT_LE(scale.place_of(ticks[i].value), 1 + 1e-6);
                EXPECT_TRUE(i == 0 || ticks[i - 1].value < ticks[i].value);
            }
        }
    }
}

TEST(NumberLabels, AreShort) {
    EXPECT_EQ(number_label(0), "0");
    EXPECT_EQ(number_label(-0.25), "−0.25");
    EXPECT_EQ(number_label(10000), "10000");
    EXPECT_EQ(number_label(12345.6), "12346");
    EXPECT_EQ(number_label(101325), "1.013×10⁵");
    EXPECT_EQ(number_label(-5e-22), "−5×10⁻²²");
}

/// How many pixels differ from the background, in a column range.
std::size_t inked(const Picture& picture, std::uint32_t from, std::uint32_t to, std::array<std::uint8_t, 4> empty) {
    std::size_t count = 0;
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = from; x < to; ++x) count += picture.at(x, y) != empty;
    return count;
}

Picture scene_of(PictureSize size, std::array<std::uint8_t, 4> pixel) {
    Picture picture{size.width, size.height, {}};
    picture.pixels.resize(std::size_t{size.width} * size.height, pixel);
    return picture;
}

Annotation sample() {
    Annotation annotation;
    annotation.title = "speed (m/s)";
    annotation.scale = ColorScale{.map = ColorMap::plasma, .lower = 0, .upper = 10};
    annotation.no_data = "no data";
    annotation.caption = "grid.vtu";
    return annotation;
}

TEST(Annotations, StandBesideTheScene) {
    const PictureSize whole{600, 400};
    const std::array<std::uint8_t, 4> white{255, 255, 255, 255}, green{0, 200, 0, 255};
    const PictureSize room = room_beside(sample(), whole).value().value();
    EXPECT_LT(room.width, whole.width);
    EXPECT_LT(room.height, whole.height);
    const Picture picture = annotate(scene_of(room, green), sample(), whole, {1, 1, 1, 1}).value();
    for (std::uint32_t y = 0; y < room.height; ++y) ASSERT_EQ(picture.at(room.width - 1, y), green);
    EXPECT_GT(inked(picture, room.width, whole.width, white), 1000u);
    // Every colour of the map, from the top down.
    const auto seen = [&](const Color& color) {
        return std::ranges::any_of(picture.pixels, [&](const auto& pixel) {
            return std::abs(pixel[0] - 255 * color.red) < 3 && std::abs(pixel[1] - 255 * color.green) < 3 &&
                   std::abs(pixel[2] - 255 * color.blue) < 3;
        });
    };
    for (const double place : {0.01, 0.25, 0.5, 0.75, 0.99})
        EXPECT_TRUE(seen(color_at(ColorMap::plasma, place))) << place;
    EXPECT_TRUE(seen(sample().scale->no_data));
    EXPECT_TRUE(annotate(scene_of(room, green), sample(), whole, {1, 1, 1, 1}).value().pixels == picture.pixels)
        << "the same every time";
}

TEST(Annotations, AreLeftOutWhereThePictureIsTooSmall) {
    EXPECT_FALSE(room_beside(sample(), {60, 40}).value());
    EXPECT_TRUE(room_beside({}, {1, 1}).value());
    EXPECT_FALSE(annotate(scene_of({10, 10}, {}), sample(), {600, 400}, {}));
}

TEST(Annotations, OfManyEntriesKeepSomeAndSayHowManyAreNotThere) {
    Annotation annotation;
    annotation.caption = "grid.vtu";
    annotation.title = "p";
    for (int i = 0; i < 60; ++i) annotation.legend.push_back({Color{0, 0, 1, 1}, std::to_string(i)});
    const PictureSize whole{1200, 900};
    const auto room = room_beside(annotation, whole).value();
    ASSERT_TRUE(room);
    Picture scene{room->width, room->height, {}};
    scene.pixels.resize(std::size_t{room->width} * room->height);
    EXPECT_TRUE(annotate(scene, annotation, whole, Color{1, 1, 1, 1}));
    EXPECT_FALSE(room_beside(annotation, {60, 40}).value());
}

TEST(Annotations, TakeAnyText) {
    Annotation annotation = sample();
    for (const std::string& text : {std::string(5000, 'W'), std::string("\xff\xfe\xf0\x9f"),
                                    std::string("\u4e2d\u6587 \u03bc\u00b2"), std::string(1, '\0')}) {
        annotation.title = annotation.caption = text;
        const PictureSize whole{500, 300};
        const auto room = room_beside(annotation, whole).value();
        ASSERT_TRUE(room);
        EXPECT_TRUE(annotate(scene_of(*room, {}), annotation, whole, {0, 0, 0, 1}));
    }
}

TEST(Annotations, TellWhatTheFontLacks) {
    EXPECT_EQ(count_missing_letters("").value(), 0u);
    EXPECT_EQ(count_missing_letters("größe µm²·s⁻¹ Δρ (m/s) …").value(), 0u);
    EXPECT_EQ(count_missing_letters("speed 速度").value(), 2u);
    EXPECT_GT(count_missing_letters("caf\xe9").value(), 0u) << "not UTF-8";
}

TEST(Annotations, OfATransparentPictureLeaveItTransparent) {
    const PictureSize whole{600, 400}, room = room_beside(sample(), whole).value().value();
    const Picture picture = annotate(scene_of(room, {}), sample(), whole, {0, 0, 0, 0}).value();
    EXPECT_EQ(picture.at(599, 0)[3], 0);
    EXPECT_GT(inked(picture, room.width, 600, {0, 0, 0, 0}), 1000u);
}

TEST(Text, IsPaintedWhereItShallBe) {
    const auto painter = render::TextPainter::open(40).value();
    Picture picture = scene_of({200, 60}, {255, 255, 255, 255});
    painter->paint(picture, 20, 50, "I", {0, 0, 0, 1});
    EXPECT_EQ(inked(picture, 0, 20, {255, 255, 255, 255}), 0u);
    EXPECT_GT(inked(picture, 20, 40, {255, 255, 255, 255}), 60u);
    EXPECT_GT(painter->width("WW"), 2 * painter->width("I"));
    painter->paint(picture, -30, -30, "beyond every edge, far to the right", {0, 0, 0, 1});
}

} // namespace
} // namespace isotet::test
