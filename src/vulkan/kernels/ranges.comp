// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Works out, from the values of its points, the range of each cluster and of its groups, and whether it holds a point without
// data; clusters of pages that are not on the device are left alone. A workgroup a cluster, an invocation a point, then a
// word of its cells. Words that clusters share are only ANDed and ORed, each its own bits. Same as packed/store_ranges.cpp.
#version 460
#include "shared/groups.glsl"
#include "shared/cluster.glsl"
#include "shared/quantize.glsl"
#include "shared/workgroup.glsl"

layout(push_constant, scalar) uniform Push {
    RangesPush push;
};

shared uint lowest, highest; ///< ordered() of values
shared uint missing;         ///< 1: some point has no data
shared uint lower_steps[max_cluster_points], upper_steps[max_cluster_points];
shared uint group_lower[max_cluster_groups], group_upper[max_cluster_groups];

const float largest_float = 3.40282346638528859811704183484516925440e+38;
const uint no_lower = 255u, no_upper = 0u; ///< steps of a point without data

/// Whole numbers in the order of the floats, which are not NaN and not -0.
uint ordered(float x) {
    const uint bits = floatBitsToUint(x);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float from_ordered(uint key) { return uintBitsToFloat((key & 0x80000000u) != 0u ? key & 0x7fffffffu : ~key); }

bool has_data(float value) { return (floatBitsToUint(value) & 0x7fffffffu) <= 0x7f800000u; }

void find_range(float value) {
    const uint self = gl_LocalInvocationIndex;
    if (self >= local_points()) return;
    if (!has_data(value)) {
        missing = 1u;
        return;
    }
    atomicMin(lowest, ordered(value));
    atomicMax(highest, ordered(value));
}

void find_steps(float value, Range range) {
    const uint self = gl_LocalInvocationIndex;
    if (self >= local_points()) return;
    const uint step = quantize(value, range);
    lower_steps[self] = has_data(value) ? step : no_lower;
    upper_steps[self] = has_data(value) ? step : no_upper;
}

void find_group_ranges() {
    const uint words = kind_words.w + 2u * kind_counts.w;
    for (uint k = gl_LocalInvocationIndex; k < words; k += workgroup_size) {
        const uint kind = k < kind_words.y ? 0u : k < kind_words.z ? 1u : k < kind_words.w ? 2u : 3u;
        const uint group = (kind == 0u ? 0u : kind_ends[kind - 1u]) + (k - kind_words[kind]) / group_size;
        const uint word = cell_word(k);
        const uvec4 v = uvec4(word & 0xffu, word >> 8 & 0xffu, word >> 16 & 0xffu, word >> 24);
        atomicMin(group_lower[group],
                  min(min(lower_steps[v.x], lower_steps[v.y]), min(lower_steps[v.z], lower_steps[v.w])));
        atomicMax(group_upper[group],
                  max(max(upper_steps[v.x], upper_steps[v.y]), max(upper_steps[v.z], upper_steps[v.w])));
    }
}

void write_group_range(uint group) {
    const uint at = cluster.first_group + group;
    const uint word = page.group_ranges + at / 2u, shift = 16u * (at % 2u);
    atomicAnd(Words(page.data).at[word], ~(0xffffu << shift));
    atomicOr(Words(page.data).at[word], (group_lower[group] | group_upper[group] << 8) << shift);
}

void write_cluster(Tables tables, uint number, Range range) {
    Ranges(tables.ranges).at[number] = range;
    const uint bit = 1u << number % 32u;
    if (missing != 0u) atomicOr(Words(tables.no_data).at[number / 32u], bit);
    else atomicAnd(Words(tables.no_data).at[number / 32u], ~bit);
}

void main() {
    const Tables tables = TablesAt(push.tables).tables;
    const uint self = gl_LocalInvocationIndex;
    const uint number = group_index();
    if (number >= tables.cluster_count) return;
    open_cluster(tables, number);
    if (page.data == Address(0u)) return;
    const uint groups = group_count();

    if (self == 0u) {
        lowest = ordered(largest_float);
        highest = ordered(-largest_float);
        missing = 0u;
    }
    if (self < max_cluster_groups) {
        group_lower[self] = no_lower;
        group_upper[self] = no_upper;
    }
    float value = 0.0;
    if (self < local_points()) value = value_of(page_point(self));
    barrier();
    find_range(value);
    barrier();
    const Range range = Range(from_ordered(lowest), from_ordered(highest));
    find_steps(value, range);
    barrier();
    find_group_ranges();
    barrier();
    if (self < groups) write_group_range(self);
    if (self == 0u) write_cluster(tables, number, range);
}
