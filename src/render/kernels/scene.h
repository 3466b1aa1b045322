// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Every struct that both the processor and the drawing shaders know, once for both. All members are 4 bytes wide, so
// that C++ and GLSL's scalar layout place them alike; render/layout.hpp checks the sizes.
//
// Lengths are those of the scene: relative to its centre, in halves of its size, so that no grid is too large or too
// small. Colours are linear light. A picture is drawn in parts that fit the images; a part has samples x samples
// samples for each of its pixels.
#ifndef ISOTET_SCENE_H
#define ISOTET_SCENE_H

#ifdef __cplusplus
#include "vulkan/kernels/shared/layout.h"
namespace isotet::render::layout {
using vulkan::layout::Address;
using vulkan::layout::uint;
struct vec3 {
    float x, y, z;
};
struct vec4 {
    float x, y, z, w;
};
struct mat4 {
    vec4 columns[4];
};
#define ISOTET_CONSTANT constexpr uint
#else
#include "shared/layout.h"
#define ISOTET_CONSTANT const uint
#endif

ISOTET_CONSTANT resolve_size = 64u;     ///< invocations of a workgroup, a pixel each
ISOTET_CONSTANT table_entries = 1024u;  ///< of a colour map

/// What colours a mesh (Mesh::values).
ISOTET_CONSTANT one_color = 0u;
ISOTET_CONSTANT by_vertex = 1u;         ///< a value a vertex
ISOTET_CONSTANT by_grid_point = 2u;     ///< a value a packed point, between the two ends of each vertex
ISOTET_CONSTANT by_triangle = 3u;       ///< a value a triangle
ISOTET_CONSTANT by_grid_tet = 4u;       ///< a value a stored tet, by the source of each triangle

/// How a part of the picture is seen, and where its samples go.
struct View {
    mat4 clip_from_scene;
    vec3 eye;             ///< where it is, or in which direction if `parallel` is 1
    uint parallel;
    vec3 up;              ///< of the picture, unit
    uint width, height;   ///< pixels
    uint samples;         ///< an axis and pixel
    uint fragment_room;   ///< translucent fragments; 0: none is drawn
    Address colors;       ///< opaque colours: four half floats a sample
    Address heads;        ///< uint a sample: 1 + its last translucent fragment, or 0
    Address fragments;    ///< FragmentList, then Fragment each
    Address pixels;       ///< uint a pixel of this part: red, green, blue, alpha, 8 bits each
    vec3 background;
    float background_opacity;
};

/// A mesh, where its arrays are and how it looks.
struct Mesh {
    Address positions;    ///< float x 3 a vertex
    Address triangles;    ///< uint x 3 a triangle
    Address normals;      ///< float x 3 a vertex, or (0, 0): faces tell
    Address values;       ///< float each: place in the colour map, 0 to 1; or value / lower end, where log_factor is
                          ///< not 0
    Address ends;         ///< uint x 2 a vertex: packed points
    Address weights;      ///< float a vertex
    Address sources;      ///< uint a triangle: stored tet
    Address table;        ///< float x 3 an entry: the colour map
    vec3 offset;          ///< place in the scene = position * scale + offset
    float scale;
    vec3 color;           ///< where no values are
    vec3 no_data;         ///< where a value is NaN
    float opacity;        ///< of the sheet seen at a right angle
    float log_factor;     ///< place in the map = log(value) * log_factor; 0: values are places
};

/// Lines: pairs of ends.
struct Lines {
    Address ends;         ///< float x 3 each
    vec3 color;
    float half_width;     ///< samples
    float lift;           ///< of the depth, towards the eye
};

/// How a store holds its tets (TetPage::records).
ISOTET_CONSTANT registers_method = 0u;  ///< TetRegisters, one for each of the four vertices of a tet
ISOTET_CONSTANT instanced_method = 1u;  ///< four corners a tet, x, y, z and value
ISOTET_CONSTANT textures_method = 2u;   ///< four point numbers a tet; also of mesh shaders

ISOTET_CONSTANT page_tets = 65536u;     ///< of a store, but for its last page
ISOTET_CONSTANT tet_group = 32u;        ///< tets of a workgroup of mesh shaders
ISOTET_CONSTANT twin_size = 64u;        ///< invocations of a workgroup, a vertex of a tet each

/// Half the table of marching tetrahedra: by which corners are above (1, 2, 4, 8), four active edges around. An index
/// of 8 or more has the row of 15 - index. Where three edges are crossed the last stands twice, and with it the
/// vertices.
#define ISOTET_HALF_CASES                                                                           \
    0u, 0u, 0u, 0u, 0u, 2u, 1u, 1u, 0u, 3u, 4u, 4u, 1u, 3u, 4u, 2u, 1u, 5u, 3u, 3u, 0u, 2u, 5u, 3u, \
    0u, 1u, 5u, 4u, 2u, 5u, 4u, 4u
/// Both corners of the six edges of a tet.
#define ISOTET_TET_EDGES 0u, 1u, 0u, 2u, 0u, 3u, 1u, 2u, 1u, 3u, 2u, 3u

/// The tables, in the store of textures.
struct TetTables {
    uint cases[32];
    uint edges[12];
};

/// A vertex of the paper's GPU(R): it knows its whole tet.
struct TetRegisters {
    vec4 corners[4];      ///< x, y, z and value
    uint number;          ///< 0 to 3
};

/// Tets of one page of a store that are drawn. Begins as a mesh does, so that fragments are those of meshes.
struct TetPage {
    Mesh mesh;            ///< of which only place and look count
    Address records;      ///< of all tets of the page
    Address numbers;      ///< uint each: which tets of the page; not read where all are drawn
    Address points;       ///< of textures: x, y, z and value each
    Address gradients;    ///< of textures: unit direction and 0, or zero, each
    Address tables;       ///< of textures: TetTables
    Address ranges;       ///< of mesh shaders: a Range for every tet_group tets of the page
    float isovalue, rest; ///< core::StoredIsovalue: value, rest
    uint tets;            ///< that are drawn
};

/// What the compute twin of the vertex shader works on.
struct TwinPush {
    Address page;         ///< TetPage
    Address vertices;     ///< float x 3 each: a place, or NaN where the tet is not cut
    uint count;           ///< of vertices, four a tet
};

struct FragmentList {
    uint count;           ///< fragments that there are, more perhaps than there is room for
};

/// A translucent fragment. Which one of a list stands where depends on timing, what the list holds does not.
struct Fragment {
    uint next;            ///< 1 + the next one of the sample, or 0
    float depth;
    uint red_green;       ///< half floats
    uint blue_opacity;
};

struct DrawPush {
    Address view;
    Address item;         ///< Mesh, TetPage or Lines
};

struct ResolvePush {
    Address view;
};

#ifdef __cplusplus
} // namespace isotet::render::layout
#endif
#undef ISOTET_CONSTANT

#endif
