// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "make/analytic_field.hpp"

#include <cmath>
#include <numbers>

#include "make/random.hpp"

namespace isotet::make {

namespace {

float sphere(const Position& p) {
    const double x = p[0], y = p[1], z = p[2];
    return static_cast<float>(std::sqrt(x * x + y * y + z * z));
}

float torus(const Position& p) {
    const double x = p[0], y = p[1], z = p[2];
    const double from_circle = std::sqrt(x * x + y * y) - 0.5;
    return static_cast<float>(std::sqrt(from_circle * from_circle + z * z));
}

float plane(const Position& p) {
    const double x = p[0], y = p[1], z = p[2];
    return static_cast<float>((x + 2 * y + 3 * z) / std::sqrt(14.0));
}

float gyroid(const Position& p) {
    const double x = 2 * std::numbers::pi * p[0], y = 2 * std::numbers::pi * p[1], z = 2 * std::numbers::pi * p[2];
    return static_cast<float>(std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x));
}

float wavelet(const Position& p) {
    const double x = p[0], y = p[1], z = p[2];
    return static_cast<float>(255 * std::exp(-(x * x + y * y + z * z) / 2) + 10 * std::sin(30 * x) +
                              18 * std::sin(15 * y) + 5 * std::cos(20 * z));
}

} // namespace

const std::array<AnalyticField, 6> analytic_fields{
    AnalyticField{"sphere", sphere}, AnalyticField{"torus", torus},     AnalyticField{"plane", plane},
    AnalyticField{"gyroid", gyroid}, AnalyticField{"wavelet", wavelet}, AnalyticField{"integer", nullptr},
};

std::int32_t small_integer(std::uint64_t seed, std::uint64_t point) noexcept {
    return static_cast<std::int32_t>(draw(seed, Stream::integer, point) % 5);
}

} // namespace isotet::make
