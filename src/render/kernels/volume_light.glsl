// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What segments of a ray give it. Same as render/volume/segments.cpp and transfer.hpp.
#ifndef ISOTET_VOLUME_LIGHT_GLSL
#define ISOTET_VOLUME_LIGHT_GLSL

#include "volume.glsl"

const float deepest_piece = 0.25;
const uint most_halvings = 12u;
const float least_through = 0.002;

/// A ray that is composed, and the slab that it is in.
struct Composed {
    float lengths, through;
    bool done;
    uint slab;
    vec4 light; ///< of the slab, and what comes through it
};

/// 2^x for x from -126 to 0. Same as render/cpu/power_of_2.hpp.
float power_of_2(float x) {
    const float whole = floor(x);
    precise float part = x - whole;
    precise float power = 1.8937541e-03;
    power = power * part + 8.9495904e-03;
    power = power * part + 5.5860337e-02;
    power = power * part + 2.4014182e-01;
    power = power * part + 6.9315449e-01;
    power = power * part + 9.9999990e-01;
    precise float shifted = power * uintBitsToFloat(uint(int(whole) + 127) << 23);
    return shifted;
}

/// What an optical depth hides.
float hidden_by(float depth) {
    if (depth < deepest_piece) {
        const float third = uintBitsToFloat(0x3eaaaaabu);
        precise float series =
            depth * (1.0 - depth * 0.5 * (1.0 - depth * third * (1.0 - depth * 0.25 * (1.0 - depth * 0.2))));
        return series;
    }
    precise float power = depth * -1.44269504;
    precise float hidden = 1.0 - power_of_2(greater(power, -126.0));
    return hidden;
}

dvec4 row_at(RowsAt rows, double place) {
    const double at = lesser(greater(place, 0.0LF), double(table_rows));
    const uint below = min(uint(at), table_rows - 1u);
    precise double part = at - double(below);
    precise dvec4 out_;
    for (int i = 0; i < 4; ++i) {
        precise double sum = rows.at[below].up_to[i] +
                             (double(rows.at[below].rise[i]) + double(rows.at[below].bend[i]) * part) * part;
        out_[i] = sum;
    }
    return out_;
}

/// The mean of a segment from one place in the table to another.
dvec4 mean_of(RowsAt rows, float from, float to) {
    const double margin = 1.0LF / 256.0LF;
    double u = double(from), v = double(to);
    precise double apart = v - u;
    if (abs(apart) < margin) {
        precise double middle = 0.5LF * (u + v);
        precise double lower = middle - 0.5LF * margin;
        precise double upper = middle + 0.5LF * margin;
        u = lower;
        v = upper;
    }
    precise double wide = v - u;
    const dvec4 a = row_at(rows, u), b = row_at(rows, v);
    const double part = quotient(1.0LF, wide);
    precise dvec4 mean = (b - a) * part;
    return mean;
}

void add_piece(dvec4 mean, float depth, float light, inout Composed ray) {
    const float hidden = hidden_by(depth);
    precise float part = ray.light.w * hidden;
    const double of_mean = mean.x > 0.0LF ? quotient(double(part), mean.x) : 0.0LF;
    precise double red = of_mean * mean.y;
    precise double green = of_mean * mean.z;
    precise double blue = of_mean * mean.w;
    precise vec3 sum = ray.light.xyz + vec3(float(red), float(green), float(blue)) * light;
    precise float through_slab = ray.light.w - part;
    precise float through = ray.through - ray.through * hidden;
    ray.light = vec4(sum, through_slab);
    ray.through = through;
    ray.done = through < least_through;
}

/// Adds a segment between two sheets, the nearer half of what is too deep first.
void add_to_slab(float whole_length, float from, float to, float light, RowsAt rows, inout Composed ray) {
    uint halvings = 0u, piece = 0u; // of 2^halvings pieces
    for (;;) {
        float begin = from, end = to, length_ = whole_length;
        for (uint k = halvings; k > 0u; --k) {
            precise float middle = 0.5 * (begin + end);
            const bool farther = (piece >> (k - 1u) & 1u) != 0u;
            begin = farther ? middle : begin;
            end = farther ? end : middle;
            length_ *= 0.5;
        }
        const dvec4 mean = mean_of(rows, begin, end);
        precise float depth = float(mean.x) * length_;
        if (depth > deepest_piece && halvings < most_halvings) {
            ++halvings;
            piece <<= 1;
            continue;
        }
        add_piece(mean, depth, light, ray);
        while ((piece & 1u) != 0u) {
            piece >>= 1;
            --halvings;
        }
        if (ray.done || halvings == 0u) return;
        ++piece;
    }
}

#endif
