// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Corners of triangles: an invocation a vertex of an indexed draw; or, where triangles have values, a corner of a draw that is
// not indexed.
#version 460
#include "mesh.glsl"

bool is_nan(float number) { return (floatBitsToUint(number) & 0x7fffffffu) > 0x7f800000u; }

/// Values beyond what can be interpolated are far beyond any end of the colour map.
vec2 known(float number) { return is_nan(number) ? vec2(0.0) : vec2(1.0, clamp(number, -1e30, 1e30)); }

vec2 value_of(Mesh mesh, uint vertex) {
    if (coloring == by_vertex) return known(float_at(mesh.values, vertex));
    if (coloring == by_triangle) return known(float_at(mesh.values, gl_VertexIndex / 3));
    if (coloring == by_grid_tet) return known(float_at(mesh.values, word_at(mesh.sources, gl_VertexIndex / 3)));
    if (coloring == by_grid_point) {
        Words ends = Words(advance(mesh.ends, vertex, 8u));
        const vec2 a = known(float_at(mesh.values, ends.at[0])), b = known(float_at(mesh.values, ends.at[1]));
        return vec2(a.x * b.x, mix(a.y, b.y, float_at(mesh.weights, vertex)));
    }
    return vec2(0.0);
}

void main() {
    const View view = ViewAt(push.view).view;
    const Mesh mesh = MeshAt(push.item).mesh;
    const bool by_corner = coloring == by_triangle || coloring == by_grid_tet;
    const uint vertex = by_corner ? word_at(mesh.triangles, gl_VertexIndex) : gl_VertexIndex;
    position = vector_at(mesh.positions, vertex) * mesh.scale + mesh.offset;
    normal = has_normals ? vector_at(mesh.normals, vertex) : vec3(0.0);
    value = value_of(mesh, vertex);
    gl_Position = view.clip_from_scene * vec4(position, 1.0);
}
