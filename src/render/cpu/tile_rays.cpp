// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Rays through volumes, with what the tile has of surfaces and lines: what is opaque ends them sample by sample, what is
// translucent stands where it is in the middle of a pixel.
#include <algorithm>
#include <cmath>

#include "render/cpu/tile.hpp"

namespace isotet::render {

void Tile::follow_rays() {
    end_rays();
    if (scene_.batch) volumes_->take_hits(*scene_.batch);
    else volumes_->find_hits();
    cut_rays();
    if (scene_.batch) volumes_->take_slabs(*scene_.batch);
    else volumes_->compose_media();
}

/// In a stage before the last.
void Tile::give_rays() {
    end_rays();
    if (scene_.stage == TileStage::to_hits) return volumes_->give_rays(Seek::isosurfaces, *scene_.batch);
    volumes_->take_hits(*scene_.batch);
    cut_rays();
    volumes_->give_rays(Seek::medium, *scene_.batch);
}

/// Behind what is opaque in all samples of a pixel nothing is seen.
void Tile::end_rays() {
    for (std::int32_t y = 0; y < frame_.height; ++y)
        for (std::int32_t x = 0; x < frame_.width; ++x) {
            const std::size_t pixel = pixel_of(x, y);
            if (!covered_[pixel]) continue;
            const float farthest =
                *std::max_element(depths_.begin() + static_cast<std::ptrdiff_t>(pixel * count_),
                                  depths_.begin() + static_cast<std::ptrdiff_t>((pixel + 1) * count_));
            if (farthest < INFINITY) volumes_->end_ray(static_cast<std::size_t>(32 * y + x), distance_of(farthest));
        }
}

void Tile::cut_rays() {
    for (std::int32_t y = 0; y < volume_tile_side; ++y)
        for (std::int32_t x = 0; x < volume_tile_side; ++x) {
            distances_.clear();
            if (x < frame_.width && y < frame_.height) take_sheet_distances(x, y, static_cast<std::size_t>(32 * y + x));
            volumes_->add_stops(distances_);
        }
}

/// The distances of opaque samples, translucent fragments and isosurfaces of a pixel, each once, ascending.
void Tile::take_sheet_distances(std::int32_t x, std::int32_t y, std::size_t ray) {
    const std::size_t pixel = pixel_of(x, y);
    if (covered_[pixel])
        for (std::uint32_t i = 0; i < count_; ++i)
            if (owners_[pixel * count_ + i]) distances_.push_back(distance_of(depths_[pixel * count_ + i]));
    for (std::uint32_t at = heads_[pixel]; at != 0; at = fragments_[at - 1].next)
        distances_.push_back(distance_of(depth_in_middle(facets_[fragments_[at - 1].facet].depth, x, y)));
    if (const RayHit hit = volumes_->hit(ray); hit.exists()) distances_.push_back(hit.distance);
    std::ranges::sort(distances_);
    distances_.erase(std::ranges::unique(distances_).begin(), distances_.end());
}

Tile::Blend Tile::blend_ray(std::int32_t x, std::int32_t y) {
    const std::size_t pixel = pixel_of(x, y), ray = static_cast<std::size_t>(32 * y + x);
    const RayHit hit = volumes_->hit(ray);
    if (!covered_[pixel] && !heads_[pixel] && !hit.exists()) {
        const Slab& slab = volumes_->slabs(ray)[0];
        return {slab.light, 1 - slab.through};
    }
    take_opaque(x, y);
    layers_.clear();
    if (heads_[pixel]) take_layers(x, y);
    Blend mean;
    for (std::uint32_t i = 0; i < count_; ++i) {
        const float depth = owners_[pixel * count_ + i] ? depths_[pixel * count_ + i] : INFINITY;
        const Blend sum = blend_sample(i, depth < INFINITY ? distance_of(depth) : INFINITY, ray, hit);
        for (std::size_t k = 0; k < 3; ++k) mean.light[k] += sum.light[k];
        mean.opacity += sum.opacity;
    }
    mean.divide_by(count_);
    return mean;
}

/// `end`   distance of what is opaque in the sample; infinite: nothing is
Tile::Blend Tile::blend_sample(std::uint32_t sample, float end, std::size_t ray, const RayHit& hit) const {
    const std::span<const float> stops = volumes_->stops(ray);
    const std::span<const Slab> slabs = volumes_->slabs(ray);
    Blend sum;
    std::size_t slab = 0;
    const auto go_to = [&](float distance) {
        for (; slab < slabs.size() && (slab == 0 || stops[slab - 1] < distance); ++slab) {
            const float part = 1 - sum.opacity;
            for (std::size_t i = 0; i < 3; ++i) sum.light[i] += part * slabs[slab].light[i];
            sum.opacity += part * (1 - slabs[slab].through);
        }
    };
    const float last = std::min(end, hit.distance);
    for (const Layer& layer : layers_) {
        if (!(layer.mask >> sample & 1)) continue;
        const float distance = distance_of(layer.depth);
        if (distance > hit.distance) break;
        go_to(std::min(distance, last));
        sum.add_behind(layer.shade.color, layer.shade.opacity);
    }
    go_to(last);
    if (hit.distance < end) sum.add_behind(hit.color, 1);
    else if (end < INFINITY) sum.add_behind(opaque_[sample].light, 1);
    return sum;
}

} // namespace isotet::render
