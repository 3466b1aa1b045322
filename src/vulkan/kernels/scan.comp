// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Turns counts into starts: where the vertices and triangles of each cluster begin. Lists the clusters that have any; writes
// the size of the surface, and whether it fits. An invocation a cluster, a workgroup a segment, each of which adds up the
// blocks and segments before it: no workgroup waits for another. Same as scan() of cpu/count.cpp.
#version 460
#include "shared/groups.glsl"
#include "shared/lists.glsl"
#include "shared/sum_pairs.glsl"

layout(push_constant, scalar) uniform Push {
    ExtractPush push;
};

shared uvec4 total_halves; ///< vertices lower, upper; triangles lower, upper
shared uvec2 before;        ///< vertices and triangles of the segments before this one
shared uint few, many, few_place, many_place;

Tables tables;

uint segment_count() { return (tables.cluster_count + segment_clusters - 1u) / segment_clusters; }
uint block_count() { return (segment_count() + block_segments - 1u) / block_segments; }

/// A sum of 64 bits from the sum of the lower and that of the upper halves of its items.
uvec2 wide_sum(uvec2 halves) {
    uint carry;
    const uint low = uaddCarry(halves.x, halves.y << 16, carry);
    return uvec2(low, (halves.y >> 16) + carry);
}

/// By all invocations of one workgroup.
void write_totals() {
    for (uint block = gl_LocalInvocationIndex; block < block_count(); block += workgroup_size) {
        const Count count = Counts(tables.blocks).at[block];
        atomicAdd(total_halves.x, count.vertices & 0xffffu);
        atomicAdd(total_halves.y, count.vertices >> 16);
        atomicAdd(total_halves.z, count.triangles & 0xffffu);
        atomicAdd(total_halves.w, count.triangles >> 16);
    }
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;

    const uvec2 all_vertices = wide_sum(total_halves.xy), all_triangles = wide_sum(total_halves.zw);
    uint vertices = all_vertices.x, triangles = all_triangles.x;
    OutputAt head = OutputAt(push.surface);
    const bool fits = (all_vertices.y | all_triangles.y) == 0u && vertices <= head.surface.vertex_capacity &&
                      triangles <= head.surface.triangle_capacity;
    head.surface.vertices_low = vertices;
    head.surface.vertices_high = all_vertices.y;
    head.surface.triangles_low = triangles;
    head.surface.triangles_high = all_triangles.y;
    head.surface.overflow = fits ? 0u : 1u;
    head.surface.selected_clusters = list_head(tables, selected_list).head.count;
    if (!fits) vertices = triangles = 0u;
    // One draw takes 2^32 - 1 indices at most.
    head.surface.draw = DrawArguments(3u * min(triangles, 0xffffffffu / 3u), 1u, 0u, 0u, 0u);
    const uvec3 of_vertices = fold_groups((vertices + workgroup_size - 1u) / workgroup_size, tables.groups_per_axis);
    const uvec3 of_triangles = fold_groups((triangles + workgroup_size - 1u) / workgroup_size, tables.groups_per_axis);
    head.surface.vertex_groups_x = of_vertices.x;
    head.surface.vertex_groups_y = of_vertices.y;
    head.surface.vertex_groups_z = of_vertices.z;
    head.surface.triangle_groups_x = of_triangles.x;
    head.surface.triangle_groups_y = of_triangles.y;
    head.surface.triangle_groups_z = of_triangles.z;
}

/// Adds up `before`.
void sum_segments_before(uint segment) {
    const uint self = gl_LocalInvocationIndex;
    const uint block = segment / block_segments;
    uvec2 sum = uvec2(0u);
    for (uint i = self; i < block; i += workgroup_size) {
        const Count count = Counts(tables.blocks).at[i];
        sum += uvec2(count.vertices, count.triangles);
    }
    for (uint i = block * block_segments + self; i < segment; i += workgroup_size) {
        const Count count = Counts(tables.segments).at[i];
        sum += uvec2(count.vertices, count.triangles);
    }
    if (sum.x != 0u) atomicAdd(before.x, sum.x);
    if (sum.y != 0u) atomicAdd(before.y, sum.y);
}

/// Appends the clusters with output to the lists.
void list_cluster(uint number, bool has_output, bool has_many) {
    uint place = 0u;
    if (has_output) place = has_many ? atomicAdd(many, 1u) : atomicAdd(few, 1u);
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        if (few != 0u) few_place = grow_list(list_head(tables, few_edges_list), few, tables.groups_per_axis);
        if (many != 0u) many_place = grow_list(list_head(tables, many_edges_list), many, tables.groups_per_axis);
    }
    barrier();
    if (!has_output) return;
    const uint at = has_many ? tables.cluster_count - 1u - many_place - place : few_place + place;
    Words(tables.emitted).at[at] = number;
}

void main() {
    tables = TablesAt(push.tables).tables;
    const uint segment = group_index();
    if (segment >= segment_count()) return;
    if (gl_LocalInvocationIndex == 0u) {
        total_halves = uvec4(0u);
        before = uvec2(0u);
        few = many = 0u;
    }
    barrier();
    if (segment == 0u) write_totals();
    const Count in_segment = Counts(tables.segments).at[segment];
    if ((in_segment.vertices | in_segment.triangles) == 0u) return;

    sum_segments_before(segment);
    const uint number = segment * segment_clusters + gl_LocalInvocationIndex;
    Count count = Count(0u, 0u);
    if (number < tables.cluster_count) count = Counts(tables.counts).at[number];
    const uint vertices = count.vertices & 0xffffu, triangles = count.triangles & ~many_edges_flag;
    const uvec2 in_segment_before = sum_before(uvec2(vertices, triangles)); // its barriers complete `before`
    const uvec2 start = before + in_segment_before;
    const bool has_output = (vertices | triangles) != 0u;
    if (has_output) Starts(tables.starts).at[number] = Start(start.x, start.x + (count.vertices >> 16), start.y);
    list_cluster(number, has_output, (count.triangles & many_edges_flag) != 0u);
}
