// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/volume/ray_batch.hpp"

namespace isotet::render {

void RayBatch::start(std::size_t first_tile, std::size_t count) {
    first = first_tile;
    tiles = count;
    rays.assign(count * tile_pixels, BatchRay{});
    tile_stops.assign(count, {});
    stops.clear();
    windows.clear();
    hits.clear();
    slabs.clear();
}

void RayBatch::start_windows(std::size_t volumes) { windows.assign(volumes * pixels(), {0, INFINITY}); }

void RayBatch::join_stops() {
    stops.clear();
    for (std::size_t tile = 0; tile < tiles; ++tile) {
        const auto before = static_cast<std::uint32_t>(stops.size());
        for (std::size_t pixel = 0; pixel < tile_pixels; ++pixel) rays[tile * tile_pixels + pixel].first_stop += before;
        stops.insert(stops.end(), tile_stops[tile].begin(), tile_stops[tile].end());
    }
}

} // namespace isotet::render
