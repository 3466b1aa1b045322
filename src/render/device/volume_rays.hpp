// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Rays through volumes that a device follows: kernels/volume_rays.comp.
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "render/device/volume_grids.hpp"
#include "render/volume/ray_batch.hpp"
#include "render/volume/volume_tile.hpp"
#include "vulkan/context.hpp"

namespace isotet::render {

class VolumeRays : public RayFollower {
public:
    explicit VolumeRays(std::shared_ptr<vulkan::Context> context) : context_(std::move(context)) {}

    /// Tests by small volumes what a scene needs, once each: follows_as_processor(). A driver may compile for a second for each.
    ///
    /// Errors   no_device: why this device does not follow rays; out_of_memory; device_failed
    Result<void> check(const Scene& scene, Projection projection);

    /// Errors   out_of_memory: also where lists grow beyond what there is for them; device_failed; cancelled
    Result<void> start(const VolumeScene& scene, const Progress& progress) override;
    Result<void> find_hits(RayBatch& batch, const Progress& progress) override;
    Result<void> compose(RayBatch& batch, const Progress& progress) override;
    const VolumeWork& work() const override { return work_; }

private:
    /// What a batch gives to the device.
    struct Given {
        vulkan::Buffer volumes, tiles, entries, rays, stops, windows, slabs, hits, scene, blocks, results, planes,
            segments, marks;

        std::uint64_t bytes() const;
    };

    Result<void> take(vulkan::Buffer& buffer, std::uint64_t bytes, std::string_view name);
    Result<void> put(vulkan::Buffer& buffer, std::span<const std::byte> bytes, std::string_view name);
    Result<void> give(const RayBatch& batch, Seek seek);
    Result<void> follow(Seek seek, std::size_t tiles, const Progress& progress);
    Result<std::vector<std::uint32_t>> follow_blocks(std::span<const std::uint32_t> blocks, Seek seek,
                                                     std::uint32_t capacity, const Progress& progress);

    std::shared_ptr<vulkan::Context> context_;
    const VolumeScene* scene_ = nullptr;
    std::vector<VolumeOnDevice> media_, surfaces_;
    Given given_;
    VolumeWork work_;
    std::set<std::pair<Seek, Projection>> checked_;
};

} // namespace isotet::render
