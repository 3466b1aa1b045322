// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/ticks.hpp"
#include "render/vector_math.hpp"

namespace isotet::render {

void paint_line(Picture& picture, std::array<double, 2> from, std::array<double, 2> to, double width,
                const Color& color) {
    const double dx = to[0] - from[0], dy = to[1] - from[1], length = dx * dx + dy * dy, reach = width / 2 + 1;
    const auto first = [&](double at) { return static_cast<std::int64_t>(std::floor(at - reach)); };
    const auto last = [&](double at) { return static_cast<std::int64_t>(std::ceil(at + reach)); };
    for (std::int64_t y = std::max<std::int64_t>(first(std::min(from[1], to[1])), 0);
         y <= last(std::max(from[1], to[1])) && y < picture.height; ++y) {
        for (std::int64_t x = std::max<std::int64_t>(first(std::min(from[0], to[0])), 0);
             x <= last(std::max(from[0], to[0])) && x < picture.width; ++x) {
            const double px = static_cast<double>(x) + 0.5 - from[0], py = static_cast<double>(y) + 0.5 - from[1];
            const double part = length > 0 ? std::clamp((px * dx + py * dy) / length, 0.0, 1.0) : 0;
            const double ex = px - part * dx, ey = py - part * dy;
            const double coverage = std::clamp(width / 2 + 0.5 - std::sqrt(ex * ex + ey * ey), 0.0, 1.0);
            if (coverage > 0)
                blend(picture.pixels[static_cast<std::size_t>(y) * picture.width + static_cast<std::size_t>(x)], color,
                      static_cast<float>(coverage));
        }
    }
}

void paint_axes(Picture& picture, double x, double y, double radius, const Camera& camera, const TextPainter& text,
                const Color& ink) {
    struct Axis {
        double right, up, towards;
        std::string_view name;
        Color color;
    };
    const Vector right = cross(camera.up, camera.direction);
    const std::array<std::string_view, 3> names{"x", "y", "z"};
    const std::array<Color, 3> colors{Color{0.84F, 0.22F, 0.18F, 1}, Color{0.20F, 0.58F, 0.22F, 1},
                                      Color{0.18F, 0.38F, 0.80F, 1}};
    std::array<Axis, 3> axes{};
    for (std::size_t i = 0; i < 3; ++i) axes[i] = {right[i], camera.up[i], camera.direction[i], names[i], colors[i]};
    std::ranges::sort(axes, {}, &Axis::towards); // farthest first
    const double width = std::max(1.5, radius / 14), head = radius / 4;
    for (const Axis& axis : axes) {
        const double length = std::sqrt(axis.right * axis.right + axis.up * axis.up);
        const std::array<double, 2> tip{x + radius * axis.right, y - radius * axis.up};
        paint_line(picture, {x, y}, tip, width, axis.color);
        if (length < 0.15) { // it points at the eye, or away
            paint_line(picture, tip, tip, 2.5 * width, axis.color);
        } else {
            const double along_x = axis.right / length, along_y = -axis.up / length,
                         size = head * std::min(1.0, 2 * length);
            for (const double side : {-0.5, 0.5})
                paint_line(picture, tip,
                           {tip[0] - size * (along_x + side * along_y), tip[1] - size * (along_y - side * along_x)},
                           width, axis.color);
        }
        const double away = length < 0.15 ? 0 : 1 / length, gap = 0.32 * radius;
        const double letter_x = length < 0.15 ? tip[0] + gap : tip[0] + gap * axis.right * away,
                     letter_y = length < 0.15 ? tip[1] + gap : tip[1] - gap * axis.up * away;
        text.paint(picture, letter_x - text.width(axis.name) / 2, letter_y + text.ascent() / 3, axis.name, ink);
    }
}

ScaleBar scale_bar(const Orientation& orientation, double height, double longest) {
    const Camera& camera = orientation.camera;
    const double shown = camera.projection == Projection::parallel
                             ? camera.height
                             : 2 * camera.distance * std::tan(camera.angle * std::numbers::pi / 360);
    const double pixels_per_length = height / shown, most = longest / pixels_per_length;
    const double power = std::pow(10.0, std::floor(std::log10(most)));
    double length = power;
    for (const double factor : {2.0, 5.0})
        if (factor * power <= most) length = factor * power;
    std::string label = number_label(length);
    if (!orientation.unit.empty()) label += "\u00A0" + orientation.unit;
    return {length * pixels_per_length, label};
}

} // namespace isotet::render
