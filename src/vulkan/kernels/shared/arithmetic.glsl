// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The arithmetic of the contract, bit for bit as the processor has it. Same as numbers/arithmetic.hpp, name by name.
//
// Vulkan rounds sums, differences and products as IEEE 754 does, if they are `precise` and neither operands nor results are
// denormal: stored values (docs/inside/precision.md) see to that. Quotients and roots may be off by a few units: `divide`
// and `root` take the device's own and correct it by the remainder, in integers.
#ifndef ISOTET_ARITHMETIC_GLSL
#define ISOTET_ARITHMETIC_GLSL

const uint implicit_bit = 0x800000u; ///< of a float's significand, 24 bits with it
const uint zero_normal_code = 0x80008000u;
const float weight_floor = 2.3283064365386962890625e-10;            ///< 2^-32, exactly
const float component_floor = 9.094947017729282379150390625e-13;    ///< 2^-40, exactly

/// What the device itself makes of a quotient and a root; tests disturb them.
#ifndef ISOTET_DEVICE_QUOTIENT
#define ISOTET_DEVICE_QUOTIENT(a, b) ((a) / (b))
#define ISOTET_DEVICE_ROOT(x) sqrt(x)
#endif

/// They are nearer to the exact ones than so many units; the self-test notices when they are not.
const uint max_corrections = 16u;

/// Not-a-number by its bits: comparisons may be compiled away.
bool is_nan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }

/// sign * significand * 2^(exponent - 23); a significand that was rounded up to 2^24 carries into the exponent.
float composed(uint sign, int exponent, uint significand) {
    return uintBitsToFloat(sign | ((uint(exponent + 127) << 23) + (significand - implicit_bit)));
}

/// a / b, rounded to nearest; 0 where that is below 2^-126. `b` is not 0, neither is denormal, the quotient is below 2^128.
float divide(float a, float b) {
    const uint a_bits = floatBitsToUint(a), b_bits = floatBitsToUint(b);
    const uint sign = (a_bits ^ b_bits) & 0x80000000u;
    uint dividend = (a_bits & 0x7fffffu) | implicit_bit;
    const uint divisor = (b_bits & 0x7fffffu) | implicit_bit;
    int exponent = int((a_bits >> 23) & 0xffu) - int((b_bits >> 23) & 0xffu);
    if (dividend < divisor) {
        dividend <<= 1;
        --exponent;
    }
    if ((a_bits & 0x7fffffffu) == 0u || exponent < -126) return uintBitsToFloat(sign);
    // quotient = dividend * 2^23 / divisor, from 2^23 to 2^24. Its remainder is small, so 32 bits of it are enough. Two
    // neighbours can never be equally near: an odd number of 25 bits times the divisor is no multiple of 2^24.
    uint quotient = uint(ISOTET_DEVICE_QUOTIENT(float(dividend), float(divisor)) * 8388608.0);
    int remainder = int((dividend << 23) - quotient * divisor);
    for (uint i = 0u; i < max_corrections; ++i) {
        if (2 * remainder > int(divisor)) {
            ++quotient;
            remainder -= int(divisor);
        } else if (-2 * remainder > int(divisor)) {
            --quotient;
            remainder += int(divisor);
        } else break;
    }
    return composed(sign, exponent, quotient);
}

/// The square root, rounded to nearest. `x` is 0 or positive, finite, not denormal.
float root(float x) {
    const uint bits = floatBitsToUint(x);
    if (bits == 0u) return 0.0;
    int exponent = int(bits >> 23) - 127;
    uint square = (bits & 0x7fffffu) | implicit_bit;
    if ((exponent & 1) != 0) {
        square <<= 1;
        --exponent;
    }
    // side = square root of square * 2^23, from 2^23 to 2^24.
    uint side = uint(ISOTET_DEVICE_ROOT(float(square) * 1.1920928955078125e-7) * 8388608.0);
    int remainder = int((square << 23) - side * side);
    for (uint i = 0u; i < max_corrections; ++i) {
        if (remainder > int(side)) {
            remainder -= int(2u * side + 1u);
            ++side;
        } else if (remainder <= -int(side)) {
            --side;
            remainder += int(2u * side + 1u);
        } else break;
    }
    return composed(0u, exponent >> 1, side);
}

/// Where isovalue + rest lies between the end below (0) and the end above (1).
float edge_weight(float isovalue, float rest, float below, float above) {
    precise float rounded_up = isovalue - below;
    precise float part = rounded_up + rest;
    precise float whole = above - below;
    const float t = divide(part, whole);
    return t < weight_floor ? 0.0 : t;
}

/// a + t (b - a); exactly b at t = 1, which the formula alone can miss.
float interpolate(float a, float b, float t) {
    if (t == 1.0) return b;
    precise float difference = b - a;
    precise float part = t * difference;
    precise float sum = a + part;
    return sum;
}

/// A point field at a vertex: NaN at an end gives the canonical NaN.
float interpolate_field(float a, float b, float t) {
    if (is_nan(a) || is_nan(b)) return uintBitsToFloat(0x7fc00000u);
    return interpolate(a, b, t);
}

/// Components of 2^-62 and below may be squared to a denormal, or to 0: the largest, of 2^-40 at least or 2^-32, hides that.
vec3 normalized(vec3 v) {
    precise float xx = v.x * v.x;
    precise float yy = v.y * v.y;
    precise float zz = v.z * v.z;
    precise float two = xx + yy;
    precise float squares = two + zz;
    const float size = root(squares);
    return vec3(divide(v.x, size), divide(v.y, size), divide(v.z, size));
}

/// The direction of a normal code in whole numbers, as numbers/normal_code.hpp has it.
ivec3 decode_normal(uint code) {
    const int u = bitfieldExtract(int(code), 0, 16), v = bitfieldExtract(int(code), 16, 16);
    const int z = 32767 - abs(u) - abs(v);
    if (z >= 0) return ivec3(u, v, z);
    return ivec3((32767 - abs(v)) * (u < 0 ? -1 : 1), (32767 - abs(u)) * (v < 0 ? -1 : 1), z);
}

/// The unit direction of a normal code; zero for zero_normal_code.
vec3 direction_of(uint code) {
    if (code == zero_normal_code) return vec3(0.0);
    return normalized(vec3(decode_normal(code)));
}

/// The gradient normal at a vertex; zero when an end has none or they cancel (the face normal then stands in).
vec3 vertex_normal(uint below, uint above, float t) {
    if (below == zero_normal_code || above == zero_normal_code) return vec3(0.0);
    const vec3 a = direction_of(below), b = direction_of(above);
    const vec3 n = vec3(interpolate(a.x, b.x, t), interpolate(a.y, b.y, t), interpolate(a.z, b.z, t));
    if (all(lessThan(abs(n), vec3(weight_floor)))) return vec3(0.0);
    return normalized(n);
}

float scaled_component(float x, float factor) {
    precise float scaled = x * factor;
    return abs(scaled) < component_floor ? 0.0 : scaled;
}

/// Times the power of two that brings the largest component into [1, 2); what is then below 2^-40 becomes 0.
vec3 scaled_to_one(vec3 v) {
    const float largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if (largest == 0.0) return vec3(0.0);
    const float factor = uintBitsToFloat((254u - (floatBitsToUint(largest) >> 23)) << 23);
    return vec3(scaled_component(v.x, factor), scaled_component(v.y, factor), scaled_component(v.z, factor));
}

vec3 exact_difference(vec3 b, vec3 a) {
    precise vec3 difference = b - a;
    return difference;
}

/// The unit normal of a triangle; (0, 0, 0) when its area is zero.
vec3 face_normal(vec3 a, vec3 b, vec3 c) {
    const vec3 u = scaled_to_one(exact_difference(b, a)), v = scaled_to_one(exact_difference(c, a));
    precise vec3 first = u.yzx * v.zxy;
    precise vec3 second = u.zxy * v.yzx;
    const vec3 n = scaled_to_one(exact_difference(first, second));
    if (n == vec3(0.0)) return vec3(0.0);
    return normalized(n);
}

#endif
