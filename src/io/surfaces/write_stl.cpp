// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// STL, binary: float32 triangles without shared vertices.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/core.h>

#include "io/surfaces/float_positions.hpp"
#include "io/write/write_text.hpp"

namespace isotet::io {
namespace {

using Vector = std::array<float, 3>;

constexpr std::size_t header_bytes = 80;
constexpr std::size_t facet_bytes = 50; // normal, three corners, two unused bytes

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

} // namespace

Result<WriteReport> write_stl(const SurfaceToWrite& input) {
    const auto& surface = input.surface;
    const std::size_t triangles = surface.triangle_count();
    if (triangles > std::numeric_limits<std::uint32_t>::max()) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("the surface has {} triangles, but STL holds at most 4294967295", triangles)};
    }
    const FloatPositions positions = float_positions(input, "STL");
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
                    vectors[k + 1] = positions.at(surface, static_cast<std::uint64_t>(corners[3 * i + k]));
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
