// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the 128 invocations of a workgroup do together. Only shared memory and barriers: a subgroup may have any size, and
// may hold any invocations.
#ifndef ISOTET_WORKGROUP_GLSL
#define ISOTET_WORKGROUP_GLSL

#extension GL_EXT_control_flow_attributes : require

layout(local_size_x = 128) in;

const uint workgroup_size = 128u;
const uint chunk = 8u;

shared uvec2 scan_items[workgroup_size];
shared uvec2 scan_chunks[workgroup_size / chunk];

/// The sum of `item` over all invocations before this one. All invocations must call it, once in a kernel.
uvec2 sum_before(uvec2 item) {
    const uint self = gl_LocalInvocationIndex;
    scan_items[self] = item;
    barrier();
    if (self < workgroup_size / chunk) {
        uvec2 sum = uvec2(0u);
        for (uint i = 0u; i < chunk; ++i) sum += scan_items[self * chunk + i];
        scan_chunks[self] = sum;
    }
    barrier();
    const uint own_chunk = self / chunk;
    uvec2 before = uvec2(0u);
    for (uint i = 0u; i < own_chunk; ++i) before += scan_chunks[i];
    for (uint i = own_chunk * chunk; i < self; ++i) before += scan_items[i];
    return before;
}

shared uint sums_before[workgroup_size];
shared uint chunk_sums[workgroup_size / chunk];

/// Leaves in sums_before, for each invocation, the sum of `item` over all before it. All invocations must call it, once in
/// a kernel; a barrier must follow.
void find_sums_before(uint item) {
    const uint self = gl_LocalInvocationIndex;
    sums_before[self] = item;
    barrier();
    if (self < workgroup_size / chunk) {
        uint sum = 0u;
        for (uint i = 0u; i < chunk; ++i) {
            const uint next = sum + sums_before[self * chunk + i];
            sums_before[self * chunk + i] = sum;
            sum = next;
        }
        chunk_sums[self] = sum;
    }
    barrier();
    uint before = 0u;
    [[dont_unroll]] for (uint i = 0u; i < self / chunk; ++i) before += chunk_sums[i];
    sums_before[self] += before;
}

#endif
