// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/surfaces/float_positions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "io/write/write_text.hpp"
#include "numbers/storage.hpp"

namespace isotet::io {
namespace {

using Origin = std::array<double, 3>;

/// The middle of the surface, rounded to float32.
Origin middle_of(const Surface& surface) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Origin lower{infinity, infinity, infinity}, upper{-infinity, -infinity, -infinity}, middle;
    for (std::uint64_t vertex = 0; vertex < surface.vertex_count(); ++vertex)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double x = surface.positions.at(vertex, axis);
            lower[axis] = std::min(lower[axis], x);
            upper[axis] = std::max(upper[axis], x);
        }
    for (std::size_t axis = 0; axis < 3; ++axis)
        middle[axis] = core::rounded_to_float(lower[axis] + (upper[axis] - lower[axis]) / 2);
    return middle;
}

/// Whether rounding to float32 brings corners of a triangle together that are apart relative to `origin`.
bool rounding_collapses_triangles(const Surface& surface, const Origin& origin) {
    const FloatPositions near, moved{origin};
    constexpr std::size_t at_once = 1 << 16;
    for (std::size_t begin = 0; begin < surface.triangle_count(); begin += at_once) {
        const auto corners = corners_of(surface.triangles, begin, std::min(begin + at_once, surface.triangle_count()));
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto from = static_cast<std::uint64_t>(corners[i]);
            const auto to = static_cast<std::uint64_t>(corners[i % 3 == 2 ? i - 2 : i + 1]);
            if (near.at(surface, from) == near.at(surface, to) &&
                moved.at(surface, from) != moved.at(surface, to))
                return true;
        }
    }
    return false;
}

/// How far float32 is from the given coordinates at most.
double largest_rounding(const Array& positions, const Origin& origin) {
    double largest = 0;
    positions.visit([&](auto values) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double exact = static_cast<double>(values[i]) - origin[i % 3];
            if (const double error = std::abs(exact - static_cast<double>(static_cast<float>(exact))); error > largest)
                largest = error;
        }
    });
    return largest;
}

} // namespace

std::array<float, 3> FloatPositions::at(const Surface& surface, std::uint64_t vertex) const {
    return surface.positions.visit([&](auto values) {
        std::array<float, 3> out;
        for (std::size_t axis = 0; axis < 3; ++axis)
            out[axis] = static_cast<float>(static_cast<double>(values[3 * vertex + axis]) - origin[axis]);
        return out;
    });
}

FloatPositions float_positions(const SurfaceToWrite& input, std::string_view format) {
    FloatPositions positions;
    const Surface& surface = input.surface;
    if (surface.positions.type() == ScalarType::float64) {
        const Origin middle = middle_of(surface);
        if (rounding_collapses_triangles(surface, middle)) {
            positions.origin = middle;
            input.notes.push_back(
                fmt::format("{} holds float32, and so far from 0 triangles would collapse: coordinates are relative to "
                            "({}, {}, {})",
                            format, middle[0], middle[1], middle[2]));
        }
    }
    if (const double error = largest_rounding(surface.positions, positions.origin); error > 0)
        input.notes.push_back(fmt::format("{} holds float32: coordinates were rounded by up to {:.3g}", format, error));
    return positions;
}

} // namespace isotet::io
