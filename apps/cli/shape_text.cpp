// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "shape_text.hpp"

#include <algorithm>
#include <cmath>

#include <isotet/jobs/number_text.hpp>

namespace isotet::cli {

namespace {

/// A place, and what follows it.
struct PlaceText {
    std::array<double, 3> place{};
    std::vector<double> rest;
};

std::optional<PlaceText> parse_place(std::string_view text) {
    const std::vector<double> numbers = parse_numbers(text);
    if (numbers.size() < 3) return {};
    return PlaceText{{numbers[0], numbers[1], numbers[2]}, {numbers.begin() + 3, numbers.end()}};
}

std::optional<std::array<double, 3>> parse_axis(std::string_view text) {
    const bool minus = text.starts_with('-');
    if (minus || text.starts_with('+')) text.remove_prefix(1);
    if (text.size() != 1 || text[0] < 'x' || text[0] > 'z') return {};
    std::array<double, 3> axis{};
    axis[static_cast<std::size_t>(text[0] - 'x')] = minus ? -1 : 1;
    return axis;
}

bool is_minus(const std::array<double, 3>& axis) { return axis[0] + axis[1] + axis[2] < 0; }

} // namespace

std::vector<double> parse_numbers(std::string_view text) {
    std::vector<double> numbers;
    std::size_t at = 0;
    while (true) {
        const std::size_t end = text.find(',', at);
        const auto number = jobs::parse_number(text.substr(at, end - at));
        if (!number) return {};
        numbers.push_back(*number);
        if (end == std::string_view::npos) return numbers;
        at = end + 1;
    }
}

std::optional<std::array<double, 3>> parse_direction(std::string_view text) {
    if (const auto axis = parse_axis(text)) return axis;
    const std::vector<double> numbers = parse_numbers(text);
    if (numbers.size() != 3 || (numbers[0] == 0 && numbers[1] == 0 && numbers[2] == 0)) return {};
    return std::array{numbers[0], numbers[1], numbers[2]};
}

std::optional<Plane> parse_plane(const std::string& text) {
    const std::optional<ShapeText> planes = parse_planes(text);
    if (!planes || planes->at.size() != 1 || text.find('@') != std::string::npos) return {};
    return std::get<Plane>(planes->shape);
}

std::optional<ShapeText> parse_planes(const std::string& text) {
    const std::size_t mark = text.find_first_of("=@");
    if (mark == std::string::npos) {
        const std::vector<double> numbers = parse_numbers(text);
        if (numbers.size() != 4 || (numbers[0] == 0 && numbers[1] == 0 && numbers[2] == 0)) return {};
        return ShapeText{Plane{{numbers[0], numbers[1], numbers[2]}, numbers[3]}, {numbers[3]}};
    }
    const std::string_view before = std::string_view(text).substr(0, mark),
                           after = std::string_view(text).substr(mark + 1);
    if (text[mark] == '=') {
        const auto axis = parse_axis(before);
        std::vector<double> at = parse_numbers(after);
        if (!axis || at.empty()) return {};
        for (double& offset : at) offset = is_minus(*axis) ? -offset : offset;
        return ShapeText{Plane{*axis, at.front()}, std::move(at)};
    }
    const auto normal = parse_direction(before);
    const std::optional<PlaceText> place = parse_place(after);
    if (!normal || !place || !place->rest.empty()) return {};
    const auto& [x, y, z] = place->place;
    const double offset = (*normal)[0] * x + (*normal)[1] * y + (*normal)[2] * z; // as slice_field() adds up
    return ShapeText{Plane{*normal, offset}, {offset}};
}

std::optional<ShapeText> parse_spheres(const std::string& text) {
    std::optional<PlaceText> centre = parse_place(text);
    if (!centre || centre->rest.empty()) return {};
    return ShapeText{Sphere{centre->place, centre->rest.front()}, std::move(centre->rest)};
}

std::optional<ShapeText> parse_cylinders(const std::string& text) {
    const std::size_t mark = text.find('@');
    if (mark == std::string::npos) return {};
    const auto axis = parse_direction(std::string_view(text).substr(0, mark));
    std::optional<PlaceText> point = parse_place(std::string_view(text).substr(mark + 1));
    if (!axis || !point || point->rest.empty()) return {};
    return ShapeText{Cylinder{*axis, point->place, point->rest.front()}, std::move(point->rest)};
}

} // namespace isotet::cli
