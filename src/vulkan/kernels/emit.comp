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

layout(constant_id = 0) const uint edge_room = 1024; ///< few_edges or max_edges: which of the two lists is worked through
const uint seam_room = edge_room > few_edges ? edge_room : few_seams;
layout(constant_id = 1) const bool with_ends = false;
layout(constant_id = 2) const bool with_normals = false;
layout(constant_id = 3) const bool with_sources = false;
layout(constant_id = 4) const bool with_others = true; ///< the grid has cells that are no tets

#include "shared/cut.glsl"

layout(push_constant, scalar) uniform Push {
    ExtractPush push;
};

shared uint points[max_cluster_points]; ///< page-local numbers of local points
shared uint tied_numbers[max_cluster_points]; ///< of the vertices at tied points
shared uint edge_count;
shared uint seam_bits[edge_room / 32u];       ///< by rank of an active edge: it is a seam
shared uint seam_ranks[edge_room / 32u];
/// By rank: the first active edges, lower + 256 * higher, until vertices are written; then vertices on active seams.
shared uint seam_numbers[seam_room];
shared uint triangle_bits[3u * max_cluster_groups]; ///< by place in hit_group, a bit a cell: of its number of triangles
// sums_before: active edges before each row of the matrix + 65536 * triangles before each place in hit_group

Tables tables;
Start start;
Output surface;
Floats position_out, normal_out, weight_out;
Words triangle_out, lowest_out, end_out, source_out;

void open_output(uint number) {
    start = Starts(tables.starts).at[number];
    position_out = Floats(advance(surface.positions, start.vertex, 12u));
    triangle_out = Words(advance(surface.triangles, start.triangle, 12u));
    // What is not asked for is assigned all the same: SwiftShader cannot compile an address that no path assigns, and all others
    // leave out what is not used.
    normal_out = Floats(advance(surface.normals, start.vertex, 12u));
    lowest_out = Words(advance(surface.lowest, start.vertex, 4u));
    end_out = Words(advance(surface.ends, start.vertex, 8u));
    weight_out = Floats(advance(surface.weights, start.vertex, 4u));
    source_out = Words(advance(surface.sources, start.triangle, 4u));
}

/// Bits before `bit` in a mask that begins at word `first`.
uint bits_before(uint first, uint bit) {
    uint count = bitCount(Words(tables.masks).at[first + bit / 32u] & (1u << bit % 32u) - 1u);
    for (uint word = 0u; word < bit / 32u; ++word) count += bitCount(Words(tables.masks).at[first + word]);
    return count;
}

void write_normal(uint vertex, uint below, uint above_end, float t) {
    const vec3 normal = vertex_normal(page_words.at[page.gradients + below], page_words.at[page.gradients + above_end], t);
    for (uint axis = 0u; axis < 3u; ++axis) normal_out.at[3u * vertex + axis] = normal[axis];
    if (normal != vec3(0.0)) return;
    lowest_out.at[vertex] = 0xffffffffu;
    OutputAt(push.surface).surface.missing_normals = 1u;
}

/// Writes the vertex between two local points. `vertex` counts this cluster's own.
void write_vertex(uint vertex, uint below, uint above_end, float t) {
    const vec3 a = position_of(points[below]), b = position_of(points[above_end]);
    for (uint axis = 0u; axis < 3u; ++axis) position_out.at[3u * vertex + axis] = interpolate(a[axis], b[axis], t);
    if (with_ends) {
        end_out.at[2u * vertex] = packed_point(points[below]);
        end_out.at[2u * vertex + 1u] = packed_point(points[above_end]);
        weight_out.at[vertex] = t;
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
        if (cell.triangles == 0u) continue;
        add_edges(tables, cell);
        for (uint bit = 0u; bit < 3u; ++bit)
            if ((cell.triangles >> bit & 1u) != 0u) atomicOr(triangle_bits[3u * place + bit], 1u << lane);
    }
}

uint edges_before_row(uint row) { return sums_before[row] & 0xffffu; }
uint triangles_before(uint place) { return sums_before[place] >> 16; }

/// Ranks of active edges by row, and the first triangle of each hit group.
void rank_edges() {
    const uint self = gl_LocalInvocationIndex;
    uint sum = 0u;
    for (uint i = 0u; i < 4u; ++i) sum += bitCount(matrix[4u * self + i]);
    if (self < max_cluster_groups) sum += triangles_in(self, 0xffffffffu) << 16;
    find_sums_before(sum);
    uint rank = edges_before_row(self);
    for (uint i = 0u; i < 4u; ++i)
        for (uint bits = matrix[4u * self + i]; bits != 0u && rank < seam_room; bits &= bits - 1u)
            seam_numbers[rank++] = self + (32u * i + findLSB(bits) << 8);
    if (self == workgroup_size - 1u) edge_count = (sums_before[self] + sum) & 0xffffu;
}

uint rank_of(uvec2 edge) {
    uint rank = edges_before_row(edge.x);
    for (uint word = 0u; word < edge.y / 32u; ++word) rank += bitCount(matrix[4u * edge.x + word]);
    return rank + bitCount(matrix[matrix_word(edge)] & (1u << edge.y % 32u) - 1u);
}

/// (lower, higher) of the active edge with this rank.
uvec2 edge_at(uint rank) {
    if (rank < seam_room) return uvec2(seam_numbers[rank] & 0xffu, seam_numbers[rank] >> 8);
    uint row = 0u; // the last one that begins at or before it: empty rows begin where the next one does
    for (uint step = max_cluster_points / 2u; step != 0u; step /= 2u)
        if (edges_before_row(row + step) <= rank) row += step;
    uint left = rank - edges_before_row(row), word = 0u, bits = matrix[4u * row];
    while (left >= bitCount(bits)) {
        left -= bitCount(bits);
        bits = matrix[4u * row + ++word];
    }
    for (; left != 0u; --left) bits &= bits - 1u;
    return uvec2(row, 32u * word + findLSB(bits));
}

bool is_seam(uint rank) { return (seam_bits[rank / 32u] >> rank % 32u & 1u) != 0u; }
uint seams_before(uint rank) { return seam_ranks[rank / 32u] + bitCount(seam_bits[rank / 32u] & (1u << rank % 32u) - 1u); }

bool is_masked(uint bit) { return (Words(tables.masks).at[cluster.first_mask + bit / 32u] >> bit % 32u & 1u) != 0u; }

/// Numbers of the tied points that other clusters own, and of this cluster's own.
void number_tied() {
    const uint self = gl_LocalInvocationIndex;
    if (self >= local_points() || !is_in(tied, self)) return;
    if (self >= ghost_points) {
        tied_numbers[self] = start.vertex + bits_before(cluster.first_mask, self - ghost_points);
        return;
    }
    const Neighbour neighbour = neighbour_of(self, 0u);
    tied_numbers[self] = Starts(tables.starts).at[neighbour.cluster].vertex +
                         bits_before(Clusters(tables.clusters).at[neighbour.cluster].first_mask,
                                     place_in_owner(tables, neighbour, self));
}

uint own_seam_number(uint k) { return start.seam_vertex + bits_before(cluster.first_mask + tied_words, k); }

void mark_seam(uvec2 edge) {
    if (!is_crossed(edge)) return;
    const uint rank = rank_of(edge);
    atomicOr(seam_bits[rank / 32u], 1u << rank % 32u);
}

void mark_seams() {
    for (uint k = gl_LocalInvocationIndex; k < own_seams; k += workgroup_size) mark_seam(own_seam(k));
    for (uint k = gl_LocalInvocationIndex; k < ghost_seams; k += workgroup_size) mark_seam(ghost_seam(k).xy);
}

void number_seams() {
    for (uint k = gl_LocalInvocationIndex; k < own_seams; k += workgroup_size) {
        const uvec2 edge = own_seam(k);
        if (is_crossed(edge)) seam_numbers[seams_before(rank_of(edge))] = own_seam_number(k);
    }
    for (uint k = gl_LocalInvocationIndex; k < ghost_seams; k += workgroup_size) {
        const uvec3 seam = ghost_seam(k);
        if (!is_crossed(seam.xy)) continue;
        const uint owner = neighbour_of(k, 16u).cluster;
        seam_numbers[seams_before(rank_of(seam.xy))] =
            Starts(tables.starts).at[owner].seam_vertex +
            bits_before(Clusters(tables.clusters).at[owner].first_mask + tied_words, seam.z);
    }
}

void rank_seams() {
    const uint self = gl_LocalInvocationIndex;
    if (self >= edge_room / 32u) return;
    uint rank = 0u;
    [[dont_unroll]] for (uint word = 0u; word < self; ++word) rank += bitCount(seam_bits[word]);
    seam_ranks[self] = rank;
}

/// Writes all own vertices: of inner edges, whose numbers are found here, by rank; of own seams that the mask has, though
/// perhaps only others cross them; of tied own points that the mask has.
void write_vertices(uint first_inner, bool special) {
    const uint edges = edge_count, items = edges + own_seams + (special ? own_points : 0u);
    for (uint item = gl_LocalInvocationIndex; item < items; item += workgroup_size) {
        uint number;
        uvec2 ends; // local points
        if (item < edges) {
            if (is_seam(item)) continue;
            number = first_inner + item - seams_before(item);
            ends = edge_at(item);
        } else if (item < edges + own_seams) {
            const uint k = item - edges;
            if (!is_masked(32u * tied_words + k)) continue;
            number = own_seam_number(k);
            ends = own_seam(k);
        } else {
            const uint place = item - edges - own_seams;
            if (!is_masked(place)) continue;
            ends = uvec2(ghost_points + place);
            number = tied_numbers[ends.x];
        }
        float t = 0.0;
        if (ends.x != ends.y) {
            if (is_in(above, ends.x)) ends = ends.yx;
            t = edge_weight(push.isovalue, push.rest, value_of(points[ends.x]), value_of(points[ends.y]));
        }
        write_vertex(number - start.vertex, ends.x, ends.y, t);
    }
}

uint number_of(uint first_inner, Cell cell, uint polygon, uint k) {
    const uvec2 ends = polygon_edge(polygon, k);
    const uint a = corner_of(cell, ends.x), b = corner_of(cell, ends.y);
    if ((cell.tied >> ends.x & 1u) != 0u) return tied_numbers[a];
    const uint rank = rank_of(ascending(a, b)), seams = seams_before(rank);
    return is_seam(rank) ? seam_numbers[seams] : first_inner + rank - seams;
}

void write_triangles(uint first_inner, bool special) {
    const uint self = gl_LocalInvocationIndex;
    const uint hits = bitCount(hit_groups);
    for (uint place = self / group_size; place < hits; place += workgroup_size / group_size) {
        const uint lane = self % group_size;
        if (triangles_in(place, 1u << lane) == 0u) continue;
        const Cell cell = cut_cell(tables, hit_group[place], lane, special);
        uint at = triangles_before(place) + triangles_in(place, (1u << lane) - 1u);
        for (uint i = 0u; i < polygon_count(tables, cell); ++i) {
            const uint polygon = polygon_of(tables, cell, i);
            uint numbers[4];
            for (uint k = 0u; k < 4u; ++k) numbers[k] = number_of(first_inner, cell, polygon, k);
            for (uint t = 0u; t < triangles_of(polygon); ++t) {
                const uint a = numbers[0], b = numbers[1u + t], c = numbers[2u + t];
                if (a == b || b == c || c == a) continue; // only with tied corners
                triangle_out.at[3u * at] = a;
                triangle_out.at[3u * at + 1u] = b;
                triangle_out.at[3u * at + 2u] = c;
                if (with_sources) source_out.at[at] = group_size * (page.first_group + cluster.first_group) + cell.word;
                ++at;
            }
        }
    }
}

void main() {
    tables = TablesAt(push.tables).tables;
    surface = OutputAt(push.surface).surface;
    const uint self = gl_LocalInvocationIndex;
    const uint place = group_index();
    const bool many = edge_room > few_edges;
    if (surface.overflow != 0u || place >= list_head(tables, many ? many_edges_list : few_edges_list).head.count) return;
    const uint number = Words(tables.emitted).at[many ? tables.cluster_count - 1u - place : place];
    open_cluster(tables, number);
    if (push.batch != 0u && page.batch != push.batch) return;
    open_output(number);

    clear_cut();
    for (uint word = self; word < edge_room / 32u; word += workgroup_size) seam_bits[word] = 0u;
    for (uint i = self; i < 3u * max_cluster_groups; i += workgroup_size) triangle_bits[i] = 0u;
    barrier();
    load_points();
    barrier();
    const bool special = any_in(tied) || any_in(no_data);
    find_hit_groups(push.isovalue, Ranges(tables.ranges).at[number]);
    cut_cells(special);
    barrier();
    rank_edges();
    barrier();
    if (special) number_tied();
    mark_seams();
    barrier();
    rank_seams();
    barrier();
    const uint first_inner = own_seam_number(own_seams);
    write_vertices(first_inner, special);
    barrier();
    number_seams();
    barrier();
    write_triangles(first_inner, special);
}
