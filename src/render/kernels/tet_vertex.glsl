// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One of the four vertices of a tet, on the edge where the isovalue crosses it: marching tetrahedra in a vertex shader
// (Buatois, Caumon and Levy 2006). The vertex shader, its compute twin and the mesh shader have this source in common.
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

/// A tet, ready to be cut.
struct Tet {
    vec4 corners[4]; // x, y, z and value
    uint points[4];  // of textures
    uint row;        // 4 times the case, of half the table; 0 where there is nothing to cut
};

uint row_of(vec4 corners[4], float isovalue) {
    uint index = 0u;
    for (uint k = 0u; k < 4u; ++k) {
        if (is_nan(corners[k].w)) return 0u;
        index |= uint(corners[k].w >= isovalue) << k;
    }
    return 4u * (index < 8u ? index : 15u - index);
}

/// `place`    of the tet among those that are drawn of this page
/// `number`   of the vertex, 0 to 3; where vertices carry it, theirs is given back
Tet tet_at(TetPage page, uint place, inout uint number) {
    Tet tet;
    tet.points = uint[](0u, 0u, 0u, 0u);
    const uint record = has_list ? word_at(page.numbers, place) : place;
    if (method == registers_method) {
        const TetRegisters own = TetRegistersAt(advance(page.records, 4u * record + number, 68u)).registers;
        tet.corners = own.corners;
        number = own.number;
    } else if (method == instanced_method) {
        tet.corners = CornersAt(advance(page.records, record, 64u)).corners;
    } else {
        tet.points = PointNumbersAt(advance(page.records, record, 16u)).points;
        for (uint k = 0u; k < 4u; ++k) tet.corners[k] = texel_at(page.points, tet.points[k]);
    }
    tet.row = row_of(tet.corners, page.isovalue);
    return tet;
}

struct TetVertex {
    vec3 position;
    vec3 gradient;
};

/// The vertex of a tet whose row is not 0.
TetVertex tet_vertex(TetPage page, Tet tet, uint number) {
    const uint edge = case_edge(page, tet.row + number);
    uint below = edge_corner(page, 2u * edge), above = edge_corner(page, 2u * edge + 1u);
    if (tet.corners[below].w >= page.isovalue) {
        const uint other = below;
        below = above;
        above = other;
    }
    const vec4 a = tet.corners[below], b = tet.corners[above];
    const float t = edge_weight(page.isovalue, page.rest, a.w, b.w);
    TetVertex found;
    found.position = vec3(interpolate(a.x, b.x, t), interpolate(a.y, b.y, t), interpolate(a.z, b.z, t));
    found.gradient = vec3(0.0);
    if (has_gradients)
        found.gradient = mix(texel_at(page.gradients, tet.points[below]).xyz, texel_at(page.gradients, tet.points[above]).xyz, t);
    return found;
}

#endif
