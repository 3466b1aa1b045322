// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Lists of clusters that workgroups append to, and that an indirect dispatch then works through, one workgroup a cluster.
#ifndef ISOTET_LISTS_GLSL
#define ISOTET_LISTS_GLSL

#include "shared/memory.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ListHeadAt {
    ListHead head;
};

// Places in Lists.
const uint selected_list = 0u;
const uint few_edges_list = 1u;
const uint many_edges_list = 2u;

ListHeadAt list_head(Tables tables, uint list) { return ListHeadAt(advance(tables.lists, list, 16u)); }

/// Makes room for `items` more; returns the place of the first. The groups are grown by maxima: whoever makes the last room
/// sees the whole count, whatever the order.
uint grow_list(ListHeadAt list, uint items, uint groups_per_axis) {
    const uint place = atomicAdd(list.head.count, items);
    const uint last = place + items - 1u;
    atomicMax(list.head.groups_x, min(last, groups_per_axis - 1u) + 1u);
    atomicMax(list.head.groups_y, min(last / groups_per_axis, groups_per_axis - 1u) + 1u);
    atomicMax(list.head.groups_z, last / groups_per_axis / groups_per_axis + 1u);
    return place;
}

#endif
