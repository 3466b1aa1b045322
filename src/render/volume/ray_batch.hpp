// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The rays of some tiles of a picture, which something else than VolumeTile follows: what it is given, and what it finds.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/render.hpp>
#include <isotet/result.hpp>

#include "render/volume/segments.hpp"

namespace isotet::render {

struct VolumeScene;

/// A ray before it is followed.
struct BatchRay {
    float end;                   ///< distance at which it ends
    float lengths;               ///< of the user, for 1 of distance
    std::array<float, 3> to_eye; ///< unit
    std::uint32_t first_stop, stops;
};

/// Where a ray meets the nearest isosurface; infinitely far: nowhere.
struct FoundHit {
    float distance = INFINITY;
    std::array<float, 3> normal{};
    std::uint32_t volume = 0, isosurface = 0;

    auto key() const { return std::tie(distance, normal, volume, isosurface); }
};

/// Tile after tile, the pixels of each row by row.
class RayBatch {
public:
    static constexpr std::size_t tile_pixels = SegmentLists::pixels;
    static constexpr std::size_t most_tiles = 256;

    void start(std::size_t first, std::size_t count);
    /// Room for the windows of so many volumes; none where nothing is clipped.
    void start_windows(std::size_t volumes);
    /// After each tile has its own.
    void join_stops();

    std::size_t pixels() const { return rays.size(); }
    std::size_t pixel_of(std::size_t tile, std::size_t pixel) const { return (tile - first) * tile_pixels + pixel; }
    /// Of a pixel.
    std::size_t first_slab(std::size_t pixel) const { return rays[pixel].first_stop + pixel; }

    std::size_t first = 0, tiles = 0;
    std::vector<BatchRay> rays;
    std::vector<std::array<float, 2>> windows;   ///< of each volume, its pixels: distances between which it is seen
    std::vector<std::vector<float>> tile_stops;  ///< of each tile
    std::vector<float> stops;                    ///< of all
    std::vector<FoundHit> hits;                  ///< found: a pixel each; none where nothing is sought
    std::vector<Slab> slabs;                     ///< found: one more a pixel than it has stops
};

/// Follows the rays of a scene with the same results as VolumeTile, bit for bit.
class RayFollower {
public:
    virtual ~RayFollower() = default;

    /// Before all batches. The scene is placed, and lives as long as its batches.
    virtual Result<void> start(const VolumeScene& scene, const Progress& progress) = 0;
    virtual Result<void> find_hits(RayBatch& batch, const Progress& progress) = 0;
    virtual Result<void> compose(RayBatch& batch, const Progress& progress) = 0;
    virtual const VolumeWork& work() const = 0; ///< since the start: tets, segments, bytes of its memory
};

} // namespace isotet::render
