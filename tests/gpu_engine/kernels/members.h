// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Every member of every struct that crosses to the kernels: M(variable, struct, member). Read by C++ and GLSL.
#ifndef ISOTET_MEMBERS_H
#define ISOTET_MEMBERS_H

#define ISOTET_STRUCTS(S) \
    S(a_page, Page) \
    S(a_cluster, Cluster) \
    S(a_neighbour, Neighbour) \
    S(a_range, Range) \
    S(a_count, Count) \
    S(a_start, Start) \
    S(a_list_head, ListHead) \
    S(a_tables, Tables) \
    S(a_lists, Lists) \
    S(a_draw_arguments, DrawArguments) \
    S(a_output, Output) \
    S(a_extract_push, ExtractPush) \
    S(a_ranges_push, RangesPush) \
    S(a_surface_push, SurfacePush) \
    S(a_field_push, FieldPush)

#define ISOTET_MEMBERS(M) \
    M(a_page, Page, data) M(a_page, Page, values) M(a_page, Page, positions) M(a_page, Page, gradients) \
    M(a_page, Page, halo) M(a_page, Page, cells) M(a_page, Page, group_ranges) M(a_page, Page, links) \
    M(a_page, Page, own_points) M(a_page, Page, first_point) M(a_page, Page, first_word) M(a_page, Page, first_group) M(a_page, Page, batch) \
    M(a_cluster, Cluster, page) M(a_cluster, Cluster, first_point) M(a_cluster, Cluster, first_word) M(a_cluster, Cluster, first_group) \
    M(a_cluster, Cluster, first_link) M(a_cluster, Cluster, first_mask) M(a_cluster, Cluster, points) \
    M(a_cluster, Cluster, tets) M(a_cluster, Cluster, others) M(a_cluster, Cluster, seams) \
    M(a_neighbour, Neighbour, cluster) M(a_neighbour, Neighbour, first_point) M(a_neighbour, Neighbour, begin) \
    M(a_range, Range, lower) M(a_range, Range, upper) \
    M(a_count, Count, vertices) M(a_count, Count, triangles) \
    M(a_start, Start, vertex) M(a_start, Start, seam_vertex) M(a_start, Start, triangle) \
    M(a_list_head, ListHead, count) M(a_list_head, ListHead, groups_x) M(a_list_head, ListHead, groups_y) \
    M(a_list_head, ListHead, groups_z) \
    M(a_tables, Tables, pages) M(a_tables, Tables, clusters) M(a_tables, Tables, ranges) \
    M(a_tables, Tables, no_data) M(a_tables, Tables, masks) M(a_tables, Tables, counts) \
    M(a_tables, Tables, segments) M(a_tables, Tables, blocks) M(a_tables, Tables, starts) \
    M(a_tables, Tables, selected) M(a_tables, Tables, emitted) M(a_tables, Tables, lists) \
    M(a_tables, Tables, cell_cases) M(a_tables, Tables, cluster_count) M(a_tables, Tables, groups_per_axis) M(a_tables, Tables, any_no_data) \
    M(a_lists, Lists, selected.count) M(a_lists, Lists, selected.groups_x) M(a_lists, Lists, selected.groups_y) \
    M(a_lists, Lists, selected.groups_z) M(a_lists, Lists, few_edges.count) M(a_lists, Lists, few_edges.groups_x) \
    M(a_lists, Lists, few_edges.groups_y) M(a_lists, Lists, few_edges.groups_z) M(a_lists, Lists, many_edges.count) \
    M(a_lists, Lists, many_edges.groups_x) M(a_lists, Lists, many_edges.groups_y) \
    M(a_lists, Lists, many_edges.groups_z) \
    M(a_draw_arguments, DrawArguments, index_count) M(a_draw_arguments, DrawArguments, instance_count) \
    M(a_draw_arguments, DrawArguments, first_index) M(a_draw_arguments, DrawArguments, vertex_offset) \
    M(a_draw_arguments, DrawArguments, first_instance) \
    M(a_output, Output, vertices_low) M(a_output, Output, vertices_high) M(a_output, Output, triangles_low) \
    M(a_output, Output, triangles_high) M(a_output, Output, overflow) M(a_output, Output, selected_clusters) \
    M(a_output, Output, tied_points) M(a_output, Output, missing_normals) M(a_output, Output, many_edges) \
    M(a_output, Output, draw.index_count) M(a_output, Output, draw.instance_count) \
    M(a_output, Output, draw.first_index) M(a_output, Output, draw.vertex_offset) \
    M(a_output, Output, draw.first_instance) M(a_output, Output, vertex_groups_x) \
    M(a_output, Output, vertex_groups_y) M(a_output, Output, vertex_groups_z) M(a_output, Output, triangle_groups_x) \
    M(a_output, Output, triangle_groups_y) M(a_output, Output, triangle_groups_z) \
    M(a_output, Output, vertex_capacity) M(a_output, Output, triangle_capacity) M(a_output, Output, positions) \
    M(a_output, Output, triangles) M(a_output, Output, normals) M(a_output, Output, lowest) \
    M(a_output, Output, ends) M(a_output, Output, weights) M(a_output, Output, sources) \
    M(a_extract_push, ExtractPush, tables) M(a_extract_push, ExtractPush, surface) \
    M(a_extract_push, ExtractPush, isovalue) M(a_extract_push, ExtractPush, rest) \
    M(a_extract_push, ExtractPush, tied) M(a_extract_push, ExtractPush, merge) \
    M(a_extract_push, ExtractPush, batch) \
    M(a_ranges_push, RangesPush, tables) \
    M(a_surface_push, SurfacePush, surface) \
    M(a_field_push, FieldPush, surface) M(a_field_push, FieldPush, values) M(a_field_push, FieldPush, field) \
    M(a_field_push, FieldPush, components)

#endif
