// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Writes the places that tet_corners.vert moves its vertices to: the surface that is drawn, to be looked at. An invocation a
// vertex, four a tet. Twin: tet_corners.vert; both are tet_vertex.glsl.
#version 460
#include "tet_vertex.glsl"
#include "shared/groups.glsl"

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    TwinPush push;
};

void main() {
    const uint vertex = group_index() * twin_size + gl_LocalInvocationIndex;
    if (vertex >= push.count) return;
    const TetPage page = TetPageAt(push.page).page;
    uint number = vertex % 4u;
    const Tet tet = tet_at(page, vertex / 4u, number);
    vec3 place = vec3(uintBitsToFloat(0x7fc00000u));
    if (tet.row > 0u) place = tet_vertex(page, tet, number).position;
    Floats at = Floats(advance(push.vertices, vertex, 12u));
    at.at[0] = place.x;
    at.at[1] = place.y;
    at.at[2] = place.z;
}
