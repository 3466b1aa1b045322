// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Quotients and roots in double, rounded to nearest as the processor does it. What the device itself makes of them, which need
// be no better than single precision allows, is corrected by its remainder, which is exact; sums, differences and products are
// exact where they are `precise`.
#ifndef ISOTET_EXACT_DOUBLE_GLSL
#define ISOTET_EXACT_DOUBLE_GLSL

/// Beyond these a remainder may be denormal or infinite; nothing in a picture is.
const double correctable_from = 1e-140LF, correctable_to = 1e140LF;

bool is_correctable(double x) { return abs(x) > correctable_from && abs(x) < correctable_to; }

/// a * b = x + y, exactly.
dvec2 exact_product(double a, double b) {
    precise double a_spread = 134217729.0LF * a;
    precise double b_spread = 134217729.0LF * b;
    precise double a_over = a_spread - a;
    precise double b_over = b_spread - b;
    precise double a_high = a_spread - a_over;
    precise double b_high = b_spread - b_over;
    precise double a_low = a - a_high;
    precise double b_low = b - b_high;
    precise double product = a * b;
    precise double first = a_high * b_high - product;
    precise double second = first + a_high * b_low;
    precise double third = second + a_low * b_high;
    precise double rest = third + a_low * b_low;
    return dvec2(product, rest);
}

double quotient(double a, double b) {
    precise double about = a / b;
    if (!is_correctable(about) || !is_correctable(a) || !is_correctable(b)) return about;
    for (int i = 0; i < 2; ++i) {
        const dvec2 back = exact_product(about, b);
        precise double difference = a - back.x;
        precise double rest = difference - back.y;
        precise double step = rest / b;
        precise double better = about + step;
        about = better;
    }
    return about;
}

double square_root(double x) {
    if (x == 0.0LF) return x;
    precise double about = sqrt(x);
    if (!is_correctable(x)) return about;
    for (int i = 0; i < 2; ++i) {
        const dvec2 back = exact_product(about, about);
        precise double difference = x - back.x;
        precise double rest = difference - back.y;
        precise double twice = about + about;
        precise double step = rest / twice;
        precise double better = about + step;
        about = better;
    }
    return about;
}

#endif
