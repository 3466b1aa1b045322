// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A tet as planes over a tile: nearness, which is linear in the picture along each face, and value times nearness. Tets
// that share a face have the same numbers for it, bit for bit.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "render/volume/placed_volume.hpp"

namespace isotet::render {

/// A corner of a tet.
struct TetCorner {
    double x, y, near; ///< as PlacedPoints
    double value;
    double across, down, w;
    std::uint8_t local;
};

/// Nearness and value times nearness (in parallel pictures the value) around a place in or near the tile.
struct FacePlane {
    float near, near_per_x, near_per_y;
    float value, value_per_x, value_per_y;
    float x, y;

    float near_at(float to_x, float to_y) const {
        return near + near_per_x * (to_x - x) + near_per_y * (to_y - y);
    }
    float value_at(float to_x, float to_y) const {
        return value + value_per_x * (to_x - x) + value_per_y * (to_y - y);
    }
};

/// Faces where rays enter, and where they leave. As many of each count as there may be; where there are fewer the first
/// is there again.
struct TetPlanes {
    static constexpr std::size_t most = 4; ///< of a tet that is cut before the eye; else 3
    std::array<FacePlane, most + 1> front, back;
    std::size_t fronts = 0, backs = 0;
    float lowest = 0, highest = 0;   ///< values
    float farthest = 0, nearest = 0; ///< nearness
    std::int32_t left = 0, right = 0, top = 0, bottom = 0; ///< pixels of the tile; none where left > right

    bool empty() const { return left > right || top > bottom; }
    void fill_up() {
        for (std::size_t i = fronts; i < most; ++i) front[i] = front[0];
        for (std::size_t i = backs; i < most; ++i) back[i] = back[0];
    }
};

/// The corners of the face opposite each corner, in the order of the corners.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> faces_of_tet{{{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

/// By their place in the picture: what follows does not depend on the numbers of points.
inline void sort_corners(std::array<TetCorner, 4>& corners) {
    const auto order = [&](std::size_t i, std::size_t j) {
        const TetCorner &a = corners[i], &b = corners[j];
        const bool behind = a.across != b.across ? a.across > b.across
                            : a.down != b.down   ? a.down > b.down
                            : a.w != b.w         ? a.w > b.w
                            : a.near != b.near   ? a.near > b.near
                                                 : a.value > b.value;
        if (behind) std::swap(corners[i], corners[j]);
    };
    order(0, 1);
    order(2, 3);
    order(0, 2);
    order(1, 3);
    order(1, 2);
}

/// A determinant that may be divided by: a face seen from its edge is all but upright.
inline double divisible(double determinant) {
    constexpr double least = 1e-20;
    return std::abs(determinant) < least ? std::copysign(least, determinant) : determinant;
}

/// The nearest place in the tile: there planes are precise.
inline double in_tile(double at) { return std::min(std::max(at, 0.0), double{volume_tile_side - 1} + 0.5); }

/// A face whose corners are all before the eye.
template <bool parallel>
FacePlane face_plane(const TetCorner& a, const TetCorner& b, const TetCorner& c) {
    const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    const double part = 1 / divisible(bx * cy - cx * by);
    const auto value = [](const TetCorner& corner) { return parallel ? corner.value : corner.value * corner.near; };
    const double bn = b.near - a.near, cn = c.near - a.near, av = value(a), bv = value(b) - av, cv = value(c) - av;
    const double near_x = (bn * cy - cn * by) * part, near_y = (bx * cn - cx * bn) * part;
    const double value_x = (bv * cy - cv * by) * part, value_y = (bx * cv - cx * bv) * part;
    const double x = in_tile(a.x), y = in_tile(a.y);
    return {static_cast<float>(a.near + near_x * (x - a.x) + near_y * (y - a.y)),
            static_cast<float>(near_x),
            static_cast<float>(near_y),
            static_cast<float>(av + value_x * (x - a.x) + value_y * (y - a.y)),
            static_cast<float>(value_x),
            static_cast<float>(value_y),
            static_cast<float>(x - ray_x),
            static_cast<float>(y - ray_y)};
}

/// How far away a face is where a corner is seen, against that corner: it is in front if the corner lies behind.
inline bool is_front(const TetCorner& a, const TetCorner& b, const TetCorner& c, const TetCorner& opposite) {
    const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    const double part = 1 / divisible(bx * cy - cx * by), bn = b.near - a.near, cn = c.near - a.near;
    const double near_x = (bn * cy - cn * by) * part, near_y = (bx * cn - cx * bn) * part;
    return opposite.near < a.near + near_x * (opposite.x - a.x) + near_y * (opposite.y - a.y);
}

/// The planes of a tet of which a corner is nearer than `nearest`, in a perspective picture; it is cut there. False where
/// no ray passes.
bool planes_of_cut(const std::array<TetCorner, 4>& corners, double nearest, TetPlanes& out);

/// The planes of a tet before the eye. False where no ray passes.
template <bool parallel>
bool planes_of(const std::array<TetCorner, 4>& corners, TetPlanes& out) {
    const auto all = [&](auto member) {
        return std::minmax({corners[0].*member, corners[1].*member, corners[2].*member, corners[3].*member});
    };
    constexpr double last = volume_tile_side - 1;
    const auto [left, right] = all(&TetCorner::x);
    const auto [top, bottom] = all(&TetCorner::y);
    out.left = static_cast<std::int32_t>(std::min(std::max(std::ceil(left - ray_x), 0.0), last + 1));
    out.right = static_cast<std::int32_t>(std::max(std::min(std::floor(right - ray_x), last), -1.0));
    out.top = static_cast<std::int32_t>(std::min(std::max(std::ceil(top - ray_y), 0.0), last + 1));
    out.bottom = static_cast<std::int32_t>(std::max(std::min(std::floor(bottom - ray_y), last), -1.0));
    if (out.empty()) return false;
    out.fronts = out.backs = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const TetCorner &a = corners[faces_of_tet[k][0]], &b = corners[faces_of_tet[k][1]],
                        &c = corners[faces_of_tet[k][2]];
        const FacePlane plane = face_plane<parallel>(a, b, c);
        if (is_front(a, b, c, corners[k])) out.front[out.fronts++] = plane;
        else out.back[out.backs++] = plane;
    }
    if (out.fronts == 0 || out.backs == 0) return false;
    out.fill_up();
    const auto [farthest, nearest] = all(&TetCorner::near);
    out.farthest = static_cast<float>(farthest);
    out.nearest = static_cast<float>(nearest);
    const auto [lowest, highest] = all(&TetCorner::value);
    out.lowest = static_cast<float>(lowest);
    out.highest = static_cast<float>(highest);
    return true;
}

} // namespace isotet::render
