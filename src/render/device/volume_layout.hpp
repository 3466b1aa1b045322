// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The structs that cross to the kernels of volumes (kernels/volume.h), checked against what they mirror.
#pragma once

#include <cstddef>

#include "packed/packed.hpp"
#include "render/kernels/volume.h"
#include "render/volume/ray_batch.hpp"
#include "render/volume/transfer.hpp"
#include "vulkan/engine/layout.hpp"

namespace isotet::render::layout {

static_assert(sizeof(TransferRow) == 64 && sizeof(Transfer::Row) == 64 && table_rows == Transfer::entries);
static_assert(sizeof(VolumePlace) == place_bytes && offsetof(VolumePlace, isosurfaces) == 4 * 32 + 7 * 8);
static_assert(sizeof(VolumeCluster) == 16 && sizeof(VolumeTileAt) == 16 && sizeof(VolumeEntry) == 12);
static_assert(sizeof(VolumeRay) == 28 && sizeof(BatchRay) == 28 && offsetof(BatchRay, stops) == 24);
static_assert(sizeof(VolumeHit) == 24 && sizeof(FoundHit) == 24 && offsetof(FoundHit, isosurface) == 20);
static_assert(sizeof(Slab) == 16 && offsetof(Slab, through) == 12);
static_assert(sizeof(VolumePlanes) == planes_bytes && sizeof(BlockResult) == 12 && sizeof(VolumePush) == 16);
static_assert(offsetof(VolumeScene, volumes) == 8 && offsetof(VolumeScene, compose_from) == 8 + 12 * 8 + 12 + 4);
static_assert(tile_pixels == RayBatch::tile_pixels && tile_side * tile_side == tile_pixels);
static_assert(blocks_per_tile * block_width * block_height == tile_pixels && block_width * block_height == block_size);
static_assert(core::max_cluster_points <= block_size, "an invocation places a point");

} // namespace isotet::render::layout
