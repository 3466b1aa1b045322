// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Writes the root of the float whose bits are first_bits + i, and leaves the device's own root off by some units first.
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

layout(constant_id = 0) const int units_off = 0;
float off(float x) { return uintBitsToFloat(floatBitsToUint(x) + uint(units_off)); }
#define ISOTET_DEVICE_QUOTIENT(a, b) off((a) / (b))
#define ISOTET_DEVICE_ROOT(x) off(sqrt(x))
#include "shared/arithmetic.glsl"
#include "shared/groups.glsl"

layout(local_size_x = 128) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Floats {
    float at[];
};

layout(push_constant, scalar) uniform Push {
    Floats roots;
    uint first_bits;
    uint count;
};

void main() {
    const uint i = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (i < count) roots.at[i] = root(uintBitsToFloat(first_bits + i));
}
