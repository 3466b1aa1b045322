// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One cluster of a packed grid, by one workgroup: its parts, and its local points wherever they lie.
#ifndef ISOTET_CLUSTER_GLSL
#define ISOTET_CLUSTER_GLSL

#include "shared/memory.glsl"

// The cluster at hand; the same in all invocations.
Cluster cluster;
Page page;
uint own_points, ghost_points, own_seams;
uvec4 kind_counts; ///< tets, pyramids, wedges, hexahedra
uvec4 kind_ends;   ///< the group behind the last one of each
uvec4 kind_words;  ///< the first word of each

void open_cluster(Tables tables, uint number) {
    cluster = Clusters(tables.clusters).at[number];
    page = Pages(tables.pages).at[cluster.page];
    own_points = cluster.points & 0xffffu;
    ghost_points = cluster.points >> 16;
    kind_counts = uvec4(cluster.tets & 0xffffu, cluster.others & 1023u, cluster.others >> 10 & 1023u, cluster.others >> 20);
    kind_ends.x = (kind_counts.x + group_size - 1u) / group_size;
    kind_words = uvec4(0u, kind_counts.x, 0u, 0u);
    for (uint kind = 1u; kind < 4u; ++kind) {
        kind_ends[kind] = kind_ends[kind - 1u] + (kind_counts[kind] + group_size / 2u - 1u) / (group_size / 2u);
        if (kind < 3u) kind_words[kind + 1u] = kind_words[kind] + 2u * kind_counts[kind];
    }
    own_seams = cluster.seams & own_seams_bits;
}

uint local_points() { return ghost_points + own_points; }

// Where the cluster's parts lie is worked out where it is used: kept from the start, it would take registers from the
// cutting of cells.
uint neighbour_count() { return cluster.tets >> 16; }
uint ghost_seams() { return cluster.seams >> 16; }
uint seams_at() { return page.links + cluster.first_link + 3u * neighbour_count(); }  ///< word of the page
uint ghost_points_at() { return 4u * seams_at() + 2u * (own_seams + ghost_seams()); } ///< byte of the page
uint seam_indices_at() { return ghost_points_at() + ghost_points; }                   ///< byte of the page
uint index_bytes() { return (cluster.seams & wide_seams_flag) == 0u ? 1u : 2u; } ///< of a ghost seam's index

/// A word of the page. Its address is made of numbers here: SwiftShader keeps a global that is a reference in half of the bytes
/// it takes, and so overwrites the one behind.
uint page_word(uint at) { return Words(page.data).at[at]; }

uint page_byte(uint at) { return page_word(at / 4u) >> 8u * (at % 4u) & 0xffu; }

Neighbour neighbour_at(uint place) {
    const uint at = page.links + cluster.first_link + 3u * place;
    return Neighbour(page_word(at), page_word(at + 1u), page_word(at + 2u));
}

/// The neighbour that owns ghost point or seam `k`: the last one whose part begins at or before it. `shift` is 0 for
/// points, 16 for seams.
Neighbour neighbour_of(uint k, uint shift) {
    const uint begins_at = page.links + cluster.first_link + 2u;
    uint first = 0u, end = neighbour_count();
    while (end - first > 1u) {
        const uint middle = (first + end) / 2u;
        const uint begin = page_word(begins_at + 3u * middle) >> shift & 0xffffu;
        if (begin <= k) first = middle;
        else end = middle;
    }
    return neighbour_at(first);
}

/// Ghost point `k`: its place among the points that its neighbour has in this page.
uint ghost_place(uint k) { return page_byte(ghost_points_at() + k); }

/// The page-local number of local point `k`.
uint page_point(uint k) {
    if (k >= ghost_points) return cluster.first_point + k - ghost_points;
    return neighbour_of(k, 0u).first_point + ghost_place(k);
}

float value_of(uint point) { return uintBitsToFloat(page_word(page.values + point)); }

vec3 position_of(uint point) {
    const uint at = page.positions + 3u * point;
    return vec3(uintBitsToFloat(page_word(at)), uintBitsToFloat(page_word(at + 1u)),
                uintBitsToFloat(page_word(at + 2u)));
}

/// The number of a page-local point among all points of the packed grid.
uint packed_point(uint point) {
    return point < page.own_points ? page.first_point + point : page_word(page.halo + point - page.own_points);
}

/// Place of ghost point `k` among the own points of its owner.
uint place_in_owner(Tables tables, Neighbour neighbour, uint k) {
    const uint point = neighbour.first_point + ghost_place(k);
    if (point < page.own_points) return ghost_place(k);
    const Cluster owner = Clusters(tables.clusters).at[neighbour.cluster];
    return packed_point(point) - Pages(tables.pages).at[owner.page].first_point - owner.first_point;
}

uint group_count() { return kind_ends.w; }

/// Word `k` of the cluster's cells: four corners.
uint cell_word(uint k) { return page_word(page.cells + cluster.first_word + k); }

/// Range of a group in steps of the cluster's: lower + 256 * upper.
uint range_of_group(uint group) {
    const uint at = cluster.first_group + group;
    return page_word(page.group_ranges + at / 2u) >> 16u * (at % 2u) & 0xffffu;
}

/// (lower, higher) local index of own seam `k`; those of ghost seams stand behind.
uvec2 own_seam(uint k) {
    const uint pair = page_word(seams_at() + k / 2u) >> 16u * (k % 2u);
    return uvec2(pair & 0xffu, pair >> 8 & 0xffu);
}

/// (lower, higher, index among the owner's own seams) of ghost seam `k`.
uvec3 ghost_seam(uint k) {
    const uint at = seam_indices_at() + index_bytes() * k;
    return uvec3(own_seam(own_seams + k), page_byte(at) | (index_bytes() == 1u ? 0u : page_byte(at + 1u) << 8));
}

#endif
