// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// read_picture(): PNG by libpng.
#include <new>

#include <fmt/format.h>
#include <png.h>

#include <isotet/compare_pictures.hpp>

#include "io/own/mapped_file.hpp"

namespace isotet {
namespace io {
namespace {

constexpr png_uint_32 most_pixels_an_axis = 32768;

/// libpng's state while it reads, given back whatever happens.
struct Image {
    png_image state{};
    Image() { state.version = PNG_IMAGE_VERSION; }
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;
    ~Image() { png_image_free(&state); }
};

Result<Picture> read_png(const std::string& path) {
    const auto file = MappedFile::open(path);
    if (!file) return file.error();
    const std::string_view bytes = file->text();
    Image image;
    const auto broken = [&] { return Error{ErrorCode::invalid_data, fmt::format("{}: not a PNG file that can be read: {}", path, image.state.message)}; };
    if (!png_image_begin_read_from_memory(&image.state, bytes.data(), bytes.size())) return broken();
    if (image.state.width > most_pixels_an_axis || image.state.height > most_pixels_an_axis) {
        return Error{ErrorCode::invalid_data, fmt::format("{}: a picture of {} x {} pixels, but {} each are the most", path, image.state.width,
                                                          image.state.height, most_pixels_an_axis)};
    }
    image.state.format = PNG_FORMAT_RGBA;
    Picture picture{image.state.width, image.state.height, {}};
    picture.pixels.resize(std::size_t{picture.width} * picture.height);
    if (!png_image_finish_read(&image.state, nullptr, picture.pixels.data(), 0, nullptr)) return broken();
    return picture;
}

} // namespace
} // namespace io

Result<Picture> read_picture(const std::string& path) {
    try {
        return io::read_png(path);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, fmt::format("no memory left to read {}", path)};
    }
}

} // namespace isotet
