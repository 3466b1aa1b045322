// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What goes from a mesh's vertices to its fragments, and the colour that fragments get.
#ifndef ISOTET_MESH_GLSL
#define ISOTET_MESH_GLSL

#include "scene.glsl"

layout(constant_id = 0) const uint coloring = one_color;
layout(constant_id = 1) const bool has_normals = false;

layout(push_constant, scalar) uniform Push {
    DrawPush push;
};

#ifdef ISOTET_FRAGMENT

layout(location = 0) in vec3 position; // in the scene
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 value;    // 1 where there is one; its place, or the value itself

/// The colour map between its two nearest entries.
vec3 color_of(Mesh mesh) {
    if (coloring == one_color) return mesh.color;
    if (value.x < 0.999) return mesh.no_data; // a corner has no value
    const float place = mesh.log_factor == 0.0 ? value.y : log(max(value.y, 1e-37)) * mesh.log_factor;
    const float entry = clamp(place, 0.0, 1.0) * float(table_entries - 1u);
    const uint below = min(uint(entry), table_entries - 2u);
    return mix(vector_at(mesh.table, below), vector_at(mesh.table, below + 1u), entry - float(below));
}

/// A light at the eye, and a little from above where the surface turns away: a surface seen at a right angle has just its own
/// colour.
struct Shading {
    vec3 color;
    float facing; // cosine between the normal and the direction to the eye, not negative
};
Shading shade(View view, Mesh mesh) {
    const vec3 to_eye = view.parallel == 1u ? view.eye : normalize(view.eye - position);
    vec3 face = cross(dFdx(position), dFdy(position));
    face = dot(face, face) > 0.0 ? normalize(face) : to_eye;
    vec3 towards = face;
    if (has_normals && dot(normal, normal) > 0.25) towards = normalize(normal);
    // Both sides are lit: the normal is taken on the side that is seen.
    if (dot(towards, dot(face, to_eye) < 0.0 ? -face : face) < 0.0) towards = -towards;
    const float facing = clamp(dot(towards, to_eye), 0.0, 1.0);
    const float sky = 0.5 + 0.5 * dot(towards, view.up);
    const float light = 0.16 + 0.84 * facing + 0.22 * sky * (1.0 - facing);
    return Shading(color_of(mesh) * light, facing);
}

#elif defined(ISOTET_MESH_STAGE)

layout(location = 0) out vec3 position[];
layout(location = 1) out vec3 normal[];
layout(location = 2) out vec2 value[];

#else

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 value;

#endif
#endif
