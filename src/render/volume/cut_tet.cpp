// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tets that reach behind the eye. A place in the picture times w is P; a face is normal . P = offset, a ray is
// P = w (x, y, 1).
#include "render/volume/tet_planes.hpp"

namespace isotet::render {

namespace {

Vector across_of(const TetCorner& corner) { return {corner.across, corner.down, corner.w}; }

/// normal . (x, y, 1) as a plane around the middle of the tile.
FacePlane plane_of(const Vector& near, const Vector& value) {
    constexpr double middle = 0.5 * volume_tile_side;
    const auto at_middle = [&](const Vector& v) { return static_cast<float>((v[0] + v[1]) * middle + v[2]); };
    return {at_middle(near),
            static_cast<float>(near[0]),
            static_cast<float>(near[1]),
            at_middle(value),
            static_cast<float>(value[0]),
            static_cast<float>(value[1]),
            static_cast<float>(middle - ray_x),
            static_cast<float>(middle - ray_y)};
}

Vector scaled(const Vector& v, double factor) { return {v[0] * factor, v[1] * factor, v[2] * factor}; }

void add_face(const std::array<TetCorner, 4>& corners, std::size_t opposite, double nearest, TetPlanes& out) {
    const auto& face = faces_of_tet[opposite];
    const TetCorner &one = corners[face[0]], &two = corners[face[1]], &three = corners[face[2]];
    const Vector a = across_of(one), b = across_of(two), c = across_of(three);
    const Vector normal = cross(minus(b, a), minus(c, a));
    const double offset = divisible(dot(normal, a)), side = dot(normal, across_of(corners[opposite])) - offset;
    const bool front = offset * side > 0;
    FacePlane plane;
    if (std::min({one.w, two.w, three.w}) >= nearest) {
        plane = face_plane<false>(one, two, three);
    } else {
        const Vector value =
            plus(plus(scaled(cross(b, c), one.value), cross(c, a), two.value), cross(a, b), three.value);
        plane = plane_of(scaled(normal, 1 / offset), scaled(value, 1 / offset));
    }
    if (front) out.front[out.fronts++] = plane;
    else out.back[out.backs++] = plane;
}

/// Where the tet is cut: there its value is gradient . P + rest.
void add_cut(const std::array<TetCorner, 4>& corners, double nearest, TetPlanes& out) {
    const Vector a = across_of(corners[0]), b = minus(across_of(corners[1]), a), c = minus(across_of(corners[2]), a),
                 d = minus(across_of(corners[3]), a);
    const double determinant = divisible(dot(b, cross(c, d)));
    const auto rise = [&](std::size_t i) { return corners[i].value - corners[0].value; };
    const Vector gradient =
        scaled(plus(plus(scaled(cross(c, d), rise(1)), cross(d, b), rise(2)), cross(b, c), rise(3)), 1 / determinant);
    const double rest = corners[0].value - dot(gradient, a), near = 1 / nearest;
    out.front[out.fronts++] = plane_of({0, 0, near}, plus(gradient, {0, 0, 1}, rest * near));
}

bool is_beside(const std::array<TetCorner, 4>& corners) {
    const auto all = [&](auto test) { return std::all_of(corners.begin(), corners.end(), test); };
    constexpr double side = volume_tile_side;
    return all([](const TetCorner& p) { return p.across < 0; }) || all([](const TetCorner& p) { return p.down < 0; }) ||
           all([](const TetCorner& p) { return p.across > side * p.w; }) ||
           all([](const TetCorner& p) { return p.down > side * p.w; });
}

} // namespace

bool planes_of_cut(const std::array<TetCorner, 4>& corners, double nearest, TetPlanes& out) {
    double farthest = 0, lowest = corners[0].value, highest = corners[0].value;
    for (const TetCorner& corner : corners) {
        farthest = std::max(farthest, corner.w);
        lowest = std::min(lowest, corner.value);
        highest = std::max(highest, corner.value);
    }
    if (farthest <= nearest || is_beside(corners)) return false;
    out.left = out.top = 0;
    out.right = out.bottom = volume_tile_side - 1;
    out.fronts = out.backs = 0;
    add_cut(corners, nearest, out);
    for (std::size_t k = 0; k < 4; ++k) add_face(corners, k, nearest, out);
    if (out.backs == 0) return false;
    out.fill_up();
    out.farthest = static_cast<float>(1 / farthest);
    out.nearest = static_cast<float>(1 / nearest);
    out.lowest = static_cast<float>(lowest);
    out.highest = static_cast<float>(highest);
    return true;
}

} // namespace isotet::render
