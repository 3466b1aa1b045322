// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/cpu/shade.hpp"

#include <algorithm>
#include <cmath>

#include "render/color/color_places.hpp"
#include "render/cpu/power_of_2.hpp"

namespace isotet::render {

namespace {

using Place = std::array<float, 3>;

float dot_of(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Place minus_of(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Place times(const Place& a, float factor) { return {a[0] * factor, a[1] * factor, a[2] * factor}; }
Place unit_of(const Place& a) { return times(a, 1 / std::sqrt(dot_of(a, a))); }
Place cross_of(const Place& a, const Place& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Place float_place(const Vector& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// How much of each corner there is at a place of the triangle: in the scene, not in the picture.
std::array<float, 3> weights_at(const std::array<const PlacedVertex*, 3>& corners, double x, double y) {
    std::array<double, 3> across{}, down{}, weights{};
    for (std::size_t i = 0; i < 3; ++i) {
        across[i] = corners[i]->x - x * corners[i]->w;
        down[i] = corners[i]->y - y * corners[i]->w;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        weights[i] = across[j] * down[k] - across[k] * down[j];
    }
    const double sum = weights[0] + weights[1] + weights[2];
    if (sum == 0) return {1.0F / 3, 1.0F / 3, 1.0F / 3};
    const double factor = 1 / sum;
    const auto part = [&](std::size_t i) { return static_cast<float>(std::clamp(weights[i] * factor, 0.0, 1.0)); };
    return {part(0), part(1), part(2)};
}

float mixed(const std::array<float, 3>& weights, float a, float b, float c) {
    return weights[0] * a + weights[1] * b + weights[2] * c;
}

Light color_in(const Sheet& sheet, const std::array<float, 3>& values, const std::array<float, 3>& weights) {
    std::array<float, 3> known{};
    for (std::size_t i = 0; i < 3; ++i) {
        if (std::isnan(values[i])) return sheet.no_data;
        known[i] = std::clamp(values[i], -1e30F, 1e30F); // what lies beyond is far beyond any end of the map
    }
    float place = mixed(weights, known[0], known[1], known[2]);
    if (sheet.log_factor != 0) place = static_cast<float>(std::log(std::max(double{place}, 1e-37))) * sheet.log_factor;
    const float entry = std::clamp(place, 0.0F, 1.0F) * static_cast<float>(entries_per_map - 1);
    const std::uint32_t below = std::min(static_cast<std::uint32_t>(entry), entries_per_map - 2);
    const float above = entry - static_cast<float>(below);
    const float* const from = sheet.table.data() + std::size_t{3} * below;
    Light color{};
    for (std::size_t i = 0; i < 3; ++i) color[i] = from[i] + (from[3 + i] - from[i]) * above;
    return color;
}

float facing_of(const Place& towards, const Place& to_eye) { return std::clamp(dot_of(towards, to_eye), 0.0F, 1.0F); }

} // namespace

float light_on(const std::array<float, 3>& towards, const std::array<float, 3>& to_eye, const Sight& sight) {
    const float facing = facing_of(towards, to_eye);
    const float sky = 0.5F + 0.5F * dot_of(towards, float_place(sight.up));
    return 0.16F + 0.84F * facing + 0.22F * sky * (1 - facing);
}

Shade shade(const Sheet& sheet, std::uint32_t triangle, double x, double y, const Sight& sight) {
    if (!sheet.lit) return {sheet.color, 1};
    const std::uint32_t* const numbers = sheet.triangles.data() + std::size_t{3} * triangle;
    const std::array<const PlacedVertex*, 3> corners{&sheet.vertices[numbers[0]], &sheet.vertices[numbers[1]],
                                                     &sheet.vertices[numbers[2]]};
    const std::array<float, 3> weights = weights_at(corners, x, y);
    Place to_eye = float_place(sight.eye);
    if (!sight.parallel) {
        Place at{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            at[axis] = mixed(weights, corners[0]->place[axis], corners[1]->place[axis], corners[2]->place[axis]);
        to_eye = unit_of(minus_of(to_eye, at));
    }
    Place face =
        cross_of(minus_of(corners[1]->place, corners[0]->place), minus_of(corners[2]->place, corners[0]->place));
    face = dot_of(face, face) > 0 ? unit_of(face) : to_eye;
    if (dot_of(face, to_eye) < 0) face = times(face, -1); // both sides are lit: as seen
    Place towards = face;
    if (!sheet.normals.empty()) {
        const auto normal = [&](std::size_t corner, std::size_t axis) {
            return sheet.normals[std::size_t{3} * numbers[corner] + axis];
        };
        Place mean{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            mean[axis] = mixed(weights, normal(0, axis), normal(1, axis), normal(2, axis));
        if (dot_of(mean, mean) > 0.25F) towards = unit_of(mean);
        if (dot_of(towards, face) < 0) towards = times(towards, -1);
    }
    const float facing = facing_of(towards, to_eye), light = light_on(towards, to_eye, sight);

    Shade shade{sheet.color, 1};
    if (sheet.coloring == Coloring::by_vertex) {
        shade.color =
            color_in(sheet, {sheet.values[numbers[0]], sheet.values[numbers[1]], sheet.values[numbers[2]]}, weights);
    } else if (sheet.coloring == Coloring::by_triangle) {
        const float value = sheet.values[triangle];
        shade.color = color_in(sheet, {value, value, value}, {1, 0, 0});
    }
    for (float& part : shade.color) part *= light;
    if (sheet.translucent) shade.opacity = 1 - power_of_2(sheet.log_transparency / std::max(facing, 0.2F));
    return shade;
}

} // namespace isotet::render
