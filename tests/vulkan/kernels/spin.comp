// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Takes its time: every invocation squares its word `rounds` times, each square needing the one before.
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 8) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Words {
    uint at[];
};

layout(push_constant, scalar) uniform Push {
    Words words;
    uint rounds;
};

void main() {
    uint x = words.at[gl_LocalInvocationIndex];
    for (uint i = 0u; i < rounds; ++i) x = x * x + i;
    words.at[gl_LocalInvocationIndex] = x;
}
