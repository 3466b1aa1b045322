// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sums of numbers over a workgroup. A file of its own: some drivers keep room for shared memory that nothing uses.
#ifndef ISOTET_SUMS_GLSL
#define ISOTET_SUMS_GLSL

#include "shared/workgroup.glsl"

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
