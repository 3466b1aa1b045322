// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/paper/grid_bench.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <isotet/contour.hpp>

#include "base/guard.hpp"
#include "paper/contestant.hpp"

namespace isotet {

namespace {

/// One isovalue, from the search to the picture.
Result<void> measure_isovalue(measure::Contestant& contestant, measure::Bed& bed, double isovalue,
                              const PictureOptions& picture, BenchTimes& times, BenchOutcome& outcome) {
    const Result<DrawnSurface> drawn = contestant.make(bed, isovalue, times, outcome);
    if (!drawn) return drawn.error();
    if (!bed.renderer) return {};
    Scene scene;
    scene.surfaces.push_back(*drawn);
    scene.bounds = bounds_of(*bed.packed);
    const measure::Stopwatch drawing;
    const Result<Picture> done = bed.renderer->draw(scene, picture, bed.run);
    times.draw = drawing.seconds();
    if (!done) return done.error();
    return {};
}

BenchTimes mean_of(const std::vector<BenchTimes>& all) {
    BenchTimes mean;
    for (const BenchTimes& one : all) {
        mean.search += one.search / static_cast<double>(all.size());
        mean.extract += one.extract / static_cast<double>(all.size());
        mean.draw += one.draw / static_cast<double>(all.size());
    }
    return mean;
}

BenchOutcome mean_of(const std::vector<BenchOutcome>& all) {
    const auto mean = [&](const auto& count_of) -> std::optional<std::uint64_t> {
        std::uint64_t sum = 0;
        for (const BenchOutcome& one : all) {
            const std::optional<std::uint64_t> count = count_of(one);
            if (!count) return {};
            sum += *count;
        }
        return sum / all.size();
    };
    return {mean([](const BenchOutcome& one) { return one.tets_looked_at; }),
            mean([](const BenchOutcome& one) { return one.triangles; }),
            *mean([](const BenchOutcome& one) { return std::optional(one.sent_bytes); })};
}

Result<void> measure_into(BenchRow& row, measure::Bed& bed, std::span<const double> isovalues, std::uint64_t rounds) {
    const std::unique_ptr<measure::Contestant> contestant = measure::make_contestant(row.pair);
    if (bed.device)
        if (Result<void> packed = bed.pack(); !packed) return packed; // for the bounds of the picture, which all share
    const Result<BenchCosts> costs = contestant->prepare(bed);
    if (!costs) return costs.error();
    row.costs = *costs;
    PictureOptions picture = bench_picture();
    if (bed.packed) picture.camera.fit(bounds_of(*bed.packed), 1);
    std::vector<BenchTimes> means;
    for (std::uint64_t round = 0; round <= rounds; ++round) { // the first builds pipelines and does not count
        std::vector<BenchTimes> times(isovalues.size());
        std::vector<BenchOutcome> outcomes(isovalues.size());
        for (std::size_t i = 0; i < isovalues.size(); ++i) {
            if (bed.run.progress.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
            if (Result<void> done = measure_isovalue(*contestant, bed, isovalues[i], picture, times[i], outcomes[i]);
                !done)
                return done;
        }
        if (round > 0) means.push_back(mean_of(times));
        row.outcome = mean_of(outcomes);
    }
    std::ranges::sort(means, {}, &BenchTimes::total);
    row.best = means.front();
    row.median = means[(means.size() - 1) / 2];
    return {};
}

} // namespace

PictureOptions bench_picture() {
    PictureOptions picture;
    picture.width = picture.height = 512;
    picture.samples = 1;
    picture.camera = camera_of(View::iso);
    return picture;
}

struct GridBench::Data : measure::Bed {};

GridBench::GridBench(std::unique_ptr<Data> data) : data_(std::move(data)) {}
GridBench::GridBench(GridBench&&) noexcept = default;
GridBench& GridBench::operator=(GridBench&&) noexcept = default;
GridBench::~GridBench() = default;

Result<GridBench> GridBench::create(Grid grid, PointField field, std::optional<Device> device) {
    return core::guarded("starting to measure", [&]() -> Result<GridBench> {
        const Result<FieldSample> sample = FieldSample::create(grid, field, true);
        if (!sample) return sample.error();
        std::optional<Renderer> renderer;
        if (device) {
            Result<Renderer> created = Renderer::create(*device);
            if (!created) return created.error();
            renderer = *std::move(created);
        }
        return GridBench(std::make_unique<Data>(
            Data{{std::move(grid), std::move(field), std::move(device), std::move(renderer), sample->tets(), {}}}));
    });
}

Result<BenchRow> GridBench::measure(const BenchPair& pair, std::span<const double> isovalues, std::uint64_t rounds,
                                    const Run& run) {
    return core::guarded("measuring", [&]() -> Result<BenchRow> {
        if (isovalues.empty() || rounds == 0)
            return Error{ErrorCode::invalid_argument,
                         fmt::format("{} isovalues and {} rounds were given, but there must be at least one of each",
                                     isovalues.size(), rounds)};
        if (needs_device(pair.method) && !data_->device)
            return Error{ErrorCode::invalid_argument, pair.name() + " needs a device, but none was given"};
        BenchRow row;
        row.pair = pair;
        data_->run = run;
        const Result<void> done = measure_into(row, *data_, isovalues, rounds);
        const auto& packed = data_->packed;
        row.tets = packed ? packed->report().tets : data_->estimated_tets;
        row.dropped_tets = packed ? packed->report().repeated_tets + packed->report().collapsed_tets : 0;
        row.points = data_->grid.points.tuples();
        if (done) return row;
        const ErrorCode code = done.error().code;
        if (code != ErrorCode::out_of_memory && !is_of_device(code)) return done.error();
        row.missing = done.error().message;
        return row;
    });
}

std::string_view name_of(BenchMethod method) noexcept {
    switch (method) {
    case BenchMethod::direct: return "direct";
    case BenchMethod::clusters: return "clusters";
    case BenchMethod::clusters_vulkan: return "clusters_vulkan";
    case BenchMethod::registers: return "registers";
    case BenchMethod::registers_instanced: return "registers_instanced";
    case BenchMethod::textures: return "textures";
    case BenchMethod::mesh: return "mesh";
    }
    return "";
}

std::optional<DrawMethod> draw_method_of(BenchMethod method) noexcept { return parse_draw_method(name_of(method)); }

bool needs_device(BenchMethod method) noexcept {
    return method != BenchMethod::direct && method != BenchMethod::clusters;
}

std::string BenchPair::name() const {
    std::string name(name_of(method));
    if (draw_method_of(method) && index != SearchIndex::none) name += fmt::format(" + {}", name_of(index));
    return name;
}

std::vector<BenchPair> pairs_of(const std::vector<BenchMethod>& methods, const std::vector<SearchIndex>& indexes) {
    std::vector<BenchPair> pairs;
    for (const BenchMethod method : methods) {
        if (!draw_method_of(method)) pairs.push_back({method});
        else
            for (const SearchIndex index : indexes) pairs.push_back({method, index});
    }
    return pairs;
}

} // namespace isotet
