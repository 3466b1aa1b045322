// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// write_picture(): PNG by libpng, through the one checked stream.
#include <csetjmp>
#include <new>
#include <optional>
#include <vector>

#include <fmt/core.h>
#include <png.h>

#include <isotet/picture_file.hpp>

#include "io/own/output_file.hpp"

namespace isotet {
namespace io {
namespace {

constexpr int best_compression = 9;

/// Where libpng's bytes go, and what stopped them.
struct Sink {
    OutputFile& file;
    std::optional<Error> error;
};

/// Pixels as rows of bytes; of an opaque picture without the fourth.
std::vector<std::uint8_t> bytes_of(const Picture& picture, std::size_t channels) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(picture.pixels.size() * channels);
    for (const auto& pixel : picture.pixels)
        bytes.insert(bytes.end(), pixel.begin(), pixel.begin() + static_cast<std::ptrdiff_t>(channels));
    return bytes;
}

void write_bytes(png_structp png, png_bytep bytes, std::size_t count) {
    auto* sink = static_cast<Sink*>(png_get_io_ptr(png));
    if (Result<void> written = sink->file.write(std::as_bytes(std::span(bytes, count))); !written) {
        sink->error = written.error();
        png_error(png, "writing failed");
    }
}

void flush_nothing(png_structp) {}
void say_nothing(png_structp, png_const_charp) {}
void give_up(png_structp png, png_const_charp) { png_longjmp(png, 1); }

/// libpng ends by a long jump when something fails: nothing here may have a destructor.
bool encode(Sink* sink, png_uint_32 width, png_uint_32 height, bool alpha, png_const_bytep bytes) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, give_up, say_nothing);
    if (!png) return false;
    png_infop info = png_create_info_struct(png);
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, sink, write_bytes, flush_nothing);
    png_set_compression_level(png, best_compression);
    png_set_IHDR(png, info, width, height, 8, alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    const std::size_t row_bytes = static_cast<std::size_t>(width) * (alpha ? 4 : 3);
    for (png_uint_32 row = 0; row < height; ++row) png_write_row(png, bytes + row * row_bytes);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return true;
}

Result<std::uint64_t> write_png(const Picture& picture, const std::string& path) {
    const bool alpha = !picture.opaque();
    const std::vector<std::uint8_t> bytes = bytes_of(picture, alpha ? 4 : 3);
    Result<OutputFile> file = OutputFile::open(path);
    if (!file) return file.error();
    Sink sink{*file, {}};
    if (!encode(&sink, picture.width, picture.height, alpha, bytes.data())) {
        if (sink.error) return *sink.error;
        return Error{ErrorCode::cannot_write, fmt::format("{}: libpng could not make the picture", path)};
    }
    if (Result<void> done = file->commit(); !done) return done.error();
    return file->bytes();
}

} // namespace
} // namespace io

Result<std::uint64_t> write_picture(const Picture& picture, const std::string& path) {
    try {
        if (!path.ends_with(".png"))
            return Error{ErrorCode::invalid_argument,
                         fmt::format("{} does not end in .png, but pictures are written as PNG", path)};
        if (picture.width == 0 || picture.height == 0 ||
            picture.pixels.size() != std::size_t{picture.width} * picture.height) {
            return Error{ErrorCode::invalid_argument,
                         fmt::format("a picture of {} x {} with {} pixels cannot be written", picture.width,
                                     picture.height, picture.pixels.size())};
        }
        return io::write_png(picture, path);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, fmt::format("no memory left to write {}", path)};
    }
}

} // namespace isotet
