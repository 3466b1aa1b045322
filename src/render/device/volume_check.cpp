// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/volume_check.hpp"

#include <cstring>
#include <memory>

#include <isotet/fields.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>

#include "render/volume/volume_tile.hpp"

namespace isotet::render {

namespace {

constexpr std::uint32_t side = 56; ///< pixels: four tiles
constexpr std::array stops{0.45F, 0.55F};

DrawnVolume drawn_of(const PackedGrid& grid, Seek seek) {
    DrawnVolume volume;
    volume.grid = &grid;
    volume.scale.lower = grid.field().lower;
    volume.scale.upper = grid.field().upper;
    if (seek == Seek::medium)
        volume.opacity.points = {{-1.2, 0.2}, {-0.6, 0.9}, {-0.4, 0}, {0.3, 0}, {0.6, 0.999}, {0.8, 0}};
    else volume.isosurfaces = {{0.95, {0.2F, 0.7F, 0.3F, 1}}, {-0.9, {0.9F, 0.1F, 0, 1}}};
    volume.opacity_length = 0.2;
    volume.clips = {{{1, 0.3, 0.2}, 0.7}};
    volume.shaded = true;
    return volume;
}

/// The four tiles of a picture, by the processor and by something else.
class TwoWays {
public:
    TwoWays(const VolumeScene& scene, const Tiling& tiling)
        : scene_(scene),
          tiling_(tiling),
          own_(std::make_unique<VolumeTile>(scene)),
          other_(std::make_unique<VolumeTile>(scene, false)) {}

    Result<bool> agree(RayFollower& follower) {
        if (Result<void> started = follower.start(scene_, Progress()); !started) return started.error();
        batch_.start(0, tiling_.tiles());
        batch_.start_windows(1);
        const bool medium = scene_.media_bins.has_value();
        for (std::size_t tile = 0; tile < tiling_.tiles(); ++tile) {
            start(*other_, tile);
            if (medium) cut(*other_);
            other_->give_rays(medium ? Seek::medium : Seek::isosurfaces, batch_);
        }
        if (medium) batch_.join_stops();
        const Result<void> followed =
            medium ? follower.compose(batch_, Progress()) : follower.find_hits(batch_, Progress());
        if (!followed) return followed.error();
        bool same = true;
        for (std::size_t tile = 0; tile < tiling_.tiles(); ++tile) same = same && agree_in(tile);
        return same;
    }

private:
    void start(VolumeTile& tile, std::size_t number) const {
        tile.start(number, static_cast<std::uint32_t>(number % tiling_.columns()) * tiling_.side,
                   static_cast<std::uint32_t>(number / tiling_.columns()) * tiling_.side);
    }
    static void cut(VolumeTile& tile) {
        for (std::size_t pixel = 0; pixel < RayBatch::tile_pixels; ++pixel) tile.add_stops(stops);
    }
    bool agree_in(std::size_t number) {
        start(*own_, number);
        own_->find_hits();
        cut(*own_);
        own_->compose_media();
        start(*other_, number);
        other_->take_hits(batch_);
        cut(*other_);
        other_->take_slabs(batch_);
        for (std::size_t pixel = 0; pixel < RayBatch::tile_pixels; ++pixel) {
            const RayHit hit = own_->hit(pixel), found = other_->hit(pixel);
            if (std::memcmp(&hit, &found, sizeof(hit)) != 0) return false;
            const std::span<const Slab> slabs = own_->slabs(pixel), others = other_->slabs(pixel);
            if (std::memcmp(slabs.data(), others.data(), slabs.size_bytes()) != 0) return false;
        }
        return true;
    }

    const VolumeScene& scene_;
    Tiling tiling_;
    std::unique_ptr<VolumeTile> own_, other_;
    RayBatch batch_;
};

} // namespace

Result<bool> follows_as_processor(RayFollower& follower, Seek seek, Projection projection) {
    const bool perspective = projection == Projection::perspective;
    const Result<Grid> grid = make_grid({.shape = perspective ? "mixed" : "kuhn", .side = 5, .fields = {"gyroid"}});
    if (!grid) return grid.error();
    const Result<PointField> field = find_field(*grid, "gyroid");
    if (!field) return field.error();
    const Result<PackedGrid> packed = pack(*grid, *field);
    if (!packed) return packed.error();
    Scene scene;
    scene.bounds = bounds_of(*packed);
    scene.volumes = {drawn_of(*packed, seek)};
    Camera camera = camera_of(31, 23, UpAxis::plus_z, projection);
    camera.fit(scene.bounds, 1);
    if (perspective) camera.distance *= 0.2; // tets reach behind the eye
    const Space space(scene.bounds);
    const Tiling tiling{side, side, 1, volume_tile_side};
    VolumeScene volumes(scene, space, space.look(camera, side, side), tiling, {});
    if (Result<void> placed = volumes.place(tiling, Progress()); !placed) return placed.error();
    return TwoWays(volumes, tiling).agree(follower);
}

} // namespace isotet::render
