// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// read_picture(): PNG by libpng.
#include "io/pictures/read_picture.hpp"

#include <cstdint>

#include <fmt/core.h>
#include <png.h>

#include "base/guard.hpp"
#include "base/system/memory.hpp"
#include "io/files/whole_file.hpp"

namespace isotet {
namespace io {
namespace {

constexpr png_uint_32 max_pixels_per_axis = 32768;

/// libpng's state while it reads, given back whatever happens.
struct Image {
    png_image state{};
    Image() { state.version = PNG_IMAGE_VERSION; }
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;
    ~Image() { png_image_free(&state); }
};

/// Deflate makes at most 1032 bytes of one, and a pixel has one bit at least.
bool can_hold(std::size_t bytes, std::uint64_t pixels) { return pixels / 8 <= 1032 * std::uint64_t{bytes}; }

} // namespace

Result<Picture> parse_picture(std::string_view bytes, const std::string& name) {
    Image image;
    const auto broken = [&](std::string_view why) {
        return Error{ErrorCode::invalid_data, fmt::format("{}: not a PNG file that can be read: {}", name, why)};
    };
    if (!png_image_begin_read_from_memory(&image.state, bytes.data(), bytes.size())) return broken(image.state.message);
    const std::uint32_t width = image.state.width, height = image.state.height;
    if (width > max_pixels_per_axis || height > max_pixels_per_axis) {
        return Error{ErrorCode::invalid_data, fmt::format("{}: a picture of {} x {} pixels, but {} each are the most",
                                                          name, width, height, max_pixels_per_axis)};
    }
    const std::uint64_t pixels = std::uint64_t{width} * height;
    if (!can_hold(bytes.size(), pixels))
        return broken(fmt::format("{} bytes are too few for {} x {} pixels", bytes.size(), width, height));
    Picture picture{width, height, {}};
    if (auto there = core::require_memory("the picture in " + name, pixels * sizeof(picture.pixels[0])); !there)
        return there.error();
    image.state.format = PNG_FORMAT_RGBA;
    picture.pixels.resize(pixels);
    if (!png_image_finish_read(&image.state, nullptr, picture.pixels.data(), 0, nullptr))
        return broken(image.state.message);
    return picture;
}

} // namespace io

Result<Picture> read_picture(const std::string& path) {
    return core::guarded("reading " + path, [&]() -> Result<Picture> {
        const auto file = io::WholeFile::read(path, {});
        if (!file) return file.error();
        return io::parse_picture(file->text(), path);
    });
}

} // namespace isotet
