// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A tet as planes over a tile, in double. Same as render/volume/tet_planes.hpp and cut_tet.cpp, name by name; what these make
// of each corner is made once for each point of a cluster.
#ifndef ISOTET_VOLUME_PLANES_GLSL
#define ISOTET_VOLUME_PLANES_GLSL

#include "volume.glsl"

/// The points of a cluster, an invocation each. `at_linear`: the value as it is linear in the picture.
const uint at_across = 0u, at_down = 1u, at_w = 2u, at_near = 3u, at_linear = 4u, at_x = 5u, at_y = 6u;
shared Double point[7][block_size];
shared float point_value[block_size];

const float ray_x = 0.5 + 3.0 / 32768.0, ray_y = 0.5 + 2.0 / 32768.0; // exactly

/// By across, down, w, near and value: the first in which they differ.
bool is_behind(uint a, uint b) {
    bool behind = point_value[a] > point_value[b];
    ISOTET_SHORT_LOOP for (uint k = 4u; k > 0u; --k)
        behind = is_less(point[k - 1u][b], point[k - 1u][a]) || (behind && !is_less(point[k - 1u][a], point[k - 1u][b]));
    return behind;
}

/// Corners are points of the cluster.
void sort_corners(inout uvec4 corners) {
    const uint pairs[5] = uint[](0x10u, 0x32u, 0x20u, 0x31u, 0x21u);
    ISOTET_SHORT_LOOP for (uint step_ = 0u; step_ < 5u; ++step_) {
        const uint i = pairs[step_] & 0xfu, j = pairs[step_] >> 4;
        const uint a = corners[i], b = corners[j];
        const bool behind = is_behind(a, b);
        corners[i] = behind ? b : a;
        corners[j] = behind ? a : b;
    }
}

Double divisible(Double determinant) {
    const Double least = double_of_bits(0x3bc79ca1u, 0x0c924223u); // 1e-20
    const Double small = chosen(is_negative(determinant), negated(least), least);
    return chosen(is_less(absolute(determinant), least), small, determinant);
}

Double in_tile(Double at) {
    return lesser(greater(at, double_of(0.0)), double_of(float(tile_side - 1u) + 0.5));
}

/// ax * by - bx * ay
Double minor_of(Double ax, Double by, Double bx, Double ay) {
    return difference_of(product_of(ax, by), product_of(bx, ay));
}

struct Triple {
    Double x, y, z;
};

// What is done for each part of a vector: the parts go round, and results come in from behind.

Triple turned(Triple v) { return Triple(v.y, v.z, v.x); }

Triple cross_of(Triple a, Triple b) {
    Triple product = a;
    ISOTET_SHORT_LOOP for (uint i = 0u; i < 3u; ++i) {
        product = Triple(product.y, product.z, minor_of(a.y, b.z, a.z, b.y));
        a = turned(a);
        b = turned(b);
    }
    return product;
}

Double dot_of(Triple a, Triple b) {
    Double sum = negated(double_of(0.0)); // which leaves any other 0 as it is
    ISOTET_SHORT_LOOP for (uint i = 0u; i < 3u; ++i) {
        sum = sum_of(sum, product_of(a.x, b.x));
        a = turned(a);
        b = turned(b);
    }
    return sum;
}

Triple minus(Triple a, Triple b) {
    ISOTET_SHORT_LOOP for (uint i = 0u; i < 3u; ++i) {
        a = Triple(a.y, a.z, difference_of(a.x, b.x));
        b = turned(b);
    }
    return a;
}

Triple scaled(Triple v, Double factor) {
    ISOTET_SHORT_LOOP for (uint i = 0u; i < 3u; ++i) v = Triple(v.y, v.z, product_of(v.x, factor));
    return v;
}

/// a + times * b
Triple plus(Triple a, Triple b, Double times) {
    ISOTET_SHORT_LOOP for (uint i = 0u; i < 3u; ++i) {
        a = Triple(a.y, a.z, sum_of(a.x, product_of(times, b.x)));
        b = turned(b);
    }
    return a;
}

/// zero + times.x * (b x c) + times.y * (c x a) + times.z * (a x b)
Triple sum_of_crosses(Double zero, Triple a, Triple b, Triple c, Triple times) {
    Triple sum = Triple(zero, zero, zero);
    ISOTET_SHORT_LOOP for (uint i = 0u; i < 3u; ++i) {
        sum = plus(sum, cross_of(b, c), times.x);
        const Triple first = a;
        a = b;
        b = c;
        c = first;
        times = turned(times);
    }
    return sum;
}

/// From the first corner to the others.
Triple rises_of(uvec4 corners) {
    const Double first = double_of(point_value[corners.x]);
    return minus(Triple(double_of(point_value[corners.y]), double_of(point_value[corners.z]),
                        double_of(point_value[corners.w])),
                 Triple(first, first, first));
}

/// Three corners in their order, and the fourth.
struct Face {
    uint a, b, c, opposite;
};

Face face_of(uvec4 corners, uint opposite) {
    return Face(opposite == 0u ? corners.y : corners.x, opposite < 2u ? corners.z : corners.y,
                opposite < 3u ? corners.w : corners.z, corners[opposite]);
}

/// A face whose corners are all before the eye, around a place in or near the tile.
struct FaceFrame {
    Double bx, by, cx, cy, part; ///< from the first corner; 1 / determinant
    Double x, y;                 ///< from the first corner to the place
};

/// A number that is linear along a face.
struct Slopes {
    Double at, per_x, per_y; ///< at the first corner
};

Slopes slopes_of(FaceFrame face, Double a, Double b, Double c) {
    const Double to_b = difference_of(b, a), to_c = difference_of(c, a);
    return Slopes(a, product_of(minor_of(to_b, face.cy, to_c, face.by), face.part),
                  product_of(minor_of(face.bx, to_c, face.cx, to_b), face.part));
}

Double number_at(Slopes slopes, Double x, Double y) {
    return sum_of(sum_of(slopes.at, product_of(slopes.per_x, x)), product_of(slopes.per_y, y));
}

/// `front`: the opposite corner lies behind it.
VolumeFace face_plane(Face face, out bool front) {
    const Double ax = point[at_x][face.a], ay = point[at_y][face.a];
    const Double place_x = in_tile(ax), place_y = in_tile(ay);
    const Double opposite_x = difference_of(point[at_x][face.opposite], ax),
                 opposite_y = difference_of(point[at_y][face.opposite], ay);
    FaceFrame frame;
    frame.bx = difference_of(point[at_x][face.b], ax);
    frame.by = difference_of(point[at_y][face.b], ay);
    frame.cx = difference_of(point[at_x][face.c], ax);
    frame.cy = difference_of(point[at_y][face.c], ay);
    frame.part = quotient(double_of(1.0), divisible(minor_of(frame.bx, frame.cy, frame.cx, frame.by)));
    frame.x = difference_of(place_x, ax);
    frame.y = difference_of(place_y, ay);
    front = false;
    vec3 nearness = vec3(0.0), value = vec3(0.0);
    ISOTET_SHORT_LOOP for (uint which = at_near; which <= at_linear; ++which) {
        const Slopes slopes = slopes_of(frame, point[which][face.a], point[which][face.b], point[which][face.c]);
        if (which == at_near) front = is_less(point[at_near][face.opposite], number_at(slopes, opposite_x, opposite_y));
        nearness = value;
        value = vec3(float_of(number_at(slopes, frame.x, frame.y)), float_of(slopes.per_x), float_of(slopes.per_y));
    }
    return VolumeFace(nearness.x, nearness.y, nearness.z, value.x, value.y, value.z,
                      float_of(difference_of(place_x, double_of(ray_x))), float_of(difference_of(place_y, double_of(ray_y))));
}

/// The planes of one tet. Front faces begin with the first, others end with the last.
struct Writer {
    PlanesAt planes;
    uint tet, fronts, backs;
};

void add_face(VolumeFace face, bool front, inout Writer to) {
    to.planes.at[to.tet].faces[front ? to.fronts : 4u - to.backs] = face;
    to.fronts += front ? 1u : 0u;
    to.backs += front ? 0u : 1u;
}

struct Bounds {
    Double least, most;
};

/// Of a number of the corners.
Bounds bounds_of(uint which, uvec4 corners) {
    Bounds bounds = Bounds(point[which][corners.x], point[which][corners.x]);
    ISOTET_SHORT_LOOP for (uint k = 1u; k < 4u; ++k) {
        const Double other = point[which][corners[k]];
        bounds = Bounds(lesser(bounds.least, other), greater(bounds.most, other));
    }
    return bounds;
}

/// The first pixel from `from` on.
int first_pixel(Double from, float beside) {
    const Double at = difference_of(from, double_of(beside));
    if (!is_less(double_of(0.0), at)) return 0;
    if (is_less(double_of(float(tile_side)), at)) return int(tile_side);
    const uint whole = whole_of(at);
    return int(whole) + (is_less(double_of(float(whole)), at) ? 1 : 0);
}

int last_pixel(Double to, float beside) {
    const Double at = difference_of(to, double_of(beside));
    if (is_less(at, double_of(0.0))) return -1;
    if (is_less(double_of(float(tile_side)), at)) return int(tile_side) - 1;
    return min(int(whole_of(at)), int(tile_side) - 1);
}

const uint no_box = 1u; ///< left > right

/// Which pixels of the tile the rays of a tet before the eye have; no_box: none of the block, whose first pixel is `block`.
uint box_of(uvec4 corners, ivec2 block) {
    ivec2 first = ivec2(0), last = ivec2(0);
    ISOTET_SHORT_LOOP for (uint axis = at_x; axis <= at_y; ++axis) {
        const Bounds bounds = bounds_of(axis, corners);
        const float beside = axis == at_x ? ray_x : ray_y;
        first = ivec2(first.y, first_pixel(bounds.least, beside));
        last = ivec2(last.y, last_pixel(bounds.most, beside));
    }
    if (any(greaterThan(max(first, block), min(last, block + ivec2(block_width - 1u, block_height - 1u)))))
        return no_box;
    return uint(first.x | first.y << 8 | last.x << 16 | last.y << 24);
}

Triple across_of(uint corner) { return Triple(point[at_across][corner], point[at_down][corner], point[at_w][corner]); }

/// normal . (x, y, 1) around the middle of the tile.
float at_middle(Triple v) {
    return float_of(sum_of(product_of(sum_of(v.x, v.y), double_of(0.5 * float(tile_side))), v.z));
}

VolumeFace plane_of(Triple nearness, Triple value) {
    const float middle = 0.5 * float(tile_side);
    return VolumeFace(at_middle(nearness), float_of(nearness.x), float_of(nearness.y), at_middle(value),
                      float_of(value.x), float_of(value.y), middle - ray_x, middle - ray_y);
}

bool is_before_eye(Face face, Double nearest) {
    return !(is_less(point[at_w][face.a], nearest) || is_less(point[at_w][face.b], nearest) ||
             is_less(point[at_w][face.c], nearest));
}

/// A face of a tet that is cut; its plane, too, if it is not before the eye. `front`: the opposite corner lies behind it.
void find_face_of_cut(Face face, bool before, inout VolumeFace plane, out bool front) {
    const Triple a = across_of(face.a), b = across_of(face.b), c = across_of(face.c);
    const Triple normal = cross_of(minus(b, a), minus(c, a));
    const Double offset = divisible(dot_of(normal, a));
    const Double side = difference_of(dot_of(normal, across_of(face.opposite)), offset);
    front = is_less(double_of(0.0), product_of(offset, side));
    if (before) return;
    const Triple value =
        sum_of_crosses(negated(double_of(0.0)), a, b, c,
                       Triple(double_of(point_value[face.a]), double_of(point_value[face.b]),
                              double_of(point_value[face.c])));
    const Double part = quotient(double_of(1.0), offset);
    plane = plane_of(scaled(normal, part), scaled(value, part));
}

/// Where the tet is cut.
VolumeFace cut_face(uvec4 corners, Double nearest) {
    const Triple a = across_of(corners.x), b = minus(across_of(corners.y), a), c = minus(across_of(corners.z), a),
                 d = minus(across_of(corners.w), a);
    const Double determinant = divisible(dot_of(b, cross_of(c, d)));
    const Triple gradient = scaled(sum_of_crosses(negated(double_of(0.0)), b, c, d, rises_of(corners)),
                                   quotient(double_of(1.0), determinant));
    const Double rest = difference_of(double_of(point_value[corners.x]), dot_of(gradient, a));
    const Double nearness = quotient(double_of(1.0), nearest), zero = double_of(0.0);
    return plane_of(Triple(zero, zero, nearness),
                    plus(gradient, Triple(zero, zero, double_of(1.0)), product_of(rest, nearness)));
}

/// All corners are on one side of the tile.
bool is_beside(uvec4 corners) {
    bool left = true, above = true, right = true, below = true;
    ISOTET_SHORT_LOOP for (uint k = 0u; k < 4u; ++k) {
        const Triple at = across_of(corners[k]);
        const Double end = product_of(double_of(float(tile_side)), at.z);
        left = left && is_less(at.x, double_of(0.0));
        above = above && is_less(at.y, double_of(0.0));
        right = right && is_less(end, at.x);
        below = below && is_less(end, at.y);
    }
    return left || above || right || below;
}

Double farthest_of(uvec4 corners) {
    return greater(double_of(0.0), bounds_of(at_w, corners).most);
}

/// Of a tet of which a corner is nearer than `nearest` any pixel of the tile may have rays; no_box: none has.
uint box_of_cut(uvec4 corners, Double nearest) {
    if (!is_less(nearest, farthest_of(corners)) || is_beside(corners)) return no_box;
    return (tile_side - 1u) << 16 | (tile_side - 1u) << 24;
}

/// The planes of a tet, in order.
void write_planes(uvec4 corners, bool cut, Double nearest, inout Writer to) {
    if (cut) {
        add_face(cut_face(corners, nearest), true, to);
        to.planes.at[to.tet].farthest = float_of(quotient(double_of(1.0), farthest_of(corners)));
        to.planes.at[to.tet].nearest = float_of(quotient(double_of(1.0), nearest));
    } else {
        const Bounds bounds = bounds_of(at_near, corners);
        to.planes.at[to.tet].farthest = float_of(bounds.least);
        to.planes.at[to.tet].nearest = float_of(bounds.most);
    }
    ISOTET_SHORT_LOOP for (uint k = 0u; k < 4u; ++k) {
        const Face face = face_of(corners, k);
        VolumeFace plane;
        bool front = false;
        const bool before = !cut || is_before_eye(face, nearest);
        if (before) plane = face_plane(face, front);
        if (cut) find_face_of_cut(face, before, plane, front);
        add_face(plane, front, to);
    }
}

/// The direction in which the values of a tet rise or fall, of length 1; 0 where they do not.
vec3 gradient_direction(uvec4 corners, Triple first, Triple second, Triple third, Triple fourth) {
    Triple sum = sum_of_crosses(double_of(0.0), minus(second, first), minus(third, first), minus(fourth, first),
                                rises_of(corners));
    const Double length_ = square_root(dot_of(sum, sum));
    if (!is_less(double_of(0.0), length_)) return vec3(0.0);
    vec3 direction = vec3(0.0);
    ISOTET_SHORT_LOOP for (uint i = 0u; i < 3u; ++i) {
        direction = vec3(direction.yz, float_of(quotient(sum.x, length_)));
        sum = turned(sum);
    }
    return direction;
}

#endif
