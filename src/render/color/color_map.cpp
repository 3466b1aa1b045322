// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include <isotet/scene.hpp>

#include "render/color/color_tables.hpp"

namespace isotet {

namespace {

struct NamedMap {
    ColorMap map;
    std::string_view name, colors;
};

constexpr std::array<NamedMap, 5> named_maps{{{ColorMap::viridis, "viridis", render::viridis_colors},
                                              {ColorMap::cividis, "cividis", render::cividis_colors},
                                              {ColorMap::plasma, "plasma", render::plasma_colors},
                                              {ColorMap::turbo, "turbo", render::turbo_colors},
                                              {ColorMap::cool_warm, "cool-warm", render::cool_warm_colors}}};
constexpr std::size_t entries = 256, digits = 6;
static_assert(std::ranges::all_of(named_maps,
                                  [](const NamedMap& one) { return one.colors.size() == entries * digits; }));

float part_of(std::string_view colors, std::size_t entry, std::size_t part) {
    const auto digit = [&](std::size_t i) {
        const char c = colors[entry * digits + 2 * part + i];
        return c <= '9' ? c - '0' : c - 'a' + 10;
    };
    return static_cast<float>(16 * digit(0) + digit(1)) / 255;
}

} // namespace

std::string_view name_of(ColorMap map) noexcept { return named_maps[static_cast<std::size_t>(map)].name; }

std::optional<ColorMap> parse_color_map(std::string_view name) noexcept {
    for (const NamedMap& one : named_maps)
        if (one.name == name) return one.map;
    return {};
}

Color color_at(ColorMap map, double place) noexcept {
    const std::string_view colors = named_maps[static_cast<std::size_t>(map)].colors;
    const double entry = std::clamp(place, 0.0, 1.0) * (entries - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(entry), entries - 2);
    const auto above_part = static_cast<float>(entry - static_cast<double>(below));
    const auto mixed = [&](std::size_t part) {
        return part_of(colors, below, part) * (1 - above_part) + part_of(colors, below + 1, part) * above_part;
    };
    return {mixed(0), mixed(1), mixed(2), 1};
}

Color color_at(const std::vector<Color>& colors, ColorMap map, double place) noexcept {
    if (colors.empty()) return color_at(map, place);
    const double entry = std::clamp(place, 0.0, 1.0) * static_cast<double>(colors.size() - 1);
    const auto below = static_cast<std::size_t>(entry);
    const Color &a = colors[below], &b = colors[std::min(below + 1, colors.size() - 1)];
    const auto part = static_cast<float>(entry - static_cast<double>(below));
    const auto mixed = [&](float from, float to) { return from * (1 - part) + to * part; };
    return {mixed(a.red, b.red), mixed(a.green, b.green), mixed(a.blue, b.blue), 1};
}

Color ColorScale::color_at(double place) const noexcept { return isotet::color_at(colors, map, place); }

double ColorScale::place_of(double value) const noexcept {
    if (!logarithmic || std::isnan(value)) return (value - lower) / (upper - lower);
    if (value <= 0) return -std::numeric_limits<double>::infinity();
    return std::log(value / lower) / std::log(upper / lower);
}

double ColorScale::value_of(double place) const noexcept {
    if (!logarithmic) return (1 - place) * lower + place * upper;
    return lower * std::exp(place * std::log(upper / lower));
}

} // namespace isotet
