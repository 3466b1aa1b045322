// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Writes the list of clusters whose range holds the isovalue, both ends included, in any order; empties their masks, and the
// counts of all clusters, segments and blocks. An invocation a cluster, a workgroup a segment. Same as cpu/select.cpp.
#version 460
#include "shared/groups.glsl"
#include "shared/lists.glsl"
#include "shared/workgroup.glsl"

layout(push_constant, scalar) uniform Push {
    ExtractPush push;
};

shared uint found, first_place;

void main() {
    const Tables tables = TablesAt(push.tables).tables;
    const uint self = gl_LocalInvocationIndex;
    const uint segment = group_index();
    if (segment * segment_clusters >= tables.cluster_count) return;
    if (self == 0u) {
        found = 0u;
        Counts(tables.segments).at[segment] = Count(0u, 0u);
        if (segment % block_segments == 0u) Counts(tables.blocks).at[segment / block_segments] = Count(0u, 0u);
        if (segment == 0u) {
            OutputAt(push.surface).surface.tied_points = 0u;
            OutputAt(push.surface).surface.missing_normals = 0u;
            OutputAt(push.surface).surface.many_edges = 0u;
        }
    }

    const uint number = segment * segment_clusters + self;
    bool selected = false;
    if (number < tables.cluster_count) {
        const Range range = Ranges(tables.ranges).at[number];
        selected = range.lower <= push.isovalue && push.isovalue <= range.upper;
        Counts(tables.counts).at[number] = Count(0u, 0u);
    }
    barrier();
    uint place = 0u;
    if (selected) place = atomicAdd(found, 1u);
    barrier();
    if (found == 0u) return;
    if (self == 0u) first_place = grow_list(list_head(tables, selected_list), found, tables.groups_per_axis);
    barrier();
    if (!selected) return;
    Words(tables.selected).at[first_place + place] = number;
    const Cluster cluster = Clusters(tables.clusters).at[number];
    const uint words = tied_words + ((cluster.seams & own_seams_bits) + 31u) / 32u;
    for (uint word = 0u; word < words; ++word) Words(tables.masks).at[cluster.first_mask + word] = 0u;
}
