// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Adds `term` times the specialization constant to each of `count` words, an invocation a word.
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/groups.glsl"

layout(local_size_x = 32) in;
layout(constant_id = 0) const uint factor = 1;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Words {
    uint at[];
};

layout(push_constant, scalar) uniform Push {
    Words words;
    uint count;
    uint term;
};

void main() {
    const uint i = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (i < count) words.at[i] += factor * term;
}
