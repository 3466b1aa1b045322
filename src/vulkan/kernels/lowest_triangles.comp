// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// For vertices without a gradient normal, which emit has marked: the lowest-numbered triangle that uses each. An invocation
// a triangle; atomic minimums. First half of what api::fill_normals() does.
#version 460
#include "shared/surface.glsl"

layout(push_constant, scalar) uniform Push {
    SurfacePush push;
};

void main() {
    const Output surface = OutputAt(push.surface).surface;
    const uint triangle = item_index();
    if (surface.missing_normals == 0u || surface.overflow != 0u || triangle >= surface.triangles_low) return;
    const uvec3 corners = triangle_at(surface, triangle);
    for (uint k = 0u; k < 3u; ++k)
        if (vector_at(surface.normals, corners[k]) == vec3(0.0))
            atomicMin(Words(advance(surface.lowest, corners[k], 4u)).at[0], triangle);
}
