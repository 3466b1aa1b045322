// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/render.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "base/guard.hpp"
#include "render/orientation.hpp"
#include "render/text.hpp"
#include "render/ticks.hpp"

namespace isotet {

namespace {

using render::TextPainter;
using render::Tick;

constexpr Color dark{0.13F, 0.13F, 0.13F, 1}, light{0.93F, 0.93F, 0.93F, 1};

bool is_light(const Color& color) {
    return color.opacity < 0.5F || 0.3F * color.red + 0.59F * color.green + 0.11F * color.blue > 0.5F;
}

/// The text, or as much of it as is `width` wide, with an ellipsis.
std::string shortened(const TextPainter& painter, const std::string& text, double width) {
    if (painter.width(text) <= width) return text;
    const auto beginning = [&](std::size_t bytes) {
        while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes; // whole characters
        return text.substr(0, bytes) + "\u2026";
    };
    std::size_t fits = 0, too_long = text.size();
    while (too_long - fits > 1) {
        const std::size_t middle = fits + (too_long - fits) / 2;
        (painter.width(beginning(middle)) <= width ? fits : too_long) = middle;
    }
    return beginning(fits);
}

void fill(Picture& picture, double x, double y, double width, double height, const Color& color) {
    const auto limit = [](double at, std::uint32_t most) {
        return static_cast<std::uint32_t>(std::clamp(std::round(at), 0.0, static_cast<double>(most)));
    };
    for (std::uint32_t row = limit(y, picture.height); row < limit(y + height, picture.height); ++row)
        for (std::uint32_t column = limit(x, picture.width); column < limit(x + width, picture.width); ++column)
            render::blend(picture.pixels[std::size_t{row} * picture.width + column], color, 1);
}

/// Where everything goes, in pixels. All lengths follow from the size of the text.
class Layout {
public:
    static Result<std::unique_ptr<Layout>> make(const Annotation& annotation, PictureSize whole);

    std::optional<PictureSize> room() const;
    void paint(Picture& picture, const Color& ink) const;

private:
    Layout(const Annotation& annotation, PictureSize whole, std::unique_ptr<TextPainter> text,
           std::unique_ptr<TextPainter> small);
    static double text_size(PictureSize whole) {
        return std::max(11.0, std::min<double>(whole.width, whole.height * 4.0 / 3) / 56);
    }

    bool has_column() const { return annotation_.scale || !annotation_.legend.empty(); }
    void thin_legend();
    double column_width() const;
    double column_height() const;
    bool has_bar() const { return annotation_.orientation && annotation_.orientation->bar; }
    double caption_height() const { return annotation_.caption.empty() && !has_bar() ? 0 : 2.2 * size_; }
    double axes_radius() const { return 2.1 * size_; }
    double axes_height() const { return annotation_.orientation && has_column() ? 3.6 * axes_radius() : 0; }
    double paint_scale_bar(Picture& picture, const Color& ink) const;
    void paint_orientation(Picture& picture, const Color& ink) const;
    double bar_height() const { return std::round(0.55 * whole_.height); }
    void paint_bar(Picture& picture, double x, double y, const Color& ink) const;
    void paint_opacity(Picture& picture, double x, double y, double stroke) const;
    void paint_entry(Picture& picture, double x, double y, const LegendEntry& entry, const Color& ink) const;

    const Annotation& annotation_;
    PictureSize whole_;
    double size_;
    std::unique_ptr<TextPainter> text_, small_;
    std::vector<Tick> ticks_;
    std::vector<LegendEntry> entries_; ///< the legend, and what no data means
    std::string title_;
    double line_, pad_, swatch_;
};

Layout::Layout(const Annotation& annotation, PictureSize whole, std::unique_ptr<TextPainter> text,
               std::unique_ptr<TextPainter> small)
    : annotation_(annotation),
      whole_(whole),
      size_(text_size(whole)),
      text_(std::move(text)),
      small_(std::move(small)),
      entries_(annotation.legend),
      line_(1.45 * size_),
      pad_(size_),
      swatch_(std::round(0.95 * size_)) {
    if (annotation.scale) {
        ticks_ = render::ticks_of(*annotation.scale,
                                  std::max<std::size_t>(2, static_cast<std::size_t>(bar_height() / (3 * size_))));
        if (!annotation.no_data.empty()) entries_.push_back({annotation.scale->no_data, annotation.no_data});
    }
    title_ = shortened(*text_, annotation.title, 0.28 * whole.width);
    thin_legend();
}

/// Entries that the picture has no room for go, evenly; the last one then says how many.
void Layout::thin_legend() {
    const double over = column_height() + axes_height() + caption_height() - whole_.height;
    if (over <= 0) return;
    constexpr std::size_t least = 3;
    const std::size_t all = entries_.size(), lines = static_cast<std::size_t>(std::ceil(over / line_));
    if (all < lines + least) return;
    const std::size_t kept = all - lines - 1;
    std::vector<LegendEntry> some;
    for (std::size_t i = 0; i < kept; ++i) some.push_back(std::move(entries_[i * (all - 1) / (kept - 1)]));
    some.push_back({Color{0, 0, 0, 0}, fmt::format("and {} more", all - kept)});
    entries_ = std::move(some);
}

Result<std::unique_ptr<Layout>> Layout::make(const Annotation& annotation, PictureSize whole) {
    const double size = text_size(whole);
    auto text = TextPainter::open(size);
    if (!text) return text.error();
    auto small = TextPainter::open(0.85 * size);
    if (!small) return small.error();
    return std::unique_ptr<Layout>(new Layout(annotation, whole, *std::move(text), *std::move(small)));
}

double Layout::column_width() const {
    if (!has_column()) return 0;
    double widest = text_->width(title_);
    for (const Tick& tick : ticks_) widest = std::max(widest, swatch_ + 0.8 * size_ + text_->width(tick.label));
    for (const LegendEntry& entry : entries_)
        widest = std::max(widest, swatch_ + 0.5 * size_ + text_->width(entry.text));
    if (annotation_.orientation) widest = std::max(widest, 3 * axes_radius());
    return widest + 1.5 * pad_;
}

double Layout::column_height() const {
    const double bar = annotation_.scale ? bar_height() + line_ : 0;
    return (title_.empty() ? 0 : 1.3 * line_) + bar + line_ * static_cast<double>(entries_.size());
}

std::optional<PictureSize> Layout::room() const {
    const double width = std::floor(whole_.width - column_width()),
                 height = std::floor(whole_.height - caption_height());
    if (width < 0.5 * whole_.width || height < 0.5 * whole_.height ||
        column_height() + axes_height() + caption_height() > whole_.height)
        return {};
    return PictureSize{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

void Layout::paint_entry(Picture& picture, double x, double y, const LegendEntry& entry, const Color& ink) const {
    if (entry.color.opacity > 0) fill(picture, x, y, swatch_, swatch_, entry.color);
    text_->paint(picture, x + swatch_ + 0.5 * size_, std::round(y + (swatch_ + text_->ascent()) / 2), entry.text, ink);
}

void Layout::paint_bar(Picture& picture, double x, double y, const Color& ink) const {
    const ColorScale& scale = *annotation_.scale;
    const double height = bar_height();
    for (double row = 0; row < height; ++row)
        fill(picture, x, y + row, swatch_, 1, scale.color_at(1 - (row + 0.5) / height));
    const double stroke = std::max(1.0, std::round(size_ / 16));
    paint_opacity(picture, x, y, stroke);
    for (const Tick& tick : ticks_) {
        const double at = std::round(y + (1 - std::clamp(scale.place_of(tick.value), 0.0, 1.0)) * (height - stroke));
        fill(picture, x + swatch_, at, 0.35 * size_, stroke, ink);
        text_->paint(picture, x + swatch_ + 0.8 * size_, std::round(at + text_->ascent() / 2), tick.label, ink);
    }
}

/// The curve of opacity over the scale, dark on light colours and light on dark ones.
void Layout::paint_opacity(Picture& picture, double x, double y, double stroke) const {
    const OpacityCurve& opacity = annotation_.opacity;
    if (opacity.is_transparent()) return;
    const double height = bar_height(), most = std::ranges::max(opacity.points, {}, &OpacityPoint::opacity).opacity;
    double before = -1;
    for (double row = 0; row < height; ++row) {
        const double place = 1 - (row + 0.5) / height;
        const double at = opacity.at(annotation_.scale->value_of(place)) / most * (swatch_ - stroke);
        const double from = before < 0 ? at : std::min(before, at), to = before < 0 ? at : std::max(before, at);
        const bool on_light = is_light(annotation_.scale->color_at(place));
        fill(picture, x + std::round(from), y + row, std::round(to) - std::round(from) + stroke, 1,
             on_light ? dark : light);
        before = at;
    }
}

/// At the right of the caption; returns how wide it is.
double Layout::paint_scale_bar(Picture& picture, const Color& ink) const {
    const render::ScaleBar bar =
        render::scale_bar(*annotation_.orientation, whole_.height - caption_height(), 0.16 * whole_.width);
    const double right = whole_.width - pad_, left = right - bar.pixels, text = small_->width(bar.label);
    const double y = std::round(whole_.height - 0.9 * size_ - small_->ascent() / 2), stroke = std::max(1.0, size_ / 12);
    const double end = 0.3 * size_;
    fill(picture, left, y - stroke / 2, bar.pixels, stroke, ink);
    fill(picture, left, y - end, stroke, 2 * end, ink);
    fill(picture, right - stroke, y - end, stroke, 2 * end, ink);
    small_->paint(picture, left - text - 0.5 * size_, std::round(whole_.height - 0.9 * size_), bar.label, ink);
    return bar.pixels + text + 1.5 * size_;
}

void Layout::paint_orientation(Picture& picture, const Color& ink) const {
    const double radius = axes_radius(), reach = 1.75 * radius;
    const double x = has_column() ? whole_.width - column_width() / 2 : reach;
    render::paint_axes(picture, x, whole_.height - caption_height() - reach, radius, annotation_.orientation->camera,
                       *small_, ink);
}

void Layout::paint(Picture& picture, const Color& ink) const {
    if (has_column()) {
        const double x = std::round(whole_.width - column_width() + 0.5 * pad_);
        double y = std::round((whole_.height - caption_height() - axes_height() - column_height()) / 2);
        if (!title_.empty()) {
            text_->paint(picture, x, std::round(y + text_->ascent()), title_, ink);
            y = std::round(y + 1.3 * line_);
        }
        if (annotation_.scale) {
            paint_bar(picture, x, y, ink);
            y = std::round(y + bar_height() + line_);
        }
        for (const LegendEntry& entry : entries_) {
            paint_entry(picture, x, y, entry, ink);
            y = std::round(y + line_);
        }
    }
    if (annotation_.orientation) paint_orientation(picture, ink);
    const double bar = has_bar() ? paint_scale_bar(picture, ink) : 0;
    if (annotation_.caption.empty()) return;
    const std::string caption = shortened(*small_, annotation_.caption, whole_.width - 2 * pad_ - bar);
    small_->paint(picture, pad_, std::round(whole_.height - 0.9 * size_), caption, ink);
}

} // namespace

Result<std::size_t> count_missing_letters(std::string_view text) {
    return core::guarded("looking for letters", [&]() -> Result<std::size_t> {
        const auto painter = TextPainter::open(12);
        if (!painter) return painter.error();
        return (*painter)->count_missing(text);
    });
}

Result<std::optional<PictureSize>> room_beside(const Annotation& annotation, PictureSize whole) {
    return core::guarded("laying out a picture", [&]() -> Result<std::optional<PictureSize>> {
        const auto layout = Layout::make(annotation, whole);
        if (!layout) return layout.error();
        return (*layout)->room();
    });
}

Result<Picture> annotate(const Picture& scene, const Annotation& annotation, PictureSize whole,
                         const Color& background) {
    return core::guarded("annotating a picture", [&]() -> Result<Picture> {
        const auto layout = Layout::make(annotation, whole);
        if (!layout) return layout.error();
        const std::optional<PictureSize> room = (*layout)->room();
        if (!room || scene.width != room->width || scene.height != room->height) {
            return Error{ErrorCode::invalid_argument,
                         fmt::format("a scene of {} x {} is to be annotated, but what is left for it is {} x {}",
                                     scene.width, scene.height, room ? room->width : 0, room ? room->height : 0)};
        }
        Picture picture{whole.width, whole.height, {}};
        const auto byte = [](float part) {
            return static_cast<std::uint8_t>(std::clamp(part, 0.0F, 1.0F) * 255 + 0.5F);
        };
        const std::array<std::uint8_t, 4> empty{byte(background.red), byte(background.green), byte(background.blue),
                                                byte(background.opacity)};
        picture.pixels.resize(std::size_t{whole.width} * whole.height, empty);
        for (std::uint32_t row = 0; row < scene.height; ++row)
            std::copy_n(scene.pixels.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * scene.width), scene.width,
                        picture.pixels.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * whole.width));
        (*layout)->paint(picture, is_light(background) ? dark : light);
        return picture;
    });
}

} // namespace isotet
