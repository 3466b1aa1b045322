// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Speeds of a machine: a made grid is packed and extracted from. Each figure is the best of a few runs, since other
// programs can only slow one down. What a surface costs besides its triangles shows at an isovalue that cuts nothing,
// and what a call costs besides, on a small grid.
#include "api/speeds.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>

#include <isotet/device_grid.hpp>
#include <isotet/extract.hpp>
#include <isotet/extract_once.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>

#include "core/block.hpp"

namespace isotet {

namespace {

constexpr std::uint64_t small_side = 8,
                        large_side = 80;              ///< 3,072 and 3,072,000 tets: the larger one beyond most caches
constexpr double cuts_much = 0.25, cuts_nothing = 10; ///< isovalues of the gyroid, which goes from -1.5 to 1.5
constexpr int rounds = 3;

struct Sample {
    Grid grid;
    PointField field;
    double tets = 0;
};

Result<Sample> make_sample(std::uint64_t side, int threads, const Progress& progress) {
    MakeOptions options;
    options.side = side;
    options.fields = {"gyroid"};
    options.threads = threads;
    Result<Grid> grid = make_grid(options, progress);
    if (!grid) return grid.error();
    Sample sample;
    sample.grid = *std::move(grid);
    sample.field = {"gyroid", sample.grid.point_fields.front().values, false, {}};
    sample.tets = static_cast<double>(sample.grid.cells.count());
    return sample;
}

/// Seconds of the fastest of a few runs.
Result<double> best_of(int runs, const Progress& progress, const std::function<Result<void>()>& work) {
    double best = std::numeric_limits<double>::infinity();
    for (int run = 0; run < runs; ++run) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "measuring speeds was cancelled"};
        const auto start = std::chrono::steady_clock::now();
        if (Result<void> done = work(); !done) return done.error();
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

/// The three parts of what a surface costs: c + tets t + triangles f; and what one that cuts much of the large grid
/// costs.
struct Parts {
    double call = 0, tet = 0, triangle = 0;
    double large_surface = 0;
};

/// `seconds(sample, isovalue)` takes the time of a surface, and sets `triangles`.
Result<Parts>
measure_parts(const Sample& small, const Sample& large,
              const std::function<Result<double>(const Sample&, double isovalue, double& triangles)>& seconds) {
    double triangles = 0;
    const Result<double> call = seconds(small, cuts_nothing, triangles);
    if (!call) return call.error();
    const Result<double> empty = seconds(large, cuts_nothing, triangles);
    if (!empty) return empty.error();
    const Result<double> full = seconds(large, cuts_much, triangles);
    if (!full) return full.error();
    return Parts{*call, std::max(0.0, *empty - *call) / large.tets,
                 std::max(0.0, *full - *empty) / std::max(1.0, triangles), *full};
}

} // namespace

Speeds typical_speeds() noexcept {
    return {.pack_call = 1e-3,
            .pack_tet = 120e-9,
            .pack_gradient_tet = 30e-9,
            .brute_call = 4e-5,
            .brute_tet = 2e-9,
            .brute_triangle = 50e-9,
            .brute_gradient_tet = 40e-9,
            .clusters_call = 5e-6,
            .clusters_tet = 0.2e-9,
            .clusters_triangle = 25e-9};
}

namespace api {

Result<Speeds> measure_speeds(std::uint64_t side, int threads, const Progress& progress) {
    const Result<Sample> small = make_sample(small_side, threads, progress),
                         large = make_sample(side, threads, progress);
    if (!small) return small.error();
    if (!large) return large.error();
    PackedGrid packed_small, packed_large;
    const auto pack_into = [&](PackedGrid& packed, const Sample& sample) -> Result<void> {
        packed = {};
        Result<PackedGrid> made = pack(sample.grid, sample.field, {.threads = threads}, progress);
        if (!made) return made.error();
        packed = *std::move(made);
        return {};
    };
    const Result<double> pack_call = best_of(2, progress, [&] { return pack_into(packed_small, *small); });
    if (!pack_call) return pack_call.error();
    const Result<double> packing = best_of(2, progress, [&] { return pack_into(packed_large, *large); });
    if (!packing) return packing.error();

    ExtractOptions options;
    options.threads = threads;
    // Gradients cost passes over the tets; what they cost a triangle is little beside.
    const Result<double> packing_gradients = best_of(1, progress, [&]() -> Result<void> {
        const Result<PackedGrid> made =
            pack(large->grid, large->field, {.gradients = true, .threads = threads}, progress);
        return made ? Result<void>() : made.error();
    });
    if (!packing_gradients) return packing_gradients.error();
    const Result<double> brute_gradients = best_of(2, progress, [&]() -> Result<void> {
        OnceOptions with_gradients{options, Precision::single};
        with_gradients.extract.normals = Normals::gradient;
        const auto once = extract_once(large->grid, large->field, std::span(&cuts_much, 1), with_gradients, progress);
        return once ? Result<void>() : once.error();
    });
    if (!brute_gradients) return brute_gradients.error();
    const Result<Parts> brute =
        measure_parts(*small, *large, [&](const Sample& sample, double isovalue, double& triangles) {
            return best_of(rounds, progress, [&]() -> Result<void> {
                const auto once = extract_once(sample.grid, sample.field, std::span(&isovalue, 1),
                                               {options, Precision::single}, progress);
                if (!once) return once.error();
                triangles = static_cast<double>(once->surfaces.front().surface.triangle_count());
                return {};
            });
        });
    if (!brute) return brute.error();
    const Result<Parts> clusters =
        measure_parts(*small, *large, [&](const Sample& sample, double isovalue, double& triangles) {
            return best_of(rounds, progress, [&]() -> Result<void> {
                const Result<Extraction> one =
                    extract(&sample == &*small ? packed_small : packed_large, isovalue, options, progress);
                if (!one) return one.error();
                triangles = static_cast<double>(one->surface.triangle_count());
                return {};
            });
        });
    if (!clusters) return clusters.error();
    core::drop_kept_blocks(); // what measuring took is not needed for the work to come
    return Speeds{.pack_call = *pack_call,
                  .pack_tet = std::max(0.0, *packing - *pack_call) / large->tets,
                  .pack_gradient_tet = std::max(0.0, *packing_gradients - *packing) / large->tets,
                  .brute_call = brute->call,
                  .brute_tet = brute->tet,
                  .brute_triangle = brute->triangle,
                  .brute_gradient_tet = std::max(0.0, *brute_gradients - brute->large_surface) / large->tets,
                  .clusters_call = clusters->call,
                  .clusters_tet = clusters->tet,
                  .clusters_triangle = clusters->triangle};
}

Result<DeviceSpeeds> measure_speeds(const Device& device, std::uint64_t side, int threads, const Progress& progress) {
    const Result<Sample> small = make_sample(small_side, threads, progress),
                         large = make_sample(side, threads, progress);
    if (!small) return small.error();
    if (!large) return large.error();
    double upload_seconds = 0;
    const Result<Parts> parts =
        measure_parts(*small, *large, [&](const Sample& sample, double isovalue, double& triangles) -> Result<double> {
            const Result<PackedGrid> packed = pack(sample.grid, sample.field, {.threads = threads}, progress);
            if (!packed) return packed.error();
            std::optional<DeviceGrid> grid;
            const Result<double> upload = best_of(2, progress, [&]() -> Result<void> {
                grid.reset();
                Result<DeviceGrid> uploaded = DeviceGrid::upload(device, *packed, {}, {.progress = progress});
                if (!uploaded) return uploaded.error();
                grid = *std::move(uploaded);
                return {};
            });
            if (!upload) return upload;
            upload_seconds = *upload;
            DeviceSurface surface;
            return best_of(rounds, progress, [&]() -> Result<void> {
                if (Result<void> done = grid->extract(isovalue, surface, {}, progress); !done) return done;
                const Result<Extraction> back = grid->download(surface, progress);
                if (!back) return back.error();
                triangles = static_cast<double>(surface.triangle_count());
                return {};
            });
        });
    if (!parts) return parts.error();
    core::drop_kept_blocks();
    return DeviceSpeeds{.upload_tet = upload_seconds / large->tets,
                        .call = parts->call,
                        .tet = parts->tet,
                        .triangle = parts->triangle};
}

} // namespace api

Result<Speeds> measure_speeds(int threads, const Progress& progress) {
    return api::measure_speeds(large_side, threads, progress);
}

Result<DeviceSpeeds> measure_speeds(const Device& device, int threads, const Progress& progress) {
    return api::measure_speeds(device, large_side, threads, progress);
}

} // namespace isotet
