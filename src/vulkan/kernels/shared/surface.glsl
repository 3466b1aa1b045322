// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A finished surface on the device, by vertices and triangles of any number. For kernels with an invocation each.
#ifndef ISOTET_SURFACE_GLSL
#define ISOTET_SURFACE_GLSL

#include "shared/arithmetic.glsl"
#include "shared/groups.glsl"
#include "shared/memory.glsl"

layout(local_size_x = 128) in;

/// The vertex or triangle of this invocation; compare it with their number.
uint item_index() { return group_index() * 128u + gl_LocalInvocationIndex; }

vec3 vector_at(Address vectors, uint item) {
    Floats at = Floats(advance(vectors, item, 12u));
    return vec3(at.at[0], at.at[1], at.at[2]);
}

void set_vector(Address vectors, uint item, vec3 vector) {
    Floats at = Floats(advance(vectors, item, 12u));
    for (uint axis = 0u; axis < 3u; ++axis) at.at[axis] = vector[axis];
}

uvec3 triangle_at(Output surface, uint triangle) {
    Words at = Words(advance(surface.triangles, triangle, 12u));
    return uvec3(at.at[0], at.at[1], at.at[2]);
}

vec3 normal_of(Output surface, uint triangle) {
    const uvec3 corners = triangle_at(surface, triangle);
    return face_normal(vector_at(surface.positions, corners.x), vector_at(surface.positions, corners.y),
                       vector_at(surface.positions, corners.z));
}

#endif
