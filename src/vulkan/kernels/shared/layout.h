// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Every struct that both the processor and the kernels know, once for both. All members are 4 bytes wide, so that C++
// and GLSL's scalar layout place them alike; engine/layout.hpp checks the sizes, tests/gpu_engine asks a device for
// each place.
//
// On the device a packed grid lies in two kinds of memory. Resident, by cluster: Page, Cluster, Range, masks, counts,
// starts. In pages, which may come and go: points, values, cells, group ranges, links, each array of a page beginning at
// a word that Page tells. A page holds whole clusters, and copies of the points that these borrow from other pages: its
// halo.
//
//   page-local points   0 ......... own_points ......... own_points + halo
//                       own points of its clusters       halo, in packed order
//
//   links of a cluster  neighbours      a Neighbour each, ascending
//                       ghost points  1 byte each: place behind Neighbour::first_point
//                       own seams       2 bytes each (lower, higher local index)
//                       ghost seams   1 word each: lower + 256 * higher + 65536 * index among the owner's own seams
#ifndef ISOTET_LAYOUT_H
#define ISOTET_LAYOUT_H

#ifdef __cplusplus
#include <cstdint>
namespace isotet::vulkan::layout {
using uint = std::uint32_t;
struct Address { ///< on the device; halves, so that no kernel needs 64-bit integers
    uint low, high;
};
#define ISOTET_CONSTANT constexpr uint
#else
#extension GL_EXT_scalar_block_layout : require
#define Address uvec2
#define ISOTET_CONSTANT const uint
#endif

ISOTET_CONSTANT group_size = 32u;            ///< words: a tet is one, any other cell two
ISOTET_CONSTANT max_cluster_points = 128u;   ///< and invocations of a workgroup: one a point
ISOTET_CONSTANT max_cluster_groups = 32u;
ISOTET_CONSTANT max_cluster_seams = 6144u;   ///< edges of the most tets there can be
ISOTET_CONSTANT matrix_words = 512u;         ///< a bit for every pair of local points
ISOTET_CONSTANT tied_words = 4u;             ///< of a cluster's masks, before those of its own seams
ISOTET_CONSTANT segment_clusters = 128u;     ///< a workgroup of select and scan
ISOTET_CONSTANT block_segments = 128u;
ISOTET_CONSTANT few_edges = 448u;            ///< active edges of a cluster that emit works through at once

/// Marching tetrahedra by which corners are above (grid/cell/case_table.hpp): a polygon's four active edges, each corner above
/// + 8 * corner below, in 6 bits; then the number of its triangles. engine/layout.hpp checks them against the table.
#define ISOTET_TET_CASES \
    0x0000000u, 0x1410608u, 0x1659441u, 0x2619450u, \
    0x128a682u, 0x229a608u, 0x265a081u, 0x1659698u, \
    0x14d32c3u, 0x24132c8u, 0x20d3441u, 0x14d3450u, \
    0x228b0c2u, 0x128a2c8u, 0x10c3081u, 0x0000000u

/// Cases of the other kinds (grid/cell/cell_cases.hpp) lie in memory, a word each: the word of the first polygon + 65536 *
/// number of polygons + 2^20 * number of triangles. Polygons, as above, stand behind.
ISOTET_CONSTANT pyramid_cases_at = 0u;
ISOTET_CONSTANT wedge_cases_at = 32u;
ISOTET_CONSTANT hexahedron_cases_at = 96u;
ISOTET_CONSTANT polygons_at = 352u;

/// A page of the packed grid; (0, 0) as `data` when it is not on the device.
struct Page {
    Address data;
    uint values;       ///< words from `data`: one a point
    uint positions;    ///< 3 a point
    uint gradients;    ///< one a point, where the grid was packed with them
    uint halo;         ///< one a halo point: its packed number
    uint cells;        ///< one a tet, two any other cell
    uint group_ranges; ///< 16 bits a group
    uint links;
    uint own_points;
    uint first_point;  ///< packed number of own point 0
    uint first_word;   ///< number of word 0 of its cells in the whole grid
    uint first_group;  ///< number of group 0 in the whole grid
    uint batch;        ///< the pass over pages that it takes part in
};

struct Cluster {
    uint page;
    uint first_point;  ///< of its own points, in the page
    uint first_word;   ///< of its cells, in the page
    uint first_group;  ///< in the page
    uint first_link;   ///< in the page's links
    uint first_mask;   ///< in the masks: tied_words, then one bit an own seam
    uint points;       ///< own + 65536 * ghost
    uint tets;         ///< tets + 65536 * neighbours
    uint others;       ///< pyramids + 1024 * wedges + 2^20 * hexahedra
    uint seams;        ///< own + wide_seams_flag + 65536 * ghost
};
ISOTET_CONSTANT own_seams_bits = 0x7fffu, wide_seams_flag = 0x8000u; ///< as in core::ClusterHeader

/// What core::Neighbour says, with sums in place of counts: nothing has to be added up to find a part.
struct Neighbour {
    uint cluster;
    uint first_point;  ///< page-local: of its own points, or of its part of the halo
    uint begin;        ///< its first ghost point + 65536 * its first ghost seam
};

/// Smallest and largest value of a cluster; has_no_data is 1 where a point has none.
struct Range {
    float lower, upper;
};

/// What clusters give so far: all parts are added to, by any workgroup in any order.
struct Count {
    uint vertices;     ///< + 65536 * those at tied points (of a cluster; segments and blocks count vertices only)
    uint triangles;    ///< + many_edges_flag (of a cluster)
};
ISOTET_CONSTANT many_edges_flag = 0x80000000u;

/// Where the output of a cluster begins.
struct Start {
    uint vertex;       ///< first one at a tied point
    uint seam_vertex;  ///< first one on an own seam
    uint triangle;
};

/// A list of clusters that grows by an atomic add; `groups` are the arguments of a dispatch with a workgroup for each.
struct ListHead {
    uint count;
    uint groups_x, groups_y, groups_z;
};

/// Addresses and sizes of everything resident.
struct Tables {
    Address pages;
    Address clusters;
    Address ranges;
    Address no_data;    ///< a bit a cluster: it holds a point without data
    Address masks;
    Address counts;     ///< Count a cluster
    Address segments;   ///< Count a segment
    Address blocks;     ///< Count a block
    Address starts;
    Address selected;   ///< list of clusters
    Address emitted;    ///< list of those with output: few edges from the front, many edges from the back
    Address lists;      ///< Lists
    Address cell_cases;
    uint cluster_count;
    uint groups_per_axis;
    uint any_no_data;   ///< some point has none
};

struct Lists {
    ListHead selected;
    ListHead few_edges;
    ListHead many_edges;
};

/// VkDrawIndexedIndirectCommand.
struct DrawArguments {
    uint index_count, instance_count, first_index, vertex_offset, first_instance;
};

/// A surface on the device: what there is, and where. The processor writes capacities and addresses, kernels the rest.
struct Output {
    uint vertices_low, vertices_high;
    uint triangles_low, triangles_high;
    uint overflow;         ///< 1: does not fit; nothing has been emitted
    uint selected_clusters;
    uint tied_points;      ///< own points of selected clusters with the isovalue as their value
    uint missing_normals;  ///< 1: some gradient normal is zero
    uint many_edges;       ///< 1: some cluster has more active edges than few_edges
    DrawArguments draw;
    uint vertex_groups_x, vertex_groups_y, vertex_groups_z;       ///< dispatch with an invocation a vertex
    uint triangle_groups_x, triangle_groups_y, triangle_groups_z; ///< a triangle
    uint vertex_capacity, triangle_capacity;
    Address positions;     ///< float x 3 a vertex
    Address triangles;     ///< uint x 3 a triangle
    Address normals;       ///< float x 3 a vertex or a triangle
    Address lowest;        ///< uint a vertex: lowest triangle at vertices without a gradient normal
    Address ends;          ///< uint x 2 a vertex: packed points
    Address weights;       ///< float a vertex
    Address sources;       ///< uint a triangle: first word of the stored cell
};

/// Push constants of the four steps.
struct ExtractPush {
    Address tables;
    Address surface;       ///< Output
    float isovalue;        ///< core::StoredIsovalue: value, rest, tied
    float rest;
    float tied;
    uint merge;            ///< 1: Ties::merge
    uint batch;            ///< 0: all pages; else count and emit leave clusters of pages of other batches alone
};

/// Push constants of the pass that works out ranges.
struct RangesPush {
    Address tables;
};

/// Push constants of kernels that work on a finished surface.
struct SurfacePush {
    Address surface;       ///< Output
};

/// Push constants of the pass that interpolates a point field.
struct FieldPush {
    Address surface;       ///< Output
    Address values;        ///< float x components a packed point
    Address field;         ///< float x components a vertex
    uint components;
};

#ifdef __cplusplus
} // namespace isotet::vulkan::layout
#endif
#undef ISOTET_CONSTANT

#endif
