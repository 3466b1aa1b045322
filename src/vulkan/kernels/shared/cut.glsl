// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cluster at hand at one isovalue: which of its cells give triangles, and which edges these cross. What count and emit
// have in common. On the processor: cpu/plain_cluster.cpp, cpu/any_cluster.cpp.
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

/// Active edges of the cells that give triangles: bit (lower, higher), four words a row. Edges to a tied point are not in it.
shared uint matrix[matrix_words];

shared uint hit_groups; ///< bits: whose range holds the isovalue
shared uint hit_group[max_cluster_groups]; ///< the same as a list, each as described()

const uint tet_cases[16] = uint[](ISOTET_TET_CASES);

bool is_in(uint set, uint point) { return (sides[set + point / 32u] >> point % 32u & 1u) != 0u; }

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

/// The first word of a group in the cluster + 2^16 * its number of cells + 2^24 * their kind. Worked out once a group: for
/// each cell it would be reading of arrays with a variable index.
uint described(uint group) {
    const uint kind = !with_others || group < kind_ends.x ? 0u : group < kind_ends.y ? 1u : group < kind_ends.z ? 2u : 3u;
    const uint first = kind == 0u ? 0u : kind_ends[kind - 1u], most = kind == 0u ? group_size : group_size / 2u;
    const uint cells = min(kind_counts[kind] - (group - first) * most, most);
    return kind_words[kind] + group_size * (group - first) | cells << 16 | kind << 24;
}

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
    if (hit) hit_group[bitCount(hit_groups & (1u << self) - 1u)] = described(self);
    barrier();
}

/// A cell of a hit group.
struct Cell {
    uint kind;    ///< 0 to 3; 4 where there is none
    uint word;    ///< its first in the cluster
    uvec2 words;  ///< corners
    uint above;   ///< which corners are: the case
    uint tied;
    uint triangles;
};

uint corner_of(Cell cell, uint k) { return (k < 4u ? cell.words.x : cell.words.y) >> 8u * (k % 4u) & 0xffu; }

uint corners_in(uint set, Cell cell, uint count) {
    uint bits = 0u;
    for (uint k = 0u; k < count; ++k) bits |= uint(is_in(set, corner_of(cell, k))) << k;
    return bits;
}

/// The first polygon + 65536 * number of polygons + 2^20 * number of triangles, of a cell that is no tet.
uint case_of(Tables tables, Cell cell) {
    const uint at = cell.kind == 1u ? pyramid_cases_at : cell.kind == 2u ? wedge_cases_at : hexahedron_cases_at;
    return Words(tables.cell_cases).at[at + cell.above];
}

uint polygon_count(Tables tables, Cell cell) {
    return !with_others || cell.kind == 0u ? 1u : case_of(tables, cell) >> 16 & 15u;
}
uint polygon_of(Tables tables, Cell cell, uint i) {
    return !with_others || cell.kind == 0u ? tet_cases[cell.above] : Words(tables.cell_cases).at[(case_of(tables, cell) & 0xffffu) + i];
}
uint triangles_of(uint polygon) { return polygon >> 24; }

/// Active edge `k` of a polygon, 0 to 3, as (corner above, corner below).
uvec2 polygon_edge(uint polygon, uint k) {
    const uint edge = polygon >> 6u * k & 63u;
    return uvec2(edge & 7u, edge >> 3);
}

/// What tells one vertex of a cell from another: its edge, or its tied point.
uint vertex_key(Cell cell, uint polygon, uint k) {
    const uvec2 ends = polygon_edge(polygon, k);
    const uint a = corner_of(cell, ends.x), b = corner_of(cell, ends.y);
    return (cell.tied >> ends.x & 1u) != 0u ? max_cluster_points * a + a : max_cluster_points * min(a, b) + max(a, b);
}

/// Whether triangle `t` of a polygon, (0, 1, 2) or (0, 2, 3), has three different vertices.
bool is_kept(Cell cell, uint polygon, uint t) {
    const uint a = vertex_key(cell, polygon, 0u), b = vertex_key(cell, polygon, 1u + t),
               c = vertex_key(cell, polygon, 2u + t);
    return a != b && b != c && c != a;
}

/// `group`     as described()
/// `special`   some local point is tied or without data
Cell cut_cell(Tables tables, uint group, uint lane, bool special) {
    Cell cell = Cell(4u, 0u, uvec2(0u), 0u, 0u, 0u); // what is not set would be kept alive round the callers' loops
    if (lane >= (group >> 16 & 0xffu)) return cell;
    cell.kind = with_others ? group >> 24 : 0u;
    const bool is_tet = cell.kind == 0u;
    const uint corners = is_tet ? 4u : cell.kind == 3u ? 8u : cell.kind + 4u;
    cell.word = (group & 0xffffu) + (is_tet ? lane : 2u * lane);
    cell.words = uvec2(cell_word(cell.word), is_tet ? 0u : cell_word(cell.word + 1u));
    cell.above = corners_in(above, cell, corners);
    if (special && corners_in(no_data, cell, corners) != 0u) return cell;
    cell.triangles = is_tet ? triangles_of(tet_cases[cell.above]) : case_of(tables, cell) >> 20;
    if (special && cell.triangles != 0u) {
        cell.tied = corners_in(tied, cell, corners);
        if (cell.tied == 0u) return cell;
        cell.triangles = 0u;
        for (uint i = 0u; i < polygon_count(tables, cell); ++i) {
            const uint polygon = polygon_of(tables, cell, i);
            for (uint t = 0u; t < triangles_of(polygon); ++t) cell.triangles += uint(is_kept(cell, polygon, t));
        }
    }
    return cell;
}

uint matrix_word(uvec2 edge) { return 4u * edge.x + edge.y / 32u; }

/// (lower, higher) of two local points.
uvec2 ascending(uint a, uint b) { return uvec2(min(a, b), max(a, b)); }

void add_edges(Tables tables, Cell cell) {
    for (uint i = 0u; i < polygon_count(tables, cell); ++i) {
        const uint polygon = polygon_of(tables, cell, i);
        for (uint k = 0u; k < 4u; ++k) {
            const uvec2 ends = polygon_edge(polygon, k);
            if ((cell.tied >> ends.x & 1u) != 0u) continue;
            const uvec2 edge = ascending(corner_of(cell, ends.x), corner_of(cell, ends.y));
            atomicOr(matrix[matrix_word(edge)], 1u << edge.y % 32u);
        }
    }
}

bool is_crossed(uvec2 edge) { return (matrix[matrix_word(edge)] >> edge.y % 32u & 1u) != 0u; }

#endif
