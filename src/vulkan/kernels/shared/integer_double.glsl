// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// IEEE 754 doubles in integers of 32 bits, for devices without shaderFloat64: sums, differences, products, quotients and roots
// rounded to nearest, ties to even, with denormals, infinities and signed zeros. Included by exact_double.glsl, which says what
// each function is.
//
// Drivers put every function where it is called, so there are no branches, and what is not finite is chosen at the end.
#ifndef ISOTET_INTEGER_DOUBLE_GLSL
#define ISOTET_INTEGER_DOUBLE_GLSL

#define ISOTET_SHORT_LOOP [[dont_unroll]]

struct Double {
    uint low, high;
};

const uint sign_bit = 0x80000000u, endless_high = 0x7ff00000u;
const Double nan_double = Double(0u, 0x7ff80000u);

Double double_of_bits(uint high, uint low) { return Double(low, high); }
Double chosen(bool first, Double one, Double other) {
    return Double(mix(other.low, one.low, first), mix(other.high, one.high, first));
}

uint magnitude_high(Double x) { return x.high & 0x7fffffffu; }
bool is_zero(Double x) { return (magnitude_high(x) | x.low) == 0u; }
bool is_nan(Double x) { return (magnitude_high(x) | min(x.low, 1u)) > endless_high; }
/// Infinite or NaN.
bool is_endless(Double x) { return magnitude_high(x) >= endless_high; }
bool is_negative(Double x) { return (x.high & sign_bit) != 0u; }
Double negated(Double x) { return Double(x.low, x.high ^ sign_bit); }
Double absolute(Double x) { return Double(x.low, magnitude_high(x)); }

// Pairs are numbers of 64 bits, the lower half first.

uvec2 pair_sum(uvec2 a, uvec2 b) {
    uint carry;
    const uint low = uaddCarry(a.x, b.x, carry);
    return uvec2(low, a.y + b.y + carry);
}

uvec2 pair_difference(uvec2 a, uvec2 b) {
    uint borrow;
    const uint low = usubBorrow(a.x, b.x, borrow);
    return uvec2(low, a.y - b.y - borrow);
}

bool pair_less(uvec2 a, uvec2 b) {
    uint borrow, borrow_high, other;
    usubBorrow(a.x, b.x, borrow);
    const uint high = usubBorrow(a.y, b.y, borrow_high);
    usubBorrow(high, borrow, other);
    return (borrow_high | other) != 0u;
}

/// By 0 to 63.
uvec2 shifted_left(uvec2 v, uint by) {
    const uvec2 words = mix(v, uvec2(0u, v.x), bvec2(by >= 32u));
    const uint bits = by & 31u;
    return uvec2(words.x << bits, words.y << bits | words.x >> 1 >> (31u - bits));
}

/// By 0 to 63. The last bit says whether any that fell out was set.
uvec2 shifted_right(uvec2 v, uint by) {
    const bool far = by >= 32u;
    const uvec2 words = mix(v, uvec2(v.y, 0u), bvec2(far));
    const uint bits = by & 31u, lost = mix(0u, v.x, far) | words.x << 1 << (31u - bits);
    return uvec2(words.x >> bits | words.y << 1 << (31u - bits) | min(lost, 1u), words.y >> bits);
}

/// Bits before the first that is set, 64 of 0.
uint leading_zeros(uvec2 v) {
    const bool in_low = v.y == 0u;
    return uint(31 - findMSB(mix(v.y, v.x, in_low)) + mix(0, 32, in_low));
}

int exponent_of(Double x) { return int(x.high >> 20 & 0x7ffu); }
/// Denormal numbers lack the first of the 53 bits.
uvec2 significand_of(Double x) { return uvec2(x.low, x.high & 0xfffffu | min(x.high >> 20 & 0x7ffu, 1u) << 20); }

/// significand * 2^(exponent - 1086), a significand from 2^63 to 2^64, or 0.
struct Wide {
    uvec2 significand;
    int exponent;
};

Wide widened(Double x) {
    const uvec2 significand = significand_of(x);
    const uint by = leading_zeros(significand);
    return Wide(shifted_left(significand, by), max(exponent_of(x), 1) + 11 - int(by));
}

/// A significand of 64 bits, of which the first is set unless the exponent is 1, to 53. The exponent is at least 1.
Double rounded(uint sign, uvec2 significand, int exponent) {
    const uvec2 kept = uvec2(significand.x >> 11 | significand.y << 21, significand.y >> 11);
    const uint up = uint((significand.x & 0x7ffu) + (kept.x & 1u) > 0x400u);
    const uvec2 bits = pair_sum(kept, uvec2(up, uint(exponent - 1) << 20)); // what carries over raises the exponent
    const bool endless = bits.y >= endless_high;
    return Double(mix(bits.x, 0u, endless), min(bits.y, endless_high) | sign);
}

/// Any exponent.
Double rounded_to_any(uint sign, Wide x) {
    const bool zero = (x.significand.x | x.significand.y) == 0u;
    const uint by = uint(clamp(1 - x.exponent, 0, 63));
    return rounded(sign, shifted_right(x.significand, by), mix(max(x.exponent, 1), 1, zero));
}

Double sum_of(Double one, Double other) {
    const bool less = pair_less(uvec2(one.low, magnitude_high(one)), uvec2(other.low, magnitude_high(other)));
    const Double a = chosen(less, other, one), b = chosen(less, one, other);
    const int exponent = max(exponent_of(a), 1);
    const uvec2 larger = shifted_left(significand_of(a), 10u);
    const uvec2 smaller =
        shifted_right(shifted_left(significand_of(b), 10u), uint(min(exponent - max(exponent_of(b), 1), 63)));
    const bool subtract = ((a.high ^ b.high) & sign_bit) != 0u;
    const uvec2 sum = mix(pair_sum(larger, smaller), pair_difference(larger, smaller), bvec2(subtract));
    const bool zero = (sum.x | sum.y) == 0u;
    const uint by = min(leading_zeros(sum), uint(exponent));
    const Double finite = rounded(mix(a.high & sign_bit, 0u, zero && subtract), shifted_left(sum, by & 63u),
                                  mix(exponent + 1 - int(by), 1, zero));
    const Double endless = chosen(subtract && is_endless(b), nan_double, a); // NaN is larger than infinity
    return chosen(is_endless(a), endless, finite);
}

Double difference_of(Double a, Double b) { return sum_of(a, negated(b)); }

Double product_of(Double a, Double b) {
    const Wide x = widened(a), y = widened(b);
    uint low_high, lowest, one_high, one_low, two_high, two_low;
    uvec2 high;
    umulExtended(x.significand.x, y.significand.x, low_high, lowest);
    umulExtended(x.significand.y, y.significand.x, one_high, one_low);
    umulExtended(x.significand.x, y.significand.y, two_high, two_low);
    umulExtended(x.significand.y, y.significand.y, high.y, high.x);
    const uvec2 one = pair_sum(uvec2(one_low, one_high), uvec2(low_high, 0u));
    const uvec2 two = pair_sum(uvec2(two_low, two_high), uvec2(one.x, 0u));
    high = pair_sum(pair_sum(high, uvec2(one.y, 0u)), uvec2(two.y, 0u));
    high.x |= min(lowest | two.x, 1u);
    const uint by = 1u - (high.y >> 31);
    const uint sign = (a.high ^ b.high) & sign_bit;
    const Double finite = rounded_to_any(
        sign, Wide(uvec2(high.x << by, high.y << by | high.x >> 31 & by), x.exponent + y.exponent - 1022 - int(by)));
    const bool none = is_nan(a) || is_nan(b) || is_zero(a) || is_zero(b);
    return chosen(is_endless(a) || is_endless(b), chosen(none, nan_double, Double(0u, sign | endless_high)), finite);
}

/// Found 18 bits at a time from the device's quotient of floats, which may be off by 1, and the remainder.
Double quotient(Double a, Double b) {
    Wide x = widened(a), y = widened(b);
    uvec2 rest = shifted_right(x.significand, 11u), divisor = shifted_right(y.significand, 11u); // 53 bits
    divisor.x = mix(divisor.x, 1u, is_zero(b));
    const uint smaller = uint(pair_less(rest, divisor));
    rest = shifted_left(rest, smaller);
    rest = pair_difference(rest, divisor); // the first bit of the quotient
    uvec2 found = uvec2(1u, 0u);
    const float part = 262144.0 / (float(divisor.y) * 4294967296.0 + float(divisor.x));
    ISOTET_SHORT_LOOP for (uint digit = 0u; digit < 3u; ++digit) {
        uint bits = uint(max((float(rest.y) * 4294967296.0 + float(rest.x)) * part - 1.25, 0.0)), high, low;
        umulExtended(bits, divisor.x, high, low);
        rest = pair_difference(shifted_left(rest, 18u), uvec2(low, high + bits * divisor.y)); // below 2^64
        ISOTET_SHORT_LOOP for (uint i = 0u; i < 4u; ++i) {
            const bool more = !pair_less(rest, divisor);
            rest = pair_difference(rest, mix(uvec2(0u), divisor, bvec2(more)));
            bits += uint(more);
        }
        found = pair_sum(shifted_left(found, 18u), uvec2(bits, 0u));
    }
    found = shifted_left(found, 9u); // from 55 bits
    found.x |= min(rest.x | rest.y, 1u);
    const uint sign = (a.high ^ b.high) & sign_bit;
    const Double finite = rounded_to_any(sign, Wide(found, x.exponent - y.exponent + 1023 - int(smaller)));
    const bool none =
        is_nan(a) || is_nan(b) || (is_endless(a) && is_endless(b)) || (is_zero(a) && is_zero(b));
    const Double zero_or_finite = chosen(is_zero(a) || is_endless(b), Double(0u, sign), finite);
    const Double any = chosen(is_zero(b) || is_endless(a), Double(0u, sign | endless_high), zero_or_finite);
    return chosen(none, nan_double, any);
}

/// Bit by bit.
Double square_root(Double x) {
    const Wide wide = widened(x);
    const int exponent = wide.exponent - 1023;
    uvec2 square = shifted_right(wide.significand, uint(~exponent & 1)); // 54 bits, the upper ones, or 53
    uvec2 rest = uvec2(0u), root = uvec2(0u);
    ISOTET_SHORT_LOOP for (uint i = 0u; i < 55u; ++i) {
        rest = uvec2(rest.x << 2 | square.y >> 30, rest.y << 2 | rest.x >> 30); // below 2^58
        square = uvec2(square.x << 2, square.y << 2 | square.x >> 30);
        const uvec2 step = uvec2(root.x << 2 | 1u, root.y << 2 | root.x >> 30);
        const bool more = !pair_less(rest, step);
        rest = pair_difference(rest, mix(uvec2(0u), step, bvec2(more)));
        root = uvec2(root.x << 1 | uint(more), root.y << 1 | root.x >> 31);
    }
    root = shifted_left(root, 9u);
    root.x |= min(rest.x | rest.y, 1u);
    const Double finite = rounded(0u, root, (exponent >> 1) + 1023); // below 0, too, half is the lower one
    const Double any = chosen(is_zero(x) || is_endless(x), x, finite);
    return chosen(is_nan(x) || (is_negative(x) && !is_zero(x)), nan_double, any);
}

bool is_less(Double a, Double b) {
    const uint a_sign = uint(int(a.high) >> 31), b_sign = uint(int(b.high) >> 31);
    const bool less = pair_less(uvec2(a.low ^ a_sign, a.high ^ (a_sign | sign_bit)),
                                uvec2(b.low ^ b_sign, b.high ^ (b_sign | sign_bit)));
    return less && !(is_nan(a) || is_nan(b) || (is_zero(a) && is_zero(b)));
}

Double double_of(float x) {
    const uint bits = floatBitsToUint(x), sign = bits & sign_bit, exponent = bits >> 23 & 0xffu,
               fraction = bits & 0x7fffffu;
    const int first = findMSB(fraction); // of a denormal number of 2^-149 each; that bit goes
    const uint kept = mix(fraction, fraction << uint(23 - max(first, 0)) & 0x7fffffu, exponent == 0u);
    const uint denormal = mix(uint(first + 874), 0u, fraction == 0u);
    const uint wide = mix(mix(exponent + 896u, denormal, exponent == 0u), 0x7ffu, exponent == 255u);
    return Double(kept << 29, sign | wide << 20 | kept >> 3);
}

float float_of(Double x) {
    const uint sign = x.high & sign_bit;
    const int exponent = exponent_of(x) - 896;
    const uvec2 significand =
        shifted_right(uvec2(x.low, x.high & 0xfffffu | 0x100000u), uint(clamp(1 - exponent, 0, 63)));
    const uint kept = significand.y << 3 | significand.x >> 29; // 24 bits
    const uint up = uint((significand.x & 0x1fffffffu) + (kept & 1u) > 0x10000000u);
    const uint bits = (uint(clamp(exponent, 1, 255) - 1) << 23) + kept + up;
    const uint any = sign | mix(min(bits, 0x7f800000u), 0x7f800000u, exponent > 254);
    return uintBitsToFloat(mix(any, 0x7fc00000u, is_nan(x)));
}

uint whole_of(Double x) {
    const int exponent = exponent_of(x) - 1023;
    return mix((x.high & 0xfffffu | 0x100000u) >> uint(clamp(20 - exponent, 0, 31)), 0u, exponent < 0);
}

#endif
