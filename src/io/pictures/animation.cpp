// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Animation: WebP by libwebp, through the one checked stream.
#include <cmath>
#include <utility>

#include <fmt/core.h>
#include <webp/encode.h>
#include <webp/mux.h>

#include <isotet/picture.hpp>

#include "base/errors.hpp"
#include "base/system/output_file.hpp"

namespace isotet {

namespace {

constexpr std::uint32_t largest_side = WEBP_MAX_DIMENSION;
constexpr float quality = 90; // of 100

struct DeleteEncoder {
    void operator()(WebPAnimEncoder* encoder) const noexcept { WebPAnimEncoderDelete(encoder); }
};

/// libwebp's picture, and its pixels.
class Pixels {
public:
    Pixels() : known_(WebPPictureInit(&pixels_)) {}
    Pixels(const Pixels&) = delete;
    Pixels& operator=(const Pixels&) = delete;
    ~Pixels() {
        if (known_) WebPPictureFree(&pixels_);
    }

    /// False when there is no memory.
    bool take(const Picture& picture) {
        if (!known_) return false;
        pixels_.width = static_cast<int>(picture.width);
        pixels_.height = static_cast<int>(picture.height);
        pixels_.use_argb = 1;
        return WebPPictureImportRGBA(&pixels_, picture.pixels.front().data(), 4 * pixels_.width);
    }
    WebPPicture* get() noexcept { return &pixels_; }

private:
    WebPPicture pixels_{};
    bool known_;
};

} // namespace

struct Animation::Encoder {
    std::string path;
    double seconds_per_picture = 0;
    std::unique_ptr<WebPAnimEncoder, DeleteEncoder> pictures; ///< made with the first one, whose size it has
    std::uint32_t width = 0, height = 0;
    std::uint64_t count = 0;

    /// When the next picture begins: no rounding adds up.
    int milliseconds() const {
        return static_cast<int>(std::lround(1000 * seconds_per_picture * static_cast<double>(count)));
    }

    Error failed() const {
        return {ErrorCode::cannot_write, fmt::format("{}: libwebp could not make picture {}: {}", path, count + 1,
                                                     WebPAnimEncoderGetError(pictures.get()))};
    }
};

Animation::Animation(std::unique_ptr<Encoder> encoder) : encoder_(std::move(encoder)) {}
Animation::Animation(Animation&&) noexcept = default;
Animation& Animation::operator=(Animation&&) noexcept = default;
Animation::~Animation() = default;

Result<Animation> Animation::create(const std::string& path, double pictures_per_second) {
    if (!path.ends_with(".webp"))
        return invalid_argument(fmt::format("{} does not end in .webp, but animations are written as WebP", path));
    if (!(pictures_per_second > 0 && pictures_per_second <= 100))
        return invalid_argument(
            fmt::format("{} pictures a second, but they must be above 0 and at most 100", pictures_per_second));
    auto encoder = std::make_unique<Encoder>();
    encoder->path = path;
    encoder->seconds_per_picture = 1 / pictures_per_second;
    return Animation(std::move(encoder));
}

Result<void> Animation::add(const Picture& picture) {
    if (!encoder_) return moved_from("the animation");
    Encoder& to = *encoder_;
    if (picture.width == 0 || picture.height == 0 || picture.width > largest_side || picture.height > largest_side ||
        picture.pixels.size() != std::size_t{picture.width} * picture.height)
        return invalid_argument(fmt::format(
            "a picture of {} x {} with {} pixels, but pictures of an animation have 1 to {} in a row and a column",
            picture.width, picture.height, picture.pixels.size(), largest_side));
    if (to.count > 0 && (picture.width != to.width || picture.height != to.height))
        return invalid_argument(fmt::format("a picture of {} x {}, but those before it are {} x {}", picture.width,
                                            picture.height, to.width, to.height));
    const Error no_memory{ErrorCode::out_of_memory,
                          fmt::format("no memory left for picture {} of {}", to.count + 1, to.path)};
    if (!to.pictures) {
        WebPAnimEncoderOptions options;
        if (!WebPAnimEncoderOptionsInit(&options))
            return Error{ErrorCode::internal, "libwebp is not the one that isotet was built for"};
        to.pictures.reset(
            WebPAnimEncoderNew(static_cast<int>(picture.width), static_cast<int>(picture.height), &options));
        if (!to.pictures) return no_memory;
        to.width = picture.width;
        to.height = picture.height;
    }
    WebPConfig config;
    Pixels pixels;
    if (!WebPConfigPreset(&config, WEBP_PRESET_DRAWING, quality))
        return Error{ErrorCode::internal, "libwebp has no preset for drawings"};
    if (!pixels.take(picture)) return no_memory;
    if (!WebPAnimEncoderAdd(to.pictures.get(), pixels.get(), to.milliseconds(), &config)) return to.failed();
    ++to.count;
    return {};
}

Result<std::uint64_t> Animation::finish() {
    if (!encoder_) return moved_from("the animation");
    Encoder& from = *encoder_;
    if (!from.pictures)
        return invalid_argument(fmt::format("{} has no picture, but an animation has one at least", from.path));
    if (!WebPAnimEncoderAdd(from.pictures.get(), nullptr, from.milliseconds(), nullptr))
        return from.failed(); // when the last one ends
    WebPData data;
    WebPDataInit(&data);
    const std::unique_ptr<WebPData, decltype(&WebPDataClear)> cleared(&data, WebPDataClear);
    if (!WebPAnimEncoderAssemble(from.pictures.get(), &data)) return from.failed();
    from.pictures.reset();
    Result<core::OutputFile> file = core::OutputFile::open(from.path);
    if (!file) return file.error();
    if (Result<void> written = file->write(std::as_bytes(std::span(data.bytes, data.size))); !written)
        return written.error();
    if (Result<void> done = file->commit(); !done) return done.error();
    return file->bytes();
}

} // namespace isotet
