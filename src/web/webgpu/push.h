// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What kernels are told, member by member: a struct here and one of WGSL (kernels.cpp). Places are words of `page`, of
// `tables` (that of clusters_without_data) and of `state`.
#define ISOTET_CARD_PUSH(FLOAT, UINT)                                                                                  \
    UINT(vertex_capacity) UINT(triangle_capacity) /* first: JavaScript sets them */                                    \
    FLOAT(isovalue) FLOAT(rest) FLOAT(tied) UINT(merge)                                                                \
    UINT(zero) /* that no compiler knows */                                                                            \
    UINT(cluster_count) UINT(groups_per_axis) UINT(any_no_data) UINT(with_others)                                      \
    UINT(values) UINT(places) UINT(cells) UINT(group_ranges) UINT(links)                                               \
    UINT(clusters_without_data)                                                                                        \
    UINT(counts) UINT(segments) UINT(blocks) UINT(starts) UINT(selected) UINT(emitted) UINT(masks)
