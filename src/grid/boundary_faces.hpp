// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Faces of a boundary as a surface.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/surface.hpp>

#include "base/parallel.hpp"

namespace isotet::core {

/// Ascending, each once.
std::vector<std::uint64_t> each_once(std::vector<std::uint64_t> points);

/// Makes some of `all` points the vertices, each both ends of an edge; positions keep the type of the points.
void place_vertices(Surface& surface, const Array& all, const std::vector<std::uint64_t>& points);

/// The points of some faces, ascending, each once.
/// `Face`   with three points
template <class Face>
std::vector<std::uint64_t> points_of_faces(const std::vector<Face>& faces) {
    std::vector<std::uint64_t> points;
    points.reserve(3 * faces.size());
    for (const Face& face : faces) points.insert(points.end(), face.points.begin(), face.points.end());
    return each_once(std::move(points));
}

/// The corners of faces as positions in `points`, turned to look outwards.
/// `Face`   with three points, ascending, and is_mirrored()
template <class Face>
Array triangles_of_faces(const std::vector<Face>& faces, const std::vector<std::uint64_t>& points) {
    std::vector<std::uint32_t> triangles(3 * faces.size());
    parallel_each(faces.size(), 1 << 12, [&](std::size_t i) {
        std::array<std::uint64_t, 3> corners = faces[i].points;
        if (is_mirrored(faces[i])) std::swap(corners[1], corners[2]);
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const auto place = std::lower_bound(points.begin(), points.end(), corners[corner]);
            triangles[3 * i + corner] =
                static_cast<std::uint32_t>(place - points.begin()); // fewer than 2^32: tets use no more points
        }
    });
    return Array::own(std::move(triangles), 3);
}

} // namespace isotet::core
