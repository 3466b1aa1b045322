// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Writes the normal of every triangle. An invocation a triangle. Same as api::face_normals().
#version 460
#include "shared/surface.glsl"

layout(push_constant, scalar) uniform Push {
    SurfacePush push;
};

void main() {
    const Output surface = OutputAt(push.surface).surface;
    const uint triangle = item_index();
    if (surface.overflow != 0u || triangle >= surface.triangles_low) return;
    set_vector(surface.normals, triangle, normal_of(surface, triangle));
}
