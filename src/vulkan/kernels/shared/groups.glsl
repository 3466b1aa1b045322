// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which workgroup this is, of many folded into three axes of limited length. The C++ half is vulkan/groups.hpp.
#ifndef ISOTET_GROUPS_GLSL
#define ISOTET_GROUPS_GLSL

/// Compare with the number of groups that there should be: folding rounds it up.
uint group_index() {
    return (gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

/// The arguments of an indirect dispatch of at least `count` groups, at most `limit` an axis; count <= limit^3.
uvec3 fold_groups(uint count, uint limit) {
    if (count == 0u) return uvec3(0u, 1u, 1u);
    const uint planes = ((count - 1u) / limit + 1u - 1u) / limit + 1u;
    const uint plane = (count - 1u) / planes + 1u;
    const uint rows = (plane - 1u) / limit + 1u;
    return uvec3((plane - 1u) / rows + 1u, rows, planes);
}

#endif
