// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Writes the vertices and triangles of each listed cluster straight to their place in the surface. A workgroup a cluster.
// A vertex on an edge has as its number the active edges before it in a matrix of bits, one on a seam the bits before it in
// its owner's mask: no edge is stored, nothing is searched for. Same as cpu/emit.cpp.
//
// Vertices of a cluster: tied own points, own seams in stored order, inner edges by (lower, higher). Its triangles: by cell,
// then by case table.
#version 460
#include "shared/arithmetic.glsl"
#include "shared/groups.glsl"
#include "shared/lists.glsl"

layout(constant_id = 0) const bool many_edges = false; ///< which list is worked through: clusters of more than few_edges
layout(constant_id = 1) const bool with_ends = false;
layout(constant_id = 2) const bool with_normals = false;
layout(constant_id = 3) const bool with_sources = false;
layout(constant_id = 4) const bool with_others = true; ///< the grid has cells that are no tets

#include "shared/cut.glsl"
#include "shared/sums.glsl"

layout(push_constant, scalar) uniform Push {
    ExtractPush push;
};

shared uint points[max_cluster_points]; ///< page-local numbers of local points
shared uint edge_count;
// The window: active edges of ranks from window_begin on, few_edges at most. Where there are many edges, one after the other.
shared uint edge_numbers[few_edges];      ///< lower + 256 * higher; then the vertex on the edge
shared uint seam_bits[few_edges / 32u];   ///< the edge is a seam
shared uint seam_ranks[few_edges / 32u];
shared uint triangle_bits[3u * max_cluster_groups]; ///< by place in hit_group, a bit a cell: of its number of triangles
// sums_before: by row of the matrix, the active edges before it (12 bits), and how many of its own are in words 0 to 2, in words 0
// and 1, in word 0 (7, 7, 6 bits).
// Half of the matrix has no edges, because lower < higher: of rows 32 to 63 word 0 holds the triangles before each place in
// hit_group, of rows 64 to 127 words 0 and 1 the numbers of the vertices at tied points.

uint window_begin = 0u;
uint seams_before_window = 0u;

Tables tables;
Start start;
Address positions, normals, weights, triangles, lowest, vertex_ends, sources; ///< of the surface, from this cluster's first on

// Addresses of the surface are read where they are used, not before the cells are cut: they need 14 registers.

void open_vertices() {
    OutputAt output_of = OutputAt(push.surface);
    positions = advance(output_of.surface.positions, start.vertex, 12u);
    normals = advance(output_of.surface.normals, start.vertex, 12u);
    lowest = advance(output_of.surface.lowest, start.vertex, 4u);
    vertex_ends = advance(output_of.surface.ends, start.vertex, 8u);
    weights = advance(output_of.surface.weights, start.vertex, 4u);
}

void open_triangles() {
    triangles = advance(OutputAt(push.surface).surface.triangles, start.triangle, 12u);
    sources = advance(OutputAt(push.surface).surface.sources, start.triangle, 4u);
}

/// Bits before `bit` in a mask that begins at word `first`.
uint bits_before(uint first, uint bit) {
    uint count = bitCount(Words(tables.masks).at[first + bit / 32u] & (1u << bit % 32u) - 1u);
    for (uint word = 0u; word < bit / 32u; ++word) count += bitCount(Words(tables.masks).at[first + word]);
    return count;
}

void write_normal(uint vertex, uint below, uint above_end, float t) {
    const vec3 normal = vertex_normal(page_word(page.gradients + below), page_word(page.gradients + above_end), t);
    for (uint axis = 0u; axis < 3u; ++axis) Floats(normals).at[3u * vertex + axis] = normal[axis];
    if (normal != vec3(0.0)) return;
    Words(lowest).at[vertex] = 0xffffffffu;
    OutputAt(push.surface).surface.missing_normals = 1u;
}

/// Writes the vertex between two local points. `vertex` counts this cluster's own.
void write_vertex(uint vertex, uint below, uint above_end, float t) {
    const vec3 a = position_of(points[below]), b = position_of(points[above_end]);
    for (uint axis = 0u; axis < 3u; ++axis) Floats(positions).at[3u * vertex + axis] = interpolate(a[axis], b[axis], t);
    if (with_ends) {
        Words(vertex_ends).at[2u * vertex] = packed_point(points[below]);
        Words(vertex_ends).at[2u * vertex + 1u] = packed_point(points[above_end]);
        Floats(weights).at[vertex] = t;
    }
    if (with_normals) write_normal(vertex, points[below], points[above_end], t);
}

void load_points() {
    const uint self = gl_LocalInvocationIndex;
    if (self >= local_points()) return;
    points[self] = page_point(self);
    classify(self, value_of(points[self]), push.isovalue, push.tied, push.merge != 0u);
}

/// Triangles of the cells of a hit group that a mask has.
uint triangles_in(uint place, uint mask) {
    uint sum = 0u;
    for (uint bit = 0u; bit < 3u; ++bit) sum += bitCount(triangle_bits[3u * place + bit] & mask) << bit;
    return sum;
}

void cut_cells(bool special) {
    const uint self = gl_LocalInvocationIndex;
    const uint hits = bitCount(hit_groups);
    for (uint place = self / group_size; place < hits; place += workgroup_size / group_size) {
        const uint lane = self % group_size;
        const Cell cell = cut_cell(tables, hit_group[place], lane, special);
        if (cell.triangles != 0u) {
            add_edges(tables, cell);
            for (uint bit = 0u; bit < 3u; ++bit)
                if ((cell.triangles >> bit & 1u) != 0u) atomicOr(triangle_bits[3u * place + bit], 1u << lane);
        }
    }
}

uint edges_before_row(uint row) { return sums_before[row] & 0xfffu; }
uint triangles_before(uint place) { return matrix[4u * (32u + place)]; }

/// Ranks of active edges by row, and the first triangle of each hit group. A barrier must follow, though not before list_edges().
void rank_edges() {
    const uint self = gl_LocalInvocationIndex;
    const uint one = bitCount(matrix[4u * self]), two = one + bitCount(matrix[4u * self + 1u]),
               three = two + bitCount(matrix[4u * self + 2u]);
    uint sum = three + bitCount(matrix[4u * self + 3u]);
    if (self < max_cluster_groups) sum += triangles_in(self, 0xffffffffu) << 16;
    find_sums_before(sum);
    const uint before = sums_before[self];
    if (self < max_cluster_groups) matrix[4u * (32u + self)] = before >> 16;
    if (self == workgroup_size - 1u) edge_count = before + sum & 0xffffu;
    sums_before[self] = before & 0xfffu | three << 12 | two << 19 | one << 26;
}

/// The words of a row before this one have no edges.
uint first_word(uint row) { return row / 32u; }

/// Where a rank lies in the window; few_edges or more: outside.
uint in_window(uint rank) { return rank - window_begin; }

/// Lists the edges of the window, and forgets the seams of the one before. A barrier must follow.
void list_edges() {
    const uint self = gl_LocalInvocationIndex;
    if (self < few_edges / 32u) seam_bits[self] = 0u;
    uint rank = edges_before_row(self);
    for (uint i = first_word(self); i < 4u; ++i)
        for (uint bits = matrix[4u * self + i]; bits != 0u; bits &= bits - 1u) {
            const uint place = in_window(rank++);
            if (!many_edges || place < few_edges) edge_numbers[place] = self + (32u * i + findLSB(bits) << 8);
        }
}

uint rank_of(uvec2 edge) {
    const uint row = sums_before[edge.x], word = edge.y / 32u;
    const uint in_words = word == 0u ? 0u : row >> 33u - 7u * word & 127u;
    return (row & 0xfffu) + in_words + bitCount(matrix[4u * edge.x + word] & (1u << edge.y % 32u) - 1u);
}

/// Where the number of the vertex at a tied point stands.
uint tied_at(uint point) { return 4u * (64u + point % 64u) + point / 64u; }

bool is_masked(uint bit) { return (Words(tables.masks).at[cluster.first_mask + bit / 32u] >> bit % 32u & 1u) != 0u; }

/// Numbers of the tied points that other clusters own, and of this cluster's own.
void number_tied() {
    const uint self = gl_LocalInvocationIndex;
    if (self >= local_points() || !is_in(tied, self)) return;
    if (self >= ghost_points) {
        matrix[tied_at(self)] = start.vertex + bits_before(cluster.first_mask, self - ghost_points);
        return;
    }
    const Neighbour neighbour = neighbour_of(self, 0u);
    matrix[tied_at(self)] = Starts(tables.starts).at[neighbour.cluster].vertex +
                            bits_before(Clusters(tables.clusters).at[neighbour.cluster].first_mask,
                                        place_in_owner(tables, neighbour, self));
}

uint own_seam_number(uint k) { return start.seam_vertex + bits_before(cluster.first_mask + tied_words, k); }

void set_seam_number(uint place, uint number) {
    edge_numbers[place] = number;
    atomicOr(seam_bits[place / 32u], 1u << place % 32u);
}

void number_seams() {
    for (uint k = gl_LocalInvocationIndex; k < own_seams; k += workgroup_size) {
        const uvec2 edge = own_seam(k);
        if (!is_crossed(edge)) continue;
        const uint place = in_window(rank_of(edge));
        if (!many_edges || place < few_edges) set_seam_number(place, own_seam_number(k));
    }
    for (uint k = gl_LocalInvocationIndex; k < ghost_seams(); k += workgroup_size) {
        const uvec3 seam = ghost_seam(k);
        if (!is_crossed(seam.xy)) continue;
        const uint place = in_window(rank_of(seam.xy));
        if (many_edges && place >= few_edges) continue;
        const uint owner = neighbour_of(k, 16u).cluster;
        set_seam_number(place, Starts(tables.starts).at[owner].seam_vertex +
                                   bits_before(Clusters(tables.clusters).at[owner].first_mask + tied_words, seam.z));
    }
}

void rank_seams() {
    const uint self = gl_LocalInvocationIndex;
    if (self >= few_edges / 32u) return;
    uint rank = seams_before_window;
    [[dont_unroll]] for (uint word = 0u; word < self; ++word) rank += bitCount(seam_bits[word]);
    seam_ranks[self] = rank;
}

/// Writes own vertices: of the window's inner edges, whose numbers are found here, by rank; with the first window those of own
/// seams that the mask has, though perhaps only others cross them, and of tied own points that the mask has.
void write_vertices(uint first_inner, bool special) {
    open_vertices();
    const uint edges = many_edges ? min(edge_count - window_begin, few_edges) : edge_count;
    const uint items = window_begin != 0u ? edges : edges + own_seams + (special ? own_points : 0u);
    for (uint item = gl_LocalInvocationIndex; item < items; item += workgroup_size) {
        bool is_own = false;
        uint number = 0u;
        uvec2 ends = uvec2(0u); // local points
        if (item < edges) {
            const uint bits = seam_bits[item / 32u], bit = 1u << item % 32u;
            is_own = (bits & bit) == 0u;
            if (is_own) {
                number = first_inner + window_begin + item - (seam_ranks[item / 32u] + bitCount(bits & bit - 1u));
                ends = uvec2(edge_numbers[item] & 0xffu, edge_numbers[item] >> 8);
                edge_numbers[item] = number;
            }
        } else if (item < edges + own_seams) {
            const uint k = item - edges;
            is_own = is_masked(32u * tied_words + k);
            if (is_own) {
                number = own_seam_number(k);
                ends = own_seam(k);
            }
        } else {
            const uint place = item - edges - own_seams;
            is_own = is_masked(place);
            if (is_own) {
                ends = uvec2(ghost_points + place);
                number = matrix[tied_at(ends.x)];
            }
        }
        if (is_own) {
            float t = 0.0;
            if (ends.x != ends.y) {
                if (is_in(above, ends.x)) ends = ends.yx;
                t = edge_weight(push.isovalue, push.rest, value_of(points[ends.x]), value_of(points[ends.y]));
            }
            write_vertex(number - start.vertex, ends.x, ends.y, t);
        }
    }
}

const uint outside = 0xffffffffu; ///< the number of no vertex

uint number_of(Cell cell, uint polygon, uint k) {
    const uvec2 ends = polygon_edge(polygon, k);
    const uint a = corner_of(cell, ends.x), b = corner_of(cell, ends.y);
    if ((cell.tied >> ends.x & 1u) != 0u) return matrix[tied_at(a)];
    const uint place = in_window(rank_of(ascending(a, b)));
    return many_edges && place >= few_edges ? outside : edge_numbers[place];
}

/// Writes those corners of a triangle that the window has.
void write_triangle(uint at, uvec3 corners) {
    for (uint i = 0u; i < 3u; ++i)
        if (!many_edges || corners[i] != outside) Words(triangles).at[3u * at + i] = corners[i];
}

void write_triangles_of(Cell cell, uint place, uint lane) {
    uint at = triangles_before(place) + triangles_in(place, (1u << lane) - 1u);
    for (uint i = 0u; i < polygon_count(tables, cell); ++i) {
        const uint polygon = polygon_of(tables, cell, i);
        // No array: compilers keep one with a variable index in memory.
        const uvec4 numbers = uvec4(number_of(cell, polygon, 0u), number_of(cell, polygon, 1u),
                                    number_of(cell, polygon, 2u), number_of(cell, polygon, 3u));
        for (uint t = 0u; t < triangles_of(polygon); ++t) {
            const uvec3 corners = uvec3(numbers.x, t == 0u ? numbers.yz : numbers.zw);
            // Only tied corners take a triangle away.
            if (many_edges ? is_kept(cell, polygon, t)
                           : corners.x != corners.y && corners.y != corners.z && corners.z != corners.x) {
                write_triangle(at, corners);
                if (with_sources) Words(sources).at[at] = page.first_word + cluster.first_word + cell.word;
                ++at;
            }
        }
    }
}

void write_triangles(bool special) {
    open_triangles();
    const uint self = gl_LocalInvocationIndex;
    const uint hits = bitCount(hit_groups);
    for (uint place = self / group_size; place < hits; place += workgroup_size / group_size) {
        const uint lane = self % group_size;
        if (triangles_in(place, 1u << lane) != 0u)
            write_triangles_of(cut_cell(tables, hit_group[place], lane, special), place, lane);
    }
}

/// Vertices and triangles of the edges from window_begin on. All invocations must call it.
void write_window(uint first_inner, bool special) {
    list_edges();
    barrier();
    if (special && window_begin == 0u) number_tied();
    number_seams();
    barrier();
    rank_seams();
    barrier();
    write_vertices(first_inner, special);
    barrier();
    write_triangles(special);
}

void main() {
    tables = TablesAt(push.tables).tables;
    const uint self = gl_LocalInvocationIndex;
    const uint place = group_index();
    const uint listed = list_head(tables, many_edges ? many_edges_list : few_edges_list).head.count;
    if (OutputAt(push.surface).surface.overflow != 0u || place >= listed) return;
    const uint number = Words(tables.emitted).at[many_edges ? tables.cluster_count - 1u - place : place];
    open_cluster(tables, number);
    if (push.batch != 0u && page.batch != push.batch) return;

    clear_cut();
    for (uint i = self; i < 3u * max_cluster_groups; i += workgroup_size) triangle_bits[i] = 0u;
    barrier();
    load_points();
    barrier();
    const bool special = any_in(tied) || any_in(no_data);
    find_hit_groups(push.isovalue, Ranges(tables.ranges).at[number]);
    cut_cells(special);
    barrier();
    rank_edges();
    start = Starts(tables.starts).at[number];
    const uint first_inner = own_seam_number(own_seams);
    for (;;) {
        write_window(first_inner, special);
        if (!many_edges || edge_count - window_begin <= few_edges) return;
        const uint last = few_edges / 32u - 1u;
        seams_before_window = seam_ranks[last] + bitCount(seam_bits[last]);
        window_begin += few_edges;
        barrier();
    }
}
