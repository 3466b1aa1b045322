// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One of the four vertices of a tet, on the edge where the isovalue crosses it: marching tetrahedra in a vertex shader
// (Buatois, Caumon and Levy 2006). The vertex shader and its compute twin have this source in common.
//
// What a tet is read from depends on the method; all else is the same. Places are those of the contract, bit for bit, so that
// neighbours leave no crack between them.
#ifndef ISOTET_TET_VERTEX_GLSL
#define ISOTET_TET_VERTEX_GLSL

#include "scene.glsl"
#include "shared/arithmetic.glsl"

layout(constant_id = 2) const uint method = textures_method;
layout(constant_id = 3) const bool has_list = false;
layout(constant_id = 4) const bool has_gradients = false;

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TetRegistersAt {
    TetRegisters registers;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer CornersAt {
    vec4 corners[4];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer PointNumbersAt {
    uint points[4];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer TexelAt {
    vec4 texel;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TetTablesAt {
    TetTables tables;
};

const uint half_cases[32] = uint[](ISOTET_HALF_CASES);
const uint tet_edges[12] = uint[](ISOTET_TET_EDGES);

vec4 texel_at(Address texels, uint index) { return TexelAt(advance(texels, index, 16u)).texel; }

uint case_edge(TetPage page, uint index) {
    if (method == textures_method) return TetTablesAt(page.tables).tables.cases[index];
    return half_cases[index];
}
uint edge_corner(TetPage page, uint index) {
    if (method == textures_method) return TetTablesAt(page.tables).tables.edges[index];
    return tet_edges[index];
}

struct TetVertex {
    bool is_there; // the tet is cut
    vec3 position;
    vec3 gradient;
};

/// `vertex`   four times the place of the tet among those that are drawn of this page, and 0 to 3
TetVertex tet_vertex(TetPage page, uint vertex) {
    uint tet = vertex / 4u, number = vertex % 4u;
    if (has_list) tet = word_at(page.numbers, tet);
    vec4 corners[4];
    uint points[4] = uint[](0u, 0u, 0u, 0u);
    if (method == registers_method) {
        const TetRegisters own = TetRegistersAt(advance(page.records, 4u * tet + number, 68u)).registers;
        corners = own.corners;
        number = own.number;
    } else if (method == instanced_method) {
        corners = CornersAt(advance(page.records, tet, 64u)).corners;
    } else {
        points = PointNumbersAt(advance(page.records, tet, 16u)).points;
        for (uint k = 0u; k < 4u; ++k) corners[k] = texel_at(page.points, points[k]);
    }

    const TetVertex none = TetVertex(false, vec3(0.0), vec3(0.0));
    uint index = 0u;
    for (uint k = 0u; k < 4u; ++k) {
        if (is_nan(corners[k].w)) return none;
        index |= uint(corners[k].w >= page.isovalue) << k;
    }
    if (index >= 8u) index = 15u - index;
    if (index == 0u) return none;

    const uint edge = case_edge(page, 4u * index + number);
    uint below = edge_corner(page, 2u * edge), above = edge_corner(page, 2u * edge + 1u);
    if (corners[below].w >= page.isovalue) {
        const uint other = below;
        below = above;
        above = other;
    }
    const vec4 a = corners[below], b = corners[above];
    const float t = edge_weight(page.isovalue, a.w, b.w);
    TetVertex found = none;
    found.is_there = true;
    found.position = vec3(interpolate(a.x, b.x, t), interpolate(a.y, b.y, t), interpolate(a.z, b.z, t));
    if (has_gradients)
        found.gradient = mix(texel_at(page.gradients, points[below]).xyz, texel_at(page.gradients, points[above]).xyz, t);
    return found;
}

#endif
