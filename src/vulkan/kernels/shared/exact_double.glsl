// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Doubles, rounded to nearest as the processor does it: the device's own, or with ISOTET_INTEGER_DOUBLES those of
// integer_double.glsl, by the same functions.
//
// Of the device's own, sums, differences and products are exact where they are `precise`; quotients and roots, which need be no
// better than single precision allows, are corrected by their remainder, which is exact.
#ifndef ISOTET_EXACT_DOUBLE_GLSL
#define ISOTET_EXACT_DOUBLE_GLSL

#extension GL_EXT_control_flow_attributes : require

#ifdef ISOTET_INTEGER_DOUBLES
#include "shared/integer_double.glsl"
#else

#define Double double
/// Before loops whose bodies are many instructions if doubles are integers.
#define ISOTET_SHORT_LOOP [[unroll]]

Double double_of_bits(uint high, uint low) { return packDouble2x32(uvec2(low, high)); }
Double double_of(float x) { return double(x); }
float float_of(Double x) { return float(x); }
/// x from 0 to 2^20 without its fraction.
uint whole_of(Double x) { return uint(x); }

Double chosen(bool first, Double one, Double other) { return first ? one : other; }
bool is_less(Double a, Double b) { return a < b; }
/// Of 0, too, by its sign.
bool is_negative(Double x) { return (unpackDouble2x32(x).y & 0x80000000u) != 0u; }
Double negated(Double x) { return -x; }
Double absolute(Double x) { return abs(x); }

Double sum_of(Double a, Double b) {
    precise Double sum = a + b;
    return sum;
}

Double difference_of(Double a, Double b) {
    precise Double difference = a - b;
    return difference;
}

Double product_of(Double a, Double b) {
    precise Double product = a * b;
    return product;
}

/// Beyond these a remainder may be denormal or infinite; nothing in a picture is.
const Double correctable_from = 1e-140LF, correctable_to = 1e140LF;

bool is_correctable(Double x) { return abs(x) > correctable_from && abs(x) < correctable_to; }

/// a * b = x + y, exactly.
dvec2 exact_product(Double a, Double b) {
    precise Double a_spread = 134217729.0LF * a;
    precise Double b_spread = 134217729.0LF * b;
    precise Double a_over = a_spread - a;
    precise Double b_over = b_spread - b;
    precise Double a_high = a_spread - a_over;
    precise Double b_high = b_spread - b_over;
    precise Double a_low = a - a_high;
    precise Double b_low = b - b_high;
    precise Double product = a * b;
    precise Double first = a_high * b_high - product;
    precise Double second = first + a_high * b_low;
    precise Double third = second + a_low * b_high;
    precise Double rest = third + a_low * b_low;
    return dvec2(product, rest);
}

Double quotient(Double a, Double b) {
    precise Double about = a / b;
    if (!is_correctable(about) || !is_correctable(a) || !is_correctable(b)) return about;
    for (int i = 0; i < 2; ++i) {
        const dvec2 back = exact_product(about, b);
        precise Double difference = a - back.x;
        precise Double rest = difference - back.y;
        precise Double step = rest / b;
        precise Double better = about + step;
        about = better;
    }
    return about;
}

/// From a number to the next larger one.
Double unit_of(Double x) { return packDouble2x32(uvec2(0u, (unpackDouble2x32(x).y & 0x7ff00000u) - (52u << 20))); }

/// x - side * side, exactly if that is small.
Double rest_of_square(Double x, Double side) {
    const dvec2 back = exact_product(side, side);
    precise Double difference = x - back.x;
    precise Double rest = difference - back.y;
    return rest;
}

Double square_root(Double x) {
    if (x == 0.0LF) return x;
    precise Double about = sqrt(x);
    if (!is_correctable(x)) return about;
    for (int i = 0; i < 2; ++i) {
        precise Double twice = about + about;
        precise Double step = rest_of_square(x, about) / twice;
        precise Double better = about + step;
        about = better;
    }
    // Now off by one unit at most. A rest of side * unit is that of the middle to the next number, but for unit^2 / 4, which
    // is less than any two rests differ by.
    const Double unit = unit_of(about), unit_below = unit_of(about - 0.5LF * unit);
    const Double rest = rest_of_square(x, about);
    precise Double above = about + unit;
    precise Double below = about - unit_below;
    if (rest > about * unit) return above;
    return rest <= -about * unit_below ? below : about;
}

#endif

/// As std::min and std::max, which keep the first of equals.
Double lesser(Double a, Double b) { return chosen(is_less(b, a), b, a); }
Double greater(Double a, Double b) { return chosen(is_less(a, b), b, a); }

#endif
