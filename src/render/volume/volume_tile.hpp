// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The volumes in one tile of the picture: isosurfaces that its rays meet, then what media give them between sheets.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <isotet/render.hpp>

#include "packed/residency.hpp"
#include "render/volume/ray_batch.hpp"
#include "render/volume/segments.hpp"
#include "render/volume/tet_planes.hpp"
#include "render/volume/volume_bins.hpp"

namespace isotet::render {

/// What tests change. No picture shows it.
struct VolumeTuning {
    ListRoom lists = {};
    bool skips = true; ///< what is transparent is left out
};

/// The volumes of a picture; those with isosurfaces are in both lists if they have opacity, too.
struct VolumeScene {
    Rays rays;
    VolumeTuning tuning;
    std::vector<PlacedVolume> media, surfaces;
    std::optional<VolumeBins> media_bins, surface_bins;

    /// Borrows the grids of the scene.
    VolumeScene(const Scene& scene, const Space& space, const Sight& sight, const Tiling& tiling,
                const VolumeTuning& tuning);
    /// Finds which tiles may show what, before anything is drawn.
    /// Errors   as Residency::bring()
    Result<void> place(const Tiling& tiling, const Progress& progress);

    /// Calls work(first, last) for ranges of tiles, one after another, while what they show of grids in files is in memory.
    /// Errors   as Residency::bring()
    Result<void> for_tiles(std::size_t tiles, const Progress& progress,
                           const std::function<void(std::size_t, std::size_t)>& work) const;
    std::uint64_t bytes() const;
    std::uint64_t clusters() const { ///< that some tile may show
        return (media_bins ? media_bins->clusters() : 0) + (surface_bins ? surface_bins->clusters() : 0);
    }

private:
    Result<bool> bring(std::size_t first, std::size_t last, const Progress& progress, core::Residency::Amount amount,
                       std::vector<core::Brought>& brought) const;
};

/// Where a ray meets the nearest isosurface.
struct RayHit {
    float distance = INFINITY;
    Light color{}; ///< lit

    bool exists() const { return distance < INFINITY; }
};

class VolumeTile {
public:
    /// `follows`   false: rays are given to a batch, and results taken from it
    explicit VolumeTile(const VolumeScene& scene, bool follows = true);

    /// Starts a tile with its rays, which end where nothing is.
    void start(std::size_t number, std::uint32_t column, std::uint32_t row);
    /// Nothing is seen from this distance on.
    void end_ray(std::size_t pixel, float distance) {
        ends_[index_of(pixel)] = std::min(ends_[index_of(pixel)], distance);
    }

    void find_hits();
    RayHit hit(std::size_t pixel) const;

    /// Sheets cut the ray at these distances, ascending: for each pixel, in order.
    void add_stops(std::span<const float> stops);
    void compose_media();

    // In place of find_hits() and compose_media():
    void give_rays(Seek seek, RayBatch& batch);
    void take_hits(const RayBatch& batch);
    void take_slabs(const RayBatch& batch);

    std::span<const float> stops(std::size_t pixel) const;
    std::span<const Slab> slabs(std::size_t pixel) const;

    const VolumeWork& work() const { return work_; } ///< of all tiles so far, bytes included

    /// Pixels of a tile are numbered row by row; here 4 x 4 of them lie together.
    static std::size_t index_of(std::size_t pixel) {
        const std::size_t x = pixel % 32, y = pixel / 32;
        return (y / 4 * 8 + x / 4) * 16 + y % 4 * 4 + x % 4;
    }
    /// Of the pixel `lane` of the 4 x 4 ones that begin with `corner`.
    static std::size_t index_in(std::size_t corner, std::size_t lane) {
        return index_of(corner + lane / 4 * 32 + lane % 4);
    }

private:
    static constexpr std::size_t pixels = SegmentLists::pixels;
    /// Sixteen pixels, 4 x 4.
    struct Lanes {
        alignas(64) std::array<float, 16> enter, leave, from, to;
        alignas(64) std::array<std::int32_t, 16> inside;
    };

    void clip_rays(const std::vector<PlacedVolume>& volumes);
    bool is_done(float nearest) const;
    void compose_full(float horizon);
    void compose_pixel(std::size_t index, float horizon);
    void draw_clusters(std::span<const ClusterEntry> entries, const std::vector<PlacedVolume>& volumes);
    template <bool parallel>
    void draw_cluster(const ClusterEntry& entry, const PlacedVolume& volume);
    template <bool parallel>
    void draw_tet(const PlacedVolume& volume, std::uint32_t number, const std::array<std::uint8_t, 4>& locals);
    template <bool parallel, std::size_t faces>
    void draw_blocks(const PlacedVolume& volume, std::uint32_t number, const std::array<TetCorner, 4>& corners);
    template <bool parallel, std::size_t faces>
    void find_lanes(std::int32_t x, std::int32_t y, Lanes& out) const;
    void add_segments(const Lanes& lanes, std::uint32_t mask, std::size_t corner, const PlacedVolume& volume,
                      std::uint32_t number, const std::array<TetCorner, 4>& corners);
    std::uint32_t before_ends(const Lanes& lanes, std::uint32_t mask, std::size_t corner) const;
    bool is_empty(std::uint32_t volume, float from, float to) const;
    float light_along(std::size_t index, std::array<float, 3> normal) const;
    void add_hits(const Lanes& lanes, std::uint32_t mask, std::size_t corner, const PlacedVolume& volume,
                  std::uint32_t number, const std::array<TetCorner, 4>& corners);

    const VolumeScene& scene_;
    std::size_t number_ = 0;
    std::uint32_t column_ = 0, row_ = 0; ///< of the tile
    Seek seek_ = Seek::medium;
    std::array<Ray, pixels> rays_;       ///< as the arrays below, in blocks of 4 x 4
    alignas(64) std::array<float, pixels> ends_;
    std::array<FoundHit, pixels> hits_;
    std::array<RayState, pixels> states_;
    std::vector<RayPart> parts_; ///< of each volume, its pixels; empty where nothing is clipped
    std::vector<float> stops_;
    std::vector<Slab> slabs_;
    std::vector<std::uint32_t> first_stops_; ///< of each pixel, row by row, and one more
    SegmentLists lists_;
    std::vector<Segment> scratch_;
    std::vector<Medium> media_;
    PlacedPoints points_;
    TetPlanes planes_;
    VolumeWork work_;
    std::vector<std::vector<std::uint16_t>> opaque_steps_; ///< of each medium: opaque_steps(); none: nothing is left out
};

} // namespace isotet::render
