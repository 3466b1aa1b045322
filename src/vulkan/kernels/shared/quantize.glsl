// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// core::quantize() of packed/packed.hpp, bit for bit: a subtraction and a multiplication by a power of two.
#ifndef ISOTET_QUANTIZE_GLSL
#define ISOTET_QUANTIZE_GLSL

#include "shared/layout.h"

uint quantize(float value, Range range) {
    precise const float width = range.upper - range.lower;
    if (!(width > 0.0) || !(value > range.lower)) return 0u;
    const uint exponent = floatBitsToUint(width) >> 23;
    const float step = uintBitsToFloat(127u + 127u + 7u - exponent << 23);
    precise const float steps = (min(value, range.upper) - range.lower) * step;
    return uint(min(steps, 255.0));
}

#endif
