// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/ticks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include <fmt/core.h>

namespace isotet::render {

namespace {

constexpr std::string_view minus_sign = "\u2212";
constexpr std::array<std::string_view, 10> raised{"\u2070", "\u00B9", "\u00B2", "\u00B3", "\u2074",
                                                  "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};

std::string with_minus(std::string number) {
    if (number.starts_with('-')) number.replace(0, 1, minus_sign);
    return number;
}

std::string raised_number(int number) {
    std::string text = number < 0 ? "\u207B" : "";
    for (const char digit : std::to_string(std::abs(number))) text += raised[static_cast<std::size_t>(digit - '0')];
    return text;
}

int exponent_of(double value) { return static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9)); }

/// `digits` behind the point, of value / 10^exponent.
std::string scaled_label(double value, int exponent, int digits) {
    const std::string text =
        with_minus(fmt::format("{:.{}f}", exponent == 0 ? value : value / std::pow(10.0, exponent), digits));
    return exponent == 0 ? text
                         : text +
                               "\u00D7"
                               "10" +
                               raised_number(exponent);
}

/// Numbers that would be long are written with a power of ten.
bool is_long(double largest) { return largest >= 1e5 || largest < 1e-3; }

std::vector<Tick> linear_ticks(double lower, double upper, std::size_t most) {
    const double width = upper - lower;
    if (!std::isfinite(width)) return {};
    const double power = std::pow(10.0, std::floor(std::log10(width / static_cast<double>(most))));
    double step = power;
    for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0}) {
        step = factor * power;
        if (width / step <= static_cast<double>(most) - 1) break;
    }
    const double largest = std::max(std::abs(lower), std::abs(upper));
    if (!(step > largest * 1e-12)) return {}; // too narrow to tell its numbers apart
    const int highest = exponent_of(largest), lowest = exponent_of(step);
    // A power of ten that needs every digit before the point, and more, saves nothing: 101325.2.
    const int exponent = is_long(largest) && !(highest > 0 && lowest <= 0) ? highest : 0;
    const int digits = std::clamp(exponent - lowest, 0, 12);
    std::vector<Tick> ticks;
    for (double k = std::ceil(lower / step - 1e-9); k * step <= upper + 1e-9 * step; ++k) {
        const double value = k == 0 ? 0 : k * step;
        ticks.push_back({value, value == 0 ? "0" : scaled_label(value, exponent, digits)});
    }
    return ticks;
}

std::vector<Tick> logarithmic_ticks(double lower, double upper, std::size_t most) {
    const int first = exponent_of(lower), last = exponent_of(upper);
    const bool few = last - first <= 2;
    const int stride = std::max(1, (last - first + static_cast<int>(most)) / static_cast<int>(most));
    std::vector<Tick> ticks;
    for (int exponent = first; exponent <= last; exponent += stride) {
        for (const double factor : {1.0, 2.0, 5.0}) {
            const double value = factor * std::pow(10.0, exponent);
            if (value < lower * (1 - 1e-9) || value > upper * (1 + 1e-9) || (factor > 1 && !few)) continue;
            const bool power_alone = is_long(value) && factor == 1;
            ticks.push_back({value, power_alone ? "10" + raised_number(exponent) : number_label(value)});
        }
    }
    return ticks;
}

} // namespace

std::string number_label(double value) {
    if (value == 0) return "0";
    const int exponent = exponent_of(value);
    const double mantissa = std::abs(value) / std::pow(10.0, exponent);
    if (!is_long(std::abs(value)) || !std::isfinite(mantissa))
        return with_minus(fmt::format("{:.{}g}", value, std::max(4, exponent + 1)));
    return with_minus(fmt::format("{}{:.4g}\u00D7"
                                  "10{}",
                                  value < 0 ? "-" : "", mantissa, raised_number(exponent)));
}

std::vector<Tick> ticks_of(const ColorScale& scale, std::size_t most) {
    most = std::max<std::size_t>(most, 2);
    std::vector<Tick> ticks = scale.logarithmic ? logarithmic_ticks(scale.lower, scale.upper, most)
                                                : linear_ticks(scale.lower, scale.upper, most);
    if (ticks.empty()) ticks = {{scale.lower, number_label(scale.lower)}, {scale.upper, number_label(scale.upper)}};
    return ticks;
}

} // namespace isotet::render
