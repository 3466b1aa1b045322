// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Corners of the quads that tets give: an invocation a vertex, four a tet. All four of a tet that is not cut lie in one place
// outside the picture.
#version 460
#include "mesh.glsl"
#include "tet_vertex.glsl"

void main() {
    const View view = ViewAt(push.view).view;
    const TetPage page = TetPageAt(push.item).page;
    const TetVertex found = tet_vertex(page, gl_VertexIndex);
    position = found.position * page.mesh.scale + page.mesh.offset;
    normal = found.gradient;
    value = vec2(0.0);
    gl_Position = found.is_there ? view.clip_from_scene * vec4(position, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
