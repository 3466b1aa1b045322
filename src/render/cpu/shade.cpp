// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/cpu/shade.hpp"

#include <algorithm>
#include <cmath>

#include "numbers/at_level.hpp"
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

constexpr std::size_t lanes = 16; ///< places that are shaded together, in as many lanes as a processor has

/// What the shades of as many places follow from, value by value.
struct Lanes {
    template <class Number>
    using Of = std::array<Number, lanes>;
    template <class Number>
    using OfCorners = std::array<Of<Number>, 3>;

    Of<double> x, y;
    OfCorners<double> corner_x, corner_y, corner_w;
    std::array<OfCorners<float>, 3> place, normal; ///< by corner and axis; no normal: zeros
    Of<float> log_transparency;

    OfCorners<float> weights;
    Of<float> light, opacity;
};

void gather(std::span<const ShadedPlace> places, Lanes& all) {
    for (std::size_t i = 0; i < lanes; ++i) {
        const ShadedPlace& at = places[std::min(i, places.size() - 1)];
        const Sheet& sheet = *at.sheet;
        const std::uint32_t* const numbers = sheet.triangles.data() + std::size_t{3} * at.triangle;
        all.x[i] = at.x;
        all.y[i] = at.y;
        all.log_transparency[i] = sheet.log_transparency;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const PlacedVertex& vertex = sheet.vertices[numbers[corner]];
            all.corner_x[corner][i] = vertex.x;
            all.corner_y[corner][i] = vertex.y;
            all.corner_w[corner][i] = vertex.w;
            const float* const normal =
                sheet.normals.empty() ? nullptr : sheet.normals.data() + std::size_t{3} * numbers[corner];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                all.place[corner][axis][i] = vertex.place[axis];
                all.normal[corner][axis][i] = normal ? normal[axis] : 0;
            }
        }
    }
}

/// std::clamp() returns a reference, which keeps loops from becoming vectors.
template <class Number>
Number limited(Number value, Number lower, Number upper) {
    return value < lower ? lower : upper < value ? upper : value;
}

/// How much of each corner there is at a place of the triangle: in the scene, not in the picture.
void find_weights(Lanes& all) {
    for (std::size_t i = 0; i < lanes; ++i) {
        const double across_a = all.corner_x[0][i] - all.x[i] * all.corner_w[0][i],
                     across_b = all.corner_x[1][i] - all.x[i] * all.corner_w[1][i],
                     across_c = all.corner_x[2][i] - all.x[i] * all.corner_w[2][i];
        const double down_a = all.corner_y[0][i] - all.y[i] * all.corner_w[0][i],
                     down_b = all.corner_y[1][i] - all.y[i] * all.corner_w[1][i],
                     down_c = all.corner_y[2][i] - all.y[i] * all.corner_w[2][i];
        const double a = across_b * down_c - across_c * down_b, b = across_c * down_a - across_a * down_c,
                     c = across_a * down_b - across_b * down_a;
        const double sum = a + b + c, factor = 1 / sum;
        const float third = 1.0F / 3;
        all.weights[0][i] = sum == 0 ? third : static_cast<float>(limited(a * factor, 0.0, 1.0));
        all.weights[1][i] = sum == 0 ? third : static_cast<float>(limited(b * factor, 0.0, 1.0));
        all.weights[2][i] = sum == 0 ? third : static_cast<float>(limited(c * factor, 0.0, 1.0));
    }
}

float facing_of(const Place& towards, const Place& to_eye) { return limited(dot_of(towards, to_eye), 0.0F, 1.0F); }

float light_of(float facing, const Place& towards, const Place& up) {
    const float sky = 0.5F + 0.5F * dot_of(towards, up);
    return 0.16F + 0.84F * facing + 0.22F * sky * (1 - facing);
}

Place turned(const Place& a, bool turns) { return {turns ? -a[0] : a[0], turns ? -a[1] : a[1], turns ? -a[2] : a[2]}; }
Place either(bool first, const Place& a, const Place& b) {
    return {first ? a[0] : b[0], first ? a[1] : b[1], first ? a[2] : b[2]};
}

/// Light and opacity.
template <bool parallel>
void find_light(Lanes& all, const Sight& sight) {
    const Place eye = float_place(sight.eye), up = float_place(sight.up);
    for (std::size_t i = 0; i < lanes; ++i) {
        const std::array<float, 3> weights{all.weights[0][i], all.weights[1][i], all.weights[2][i]};
        const auto corner_of = [&](const auto& corners, std::size_t corner) {
            return Place{corners[corner][0][i], corners[corner][1][i], corners[corner][2][i]};
        };
        const auto mean_of = [&](const Place& a, const Place& b, const Place& c) {
            return Place{mixed(weights, a[0], b[0], c[0]), mixed(weights, a[1], b[1], c[1]),
                         mixed(weights, a[2], b[2], c[2])};
        };
        const Place a = corner_of(all.place, 0), b = corner_of(all.place, 1), c = corner_of(all.place, 2);
        const Place to_eye = parallel ? eye : unit_of(minus_of(eye, mean_of(a, b, c)));
        const Place across = cross_of(minus_of(b, a), minus_of(c, a));
        const Place one_side = either(dot_of(across, across) > 0, unit_of(across), to_eye);
        const Place face = turned(one_side, dot_of(one_side, to_eye) < 0); // both sides are lit: as seen
        const Place mean = mean_of(corner_of(all.normal, 0), corner_of(all.normal, 1), corner_of(all.normal, 2));
        const Place smooth = either(dot_of(mean, mean) > 0.25F, unit_of(mean), face);
        const Place towards = turned(smooth, dot_of(smooth, face) < 0);
        const float facing = facing_of(towards, to_eye);
        all.light[i] = light_of(facing, towards, up);
        all.opacity[i] = 1 - power_of_2(all.log_transparency[i] / (facing < 0.2F ? 0.2F : facing));
    }
}

Shade shade_of(const ShadedPlace& at, const Lanes& all, std::size_t lane) {
    const Sheet& sheet = *at.sheet;
    Shade shade{sheet.color, 1};
    if (!sheet.lit) return shade;
    const std::array<float, 3> weights{all.weights[0][lane], all.weights[1][lane], all.weights[2][lane]};
    const std::uint32_t* const numbers = sheet.triangles.data() + std::size_t{3} * at.triangle;
    if (sheet.coloring == Coloring::by_vertex) {
        shade.color =
            color_in(sheet, {sheet.values[numbers[0]], sheet.values[numbers[1]], sheet.values[numbers[2]]}, weights);
    } else if (sheet.coloring == Coloring::by_triangle) {
        const float value = sheet.values[at.triangle];
        shade.color = color_in(sheet, {value, value, value}, {1, 0, 0});
    }
    for (float& part : shade.color) part *= all.light[lane];
    if (sheet.translucent) shade.opacity = all.opacity[lane];
    return shade;
}

} // namespace

float light_on(const std::array<float, 3>& towards, const std::array<float, 3>& to_eye, const Sight& sight) {
    return light_of(facing_of(towards, to_eye), towards, float_place(sight.up));
}

void shade(std::span<const ShadedPlace> places, const Sight& sight, std::span<Shade> shades) {
    core::at_level([&] {
        Lanes all;
        for (std::size_t first = 0; first < places.size(); first += lanes) {
            const auto some = places.subspan(first, std::min(lanes, places.size() - first));
            gather(some, all);
            find_weights(all);
            sight.parallel ? find_light<true>(all, sight) : find_light<false>(all, sight);
            for (std::size_t i = 0; i < some.size(); ++i) shades[first + i] = shade_of(some[i], all, i);
        }
    });
}

} // namespace isotet::render
