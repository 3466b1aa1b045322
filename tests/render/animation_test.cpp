// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Animated WebP files: read back by libwebp, picture by picture.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <webp/demux.h>

#include <isotet/picture.hpp>

#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

class Animations : public testing::Test {
protected:
    std::string path(const std::string& name) const { return folder_.file(name); }

    TemporaryFolder folder_;
};

Picture plain(std::uint32_t width, std::uint32_t height, std::array<std::uint8_t, 4> color) {
    return {width, height, std::vector(std::size_t{width} * height, color)};
}

constexpr std::array<std::array<std::uint8_t, 4>, 3> frame_colors{
    {{200, 40, 40, 255}, {40, 180, 60, 255}, {250, 250, 250, 255}}};

std::uint64_t write_colors(const std::string& path) {
    Animation animation = Animation::create(path, 8).value();
    for (const auto& color : frame_colors) EXPECT_TRUE(animation.add(plain(70, 50, color)));
    return animation.finish().value();
}

TEST_F(Animations, HoldTheirPicturesAndTimes) {
    const std::uint64_t bytes = write_colors(path("a.webp"));
    const std::string file = content_of(path("a.webp"));
    EXPECT_EQ(file.size(), bytes);
    const WebPData data{reinterpret_cast<const std::uint8_t*>(file.data()), file.size()};
    WebPAnimDecoder* const decoder = WebPAnimDecoderNew(&data, nullptr);
    ASSERT_NE(decoder, nullptr);
    WebPAnimInfo info{};
    ASSERT_TRUE(WebPAnimDecoderGetInfo(decoder, &info));
    EXPECT_EQ(info.canvas_width, 70u);
    EXPECT_EQ(info.canvas_height, 50u);
    EXPECT_EQ(info.frame_count, 3u);
    EXPECT_EQ(info.loop_count, 0u) << "for ever";
    for (std::size_t i = 0; i < frame_colors.size(); ++i) {
        std::uint8_t* pixels = nullptr;
        int end = 0;
        ASSERT_TRUE(WebPAnimDecoderGetNext(decoder, &pixels, &end));
        EXPECT_EQ(end, 125 * (static_cast<int>(i) + 1));
        for (std::size_t pixel = 0; pixel < 70 * 50; ++pixel)
            for (std::size_t k = 0; k < 4; ++k)
                ASSERT_LE(std::abs(pixels[4 * pixel + k] - frame_colors[i][k]), 6) << pixel;
    }
    WebPAnimDecoderDelete(decoder);
}

TEST_F(Animations, AreTheSameBytesForTheSamePictures) {
    write_colors(path("a.webp"));
    write_colors(path("b.webp"));
    EXPECT_TRUE(content_of(path("a.webp")) == content_of(path("b.webp")));
}

TEST_F(Animations, LeaveTheOldFileUntilTheyAreFinished) {
    std::ofstream(path("a.webp")) << "old";
    {
        Animation animation = Animation::create(path("a.webp"), 8).value();
        ASSERT_TRUE(animation.add(plain(8, 8, frame_colors[0])));
    }
    EXPECT_EQ(content_of(path("a.webp")), "old");
}

TEST_F(Animations, RefuseWhatCannotBeOne) {
    EXPECT_EQ(Animation::create(path("a.gif"), 8).error().code, ErrorCode::invalid_argument);
    for (const double rate : {0.0, -1.0, 101.0, std::nan("")})
        EXPECT_EQ(Animation::create(path("a.webp"), rate).error().code, ErrorCode::invalid_argument);
    Animation animation = Animation::create(path("a.webp"), 8).value();
    EXPECT_EQ(animation.finish().error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(animation.add({}).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(animation.add(plain(16384, 1, frame_colors[0])).error().code, ErrorCode::invalid_argument);
    ASSERT_TRUE(animation.add(plain(8, 8, frame_colors[0])));
    EXPECT_EQ(animation.add(plain(8, 9, frame_colors[0])).error().message,
              "a picture of 8 x 9, but those before it are 8 x 8");
    Animation nowhere = Animation::create(path("no/where.webp"), 8).value();
    ASSERT_TRUE(nowhere.add(plain(8, 8, frame_colors[0])));
    EXPECT_EQ(nowhere.finish().error().code, ErrorCode::file);
}

} // namespace
} // namespace isotet::test
