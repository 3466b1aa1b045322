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

/// A place in the table.
struct TablePlace {
    uint below;
    Double part;
};

TablePlace place_in_table(Double place) {
    const Double at = lesser(greater(place, double_of(0.0)), double_of(float(table_rows)));
    const uint below = min(whole_of(at), table_rows - 1u);
    return TablePlace(below, difference_of(at, double_of(float(below))));
}

/// A segment from one place in the table to another.
struct TableWay {
    TablePlace from, to;
    Double part; ///< 1 / its length
};

TableWay way_in_table(float from, float to) {
    const float margin = 1.0 / 256.0;
    Double u = double_of(from), v = double_of(to), wide = difference_of(v, u);
    if (is_less(absolute(wide), double_of(margin))) {
        const Double middle = product_of(double_of(0.5), sum_of(u, v));
        u = difference_of(middle, double_of(0.5 * margin));
        v = sum_of(middle, double_of(0.5 * margin));
        wide = difference_of(v, u);
    }
    TableWay way;
    way.part = quotient(double_of(1.0), wide);
    ISOTET_SHORT_LOOP for (uint end = 0u; end < 2u; ++end) {
        way.from = way.to;
        way.to = place_in_table(u);
        u = v;
    }
    return way;
}

/// The mean of a segment's extinction, or of it times a colour.
Double mean_of(RowsAt rows, TableWay way, uint which) {
    Double from = double_of(0.0), to = from; // integrals
    ISOTET_SHORT_LOOP for (uint end = 0u; end < 2u; ++end) {
        const TablePlace at = way.from;
        const Double rise = sum_of(double_of(rows.at[at.below].rise[which]),
                                   product_of(double_of(rows.at[at.below].bend[which]), at.part));
        from = to;
        to = sum_of(rows.at[at.below].up_to[which], product_of(rise, at.part));
        way.from = way.to;
    }
    return product_of(difference_of(to, from), way.part);
}

void add_piece(RowsAt rows, TableWay way, Double mean, float depth, float light, inout Composed ray) {
    const float hidden = hidden_by(depth);
    precise float part = ray.light.w * hidden;
    vec3 color = vec3(0.0);
    if (is_less(double_of(0.0), mean)) {
        const Double of_mean = quotient(double_of(part), mean);
        ISOTET_SHORT_LOOP for (uint i = 0u; i < 3u; ++i)
            color = vec3(color.yz, float_of(product_of(of_mean, mean_of(rows, way, i + 1u))));
    }
    precise vec3 sum = ray.light.xyz + color * light;
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
        const TableWay way = way_in_table(begin, end);
        const Double mean = mean_of(rows, way, 0u);
        precise float depth = float_of(mean) * length_;
        if (depth > deepest_piece && halvings < most_halvings) {
            ++halvings;
            piece <<= 1;
            continue;
        }
        add_piece(rows, way, mean, depth, light, ray);
        while ((piece & 1u) != 0u) {
            piece >>= 1;
            --halvings;
        }
        if (ray.done || halvings == 0u) return;
        ++piece;
    }
}

#endif
