// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Counts what each selected cluster gives, and sets the masks: which own seams are crossed, which own tied points are used.
// A workgroup a cluster, an invocation a point, a cell of a group, a seam. All that workgroups share they OR or add to, so
// their order does not matter. Same as cpu/count.cpp.
#version 460
#include "shared/groups.glsl"
#include "shared/lists.glsl"

layout(constant_id = 0) const bool with_others = true; ///< the grid has cells that are no tets

#include "shared/cut.glsl"

layout(push_constant, scalar) uniform Push {
    ExtractPush push;
};

shared uint own_seam_bits[max_cluster_seams / 32u];
shared uint used_tied[tied_words]; ///< local points
shared uint tied_points;
shared uint edge_sum, seam_sum, triangle_sum, fresh_sum;

Tables tables;

void add_to_counts(uint number, uint vertices, uint at_points, uint triangles, uint flag) {
    if (vertices != 0u) {
        atomicAdd(Counts(tables.counts).at[number].vertices, vertices + (at_points << 16));
        atomicAdd(Counts(tables.segments).at[number / segment_clusters].vertices, vertices);
        atomicAdd(Counts(tables.blocks).at[number / segment_clusters / block_segments].vertices, vertices);
    }
    if (triangles != 0u) {
        atomicAdd(Counts(tables.counts).at[number].triangles, triangles + flag);
        atomicAdd(Counts(tables.segments).at[number / segment_clusters].triangles, triangles);
        atomicAdd(Counts(tables.blocks).at[number / segment_clusters / block_segments].triangles, triangles);
    }
}

bool has_no_data(uint number) { return (Words(tables.no_data).at[number / 32u] >> number % 32u & 1u) != 0u; }

/// Sets a bit of the masks of `owner`; whoever sets it first counts the vertex.
void tell_owner(uint owner, uint bit, uint at_point) {
    const uint word = Clusters(tables.clusters).at[owner].first_mask + bit / 32u;
    const uint value = 1u << bit % 32u;
    if ((atomicOr(Words(tables.masks).at[word], value) & value) == 0u) add_to_counts(owner, 1u, at_point, 0u, 0u);
}

void load_points(bool merge) {
    const uint self = gl_LocalInvocationIndex;
    if (self >= local_points()) return;
    const float value = value_of(page_point(self));
    classify(self, value, push.isovalue, push.tied, merge);
    if (self >= ghost_points && value == push.tied) atomicAdd(tied_points, 1u);
}

/// Tied points are used where a triangle is kept.
void use_tied(Cell cell) {
    for (uint i = 0u; i < polygon_count(tables, cell); ++i) {
        const uint polygon = polygon_of(tables, cell, i);
        for (uint t = 0u; t < triangles_of(polygon); ++t) {
            if (!is_kept(cell, polygon, t)) continue;
            for (uint k = 0u; k < 3u; ++k) {
                const uint end = polygon_edge(polygon, k == 0u ? 0u : k + t).x, point = corner_of(cell, end);
                if ((cell.tied >> end & 1u) != 0u) atomicOr(used_tied[point / 32u], 1u << point % 32u);
            }
        }
    }
}

void cut_cells(bool special) {
    const uint self = gl_LocalInvocationIndex;
    const uint hits = bitCount(hit_groups);
    uint triangles = 0u;
    for (uint place = self / group_size; place < hits; place += workgroup_size / group_size) {
        const Cell cell = cut_cell(tables, hit_group[place], self % group_size, special);
        if (cell.triangles != 0u) {
            triangles += cell.triangles;
            add_edges(tables, cell);
            if (cell.tied != 0u) use_tied(cell);
        }
    }
    if (triangles != 0u) atomicAdd(triangle_sum, triangles);
}

void count_edges() {
    uint edges = 0u;
    for (uint i = 0u; i < 4u; ++i) edges += bitCount(matrix[4u * gl_LocalInvocationIndex + i]);
    if (edges != 0u) atomicAdd(edge_sum, edges);
}

/// Notes crossed own seams in own_seam_bits, tells owners that cannot know of the others.
void find_seams() {
    uint found = 0u;
    for (uint k = gl_LocalInvocationIndex; k < own_seams; k += workgroup_size) {
        if (is_crossed(own_seam(k))) {
            atomicOr(own_seam_bits[k / 32u], 1u << k % 32u);
            ++found;
        }
    }
    for (uint k = gl_LocalInvocationIndex; k < ghost_seams(); k += workgroup_size) {
        const uvec3 seam = ghost_seam(k);
        if (!is_crossed(seam.xy)) continue;
        ++found;
        // Where all points of the owner have data, it knows from its own cells: all of them count.
        if (tables.any_no_data == 0u) continue;
        const uint owner = neighbour_of(k, 16u).cluster;
        if (has_no_data(owner)) tell_owner(owner, 32u * tied_words + seam.z, 0u);
    }
    if (found != 0u) atomicAdd(seam_sum, found);
}

/// Writes the mask of own seams; counts the bits that were not set before.
void write_own_seams(uint number) {
    const bool others_write = tables.any_no_data != 0u && has_no_data(number);
    uint fresh = 0u;
    for (uint word = gl_LocalInvocationIndex; word < (own_seams + 31u) / 32u; word += workgroup_size) {
        const uint bits = own_seam_bits[word], at = cluster.first_mask + tied_words + word;
        uint known = 0u;
        if (others_write) known = atomicOr(Words(tables.masks).at[at], bits);
        else Words(tables.masks).at[at] = bits;
        fresh += bitCount(bits & ~known);
    }
    if (fresh != 0u) atomicAdd(fresh_sum, fresh);
}

void tell_tied(uint number) {
    const uint self = gl_LocalInvocationIndex;
    if (self >= local_points() || (used_tied[self / 32u] >> self % 32u & 1u) == 0u) return;
    if (self >= ghost_points) {
        tell_owner(number, self - ghost_points, 1u);
    } else {
        const Neighbour neighbour = neighbour_of(self, 0u);
        tell_owner(neighbour.cluster, place_in_owner(tables, neighbour, self), 1u);
    }
}

void main() {
    tables = TablesAt(push.tables).tables;
    const uint self = gl_LocalInvocationIndex;
    const uint place = group_index();
    if (place >= list_head(tables, selected_list).head.count) return;
    const uint number = Words(tables.selected).at[place];
    open_cluster(tables, number);
    if (push.batch != 0u && page.batch != push.batch) return;

    clear_cut();
    for (uint word = self; word < max_cluster_seams / 32u; word += workgroup_size) own_seam_bits[word] = 0u;
    if (self < tied_words) used_tied[self] = 0u;
    if (self == 0u) tied_points = edge_sum = seam_sum = triangle_sum = fresh_sum = 0u;
    barrier();
    load_points(push.merge != 0u);
    barrier();
    const bool special = any_in(tied) || any_in(no_data);
    find_hit_groups(push.isovalue, Ranges(tables.ranges).at[number]);
    cut_cells(special);
    barrier();
    count_edges();
    find_seams();
    barrier();
    write_own_seams(number);
    if (special) tell_tied(number);
    barrier();
    if (self != 0u) return;
    const bool many = edge_sum > few_edges;
    add_to_counts(number, edge_sum - seam_sum + fresh_sum, 0u, triangle_sum, many ? many_edges_flag : 0u);
    if (many) OutputAt(push.surface).surface.many_edges = 1u;
    if (tied_points != 0u) atomicAdd(OutputAt(push.surface).surface.tied_points, tied_points);
}
