// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <isotet/scene.hpp>

#include "base/errors.hpp"
#include "render/color/color_space.hpp"

namespace isotet {

namespace {

using Json = nlohmann::json;
using Point = std::array<double, 4>;

constexpr std::size_t colors_per_map = 1024;

const std::string& text_of(const Json& map, const char* key) {
    static const std::string none;
    const auto found = map.find(key);
    return found != map.end() && found->is_string() ? found->get_ref<const std::string&>() : none;
}

std::string names_of(const Json& maps) {
    constexpr std::size_t most = 20;
    std::string names;
    for (std::size_t i = 0; i < maps.size() && i < most; ++i)
        if (maps[i].is_object()) names += fmt::format("{}'{}'", i > 0 ? ", " : "", text_of(maps[i], "Name"));
    return maps.size() > most ? names + ", ..." : names;
}

/// The map of a name among all of a file.
Result<Json> find_map(std::string_view text, std::string_view name) {
    Json maps = Json::parse(text, nullptr, false);
    if (maps.is_discarded()) return invalid_data("it is not JSON");
    if (maps.is_object()) maps = Json::array({std::move(maps)});
    if (!maps.is_array() || maps.empty() || !std::ranges::all_of(maps, &Json::is_object))
        return invalid_data("it is not a list of colour maps, each an object");
    if (name.empty()) {
        if (maps.size() == 1) return std::move(maps[0]);
        return invalid_data(
            fmt::format("it has {} colour maps, and one must be named: {}", maps.size(), names_of(maps)));
    }
    for (Json& map : maps)
        if (text_of(map, "Name") == name) return std::move(map);
    return invalid_data(fmt::format("it has no colour map '{}', but {}", name, names_of(maps)));
}

/// A list of four numbers a point, the first ones ascending and the next `parts` from 0 to 1; none where there is no list.
Result<std::vector<Point>> points_of(const Json& map, const char* key, std::size_t parts) {
    std::vector<Point> points;
    const auto list = map.find(key);
    if (list == map.end()) return points;
    if (!list->is_array() || list->size() % 4 != 0 || !std::ranges::all_of(*list, &Json::is_number))
        return invalid_data(fmt::format("its {} is not a list of four numbers a point", key));
    for (std::size_t i = 0; i < list->size(); i += 4) {
        Point& point = points.emplace_back();
        for (std::size_t k = 0; k < 4; ++k) point[k] = (*list)[i + k].get<double>();
        if (!std::isfinite(point[0]) || (i > 0 && point[0] < points[points.size() - 2][0]))
            return invalid_data(fmt::format("point {} of its {} is at {}, but values must be finite and ascend",
                                            points.size(), key, point[0]));
        for (std::size_t k = 1; k <= parts; ++k)
            if (!(point[k] >= 0 && point[k] <= 1))
                return invalid_data(fmt::format("point {} of its {} has {}, but must have numbers from 0 to 1",
                                                points.size(), key, point[k]));
    }
    return points;
}

Color rounded(const render::Rgb& rgb) {
    const auto part = [&](std::size_t i) { return static_cast<float>(std::round(rgb[i] * 65535) / 65535); };
    return {part(0), part(1), part(2), 1};
}

std::vector<Color> colors_of(const std::vector<Point>& points, render::ColorSpace space) {
    std::vector<Color> colors;
    const double lower = points.front()[0], upper = points.back()[0];
    const auto rgb_of = [](const Point& point) { return render::Rgb{point[1], point[2], point[3]}; };
    std::size_t above = 1;
    for (std::size_t i = 0; i < colors_per_map; ++i) {
        const double at = static_cast<double>(i) / (colors_per_map - 1), value = (1 - at) * lower + at * upper;
        while (above + 1 < points.size() && points[above][0] < value) ++above;
        const Point &a = points[above - 1], &b = points[above];
        const double part = b[0] > a[0] ? std::clamp((value - a[0]) / (b[0] - a[0]), 0.0, 1.0) : 1;
        colors.push_back(rounded(render::color_between(space, rgb_of(a), rgb_of(b), part)));
    }
    return colors;
}

/// The opacity at `part` of the way between two points, as VTK's piecewise functions have it.
double opacity_between(const Point& a, const Point& b, double part) {
    const double middle = a[2], sharpness = a[3];
    double s = part < middle ? 0.5 * part / middle : 0.5 + 0.5 * (part - middle) / (1 - middle);
    const double power = 1 + 10 * sharpness, rise = b[1] - a[1];
    s = s < 0.5 ? 0.5 * std::pow(2 * s, power) : 1 - 0.5 * std::pow(2 * (1 - s), power);
    const double square = s * s, cube = square * s, smooth = 3 * square - 2 * cube;
    const double bent = a[1] + smooth * rise + (2 * cube - 3 * square + s) * (1 - sharpness) * rise;
    return std::clamp(bent, std::min(a[1], b[1]), std::max(a[1], b[1]));
}

/// Lines that follow the curves between points.
OpacityCurve curve_of(const std::vector<Point>& points) {
    constexpr int pieces = 32;
    OpacityCurve curve;
    const auto add = [&](double value, double opacity) {
        const OpacityPoint point{value, opacity};
        if (curve.points.empty() || curve.points.back() != point) curve.points.push_back(point);
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& a = points[i];
        add(a[0], a[1]);
        if (i + 1 == points.size()) break;
        const Point& b = points[i + 1];
        const double middle = (1 - a[2]) * a[0] + a[2] * b[0];
        if (a[3] > 0.99) {
            add(middle, a[1]);
            add(middle, b[1]);
        } else if (a[3] >= 0.01 && a[2] > 0 && a[2] < 1) {
            for (int k = 1; k < pieces; ++k) {
                const double part = static_cast<double>(k) / pieces;
                add((1 - part) * a[0] + part * b[0], opacity_between(a, b, part));
            }
        } else if (a[2] != 0.5) {
            add(middle, 0.5 * (a[1] + b[1]));
        }
    }
    return curve;
}

std::optional<Color> color_of(const Json& map, const char* key) {
    const auto list = map.find(key);
    if (list == map.end() || !list->is_array() || list->size() != 3 || !std::ranges::all_of(*list, &Json::is_number))
        return {};
    const auto part = [&](std::size_t i) { return std::clamp((*list)[i].get<float>(), 0.0F, 1.0F); };
    return Color{part(0), part(1), part(2), 1};
}

} // namespace

Result<ColorMapFile> parse_color_map_file(std::string_view text, std::string_view name) {
    const Result<Json> map = find_map(text, name);
    if (!map) return map.error();
    ColorMapFile out;
    out.name = text_of(*map, "Name");
    const Result<std::vector<Point>> colors = points_of(*map, "RGBPoints", 3), opacity = points_of(*map, "Points", 3);
    if (!colors) return colors.error();
    if (!opacity) return opacity.error();
    if (colors->empty() && opacity->empty())
        return invalid_data(fmt::format("its colour map '{}' has neither RGBPoints nor Points{}", out.name,
                                        map->contains("IndexedColors") ? ", but colours of categories" : ""));
    if (colors->size() == 1 || (!colors->empty() && !(colors->front()[0] < colors->back()[0])))
        return invalid_data(fmt::format("its colour map '{}' has RGBPoints of one value only", out.name));
    if (!colors->empty()) {
        const auto wraps = map->find("HSVWrap");
        const std::string& space_name = text_of(*map, "ColorSpace");
        const auto space = render::parse_color_space(space_name.empty() ? "RGB" : space_name,
                                                     wraps != map->end() && (*wraps == true || *wraps == 1));
        if (!space)
            return invalid_data(
                fmt::format("its colour map '{}' is in the space '{}', but RGB, HSV, Lab, LabCIEDE2000, "
                            "Diverging and Step are known",
                            out.name, space_name));
        out.colors = colors_of(*colors, *space);
        out.range = {colors->front()[0], colors->back()[0]};
    }
    out.no_data = color_of(*map, "NanColor");
    out.opacity = curve_of(*opacity);
    return out;
}

Result<OpacityText> parse_opacity_file(std::string_view text, std::string_view name) {
    constexpr std::string_view separators = " \t\r\n\f\v,";
    const std::size_t first = text.find_first_not_of(separators);
    if (first != std::string_view::npos && (text[first] == '[' || text[first] == '{')) {
        Result<ColorMapFile> map = parse_color_map_file(text, name);
        if (!map) return map.error();
        if (map->opacity.points.empty())
            return invalid_data(fmt::format("its colour map '{}' has colours, but no Points of opacity", map->name));
        return OpacityText{std::move(map->opacity), {}, 0};
    }
    std::string points;
    for (std::size_t begin = 0; (begin = text.find_first_not_of(separators, begin)) != std::string_view::npos;) {
        if (text[begin] == '#') {
            begin = std::min(text.find('\n', begin), text.size());
            continue;
        }
        const std::size_t end = std::min(text.find_first_of(" \t\r\n\f\v,#", begin), text.size());
        points += points.empty() ? "" : ",";
        points += text.substr(begin, end - begin);
        begin = end;
    }
    return parse_opacity(points);
}

} // namespace isotet
