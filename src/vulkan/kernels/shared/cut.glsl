// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cluster at hand at one isovalue: which of its tets give triangles, and which edges these cross. What count and emit
// have in common; the twin of cpu/cut_cluster.hpp.
#ifndef ISOTET_CUT_GLSL
#define ISOTET_CUT_GLSL

#include "shared/cluster.glsl"
#include "shared/quantize.glsl"
#include "shared/workgroup.glsl"

// Sets of local points, 4 words each.
const uint above = 0u;   ///< value >= isovalue
const uint tied = 4u;    ///< value == tied_value (Ties::merge; with Ties::keep a tied point is like any above)
const uint no_data = 8u;
shared uint sides[12];

/// Active edges of the tets that give triangles: bit (lower, higher), four words a row. Edges to a tied point are not in it.
shared uint matrix[matrix_words];

shared uint hit_groups; ///< bits: whose range holds the isovalue
shared uint hit_group[max_cluster_groups]; ///< the same as a list

const uint tet_cases[16] = uint[](ISOTET_TET_CASES);

bool is_in(uint set, uint point) { return (sides[set + point / 32u] >> point % 32u & 1u) != 0u; }

/// Which of four local points are in a set.
uint corners_in(uint set, uvec4 v) {
    return uint(is_in(set, v.x)) | uint(is_in(set, v.y)) << 1 | uint(is_in(set, v.z)) << 2 | uint(is_in(set, v.w)) << 3;
}

bool any_in(uint set) { return (sides[set] | sides[set + 1u] | sides[set + 2u] | sides[set + 3u]) != 0u; }

/// Empties the sets. A barrier must follow.
void clear_cut() {
    const uint self = gl_LocalInvocationIndex;
    if (self < 12u) sides[self] = 0u;
    for (uint i = 0u; i < 4u; ++i) matrix[4u * self + i] = 0u;
    if (self == 0u) hit_groups = 0u;
}

/// Puts a local point into the sets. A barrier must follow.
void classify(uint point, float value, float isovalue, float tied_value, bool merge) {
    const uint bit = 1u << point % 32u;
    if ((floatBitsToUint(value) & 0x7fffffffu) > 0x7f800000u) {
        atomicOr(sides[no_data + point / 32u], bit);
    } else if (value >= isovalue) {
        atomicOr(sides[above + point / 32u], bit);
        if (merge && value == tied_value) atomicOr(sides[tied + point / 32u], bit);
    }
}

uint group_count() { return (tet_count + group_size - 1u) / group_size; }

/// Notes the groups that may have something to give: none when no point is below. All invocations must call it.
void find_hit_groups(float isovalue, Range range) {
    const uint self = gl_LocalInvocationIndex;
    bool hit = false;
    if (self < group_count() && range.lower < isovalue) {
        const uint step = quantize(isovalue, range);
        const uint ends = range_of_group(self);
        hit = (ends & 0xffu) <= step && step <= ends >> 8;
    }
    if (hit) atomicOr(hit_groups, 1u << self);
    barrier();
    if (hit) hit_group[bitCount(hit_groups & (1u << self) - 1u)] = self;
    barrier();
}

/// A tet of a hit group: the case by its corners above, its tied corners, and how many triangles it gives.
struct CutTet {
    uvec4 corners;
    uint above, tied, triangles;
};

/// `special`   some local point is tied or without data
CutTet cut_tet(uint tet, bool special) {
    CutTet cut;
    cut.corners = corners_of_tet(tet);
    cut.above = corners_in(above, cut.corners);
    cut.tied = 0u;
    cut.triangles = tet_cases[cut.above] >> 16;
    if (special && cut.triangles != 0u) {
        cut.tied = corners_in(tied, cut.corners);
        if (corners_in(no_data, cut.corners) != 0u) cut.triangles = 0u;
        else if (cut.tied == cut.above && bitCount(cut.tied) != 3) cut.triangles = 0u; // nothing strictly above
        else if (cut.tied != 0u) cut.triangles = 1u;
    }
    return cut;
}

/// Active edge `k` of the tet's polygon, 0 to 3, as (corner above, corner below).
uvec2 polygon_edge(CutTet cut, uint k) {
    const uint nibble = tet_cases[cut.above] >> 4u * k;
    return uvec2(nibble & 3u, nibble >> 2 & 3u);
}

uint matrix_word(uvec2 edge) { return 4u * edge.x + edge.y / 32u; }

/// (lower, higher) of two local points.
uvec2 ascending(uint a, uint b) { return uvec2(min(a, b), max(a, b)); }

void add_edges(CutTet cut) {
    for (uint k = 0u; k < 4u; ++k) {
        const uvec2 ends = polygon_edge(cut, k);
        if ((cut.tied >> ends.x & 1u) != 0u) continue;
        const uvec2 edge = ascending(cut.corners[ends.x], cut.corners[ends.y]);
        atomicOr(matrix[matrix_word(edge)], 1u << edge.y % 32u);
    }
}

bool is_crossed(uvec2 edge) { return (matrix[matrix_word(edge)] >> edge.y % 32u & 1u) != 0u; }

#endif
