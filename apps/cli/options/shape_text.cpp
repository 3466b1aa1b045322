// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/shape_text.hpp"

#include <algorithm>
#include <cmath>

#include <isotet/jobs/number_text.hpp>

namespace isotet::cli {

namespace {

/// Numbers and shares, separated by commas.
struct Offsets {
    std::vector<double> numbers;
    std::vector<IsovalueShare> shares;
};

/// Nothing where one of them is neither.
std::optional<Offsets> parse_offsets(std::string_view text) {
    Offsets out;
    for (std::size_t at = 0;;) {
        const std::size_t end = text.find(',', at);
        const std::string_view word = text.substr(at, end - at);
        if (const auto share = parse_share(word)) out.shares.push_back(*share);
        else if (const auto number = jobs::parse_number(word)) out.numbers.push_back(*number);
        else return {};
        if (end == std::string_view::npos) return out;
        at = end + 1;
    }
}

/// A place, and what follows it.
struct PlaceText {
    std::array<double, 3> place{};
    Offsets rest;
};

std::optional<PlaceText> parse_place(std::string_view text) {
    std::size_t end = 0; // of the third number
    for (int commas = 0; end < text.size(); ++end)
        if (text[end] == ',' && ++commas == 3) break;
    const std::vector<double> numbers = parse_numbers(text.substr(0, end));
    if (numbers.size() != 3) return {};
    PlaceText out{{numbers[0], numbers[1], numbers[2]}, {}};
    if (end == text.size()) return out;
    auto rest = parse_offsets(text.substr(end + 1));
    if (!rest) return {};
    out.rest = *std::move(rest);
    return out;
}

/// With a shape of some size: that of the first number.
ShapeText with_radii(SliceShape shape, Offsets radii) {
    const double first = radii.numbers.empty() ? 1 : radii.numbers.front();
    if (auto* sphere = std::get_if<Sphere>(&shape)) sphere->radius = first;
    if (auto* cylinder = std::get_if<Cylinder>(&shape)) cylinder->radius = first;
    return {shape, std::move(radii.numbers), std::move(radii.shares)};
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

std::optional<IsovalueShare> parse_share(std::string_view word) {
    IsovalueShare share;
    if (word.ends_with("%v")) {
        word.remove_suffix(2);
    } else if (word.starts_with('p')) {
        word.remove_prefix(1);
        share.of = IsovalueShare::Of::points;
    } else {
        return {};
    }
    const std::optional<double> percent = jobs::parse_number(word);
    if (!percent || !(*percent >= 0 && *percent <= 100)) return {};
    share.percent = *percent;
    return share;
}

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
    if (!planes || planes->at.size() != 1 || !planes->shares.empty() || text.find('@') != std::string::npos) return {};
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
        std::optional<Offsets> at = parse_offsets(after);
        if (!axis || !at) return {};
        for (double& offset : at->numbers) offset = is_minus(*axis) ? -offset : offset;
        const double first = at->numbers.empty() ? 0 : at->numbers.front();
        return ShapeText{Plane{*axis, first}, std::move(at->numbers), std::move(at->shares)};
    }
    const auto normal = parse_direction(before);
    const std::optional<PlaceText> place = parse_place(after);
    if (!normal || !place || std::ranges::count(after, ',') != 2) return {};
    const auto& [x, y, z] = place->place;
    const double offset = (*normal)[0] * x + (*normal)[1] * y + (*normal)[2] * z; // as slice_field() adds up
    return ShapeText{Plane{*normal, offset}, {offset}};
}

std::optional<ShapeText> parse_spheres(const std::string& text) {
    std::optional<PlaceText> centre = parse_place(text);
    if (!centre || (centre->rest.numbers.empty() && centre->rest.shares.empty())) return {};
    return with_radii(Sphere{centre->place, 1}, std::move(centre->rest));
}

std::optional<ShapeText> parse_cylinders(const std::string& text) {
    const std::size_t mark = text.find('@');
    if (mark == std::string::npos) return {};
    const auto axis = parse_direction(std::string_view(text).substr(0, mark));
    std::optional<PlaceText> point = parse_place(std::string_view(text).substr(mark + 1));
    if (!axis || !point || (point->rest.numbers.empty() && point->rest.shares.empty())) return {};
    return with_radii(Cylinder{*axis, point->place, 1}, std::move(point->rest));
}

} // namespace isotet::cli
