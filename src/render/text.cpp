// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/text.hpp"

#include <algorithm>
#include <cmath>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <isotet/text.hpp>

#include "font_bytes.hpp"

namespace isotet::render {

namespace {

constexpr double fixed = 64; // FreeType counts in 64ths of a pixel

/// Takes the next character off; U+FFFD stands for a byte that is not UTF-8.
char32_t next_character(std::string_view& text) {
    const Utf8Character character = first_utf8_character(text);
    text.remove_prefix(character.bytes);
    return character.code;
}

} // namespace

struct TextPainter::Data {
    FT_Library library = nullptr;
    FT_Face face = nullptr;

    Data() = default;
    Data(const Data&) = delete;
    Data& operator=(const Data&) = delete;
    ~Data() {
        if (face) FT_Done_Face(face);
        if (library) FT_Done_FreeType(library);
    }

    /// Calls `draw` with the glyph of each character (not hinted, so that it is the same everywhere) and where it
    /// begins; returns where the text ends.
    template <class Draw>
    double each_glyph(std::string_view text, const Draw& draw) const {
        double x = 0;
        FT_UInt before = 0;
        while (!text.empty()) {
            const FT_UInt glyph = FT_Get_Char_Index(face, next_character(text));
            FT_Vector kerning{};
            if (before && FT_Get_Kerning(face, before, glyph, FT_KERNING_UNFITTED, &kerning) == 0)
                x += static_cast<double>(kerning.x) / fixed;
            before = glyph;
            if (FT_Load_Glyph(face, glyph, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0) continue;
            draw(face->glyph, x);
            x += static_cast<double>(face->glyph->linearHoriAdvance) / 65536;
        }
        return x;
    }
};

void blend(std::array<std::uint8_t, 4>& pixel, const Color& color, float coverage) {
    const float front = coverage * color.opacity, back = static_cast<float>(pixel[3]) / 255 * (1 - front),
                all = front + back;
    if (!(all > 0)) return;
    const auto mixed = [&](float part, std::uint8_t old) {
        return static_cast<std::uint8_t>(
            std::clamp((part * front + static_cast<float>(old) / 255 * back) / all, 0.0F, 1.0F) * 255 + 0.5F);
    };
    pixel = {mixed(color.red, pixel[0]), mixed(color.green, pixel[1]), mixed(color.blue, pixel[2]),
             static_cast<std::uint8_t>(std::min(all, 1.0F) * 255 + 0.5F)};
}

TextPainter::TextPainter(std::unique_ptr<Data> data) : data_(std::move(data)) {}
TextPainter::~TextPainter() = default;

Result<std::unique_ptr<TextPainter>> TextPainter::open(double size) {
    auto data = std::make_unique<Data>();
    const Error broken{ErrorCode::internal, "FreeType cannot open the font that is part of isotet"};
    if (FT_Init_FreeType(&data->library) != 0) return broken;
    if (FT_New_Memory_Face(data->library, font_bytes, static_cast<FT_Long>(sizeof font_bytes), 0, &data->face) != 0)
        return broken;
    if (FT_Set_Char_Size(data->face, 0, std::lround(std::max(size, 4.0) * fixed), 72, 72) != 0) return broken;
    return std::unique_ptr<TextPainter>(new TextPainter(std::move(data)));
}

double TextPainter::width(std::string_view text) const {
    return data_->each_glyph(text, [](FT_GlyphSlot, double) {});
}

std::size_t TextPainter::count_missing(std::string_view text) const {
    std::size_t missing = 0;
    while (!text.empty()) {
        const char32_t character = next_character(text);
        missing += character == U'\uFFFD' || FT_Get_Char_Index(data_->face, character) == 0;
    }
    return missing;
}

double TextPainter::ascent() const noexcept {
    if (FT_Load_Char(data_->face, '0', FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0) return 0;
    return static_cast<double>(data_->face->glyph->metrics.horiBearingY) / fixed;
}

void TextPainter::paint(Picture& picture, double x, double y, std::string_view text, const Color& color) const {
    data_->each_glyph(text, [&](FT_GlyphSlot glyph, double begin) {
        const double left = x + begin, column = std::floor(left), row = std::floor(y);
        FT_Outline_Translate(&glyph->outline, std::lround((left - column) * fixed), std::lround((row - y) * fixed));
        if (FT_Render_Glyph(glyph, FT_RENDER_MODE_NORMAL) != 0) return;
        const FT_Bitmap& bitmap = glyph->bitmap;
        for (unsigned j = 0; j < bitmap.rows; ++j) {
            for (unsigned i = 0; i < bitmap.width; ++i) {
                const auto to_x = static_cast<std::int64_t>(column) + glyph->bitmap_left + i;
                const auto to_y = static_cast<std::int64_t>(row) - glyph->bitmap_top + j;
                if (to_x < 0 || to_y < 0 || to_x >= picture.width || to_y >= picture.height) continue;
                const unsigned char covered = bitmap.buffer[static_cast<std::ptrdiff_t>(j) * bitmap.pitch + i];
                if (covered > 0)
                    blend(
                        picture.pixels[static_cast<std::size_t>(to_y) * picture.width + static_cast<std::size_t>(to_x)],
                        color, static_cast<float>(covered) / 255);
            }
        }
    });
}

} // namespace isotet::render
