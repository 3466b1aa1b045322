// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A tet as planes over a tile, in double. Same as render/volume/tet_planes.hpp and cut_tet.cpp, name by name.
#ifndef ISOTET_VOLUME_PLANES_GLSL
#define ISOTET_VOLUME_PLANES_GLSL

#include "volume.glsl"

const double ray_x = 0.5LF + 3.0LF / 32768.0LF, ray_y = 0.5LF + 2.0LF / 32768.0LF;

struct Corner {
    double across, down, w, near, value;
    double x, y;
    uint local;
};

bool is_behind(Corner a, Corner b) {
    if (a.across != b.across) return a.across > b.across;
    if (a.down != b.down) return a.down > b.down;
    if (a.w != b.w) return a.w > b.w;
    if (a.near != b.near) return a.near > b.near;
    return a.value > b.value;
}

void put_in_order(inout Corner a, inout Corner b) {
    if (!is_behind(a, b)) return;
    const Corner other = a;
    a = b;
    b = other;
}

void sort_corners(inout Corner corners[4]) {
    put_in_order(corners[0], corners[1]);
    put_in_order(corners[2], corners[3]);
    put_in_order(corners[0], corners[2]);
    put_in_order(corners[1], corners[3]);
    put_in_order(corners[1], corners[2]);
}

double divisible(double determinant) {
    const double least = 1e-20LF;
    if (!(abs(determinant) < least)) return determinant;
    return (unpackDouble2x32(determinant).y & 0x80000000u) != 0u ? -least : least;
}

double in_tile(double at) { return lesser(greater(at, 0.0LF), double(tile_side - 1u) + 0.5LF); }

double minor_of(double ax, double by, double bx, double ay) {
    precise double minor = ax * by - bx * ay;
    return minor;
}

dvec3 cross_of(dvec3 a, dvec3 b) {
    return dvec3(minor_of(a.y, b.z, a.z, b.y), minor_of(a.z, b.x, a.x, b.z), minor_of(a.x, b.y, a.y, b.x));
}

double dot_of(dvec3 a, dvec3 b) {
    precise double sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
}

dvec3 minus(dvec3 a, dvec3 b) {
    precise dvec3 difference = a - b;
    return difference;
}

dvec3 scaled(dvec3 v, double factor) {
    precise dvec3 product = v * factor;
    return product;
}

/// a + times * b
dvec3 plus(dvec3 a, dvec3 b, double times) {
    precise dvec3 sum = a + times * b;
    return sum;
}

/// What is linear in the picture.
double value_in_picture(Corner corner) {
    precise double weighted = corner.value * corner.near;
    return parallel ? corner.value : weighted;
}

/// A face whose corners are all before the eye. `front`: the opposite corner lies behind it.
VolumeFace face_plane(Corner a, Corner b, Corner c, Corner opposite, out bool front) {
    precise double bx = b.x - a.x;
    precise double by = b.y - a.y;
    precise double cx = c.x - a.x;
    precise double cy = c.y - a.y;
    const double part = quotient(1.0LF, divisible(minor_of(bx, cy, cx, by)));
    const double av = value_in_picture(a);
    precise double bv = value_in_picture(b) - av;
    precise double cv = value_in_picture(c) - av;
    precise double bn = b.near - a.near;
    precise double cn = c.near - a.near;
    precise double near_x = minor_of(bn, cy, cn, by) * part;
    precise double near_y = minor_of(bx, cn, cx, bn) * part;
    precise double value_x = minor_of(bv, cy, cv, by) * part;
    precise double value_y = minor_of(bx, cv, cx, bv) * part;
    const double x = in_tile(a.x), y = in_tile(a.y);
    precise double near = a.near + near_x * (x - a.x) + near_y * (y - a.y);
    precise double value = av + value_x * (x - a.x) + value_y * (y - a.y);
    precise double to_x = x - ray_x;
    precise double to_y = y - ray_y;
    precise double before = a.near + near_x * (opposite.x - a.x) + near_y * (opposite.y - a.y);
    front = opposite.near < before;
    return VolumeFace(float(near), float(near_x), float(near_y), float(value), float(value_x), float(value_y),
                      float(to_x), float(to_y));
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
    double least, most;
};

Bounds bounds_of(double a, double b, double c, double d) {
    return Bounds(lesser(lesser(a, b), lesser(c, d)), greater(greater(a, b), greater(c, d)));
}

/// The first pixel from `from` on.
int first_pixel(double from, double beside) {
    precise double at = from - beside;
    return int(lesser(greater(ceil(at), 0.0LF), double(tile_side)));
}

int last_pixel(double to, double beside) {
    precise double at = to - beside;
    return int(greater(lesser(floor(at), double(tile_side - 1u)), -1.0LF));
}

const uint no_box = 1u; ///< left > right

/// Which pixels of the tile the rays of a tet before the eye have; no_box: none of the block, whose first pixel is `block`.
uint box_of(Corner corners[4], ivec2 block) {
    const Bounds x = bounds_of(corners[0].x, corners[1].x, corners[2].x, corners[3].x);
    const Bounds y = bounds_of(corners[0].y, corners[1].y, corners[2].y, corners[3].y);
    const int left = first_pixel(x.least, ray_x), right = last_pixel(x.most, ray_x);
    const int top = first_pixel(y.least, ray_y), bottom = last_pixel(y.most, ray_y);
    if (max(left, block.x) > min(right, block.x + int(block_width) - 1) ||
        max(top, block.y) > min(bottom, block.y + int(block_height) - 1))
        return no_box;
    return uint(left | top << 8 | right << 16 | bottom << 24);
}

void add_face_before(Corner a, Corner b, Corner c, Corner opposite, inout Writer to) {
    bool front;
    const VolumeFace face = face_plane(a, b, c, opposite, front);
    add_face(face, front, to);
}

/// The planes of a tet before the eye.
void write_planes(Corner corners[4], inout Writer to) {
    add_face_before(corners[1], corners[2], corners[3], corners[0], to);
    add_face_before(corners[0], corners[2], corners[3], corners[1], to);
    add_face_before(corners[0], corners[1], corners[3], corners[2], to);
    add_face_before(corners[0], corners[1], corners[2], corners[3], to);
    const Bounds near = bounds_of(corners[0].near, corners[1].near, corners[2].near, corners[3].near);
    to.planes.at[to.tet].farthest = float(near.least);
    to.planes.at[to.tet].nearest = float(near.most);
}

dvec3 across_of(Corner corner) { return dvec3(corner.across, corner.down, corner.w); }

/// normal . (x, y, 1) around the middle of the tile.
float at_middle(dvec3 v) {
    const double middle = 0.5LF * double(tile_side);
    precise double at = (v.x + v.y) * middle + v.z;
    return float(at);
}

VolumeFace plane_of(dvec3 near, dvec3 value) {
    const double middle = 0.5LF * double(tile_side);
    precise double to_x = middle - ray_x;
    precise double to_y = middle - ray_y;
    return VolumeFace(at_middle(near), float(near.x), float(near.y), at_middle(value), float(value.x), float(value.y),
                      float(to_x), float(to_y));
}

void add_face_of_cut(Corner one, Corner two, Corner three, Corner opposite, double nearest, inout Writer to) {
    const dvec3 a = across_of(one), b = across_of(two), c = across_of(three);
    const dvec3 normal = cross_of(minus(b, a), minus(c, a));
    const double offset = divisible(dot_of(normal, a));
    precise double side = dot_of(normal, across_of(opposite)) - offset;
    precise double sign_ = offset * side;
    const bool front = sign_ > 0.0LF;
    if (lesser(lesser(one.w, two.w), three.w) >= nearest) {
        bool same;
        add_face(face_plane(one, two, three, opposite, same), front, to);
        return;
    }
    const dvec3 value =
        plus(plus(scaled(cross_of(b, c), one.value), cross_of(c, a), two.value), cross_of(a, b), three.value);
    const double part = quotient(1.0LF, offset);
    add_face(plane_of(scaled(normal, part), scaled(value, part)), front, to);
}

/// Where the tet is cut.
VolumeFace cut_face(Corner corners[4], double nearest) {
    const dvec3 a = across_of(corners[0]), b = minus(across_of(corners[1]), a), c = minus(across_of(corners[2]), a),
                d = minus(across_of(corners[3]), a);
    const double determinant = divisible(dot_of(b, cross_of(c, d)));
    precise double rise_b = corners[1].value - corners[0].value;
    precise double rise_c = corners[2].value - corners[0].value;
    precise double rise_d = corners[3].value - corners[0].value;
    const dvec3 gradient = scaled(plus(plus(scaled(cross_of(c, d), rise_b), cross_of(d, b), rise_c), cross_of(b, c), rise_d),
                                  quotient(1.0LF, determinant));
    precise double rest = corners[0].value - dot_of(gradient, a);
    const double near = quotient(1.0LF, nearest);
    precise double rest_near = rest * near;
    return plane_of(dvec3(0.0LF, 0.0LF, near), plus(gradient, dvec3(0.0LF, 0.0LF, 1.0LF), rest_near));
}

/// All corners are on one side of the tile.
bool is_beside(Corner corners[4]) {
    bool left = true, above = true, right = true, below = true;
    for (int k = 0; k < 4; ++k) {
        precise double end = double(tile_side) * corners[k].w;
        left = left && corners[k].across < 0.0LF;
        above = above && corners[k].down < 0.0LF;
        right = right && corners[k].across > end;
        below = below && corners[k].down > end;
    }
    return left || above || right || below;
}

double farthest_of(Corner corners[4]) {
    return greater(greater(greater(greater(0.0LF, corners[0].w), corners[1].w), corners[2].w), corners[3].w);
}

/// Of a tet of which a corner is nearer than `nearest` any pixel of the tile may have rays; no_box: none has.
uint box_of_cut(Corner corners[4], double nearest) {
    if (farthest_of(corners) <= nearest || is_beside(corners)) return no_box;
    return (tile_side - 1u) << 16 | (tile_side - 1u) << 24;
}

void write_planes_of_cut(Corner corners[4], double nearest, inout Writer to) {
    add_face(cut_face(corners, nearest), true, to);
    add_face_of_cut(corners[1], corners[2], corners[3], corners[0], nearest, to);
    add_face_of_cut(corners[0], corners[2], corners[3], corners[1], nearest, to);
    add_face_of_cut(corners[0], corners[1], corners[3], corners[2], nearest, to);
    add_face_of_cut(corners[0], corners[1], corners[2], corners[3], nearest, to);
    to.planes.at[to.tet].farthest = float(quotient(1.0LF, farthest_of(corners)));
    to.planes.at[to.tet].nearest = float(quotient(1.0LF, nearest));
}

/// The direction in which the values of a tet rise or fall, of length 1; 0 where they do not.
vec3 gradient_direction(Corner corners[4], dvec3 first, dvec3 second, dvec3 third, dvec3 fourth) {
    const dvec3 a = minus(second, first), b = minus(third, first), c = minus(fourth, first);
    precise double rise_a = corners[1].value - corners[0].value;
    precise double rise_b = corners[2].value - corners[0].value;
    precise double rise_c = corners[3].value - corners[0].value;
    const dvec3 sum = plus(plus(scaled(cross_of(b, c), rise_a), cross_of(c, a), rise_b), cross_of(a, b), rise_c);
    const double length_ = square_root(dot_of(sum, sum));
    if (!(length_ > 0.0LF)) return vec3(0.0);
    return vec3(quotient(sum.x, length_), quotient(sum.y, length_), quotient(sum.z, length_));
}

#endif
