// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the processor and the kernels of volumes both know, once for both; render/device/volume_layout.hpp checks the
// sizes. Doubles stand first, so that C++ and GLSL's scalar layout place all alike.
//
// Rays are followed tile by tile. A workgroup has a block of 16 x 8 pixels of a tile, an invocation a pixel.
#ifndef ISOTET_VOLUME_H
#define ISOTET_VOLUME_H

#ifdef __cplusplus
#include "vulkan/kernels/shared/layout.h"
namespace isotet::render::layout {
using vulkan::layout::Address;
using vulkan::layout::uint;
using Double = double;
#define ISOTET_CONSTANT constexpr uint
#else
#include "shared/layout.h"
#define ISOTET_CONSTANT const uint
#endif

ISOTET_CONSTANT tile_side = 32u;        ///< pixels
ISOTET_CONSTANT tile_pixels = 1024u;
ISOTET_CONSTANT block_width = 16u;
ISOTET_CONSTANT block_height = 8u;
ISOTET_CONSTANT block_size = 128u;      ///< pixels, and invocations
ISOTET_CONSTANT blocks_per_tile = 8u;
ISOTET_CONSTANT table_rows = 1024u;     ///< of a transfer function

/// A row of the table of a transfer function, as Transfer has it.
struct TransferRow {
    Double up_to[4];
    float rise[4];
    float bend[4];
};

/// A volume, and where it is in the picture: rows for positions, which stand first.
struct VolumePlace {
    Double across[4];     ///< times w, pixels
    Double down[4];
    Double w[4];
    Double depth[4];      ///< of parallel pictures
    Address positions;    ///< double x 3 each, of the local points of clusters
    Address values;       ///< float each: place in the transfer table, or height above an isovalue
    Address clusters;     ///< VolumeCluster
    Address tets;         ///< uint each: four local points
    Address table;        ///< TransferRow
    Address heights;      ///< float each: isosurfaces
    Address windows;      ///< float x 2 a pixel: between these distances the volume is seen; (0, 0): everywhere
    uint isosurfaces;
    uint shaded;
};

ISOTET_CONSTANT place_bytes = 192u;     ///< of VolumePlace

struct VolumeCluster {
    uint first_point, points, first_tet, tets;
};

/// A tile: its corner in pixels, and its clusters.
struct VolumeTileAt {
    uint x, y, first, count;
};

/// A cluster in a tile, nearest first.
struct VolumeEntry {
    float nearest;        ///< distance before which nothing of it is
    uint volume, cluster;
};

/// A ray before it is followed.
struct VolumeRay {
    float end;            ///< distance at which it ends
    float lengths;        ///< of the user, for 1 of distance
    float to_eye[3];
    uint first_stop, stops;
};

/// Where a ray meets the nearest isosurface; infinitely far: nowhere.
struct VolumeHit {
    float distance;
    float normal[3];
    uint volume, isosurface;
};

/// A face of a tet as FacePlane has it.
struct VolumeFace {
    float near, near_per_x, near_per_y;
    float value, value_per_x, value_per_y;
    float x, y;
};

/// A tet over a tile. Front faces come first.
struct VolumePlanes {
    VolumeFace faces[5];
    float lowest, highest, farthest, nearest;
    float normal[3];      ///< direction of the gradient, or 0
    uint fronts, backs;   ///< these end with the last
    uint box;             ///< left, top, right, bottom of the tile, 8 bits each
};

ISOTET_CONSTANT planes_bytes = 200u;    ///< of VolumePlanes

/// What became of a block.
struct BlockResult {
    uint full;            ///< 1: a list was too short, and nothing else counts
    uint tets, segments;
};

/// What blocks work on.
struct VolumeScene {
    Double nearest;       ///< distance: what is before it is cut off
    Address volumes;      ///< VolumePlace
    Address tiles;        ///< VolumeTileAt
    Address entries;      ///< VolumeEntry
    Address rays;         ///< VolumeRay a pixel, tile by tile
    Address stops;        ///< float each: distances of sheets
    Address slabs;        ///< float x 4 each, one more than stops a pixel: light, and what comes through
    Address hits;         ///< VolumeHit a pixel
    Address blocks;       ///< uint each: blocks_per_tile * tile + block
    Address results;      ///< BlockResult a block of `blocks`
    Address planes;       ///< VolumePlanes, block_size a workgroup
    Address segments;     ///< float x 4 each, room for `capacity` a pixel and workgroup
    Address marks;        ///< uint each: of segments, 65536 * light + volume
    float up[3];          ///< of the picture
    uint capacity;        ///< of a list
    uint compose_from;    ///< segments
};

struct VolumePush {
    Address scene;        ///< VolumeScene
    uint first, count;    ///< of the blocks
};

#ifdef __cplusplus
} // namespace isotet::render::layout
#endif
#undef ISOTET_CONSTANT

#endif
