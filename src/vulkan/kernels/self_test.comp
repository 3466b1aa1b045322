// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Writes what this device's arithmetic makes of each case, an invocation a case. Same as vulkan/self_test.cpp, on the processor.
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/arithmetic.glsl"
#include "shared/groups.glsl"
#include "shared/self_test.h"

layout(local_size_x = 64) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Cases {
    SelfTestCase at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Answers {
    SelfTestAnswer at[];
};

layout(push_constant, scalar) uniform Push {
    Cases cases;
    Answers answers;
    uint count;
};

vec3 corner(SelfTestCase given, uint i) {
    return vec3(given.corners[3u * i], given.corners[3u * i + 1u], given.corners[3u * i + 2u]);
}

void main() {
    const uint i = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (i >= count) return;
    const SelfTestCase given = cases.at[i];
    const float t = edge_weight(given.isovalue, given.rest, given.below, given.above);
    const vec3 vertex = vertex_normal(given.code_below, given.code_above, t);
    const vec3 face = face_normal(corner(given, 0u), corner(given, 1u), corner(given, 2u));
    answers.at[i].weight = floatBitsToUint(t);
    answers.at[i].interpolated = floatBitsToUint(interpolate(given.a, given.b, t));
    for (uint axis = 0u; axis < 3u; ++axis) {
        answers.at[i].vertex_normal[axis] = floatBitsToUint(vertex[axis]);
        answers.at[i].face_normal[axis] = floatBitsToUint(face[axis]);
    }
}
