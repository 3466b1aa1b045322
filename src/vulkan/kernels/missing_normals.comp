// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Gives vertices without a gradient normal the face normal of the triangle that lowest_triangles found. An invocation a
// vertex. Second half of what api::fill_normals() does.
#version 460
#include "shared/surface.glsl"

layout(push_constant, scalar) uniform Push {
    SurfacePush push;
};

void main() {
    const Output surface = OutputAt(push.surface).surface;
    const uint vertex = item_index();
    if (surface.missing_normals == 0u || surface.overflow != 0u || vertex >= surface.vertices_low) return;
    if (vector_at(surface.normals, vertex) != vec3(0.0)) return;
    set_vector(surface.normals, vertex, normal_of(surface, Words(advance(surface.lowest, vertex, 4u)).at[0]));
}
