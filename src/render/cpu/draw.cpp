// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/render.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include <fmt/core.h>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "render/check_drawing.hpp"
#include "render/cpu/bins.hpp"
#include "render/cpu/draw_tuned.hpp"
#include "render/cpu/tile.hpp"

namespace isotet {

namespace {

using render::Sheet;

constexpr std::uint64_t volume_bytes_per_thread = 3 << 20; ///< of a tile

/// What is opaque before what is translucent.
Result<std::vector<Sheet>> sheets_of(const Scene& scene, const render::Space& space, const render::Screen& screen) {
    std::vector<Sheet> sheets;
    for (const DrawnLines& lines : scene.lines) {
        Result<Sheet> sheet = render::sheet_of(lines, space, screen);
        if (!sheet) return sheet.error();
        sheets.push_back(*std::move(sheet));
    }
    for (const DrawnSurface& surface : scene.surfaces) {
        if (surface.opacity == 0 || (surface.triangles && surface.triangles->triangle_count() == 0)) continue;
        Result<Sheet> sheet = render::sheet_of(surface, space, screen);
        if (!sheet) return sheet.error();
        sheets.push_back(*std::move(sheet));
    }
    std::ranges::stable_sort(sheets, {}, &Sheet::translucent);
    return sheets;
}

/// Refuses a volume that cannot be drawn.
Result<void> check_volume(const DrawnVolume& volume) {
    if (!volume.grid) return invalid_argument("a volume without a grid");
    if (Result<void> right = render::check_scale(volume.scale); !right) return right;
    if (Result<void> right = volume.opacity.check(); !right) return right;
    if (!(volume.opacity_length > 0 && std::isfinite(volume.opacity_length)))
        return invalid_argument(
            fmt::format("the length of the opacity is {}, but it must be positive", volume.opacity_length));
    for (const DrawnIsosurface& one : volume.isosurfaces)
        if (!std::isfinite(one.isovalue))
            return invalid_argument(
                fmt::format("an isosurface of a volume at {}, but it must be finite", one.isovalue));
    return {};
}

/// The volumes of a scene, placed; nothing where there are none, or none with a value.
Result<std::unique_ptr<render::VolumeScene>> volumes_of(const Scene& scene, const render::Space& space,
                                                        const render::Sight& sight, const render::Tiling& tiling,
                                                        const render::VolumeTuning& tuning, const Progress& progress) {
    std::uint64_t bytes = 0;
    if (scene.volumes.size() > render::most_volumes)
        return invalid_argument(fmt::format("a scene with {} volumes, but at most {} are drawn together",
                                            scene.volumes.size(), render::most_volumes));
    Scene known;
    for (const DrawnVolume& volume : scene.volumes) {
        if (Result<void> right = check_volume(volume); !right) return right.error();
        if (!(volume.grid->field().lower <= volume.grid->field().upper)) continue;
        const core::Packed& packed = volume.grid->data();
        bytes +=
            packed.groups() * sizeof(render::TileBox) + packed.clusters() * sizeof(render::PlacedVolume::ClusterPlace);
        known.volumes.push_back(volume);
    }
    if (known.volumes.empty()) return std::unique_ptr<render::VolumeScene>();
    const auto threads = static_cast<std::uint64_t>(core::threads_here());
    if (Result<void> enough = core::require_memory("drawing a volume", bytes + threads * volume_bytes_per_thread);
        !enough)
        return enough.error();
    auto placed = std::make_unique<render::VolumeScene>(known, space, sight, tiling, tuning);
    if (Result<void> found = placed->place(tiling, progress); !found) return found.error();
    return placed;
}

bool is_clipped(const std::vector<render::PlacedVolume>& volumes) {
    return std::ranges::any_of(volumes, [](const render::PlacedVolume& one) { return !one.clips().empty(); });
}

/// Draws all tiles, batch by batch, with rays that something else follows.
/// `draw_tiles`   (first, last): of the batch, up to the stage of `scene`
Result<void> draw_batches(render::TileScene& scene, render::RayFollower& follower, std::size_t tiles,
                          const Progress& progress, const std::function<void(std::size_t, std::size_t)>& draw_tiles) {
    const render::VolumeScene& volumes = *scene.volumes;
    if (Result<void> started = follower.start(volumes, progress); !started) return started;
    render::RayBatch batch;
    scene.batch = &batch;
    for (std::size_t first = 0; first < tiles && !progress.cancelled(); first += render::RayBatch::most_tiles) {
        const std::size_t last = std::min(tiles, first + render::RayBatch::most_tiles);
        batch.start(first, last - first);
        if (volumes.surface_bins) {
            if (is_clipped(volumes.surfaces)) batch.start_windows(volumes.surfaces.size());
            scene.stage = render::TileStage::to_hits;
            draw_tiles(first, last);
            if (Result<void> found = follower.find_hits(batch, progress); !found) return found;
        }
        if (volumes.media_bins) {
            batch.windows.clear();
            if (is_clipped(volumes.media)) batch.start_windows(volumes.media.size());
            scene.stage = render::TileStage::to_media;
            draw_tiles(first, last);
            batch.join_stops();
            if (Result<void> composed = follower.compose(batch, progress); !composed) return composed;
        }
        scene.stage = render::TileStage::whole;
        draw_tiles(first, last);
    }
    return {};
}

} // namespace

Result<Picture> render::draw_with(const Scene& scene, const PictureOptions& options, const VolumeTuning& tuning,
                                  RayFollower* follower, const Progress& progress, VolumeWork& work) {
    if (Result<void> right = render::check_options(options); !right) return right.error();
    const render::Space space(scene.bounds);
    const render::Screen screen{space.look(options.camera, options.width, options.height), options.width,
                                options.height, options.samples};
    const Result<std::vector<Sheet>> sheets = sheets_of(scene, space, screen);
    if (!sheets) return sheets.error();
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "drawing was cancelled"};

    // A tile's samples fit a core's cache.
    const render::Tiling tiling{options.width, options.height, options.samples,
                                options.samples > 3 && scene.volumes.empty() ? 16U : 32U};
    const Result<std::unique_ptr<render::VolumeScene>> volumes =
        volumes_of(scene, space, screen.sight, tiling, tuning, progress);
    if (!volumes) return volumes.error();
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "drawing was cancelled"};
    const render::Bins bins(*sheets, tiling, screen.sight, progress);
    const auto is_lit = [](const Sheet& sheet) { return sheet.lit && !sheet.translucent; };
    std::optional<render::Occlusion> occlusion;
    if (options.occlusion > 0 && std::ranges::any_of(*sheets, is_lit))
        occlusion.emplace(*sheets, bins, tiling, screen, progress);
    render::TileScene shared{*sheets,
                             screen,
                             tiling,
                             render::linear_light(options.background),
                             std::clamp(options.background.opacity, 0.0F, 1.0F),
                             {},
                             volumes->get(),
                             occlusion ? &*occlusion : nullptr,
                             static_cast<float>(options.occlusion)};
    Picture picture{options.width, options.height, {}};
    picture.pixels.resize(std::size_t{options.width} * options.height);
    std::atomic<std::size_t> done = 0;
    std::mutex mutex;
    work = {};
    const auto draw_tiles = [&](std::size_t first, std::size_t last) {
        core::parallel_pieces(last - first, 4, progress, [&](std::size_t begin, std::size_t end) {
            render::Tile tile(shared);
            for (std::size_t i = first + begin; i < first + end && !progress.cancelled(); ++i)
                tile.draw(i, bins.of(i), picture);
            if (shared.stage == render::TileStage::whole)
                progress("draw", static_cast<double>(done += end - begin) / static_cast<double>(tiling.tiles()));
            const VolumeWork part = tile.volume_work();
            const std::lock_guard lock(mutex);
            work.tets += part.tets;
            work.segments += part.segments;
            work.bytes = std::max(work.bytes, part.bytes);
        });
    };
    if (!*volumes) draw_tiles(0, tiling.tiles());
    else if (follower) {
        if (Result<void> drawn = draw_batches(shared, *follower, tiling.tiles(), progress, draw_tiles); !drawn)
            return drawn.error();
        work = follower->work();
    } else if (Result<void> drawn = (*volumes)->for_tiles(tiling.tiles(), progress, draw_tiles); !drawn)
        return drawn.error();
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "drawing was cancelled"};
    if (*volumes) {
        if (!follower) work.bytes *= static_cast<std::uint64_t>(core::threads_here());
        work.bytes += (*volumes)->bytes();
        work.clusters = (*volumes)->clusters();
    }
    return picture;
}

Result<Picture> render::draw_tuned(const Scene& scene, const PictureOptions& options, const VolumeTuning& tuning,
                                   const Run& run, VolumeWork& work) {
    return core::carry_out("drawing", run, [&](const Progress& progress) {
        return draw_with(scene, options, tuning, nullptr, progress, work);
    });
}

Result<Picture> draw(const Scene& scene, const PictureOptions& options, const Run& run, VolumeWork& work) {
    return render::draw_tuned(scene, options, {}, run, work);
}

Result<Picture> draw(const Scene& scene, const PictureOptions& options, const Run& run) {
    VolumeWork work;
    return draw(scene, options, run, work);
}

} // namespace isotet
