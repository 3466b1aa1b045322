// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// STL, binary: float32 triangles without shared vertices.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/core.h>

#include "io/write/write_formats.hpp"
#include "io/write/write_text.hpp"
#include "numbers/storage.hpp"

namespace isotet::io {
namespace {

using Vector = std::array<float, 3>;

constexpr std::size_t header_bytes = 80;
constexpr std::size_t facet_bytes = 50; // normal, three corners, two unused bytes

using Origin = std::array<double, 3>;

/// In float32, relative to the origin.
Vector position(const Surface& surface, std::uint64_t vertex, const Origin& origin) {
    return surface.positions.visit([&](auto values) {
        Vector out;
        for (std::size_t axis = 0; axis < 3; ++axis)
            out[axis] = static_cast<float>(static_cast<double>(values[3 * vertex + axis]) - origin[axis]);
        return out;
    });
}

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
    constexpr std::size_t at_once = 1 << 16;
    for (std::size_t begin = 0; begin < surface.triangle_count(); begin += at_once) {
        const auto corners = corners_of(surface.triangles, begin, std::min(begin + at_once, surface.triangle_count()));
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto from = static_cast<std::uint64_t>(corners[i]);
            const auto to = static_cast<std::uint64_t>(corners[i % 3 == 2 ? i - 2 : i + 1]);
            if (position(surface, from, {}) == position(surface, to, {}) &&
                position(surface, from, origin) != position(surface, to, origin))
                return true;
        }
    }
    return false;
}

/// Of unit length, or zero where the triangle has no area.
Vector facet_normal(const Vector& a, const Vector& b, const Vector& c) {
    std::array<double, 3> u{}, v{};
    for (std::size_t i = 0; i < 3; ++i) {
        u[i] = static_cast<double>(b[i]) - static_cast<double>(a[i]);
        v[i] = static_cast<double>(c[i]) - static_cast<double>(a[i]);
    }
    const std::array<double, 3> n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::hypot(n[0], n[1], n[2]);
    if (!(length > 0) || !std::isfinite(length)) return {};
    return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length), static_cast<float>(n[2] / length)};
}

void put(const Vector& vector, char* out) {
    for (const float value : vector) {
        auto bytes = std::bit_cast<std::array<char, sizeof(float)>>(value);
        if (std::endian::native != std::endian::little) std::reverse(bytes.begin(), bytes.end());
        out = std::copy(bytes.begin(), bytes.end(), out);
    }
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

Result<WriteReport> write_stl(const SurfaceToWrite& input) {
    const auto& surface = input.surface;
    const std::size_t triangles = surface.triangle_count();
    if (triangles > std::numeric_limits<std::uint32_t>::max()) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("the surface has {} triangles, but STL holds at most 4294967295", triangles)};
    }
    Origin origin{};
    if (surface.positions.type() == ScalarType::float64) {
        const Origin middle = middle_of(surface);
        if (rounding_collapses_triangles(surface, middle)) {
            origin = middle;
            input.notes.push_back(
                fmt::format("STL holds float32, and so far from 0 triangles would collapse: coordinates are relative "
                            "to ({}, {}, {})",
                            origin[0], origin[1], origin[2]));
        }
    }
    if (const double error = largest_rounding(surface.positions, origin); error > 0)
        input.notes.push_back(fmt::format("STL holds float32: coordinates were rounded by up to {:.3g}", error));
    note_left_out(input, "STL", {&input.columns.edges, &input.columns.point_fields, &input.columns.cell_fields});

    const std::uint64_t expected = header_bytes + sizeof(std::uint32_t) + std::uint64_t{triangles} * facet_bytes;
    return write_file(input.path, input.progress, expected, [&](WriteStream& stream) {
        // A text STL is told by "solid" at the start; VTK takes a file without a NUL in its header for one, too.
        std::string header = "isotet";
        header.resize(header_bytes, '\0');
        stream.text(header);
        stream.number(static_cast<std::uint32_t>(triangles), std::endian::little);
        stream.rows(triangles, [&](std::size_t begin, std::size_t end, std::string& out) {
            const auto corners = corners_of(surface.triangles, begin, end);
            out.assign((end - begin) * facet_bytes, '\0');
            char* facet = out.data();
            for (std::size_t i = 0; i < end - begin; ++i, facet += facet_bytes) {
                std::array<Vector, 4> vectors{};
                for (std::size_t k = 0; k < 3; ++k)
                    vectors[k + 1] = position(surface, static_cast<std::uint64_t>(corners[3 * i + k]), origin);
                if (input.columns.cell_normals) {
                    for (std::size_t k = 0; k < 3; ++k)
                        vectors[0][k] = static_cast<float>(surface.normals.at(begin + i, k));
                } else {
                    vectors[0] = facet_normal(vectors[1], vectors[2], vectors[3]);
                }
                for (std::size_t k = 0; k < 4; ++k) put(vectors[k], facet + 12 * k);
            }
        });
    });
}

} // namespace isotet::io
