// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Writes what shared/exact_double.glsl makes of a[i] and b[i], for each operation of doubles_test.cpp, as bits.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/exact_double.glsl"
#include "shared/groups.glsl"

layout(local_size_x = 128) in;

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Doubles {
    Double at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) writeonly buffer Answers {
    Double at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Words {
    uint at[];
};

layout(push_constant, scalar) uniform Push {
    uvec2 a;
    Doubles b;
    Answers answers;
    uint count, operation;
};

Double answer(Double a, Double b, uint low) {
    switch (operation) {
    case 0u: return sum_of(a, b);
    case 1u: return difference_of(a, b);
    case 2u: return product_of(a, b);
    case 3u: return quotient(a, b);
    case 4u: return square_root(a);
    case 5u: return double_of_bits(0u, floatBitsToUint(float_of(a)));
    case 6u: return double_of(float(whole_of(a)));
    case 7u: return lesser(a, b);
    case 8u: return greater(a, b);
    case 9u: return negated(absolute(a));
    case 10u: return double_of(uintBitsToFloat(low));
    }
    return double_of(is_less(a, b) ? 1.0 : 0.0);
}

void main() {
    const uint i = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (i < count) answers.at[i] = answer(Doubles(a).at[i], b.at[i], Words(a).at[2u * i]);
}
