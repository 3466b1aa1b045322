// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/volume_rays.hpp"

#include <algorithm>
#include <array>

#include <fmt/core.h>

#include "render/device/send.hpp"
#include "render/device/volume_check.hpp"
#include "render_shaders.hpp"

namespace isotet::render {

namespace {

using vulkan::address_of;

constexpr std::uint64_t least_list_bytes = std::uint64_t{256} << 20; ///< that all workgroups at work may have
constexpr std::uint64_t most_list_bytes = std::uint64_t{1} << 30;
constexpr std::uint64_t bytes_per_segment = 20;
constexpr std::size_t most_windows = 64; ///< volumes of a scene with clip planes

} // namespace

std::uint64_t VolumeRays::Given::bytes() const {
    std::uint64_t bytes = 0;
    for (const vulkan::Buffer* buffer : {&volumes, &tiles, &entries, &rays, &stops, &windows, &slabs, &hits, &scene,
                                         &blocks, &results, &planes, &segments, &marks})
        bytes += buffer->size();
    return bytes;
}

Result<void> VolumeRays::check(const Scene& scene, Projection projection) {
    for (const Seek seek : {Seek::isosurfaces, Seek::medium}) {
        const bool is_sought = std::ranges::any_of(scene.volumes, [seek](const DrawnVolume& volume) {
            return seek == Seek::medium ? !volume.opacity.is_transparent() : !volume.isosurfaces.empty();
        });
        if (!is_sought || checked_.contains({seek, projection})) continue;
        const Result<bool> same = follows_as_processor(*this, seek, projection);
        if (!same) return same.error();
        if (!*same)
            return Error{ErrorCode::no_device,
                         fmt::format("what the driver of the device {} makes of the kernel gives other light than the "
                                     "CPU does ({})",
                                     context_->info().name, context_->info().driver)};
        checked_.insert({seek, projection});
    }
    return {};
}

Result<void> VolumeRays::take(vulkan::Buffer& buffer, std::uint64_t bytes, std::string_view name) {
    if (buffer && buffer.size() >= bytes) return {};
    buffer = {};
    Result<vulkan::Buffer> taken = context_->memory().take(bytes, vulkan::Where::device, name);
    if (!taken) return taken.error();
    buffer = *std::move(taken);
    return {};
}

Result<void> VolumeRays::put(vulkan::Buffer& buffer, std::span<const std::byte> bytes, std::string_view name) {
    if (Result<void> taken = take(buffer, bytes.size(), name); !taken || bytes.empty()) return taken;
    return context_->staging().upload(buffer, 0, bytes);
}

Result<void> VolumeRays::start(const VolumeScene& scene, const Progress& progress) {
    scene_ = &scene;
    work_ = {};
    media_.clear();
    surfaces_.clear();
    for (const auto& [volumes, uploaded] : {std::tie(scene.media, media_), std::tie(scene.surfaces, surfaces_)}) {
        const bool clipped = std::ranges::any_of(volumes, [](const auto& one) { return !one.clips().empty(); });
        if (clipped && volumes.size() > most_windows)
            return Error{ErrorCode::out_of_memory,
                         fmt::format("{} volumes with clip planes, but a device takes {} together", volumes.size(),
                                     most_windows)};
        for (const PlacedVolume& volume : volumes) {
            Result<VolumeOnDevice> one = VolumeOnDevice::upload(*context_, volume, progress);
            if (!one) return one.error();
            uploaded.push_back(*std::move(one));
        }
    }
    return {};
}

/// Everything but lists and blocks.
Result<void> VolumeRays::give(const RayBatch& batch, Seek seek) {
    const bool medium = seek == Seek::medium;
    const std::vector<VolumeOnDevice>& volumes = medium ? media_ : surfaces_;
    const VolumeBins& bins = medium ? *scene_->media_bins : *scene_->surface_bins;
    const std::uint32_t columns = (scene_->rays.width() + layout::tile_side - 1) / layout::tile_side;
    std::vector<layout::VolumeTileAt> tiles;
    std::vector<layout::VolumeEntry> entries;
    for (std::size_t tile = batch.first; tile < batch.first + batch.tiles; ++tile) {
        const auto number = static_cast<std::uint32_t>(tile);
        tiles.push_back({number % columns * layout::tile_side, number / columns * layout::tile_side,
                         static_cast<std::uint32_t>(entries.size()), static_cast<std::uint32_t>(bins.of(tile).size())});
        for (const ClusterEntry& entry : bins.of(tile))
            entries.push_back({entry.nearest, entry.volume, volumes[entry.volume].number_of(entry.cluster)});
    }
    const auto bytes_of = [](const auto& values) { return std::as_bytes(std::span(values)); };
    if (Result<void> sent = put(given_.windows, bytes_of(batch.windows), "windows of rays"); !sent) return sent;
    std::vector<layout::VolumePlace> places;
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        places.push_back(volumes[i].place());
        if (!batch.windows.empty())
            places.back().windows = address_of(given_.windows, i * batch.pixels() * sizeof(batch.windows[0]));
    }
    for (const Result<void>& sent :
         {put(given_.volumes, bytes_of(places), "volumes"), put(given_.tiles, bytes_of(tiles), "tiles"),
          put(given_.entries, bytes_of(entries), "clusters of tiles"), put(given_.rays, bytes_of(batch.rays), "rays"),
          put(given_.stops, bytes_of(batch.stops), "distances of sheets"),
          take(given_.slabs, (batch.stops.size() + batch.pixels()) * sizeof(Slab), "light"),
          take(given_.hits, batch.pixels() * sizeof(FoundHit), "hits")})
        if (!sent) return sent;
    return {};
}

Result<void> VolumeRays::find_hits(RayBatch& batch, const Progress& progress) {
    if (Result<void> given = give(batch, Seek::isosurfaces); !given) return given;
    if (Result<void> followed = follow(Seek::isosurfaces, batch.tiles, progress); !followed) return followed;
    batch.hits.resize(batch.pixels());
    return context_->staging().download(given_.hits, 0, std::as_writable_bytes(std::span(batch.hits)));
}

Result<void> VolumeRays::compose(RayBatch& batch, const Progress& progress) {
    if (Result<void> given = give(batch, Seek::medium); !given) return given;
    if (Result<void> followed = follow(Seek::medium, batch.tiles, progress); !followed) return followed;
    batch.slabs.resize(batch.stops.size() + batch.pixels());
    return context_->staging().download(given_.slabs, 0, std::as_writable_bytes(std::span(batch.slabs)));
}

/// All blocks; those with a list that was too short again, with lists of twice the length.
Result<void> VolumeRays::follow(Seek seek, std::size_t tiles, const Progress& progress) {
    std::vector<std::uint32_t> blocks(tiles * layout::blocks_per_tile);
    for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] = static_cast<std::uint32_t>(i);
    std::uint32_t capacity = seek == Seek::medium ? scene_->tuning.lists.capacity : 1;
    while (!blocks.empty()) {
        Result<std::vector<std::uint32_t>> full = follow_blocks(blocks, seek, capacity, progress);
        if (!full) return full.error();
        blocks = *std::move(full);
        capacity *= 2;
    }
    return {};
}

/// Returns the blocks that need longer lists.
Result<std::vector<std::uint32_t>> VolumeRays::follow_blocks(std::span<const std::uint32_t> blocks, Seek seek,
                                                             std::uint32_t capacity, const Progress& progress) {
    const std::array<std::uint32_t, 2> constants{scene_->rays.parallel() ? 1U : 0U, seek == Seek::medium ? 0U : 1U};
    const bool has_doubles = context_->capabilities().features.shaderFloat64 == VK_TRUE;
    const Result<const vulkan::Kernel*> kernel = context_->kernels().get(
        has_doubles ? vulkan::drawing::volume_rays : vulkan::drawing::volume_rays_without_doubles, constants);
    if (!kernel) return kernel.error();
    const std::uint64_t per_group = std::uint64_t{layout::block_size} * capacity * bytes_per_segment;
    const std::uint64_t for_lists =
        std::clamp(context_->memory().free() / 8 + given_.segments.size(), least_list_bytes, most_list_bytes);
    if (per_group > for_lists)
        return Error{ErrorCode::out_of_memory,
                     fmt::format("lists of {} segments a ray, longer than a device gets", capacity)};
    const std::uint64_t groups = std::min<std::uint64_t>(blocks.size(), for_lists / per_group);
    const std::uint64_t segments = groups * layout::block_size * capacity;
    for (const Result<void>& had :
         {take(given_.segments, segments * 16, "segments of rays"), take(given_.marks, segments * 4, "marks of rays"),
          take(given_.planes, groups * layout::block_size * layout::planes_bytes, "planes of tets"),
          take(given_.results, blocks.size() * sizeof(layout::BlockResult), "results of blocks"),
          put(given_.blocks, std::as_bytes(blocks), "blocks")})
        if (!had) return had.error();

    layout::VolumeScene scene{};
    scene.nearest = scene_->rays.nearest();
    scene.volumes = address_of(given_.volumes);
    scene.tiles = address_of(given_.tiles);
    scene.entries = address_of(given_.entries);
    scene.rays = address_of(given_.rays);
    scene.stops = address_of(given_.stops);
    scene.slabs = address_of(given_.slabs);
    scene.hits = address_of(given_.hits);
    scene.blocks = address_of(given_.blocks);
    scene.results = address_of(given_.results);
    scene.planes = address_of(given_.planes);
    scene.segments = address_of(given_.segments);
    scene.marks = address_of(given_.marks);
    for (std::size_t axis = 0; axis < 3; ++axis) scene.up[axis] = static_cast<float>(scene_->rays.sight().up[axis]);
    scene.capacity = capacity;
    scene.compose_from = scene_->tuning.lists.compose_from;
    if (Result<void> sent = put(given_.scene, std::as_bytes(std::span(&scene, 1)), "volumes of a picture"); !sent)
        return sent.error();

    std::vector<vulkan::Use> uses;
    for (const vulkan::Buffer* buffer : {&given_.volumes, &given_.tiles, &given_.entries, &given_.rays, &given_.stops,
                                         &given_.windows, &given_.blocks, &given_.scene})
        uses.push_back(vulkan::reads(*buffer));
    for (const vulkan::Buffer* buffer :
         {&given_.slabs, &given_.hits, &given_.results, &given_.planes, &given_.segments, &given_.marks})
        uses.push_back(vulkan::writes(*buffer));
    for (const VolumeOnDevice& volume : seek == Seek::medium ? media_ : surfaces_) volume.add_uses(uses);
    for (std::uint64_t first = 0; first < blocks.size(); first += groups) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "drawing was cancelled"};
        const std::uint64_t count = std::min<std::uint64_t>(groups, blocks.size() - first);
        vulkan::Recorder recorder(*context_);
        recorder.dispatch(**kernel,
                          layout::VolumePush{address_of(given_.scene), static_cast<std::uint32_t>(first),
                                             static_cast<std::uint32_t>(count)},
                          count, uses);
        if (Result<vulkan::Timings> ran = recorder.run(); !ran) return ran.error();
    }

    std::vector<layout::BlockResult> results(blocks.size());
    if (Result<void> fetched =
            context_->staging().download(given_.results, 0, std::as_writable_bytes(std::span(results)));
        !fetched)
        return fetched.error();
    std::vector<std::uint32_t> full;
    for (std::size_t i = 0; i < results.size(); ++i) {
        if (results[i].full) {
            full.push_back(blocks[i]);
            continue;
        }
        work_.tets += results[i].tets;
        work_.segments += results[i].segments;
    }
    std::uint64_t bytes = given_.bytes();
    for (const std::vector<VolumeOnDevice>* volumes : {&media_, &surfaces_})
        for (const VolumeOnDevice& volume : *volumes) bytes += volume.bytes();
    work_.bytes = std::max(work_.bytes, bytes);
    return full;
}

} // namespace isotet::render
