// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/color/color_space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isotet::render {

namespace {

constexpr Rgb white{0.9505, 1, 1.089}; ///< D65, as X, Y and Z

Rgb mixed(const Rgb& a, const Rgb& b, double part) {
    Rgb out;
    for (std::size_t i = 0; i < 3; ++i) out[i] = (1 - part) * a[i] + part * b[i];
    return out;
}

double linear_of(double c) { return c > 0.04045 ? std::pow((c + 0.055) / 1.055, 2.4) : c / 12.92; }
double encoded(double c) { return c > 0.0031308 ? 1.055 * std::pow(c, 1 / 2.4) - 0.055 : 12.92 * c; }

Rgb lab_of(const Rgb& rgb) {
    const double r = linear_of(rgb[0]), g = linear_of(rgb[1]), b = linear_of(rgb[2]);
    const Rgb xyz{0.4124 * r + 0.3576 * g + 0.1805 * b, 0.2126 * r + 0.7152 * g + 0.0722 * b,
                  0.0193 * r + 0.1192 * g + 0.9505 * b};
    Rgb f;
    for (std::size_t i = 0; i < 3; ++i) {
        const double part = xyz[i] / white[i];
        f[i] = part > 0.008856 ? std::cbrt(part) : 7.787 * part + 16.0 / 116;
    }
    return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

Rgb rgb_of_lab(const Rgb& lab) {
    const double y = (lab[0] + 16) / 116;
    Rgb xyz{lab[1] / 500 + y, y, y - lab[2] / 200};
    for (std::size_t i = 0; i < 3; ++i) {
        const double cube = xyz[i] * xyz[i] * xyz[i];
        xyz[i] = white[i] * (cube > 0.008856 ? cube : (xyz[i] - 16.0 / 116) / 7.787);
    }
    Rgb rgb{encoded(3.2406 * xyz[0] - 1.5372 * xyz[1] - 0.4986 * xyz[2]),
            encoded(-0.9689 * xyz[0] + 1.8758 * xyz[1] + 0.0415 * xyz[2]),
            encoded(0.0557 * xyz[0] - 0.2040 * xyz[1] + 1.0570 * xyz[2])};
    const double most = std::max(1.0, *std::ranges::max_element(rgb)); // the same hue
    for (double& part : rgb) part = std::max(part / most, 0.0);
    return rgb;
}

/// Lab in polar coordinates: magnitude, saturation, hue.
struct Msh {
    double m, s, h;
};

Msh msh_of(const Rgb& rgb) {
    const auto [l, a, b] = lab_of(rgb);
    const double m = std::sqrt(l * l + a * a + b * b), s = m > 0.001 ? std::acos(l / m) : 0;
    return {m, s, s > 0.001 ? std::atan2(b, a) : 0};
}

/// The hue of a gray end of magnitude `m`, so that the way to a colour looks straight.
double hue_beside(const Msh& color, double m) {
    if (color.m >= m - 0.1) return color.h;
    const double spin = color.s * std::sqrt(m * m - color.m * color.m) / (color.m * std::sin(color.s));
    return color.h > -std::numbers::pi / 3 ? color.h + spin : color.h - spin;
}

Rgb diverging(const Rgb& from, const Rgb& to, double part) {
    constexpr double colored = 0.05;
    Msh a = msh_of(from), b = msh_of(to);
    const double apart = std::abs(a.h - b.h);
    if (a.s > colored && b.s > colored && std::min(apart, 2 * std::numbers::pi - apart) > 0.33 * std::numbers::pi) {
        const Msh middle{std::max({a.m, b.m, 88.0}), 0, 0};
        (part < 0.5 ? b : a) = middle;
        part = part < 0.5 ? 2 * part : 2 * part - 1;
    }
    if (a.s < colored && b.s > colored) a.h = hue_beside(b, a.m);
    else if (b.s < colored && a.s > colored) b.h = hue_beside(a, b.m);
    const auto [m, s, h] = mixed({a.m, a.s, a.h}, {b.m, b.s, b.h}, part);
    return rgb_of_lab({m * std::cos(s), m * std::sin(s) * std::cos(h), m * std::sin(s) * std::sin(h)});
}

Rgb hsv_of(const Rgb& rgb) {
    const auto [r, g, b] = rgb;
    const double most = std::max({r, g, b}), width = most - std::min({r, g, b});
    if (!(width > 0)) return {0, 0, most};
    const double hue = most == r ? (g - b) / width : most == g ? 2 + (b - r) / width : 4 + (r - g) / width;
    return {hue < 0 ? hue / 6 + 1 : hue / 6, width / most, most};
}

Rgb rgb_of_hsv(const Rgb& hsv) {
    const auto part = [&](double shift) {
        const double k = std::fmod(shift + hsv[0] * 6, 6);
        return hsv[2] * (1 - hsv[1] * std::clamp(std::min(k, 4 - k), 0.0, 1.0));
    };
    return {part(5), part(3), part(1)};
}

Rgb between_hues(const Rgb& from, const Rgb& to, double part, bool wraps) {
    Rgb a = hsv_of(from), b = hsv_of(to);
    if (wraps && std::abs(a[0] - b[0]) > 0.5) (a[0] > b[0] ? a : b)[0] -= 1;
    Rgb hsv = mixed(a, b, part);
    if (hsv[0] < 0) hsv[0] += 1;
    return rgb_of_hsv(hsv);
}

} // namespace

Rgb color_between(ColorSpace space, const Rgb& from, const Rgb& to, double part) {
    switch (space) {
    case ColorSpace::hsv: return between_hues(from, to, part, false);
    case ColorSpace::hsv_wrapped: return between_hues(from, to, part, true);
    case ColorSpace::lab: return rgb_of_lab(mixed(lab_of(from), lab_of(to), part));
    case ColorSpace::diverging: return diverging(from, to, part);
    case ColorSpace::step: return part > 0 ? to : from;
    default: return mixed(from, to, part);
    }
}

std::optional<ColorSpace> parse_color_space(std::string_view name, bool wraps) {
    if (name == "RGB") return ColorSpace::rgb;
    if (name == "HSV") return wraps ? ColorSpace::hsv_wrapped : ColorSpace::hsv;
    if (name == "Lab" || name == "LabCIEDE2000" || name == "Lab/CIEDE2000") return ColorSpace::lab;
    if (name == "Diverging") return ColorSpace::diverging;
    if (name == "Step") return ColorSpace::step;
    return {};
}

} // namespace isotet::render
