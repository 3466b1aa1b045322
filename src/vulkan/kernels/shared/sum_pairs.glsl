// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sums of pairs of numbers over a workgroup. A file of its own: some drivers keep room for shared memory that nothing uses.
#ifndef ISOTET_SUM_PAIRS_GLSL
#define ISOTET_SUM_PAIRS_GLSL

#include "shared/workgroup.glsl"

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

#endif
