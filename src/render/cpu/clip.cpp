// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/cpu/clip.hpp"

namespace isotet::render {

namespace {

constexpr double kept_beside = 1 << 19; ///< samples; less than where vertices are out of view

struct ClipPoint {
    double x, y, z, w;
};

/// How far a point is inside the bound that has this number.
double inside(const ClipPoint& p, int bound) {
    switch (bound) {
    case 0: return p.z;
    case 1: return p.w - p.z;
    case 2: return kept_beside * p.w + p.x;
    case 3: return kept_beside * p.w - p.x;
    case 4: return kept_beside * p.w + p.y;
    default: return kept_beside * p.w - p.y;
    }
}

/// Clips against all bounds, one after another (Sutherland and Hodgman 1974).
FixedPolygon clipped(const std::array<const PlacedVertex*, 3>& corners, const Sight& sight) {
    std::array<ClipPoint, 9> from{}, to{};
    std::size_t count = 3;
    for (std::size_t i = 0; i < 3; ++i) {
        const PlacedVertex& v = *corners[i];
        from[i] = {v.x, v.y, sight.z.at({v.place[0], v.place[1], v.place[2]}), v.w};
    }
    for (int bound = 0; bound < 6; ++bound) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const ClipPoint &a = from[i], &b = from[(i + 1) % count];
            const double in_a = inside(a, bound), in_b = inside(b, bound);
            if (in_a >= 0) to[kept++] = a;
            if ((in_a >= 0) == (in_b >= 0)) continue;
            const double part = in_a / (in_a - in_b);
            to[kept++] = {a.x + (b.x - a.x) * part, a.y + (b.y - a.y) * part, a.z + (b.z - a.z) * part,
                          a.w + (b.w - a.w) * part};
        }
        from = to;
        count = kept;
    }
    FixedPolygon polygon;
    for (std::size_t i = 0; i < count; ++i) {
        // What was cut may lie beyond a bound by its last bit.
        const FixedPoint point =
            fixed_point(from[i].x, from[i].y, std::min(std::max(from[i].z, 0.0), from[i].w), from[i].w);
        if (point.x != out_of_view) polygon.points[polygon.count++] = point;
    }
    return polygon;
}

} // namespace

FixedPolygon clipped_polygon_of(const Sheet& sheet, std::size_t triangle, const Sight& sight) {
    std::array<const PlacedVertex*, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) corners[i] = &sheet.vertices[sheet.triangles[3 * triangle + i]];
    return clipped(corners, sight);
}

} // namespace isotet::render
