// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Corners of the quads that tets give: an invocation a vertex, four a tet. All four of a tet that is not cut lie in one place
// outside the picture.
#version 460
#include "mesh.glsl"
#include "tet_vertex.glsl"

void main() {
    const View view = ViewAt(push.view).view;
    const TetPage page = TetPageAt(push.item).page;
    uint number = gl_VertexIndex % 4u;
    const Tet tet = tet_at(page, gl_VertexIndex / 4u, number);
    position = normal = vec3(0.0);
    value = vec2(0.0);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    if (tet.row == 0u) return;
    const TetVertex found = tet_vertex(page, tet, number);
    position = found.position * page.mesh.scale + page.mesh.offset;
    normal = found.gradient;
    gl_Position = view.clip_from_scene * vec4(position, 1.0);
}
