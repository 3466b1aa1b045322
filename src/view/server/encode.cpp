// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/server/encode.hpp"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <jpeglib.h>
#include <png.h>

namespace isotet::view {

namespace {

constexpr int jpeg_quality = 82;

std::vector<unsigned char> without_opacity(const Picture& picture) {
    std::vector<unsigned char> rgb;
    rgb.reserve(3 * picture.pixels.size());
    for (const auto& pixel : picture.pixels) rgb.insert(rgb.end(), pixel.begin(), pixel.begin() + 3);
    return rgb;
}

Error no_memory_for_picture() { return {ErrorCode::out_of_memory, "there is too little memory for a picture"}; }

struct JpegErrors {
    jpeg_error_mgr manager; // first: the library knows of it alone
    std::jmp_buf leave;
};

/// Nothing with a destructor stands here: the library leaves it by longjmp(). False when it could not be done.
bool write_jpeg(const unsigned char* rgb, std::uint32_t width, std::uint32_t height, unsigned char** out,
                unsigned long* size) {
    jpeg_compress_struct jpeg{};
    JpegErrors errors{};
    jpeg.err = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = [](j_common_ptr common) {
        std::longjmp(reinterpret_cast<JpegErrors*>(common->err)->leave, 1);
    };
    if (setjmp(errors.leave) != 0) {
        jpeg_destroy_compress(&jpeg);
        return false;
    }
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, out, size);
    jpeg.image_width = width;
    jpeg.image_height = height;
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, jpeg_quality, TRUE);
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
        JSAMPROW row = const_cast<JSAMPROW>(rgb + std::size_t{3} * width * jpeg.next_scanline);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    return true;
}

} // namespace

Result<EncodedPicture> encode_png(const Picture& picture) {
    const std::vector<unsigned char> rgb = without_opacity(picture);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = picture.width;
    image.height = picture.height;
    image.format = PNG_FORMAT_RGB;
    image.flags = PNG_IMAGE_FLAG_FAST;
    EncodedPicture encoded{picture.width, picture.height, "image/png", {}};
    encoded.bytes.resize(PNG_IMAGE_PNG_SIZE_MAX(image));
    png_alloc_size_t size = encoded.bytes.size();
    if (png_image_write_to_memory(&image, encoded.bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
        return no_memory_for_picture();
    encoded.bytes.resize(size);
    return encoded;
}

Result<EncodedPicture> encode_jpeg(const Picture& picture) {
    const std::vector<unsigned char> rgb = without_opacity(picture);
    unsigned char* out = nullptr;
    unsigned long size = 0;
    const bool written = write_jpeg(rgb.data(), picture.width, picture.height, &out, &size);
    EncodedPicture encoded{picture.width, picture.height, "image/jpeg", {}};
    if (written) encoded.bytes.assign(reinterpret_cast<const char*>(out), size);
    std::free(out);
    if (!written) return no_memory_for_picture();
    return encoded;
}

} // namespace isotet::view
