// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// PNG files: read back by libpng, pixel by pixel.
#include <array>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <png.h>

#include <isotet/picture.hpp>

#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

class PictureFile : public testing::Test {
protected:
    std::string path(const std::string& name) const { return folder_.file(name); }

    /// What libpng's own reader makes of a file.
    static Picture read(const std::string& file, bool& alpha) {
        png_image image{};
        image.version = PNG_IMAGE_VERSION;
        EXPECT_TRUE(png_image_begin_read_from_file(&image, file.c_str())) << image.message;
        alpha = image.format & PNG_FORMAT_FLAG_ALPHA;
        image.format = PNG_FORMAT_RGBA;
        Picture picture{image.width, image.height, {}};
        picture.pixels.resize(std::size_t{image.width} * image.height);
        EXPECT_TRUE(png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr)) << image.message;
        return picture;
    }

    static Picture sample(std::uint8_t opacity) {
        Picture picture{7, 5, {}};
        for (int i = 0; i < 35; ++i)
            picture.pixels.push_back({static_cast<std::uint8_t>(7 * i), static_cast<std::uint8_t>(255 - i), 3,
                                      i == 12 ? opacity : std::uint8_t{255}});
        return picture;
    }

    TemporaryFolder folder_;
};

TEST_F(PictureFile, HoldsEveryPixel) {
    for (const std::uint8_t opacity : {std::uint8_t{0}, std::uint8_t{255}}) {
        const Picture picture = sample(opacity);
        ASSERT_TRUE(write_picture(picture, path("a.png")));
        bool alpha = false;
        const Picture back = read(path("a.png"), alpha);
        EXPECT_EQ(alpha, opacity < 255) << "only where something lets through";
        EXPECT_EQ(back.width, 7u);
        EXPECT_TRUE(back.pixels == picture.pixels);
    }
}

TEST_F(PictureFile, IsReadBack) {
    ASSERT_TRUE(write_picture(sample(9), path("a.png")));
    const Picture back = read_picture(path("a.png")).value();
    EXPECT_TRUE(back.pixels == sample(9).pixels);
    EXPECT_EQ(difference(back, sample(9)).value(), 0);
    EXPECT_NEAR(difference(back, sample(200)).value(), 1.0 / 35, 1e-12) << "one pixel has another opacity";
    EXPECT_FALSE(difference(back, {}));
}

TEST_F(PictureFile, BrokenOnesAreErrors) {
    ASSERT_TRUE(write_picture(sample(9), path("a.png")));
    const std::string whole = content_of(path("a.png"));
    for (std::size_t length = 1; length < whole.size(); ++length) {
        std::ofstream(path("b.png"), std::ios::binary) << whole.substr(0, length);
        const Result<Picture> picture = read_picture(path("b.png"));
        ASSERT_TRUE(!picture || length + 16 >= whole.size()) << length; // all pixels may be there before the last chunk
    }
    EXPECT_EQ(read_picture(path("none.png")).error().code, ErrorCode::file);
    std::ofstream(path("b.png")) << "no picture";
    EXPECT_EQ(read_picture(path("b.png")).error().code, ErrorCode::invalid_data);
}

/// Else a file of a hundred bytes could ask for gigabytes.
TEST_F(PictureFile, TooShortForItsSizeIsAnErrorBeforeMemoryIsTaken) {
    constexpr std::array<unsigned char, 33> head{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0,    0,    0,
                                                 13,   'I', 'H', 'D', 'R',  0,    0,    0x80, 0,    0,    0,
                                                 0x80, 0,   1,   0,   0,    0,    0,    0xec, 0x07, 0x9e, 0xd2};
    constexpr std::array<unsigned char, 12> data{0, 0, 0, 0, 'I', 'D', 'A', 'T', 0x35, 0xaf, 0x06, 0x1e};
    std::ofstream(path("b.png"), std::ios::binary)
        .write(reinterpret_cast<const char*>(head.data()), head.size())
        .write(reinterpret_cast<const char*>(data.data()), data.size());
    const Result<Picture> picture = read_picture(path("b.png"));
    ASSERT_FALSE(picture);
    EXPECT_EQ(picture.error().code, ErrorCode::invalid_data);
    EXPECT_NE(picture.error().message.find("45 bytes are too few for 32768 x 32768 pixels"), std::string::npos)
        << picture.error().message;
}

TEST_F(PictureFile, IsTheSameEveryTime) {
    ASSERT_TRUE(write_picture(sample(9), path("a.png")));
    ASSERT_TRUE(write_picture(sample(9), path("b.png")));
    EXPECT_EQ(content_of(path("a.png")), content_of(path("b.png")));
}

TEST_F(PictureFile, IsRefusedWhereItCannotBe) {
    EXPECT_EQ(write_picture(sample(0), path("a.jpg")).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(write_picture({}, path("a.png")).error().code, ErrorCode::invalid_argument);
    Picture short_one = sample(0);
    short_one.pixels.pop_back();
    EXPECT_EQ(write_picture(short_one, path("a.png")).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(write_picture(sample(0), path("nowhere/a.png")).error().code, ErrorCode::file);
    EXPECT_TRUE(std::filesystem::is_empty(path("")));
}

} // namespace
} // namespace isotet::test
