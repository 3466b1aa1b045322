// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Normals of vertices from the triangles around them. Weighted by areas: by angles would need functions that machines
// compute differently, and the thin triangles that marching makes would count as much as others.
#include "api/vertex_normals.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <fmt/core.h>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/workers.hpp"
#include "numbers/storage.hpp"

namespace isotet {

namespace {

/// The triangles around each vertex, ascending.
struct TrianglesAround {
    std::vector<std::uint64_t> begins;
    std::vector<std::uint32_t> triangles;
};

template <class Corners>
Result<TrianglesAround> triangles_around(const Corners& corners, std::size_t vertices) {
    constexpr std::uint64_t max_triangles = std::numeric_limits<std::uint32_t>::max();
    if (corners.size() / 3 > max_triangles)
        return invalid_argument(fmt::format("the surface has {} triangles, but normals of vertices take at most {}",
                                            corners.size() / 3, max_triangles));
    TrianglesAround around;
    around.begins.resize(vertices + 2);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto vertex = static_cast<std::uint64_t>(corners[i]);
        if (vertex >= vertices)
            return invalid_data(fmt::format("triangles[{}] has vertex {}, but the surface has {} vertices", i / 3,
                                            corners[i], vertices));
        ++around.begins[vertex + 2];
    }
    for (std::size_t i = 2; i < around.begins.size(); ++i) around.begins[i] += around.begins[i - 1];
    around.triangles.resize(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i)
        around.triangles[around.begins[static_cast<std::uint64_t>(corners[i]) + 1]++] =
            static_cast<std::uint32_t>(i / 3);
    return around;
}

template <class Positions, class Corners>
Array normals_of(const Positions& positions, const Corners& corners, const TrianglesAround& around,
                 std::size_t vertices) {
    std::vector<float> normals(3 * vertices);
    core::worker_each(vertices, std::size_t{1} << 12, [&](std::size_t vertex) {
        double sum[3] = {0, 0, 0};
        for (std::uint64_t k = around.begins[vertex]; k < around.begins[vertex + 1]; ++k) {
            const std::size_t first = std::size_t{3} * around.triangles[k];
            double edges[2][3];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto at = [&](std::size_t corner) {
                    return static_cast<double>(positions[3 * static_cast<std::size_t>(corners[first + corner]) + axis]);
                };
                edges[0][axis] = at(1) - at(0);
                edges[1][axis] = at(2) - at(0);
            }
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::size_t j = (axis + 1) % 3, l = (axis + 2) % 3;
                sum[axis] += edges[0][j] * edges[1][l] - edges[0][l] * edges[1][j];
            }
        }
        const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            normals[3 * vertex + axis] = length > 0 && std::isfinite(length)
                                             ? static_cast<float>(core::rounded_to_float(sum[axis] / length))
                                             : 0;
    });
    return Array::own(std::move(normals), 3);
}

} // namespace

Result<Array> normals_of_vertices(const Surface& surface) {
    return surface.triangles.visit([&](auto corners) -> Result<Array> {
        const Result<TrianglesAround> around = triangles_around(corners, surface.vertex_count());
        if (!around) return around.error();
        return surface.positions.visit(
            [&](auto positions) { return normals_of(positions, corners, *around, surface.vertex_count()); });
    });
}

Result<Array> vertex_normals(const Surface& surface, const Run& run) {
    return core::carry_out("normals of vertices", run, [&](const Progress&) { return normals_of_vertices(surface); });
}

} // namespace isotet
