// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Follows the rays of a block of pixels, an invocation each: what they meet in tets, in lists that are composed in order, or
// the nearest isosurface. Same as render/volume/volume_tile.cpp; docs/inside/render.md.
//
// Lists need no order, since the nearest segment is sought whenever one is composed, by all its numbers. Nothing depends on
// which invocation is faster.
#ifndef ISOTET_VOLUME_RAYS_GLSL
#define ISOTET_VOLUME_RAYS_GLSL

#include "volume_light.glsl"
#include "volume_planes.glsl"
#include "shared/groups.glsl"

layout(local_size_x = 128) in;

shared uint planes_found, rays_left, lists_full, tets_drawn, segments_found;

/// A pixel and its ray.
struct Ray {
    float nearest, end; ///< between which something is seen
    vec3 to_eye;
    uint pixel;
    uint segments;      ///< in its list
    uint first_stop, stops;
};

/// The list of the invocation: its segments are block_size apart.
struct List {
    Quads segments;     ///< enter, leave, from, to
    Words marks;
};

uint place_in(uint segment) { return segment * block_size + gl_LocalInvocationIndex; }

Triple position_of(VolumePlace volume, uint number) {
    Doubles at = Doubles(advance(volume.positions, number, 24u));
    return Triple(at.at[0], at.at[1], at.at[2]);
}

/// `rows`: those of the VolumePlace, one behind the other.
void place_point(VolumePlace volume, Doubles rows, VolumeTileAt tile, uint number) {
    const uint local = gl_LocalInvocationIndex;
    const Triple p = position_of(volume, number);
    const uint count = parallel ? 4u : 3u; // the depth is the last
    ISOTET_SHORT_LOOP for (uint row = 0u; row < count; ++row)
        point[row][local] = sum_of(dot_of(Triple(rows.at[4u * row], rows.at[4u * row + 1u], rows.at[4u * row + 2u]), p),
                                   rows.at[4u * row + 3u]);
    const float value = Floats(advance(volume.values, number, 4u)).at[0];
    const Double w = point[at_w][local];
    if (parallel) point[at_near][local] = negated(point[at_near][local]);
    else point[at_near][local] = quotient(double_of(1.0), w);
    ISOTET_SHORT_LOOP for (uint axis = 0u; axis < 2u; ++axis) {
        const float corner = float(axis == 0u ? tile.x : tile.y);
        const Double at = difference_of(point[axis][local], product_of(double_of(corner), w));
        point[axis][local] = at;
        if (parallel) point[at_x + axis][local] = at;
        else point[at_x + axis][local] = product_of(at, point[at_near][local]);
    }
    point_value[local] = value;
    if (parallel) point[at_linear][local] = double_of(value);
    else point[at_linear][local] = product_of(double_of(value), point[at_near][local]);
}

/// Adds the planes of a tet to those of the workgroup, if rays of the block may pass it.
void add_planes(VolumeScene scene, VolumePlace volume, uint first_point, uint tet, ivec2 block, PlanesAt planes) {
    uvec4 corners = uvec4(tet, tet >> 8, tet >> 16, tet >> 24) & 0xffu;
    bool cut = false;
    if (!parallel)
        ISOTET_SHORT_LOOP for (uint k = 0u; k < 4u; ++k) cut = cut || is_less(point[at_w][corners[k]], scene.nearest);
    uint box;
    if (cut) box = box_of_cut(corners, scene.nearest);
    else box = box_of(corners, block);
    if (box == no_box) return;
    sort_corners(corners);
    Writer to = Writer(planes, atomicAdd(planes_found, 1u), 0u, 0u);
    write_planes(corners, cut, scene.nearest, to);
    const vec4 values =
        vec4(point_value[corners.x], point_value[corners.y], point_value[corners.z], point_value[corners.w]);
    planes.at[to.tet].lowest = lesser(lesser(values.x, values.y), lesser(values.z, values.w));
    planes.at[to.tet].highest = greater(greater(values.x, values.y), greater(values.z, values.w));
    planes.at[to.tet].fronts = to.fronts;
    planes.at[to.tet].backs = to.backs;
    planes.at[to.tet].box = to.fronts == 0u || to.backs == 0u ? no_box : box;
    vec3 normal = vec3(0.0);
    if (seeks_isosurfaces || volume.shaded != 0u)
        normal = gradient_direction(corners, position_of(volume, first_point + corners.x),
                                    position_of(volume, first_point + corners.y),
                                    position_of(volume, first_point + corners.z),
                                    position_of(volume, first_point + corners.w));
    planes.at[to.tet].normal[0] = normal.x;
    planes.at[to.tet].normal[1] = normal.y;
    planes.at[to.tet].normal[2] = normal.z;
}

float near_at(VolumeFace face, vec2 pixel) {
    precise float at = face.near + face.near_per_x * (pixel.x - face.x) + face.near_per_y * (pixel.y - face.y);
    return at;
}

float value_at(VolumeFace face, vec2 pixel) {
    precise float at = face.value + face.value_per_x * (pixel.x - face.x) + face.value_per_y * (pixel.y - face.y);
    return at;
}

/// Of the corners of a tet.
struct Limits {
    float farthest, nearest, lowest, highest;
};

/// From nearness and value times nearness to distance and value, within those of the corners.
vec2 distance_of(Limits limits, float near, float value) {
    const float below = near < limits.nearest ? near : limits.nearest;
    const float within = below > limits.farthest ? below : limits.farthest;
    const float distance_ = parallel ? -within : divide(1.0, within);
    precise float times = value * distance_;
    const float whole = parallel ? value : times;
    const float lower = whole < limits.highest ? whole : limits.highest;
    return vec2(distance_, lower > limits.lowest ? lower : limits.lowest);
}

/// The way of the ray of a pixel through a tet: enter, leave, from, to. Nowhere where it does not enter before it leaves.
vec4 way_through(PlanesAt all, uint tet, ivec2 at) {
    const uint box = all.at[tet].box;
    if (at.x < int(box & 0xffu) || at.y < int(box >> 8 & 0xffu) || at.x > int(box >> 16 & 0xffu) ||
        at.y > int(box >> 24))
        return vec4(0.0);
    const vec2 pixel = vec2(at);
    const Limits limits =
        Limits(all.at[tet].farthest, all.at[tet].nearest, all.at[tet].lowest, all.at[tet].highest);
    float enter = near_at(all.at[tet].faces[0], pixel), from = value_at(all.at[tet].faces[0], pixel);
    const uint fronts = all.at[tet].fronts, backs = all.at[tet].backs;
    for (uint k = 1u; k < fronts; ++k) {
        const float near = near_at(all.at[tet].faces[k], pixel), value = value_at(all.at[tet].faces[k], pixel);
        from = near < enter ? value : near == enter && value < from ? value : from;
        enter = near < enter ? near : enter;
    }
    float leave = near_at(all.at[tet].faces[4], pixel), to = value_at(all.at[tet].faces[4], pixel);
    for (uint k = 1u; k < backs; ++k) {
        const float near = near_at(all.at[tet].faces[4u - k], pixel), value = value_at(all.at[tet].faces[4u - k], pixel);
        to = near > leave ? value : near == leave && value < to ? value : to;
        leave = near > leave ? near : leave;
    }
    const vec2 first = distance_of(limits, enter, from), last = distance_of(limits, leave, to);
    return vec4(first.x, last.x, first.y, last.y);
}

/// How much light a ray gets from what lies across a gradient, lit on both sides.
float light_along(vec3 normal, vec3 to_eye, vec3 up) {
    precise float facing = normal.x * to_eye.x + normal.y * to_eye.y + normal.z * to_eye.z;
    if (facing < 0.0) {
        normal = -normal;
        precise float other = normal.x * to_eye.x + normal.y * to_eye.y + normal.z * to_eye.z;
        facing = other;
    }
    const float within = facing < 0.0 ? 0.0 : facing > 1.0 ? 1.0 : facing;
    precise float sky = 0.5 + 0.5 * (normal.x * up.x + normal.y * up.y + normal.z * up.z);
    precise float light = 0.16 + 0.84 * within + 0.22 * sky * (1.0 - within);
    return light;
}

/// 16 bits of light; all of it without a side.
uint light_of(PlanesAt all, uint tet, vec3 to_eye, vec3 up) {
    const vec3 normal = vec3(all.at[tet].normal[0], all.at[tet].normal[1], all.at[tet].normal[2]);
    if (normal == vec3(0.0)) return 65535u;
    precise float steps = lesser(light_along(normal, to_eye, up), 1.0) * 65535.0 + 0.5;
    return uint(steps);
}

/// Between which distances a volume is seen along the ray.
vec2 window_of(VolumePlace volume, Ray ray) {
    if (volume.windows == Address(0u)) return vec2(ray.nearest, ISOTET_INFINITY);
    Floats at = Floats(advance(volume.windows, ray.pixel, 8u));
    return vec2(at.at[0], at.at[1]);
}

/// Whether segment i of the list comes before another, of an equal beginning.
bool is_before(List list, uint i, uint other) {
    const vec4 a = list.segments.at[place_in(i)], b = list.segments.at[place_in(other)];
    if (a.y != b.y) return a.y < b.y;
    if (a.z != b.z) return a.z < b.z;
    if (a.w != b.w) return a.w < b.w;
    return list.marks.at[place_in(i)] < list.marks.at[place_in(other)];
}

void go_to_slab(VolumeScene scene, Ray ray, uint slab, inout Composed state) {
    if (slab == state.slab) return;
    Quads slabs = Quads(advance(scene.slabs, ray.first_stop + ray.pixel, 16u));
    slabs.at[state.slab] = state.light;
    state.light = slabs.at[slab];
    state.slab = slab;
}

/// Adds a segment, cut by the ends of the ray and by sheets.
void add_segment(VolumeScene scene, vec4 way, uint mark, Ray ray, inout Composed state) {
    VolumePlace volume = PlacesAt(scene.volumes).at[mark & 0xffffu];
    const vec2 window = window_of(volume, ray);
    const float begin = greater(way.x, greater(ray.nearest, window.x)),
                end = lesser(way.y, lesser(ray.end, window.y));
    if (!(begin < end)) return;
    const float light = divide(float(mark >> 16), 65535.0);
    precise float rise = way.w - way.z;
    precise float run = way.y - way.x;
    const float slope = divide(rise, run);
    Floats stops = Floats(advance(scene.stops, ray.first_stop, 4u));
    uint slab = 0u;
    while (slab < ray.stops && !(begin < stops.at[slab])) ++slab;
    for (float at = begin; at < end && !state.done; ++slab) {
        const float next = slab < ray.stops ? lesser(stops.at[slab], end) : end;
        precise float from = way.z + slope * (at - way.x);
        precise float to = way.z + slope * (next - way.x);
        precise float length_ = (next - at) * state.lengths;
        go_to_slab(scene, ray, slab, state);
        add_to_slab(length_, at == way.x ? way.z : from, next == way.y ? way.w : to, light, RowsAt(volume.table), state);
        at = next;
    }
}

/// Composes what begins before a distance.
void compose(VolumeScene scene, List list, float horizon, inout Ray ray, inout Composed state) {
    while (ray.segments > 0u && !state.done) {
        uint nearest = 0u;
        float enter = list.segments.at[place_in(0u)].x;
        for (uint i = 1u; i < ray.segments; ++i) {
            const float other = list.segments.at[place_in(i)].x;
            if (other < enter || (other == enter && is_before(list, i, nearest))) {
                nearest = i;
                enter = other;
            }
        }
        if (!(enter < horizon)) return;
        const vec4 way = list.segments.at[place_in(nearest)];
        const uint mark = list.marks.at[place_in(nearest)];
        --ray.segments;
        list.segments.at[place_in(nearest)] = list.segments.at[place_in(ray.segments)];
        list.marks.at[place_in(nearest)] = list.marks.at[place_in(ray.segments)];
        add_segment(scene, way, mark, ray, state);
    }
    if (!state.done) return;
    ray.segments = 0u;
    ray.end = -ISOTET_INFINITY;
}

bool is_nearer(VolumeHit a, VolumeHit b) {
    if (a.distance != b.distance) return a.distance < b.distance;
    for (int k = 0; k < 3; ++k)
        if (a.normal[k] != b.normal[k]) return a.normal[k] < b.normal[k];
    if (a.volume != b.volume) return a.volume < b.volume;
    return a.isosurface < b.isosurface;
}

/// The nearest of the isosurfaces that the ray meets in a tet, and that it met before.
void find_hits(VolumePlace volume, uint number, PlanesAt all, uint tet, vec4 way, Ray ray, inout VolumeHit hit) {
    const vec2 window = window_of(volume, ray);
    Floats heights = Floats(volume.heights);
    precise float length_ = way.y - way.x;
    precise float rise = way.w - way.z;
    for (uint which = 0u; which < volume.isosurfaces; ++which) {
        const float height = heights.at[which];
        if ((way.z < height) == (way.w < height)) continue;
        precise float above = height - way.z;
        precise float distance_ = way.x + divide(above, rise) * length_;
        if (distance_ > ray.end || distance_ < ray.nearest) continue;
        if (distance_ < window.x || distance_ > window.y) continue;
        VolumeHit found;
        found.distance = distance_;
        for (int k = 0; k < 3; ++k) found.normal[k] = all.at[tet].normal[k];
        found.volume = number;
        found.isosurface = which;
        if (is_nearer(found, hit)) hit = found;
    }
}

void main() {
    const uint group = group_index(), local = gl_LocalInvocationIndex;
    if (group >= push.count) return;
    const VolumeScene scene = SceneAt(push.scene).scene;
    const uint number = Words(advance(scene.blocks, push.first + group, 4u)).at[0];
    const uint tile_number = number / blocks_per_tile, in_tile_ = number % blocks_per_tile;
    const VolumeTileAt tile = TilesAt(scene.tiles).at[tile_number];
    const ivec2 block = ivec2(in_tile_ % 2u * block_width, in_tile_ / 2u * block_height);
    const ivec2 at = block + ivec2(local % block_width, local / block_width);
    Ray ray;
    ray.pixel = tile_number * tile_pixels + uint(at.y) * tile_side + uint(at.x);
    const VolumeRay start = RaysAt(scene.rays).at[ray.pixel];
    ray.nearest = float_of(scene.nearest);
    ray.end = start.end;
    ray.to_eye = vec3(start.to_eye[0], start.to_eye[1], start.to_eye[2]);
    ray.segments = 0u;
    ray.first_stop = start.first_stop;
    ray.stops = start.stops;
    Composed state;
    state.lengths = start.lengths;
    state.through = 1.0;
    state.done = false;
    state.slab = 0u;
    state.light = vec4(0.0, 0.0, 0.0, 1.0);
    Quads slabs = Quads(advance(scene.slabs, ray.first_stop + ray.pixel, 16u));
    if (!seeks_isosurfaces)
        for (uint i = 0u; i <= ray.stops; ++i) slabs.at[i] = state.light;
    VolumeHit hit;
    hit.distance = ISOTET_INFINITY;
    hit.normal[0] = hit.normal[1] = hit.normal[2] = 0.0;
    hit.volume = hit.isosurface = 0u;
    PlanesAt planes = PlanesAt(advance(scene.planes, group, block_size * planes_bytes));
    List list;
    list.segments = Quads(advance(scene.segments, group, block_size * 16u * scene.capacity));
    list.marks = Words(advance(scene.marks, group, block_size * 4u * scene.capacity));
    const vec3 up = vec3(scene.up[0], scene.up[1], scene.up[2]);
    uint met = 0u;
    if (local == 0u) {
        lists_full = 0u;
        tets_drawn = 0u;
        segments_found = 0u;
    }
    barrier();

    for (uint i = 0u; i < tile.count; ++i) {
        const VolumeEntry entry = EntriesAt(scene.entries).at[tile.first + i];
        if (!seeks_isosurfaces && ray.segments >= scene.compose_from) compose(scene, list, entry.nearest, ray, state);
        if (local == 0u) rays_left = 0u;
        barrier();
        if (entry.nearest < ray.end && !(entry.nearest > hit.distance)) atomicOr(rays_left, 1u);
        barrier();
        if (rays_left == 0u) break;
        const VolumePlace volume = PlacesAt(scene.volumes).at[entry.volume];
        const VolumeCluster cluster = VolumeClusters(volume.clusters).at[entry.cluster];
        if (local < cluster.points) 
            place_point(volume, Doubles(advance(scene.volumes, entry.volume, place_bytes)), tile,
                        cluster.first_point + local);
        for (uint first = 0u; first < cluster.tets; first += block_size) {
            if (local == 0u) planes_found = 0u;
            barrier();
            if (first + local < cluster.tets)
                add_planes(scene, volume, cluster.first_point,
                           Words(advance(volume.tets, cluster.first_tet + first + local, 4u)).at[0], block, planes);
            memoryBarrierBuffer();
            barrier();
            const uint found = planes_found;
            for (uint tet = 0u; tet < found; ++tet) {
                const vec4 way = way_through(planes, tet, at);
                if (!(way.x < way.y && way.x < ray.end) || way.x > hit.distance) continue;
                ++met;
                if (seeks_isosurfaces) {
                    find_hits(volume, entry.volume, planes, tet, way, ray, hit);
                } else if (ray.segments == scene.capacity) {
                    atomicOr(lists_full, 1u);
                } else {
                    const uint light = volume.shaded != 0u ? light_of(planes, tet, ray.to_eye, up) : 65535u;
                    list.segments.at[place_in(ray.segments)] = way;
                    list.marks.at[place_in(ray.segments)] = light << 16 | entry.volume;
                    ++ray.segments;
                }
            }
            barrier();
            if (local == 0u) tets_drawn += found;
        }
        barrier();
        if (lists_full != 0u) break;
    }
    if (!seeks_isosurfaces) {
        if (lists_full == 0u) compose(scene, list, ISOTET_INFINITY, ray, state);
        slabs.at[state.slab] = state.light;
    } else {
        HitsAt(scene.hits).at[ray.pixel] = hit;
    }
    barrier();
    atomicAdd(segments_found, met);
    barrier();
    if (local != 0u) return;
    ResultsAt(scene.results).at[push.first + group] = BlockResult(lists_full, tets_drawn, segments_found);
}

#endif
