// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "bench_run.hpp"

#include <algorithm>
#include <utility>

#include "stopwatch.hpp"

namespace isotet::cli {

namespace {

/// One isovalue, from the search to the picture.
Result<void> measure_isovalue(Contestant& contestant, BenchBed& bed, double isovalue, const PictureOptions& picture,
                              BenchTimes& times, BenchOutcome& outcome) {
    const Result<DrawnSurface> drawn = contestant.make(bed, isovalue, times, outcome);
    if (!drawn) return drawn.error();
    if (!bed.renderer) return {};
    Scene scene;
    scene.surfaces.push_back(*drawn);
    scene.bounds = bounds_of(*bed.packed);
    const Stopwatch drawing;
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

Result<void> measure_into(BenchRow& row, BenchBed& bed, const std::vector<double>& isovalues, std::uint64_t rounds) {
    const std::unique_ptr<Contestant> contestant = make_contestant(row.pair);
    if (bed.device)
        if (Result<void> packed = bed.pack(); !packed) return packed; // for the bounds of the picture, which all share
    const Result<BenchCosts> costs = contestant->prepare(bed);
    if (!costs) return costs.error();
    row.costs = *costs;
    PictureOptions picture = bench_picture();
    if (bed.packed) picture.camera.fit(bounds_of(*bed.packed), 1);
    std::vector<BenchTimes> means;
    for (std::uint64_t round = 0; round <= rounds;
         ++round) { // the first makes pipelines and takes memory, and does not count
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

Result<BenchRow> measure(const BenchPair& pair, BenchBed& bed, const std::vector<double>& isovalues,
                         std::uint64_t rounds) {
    BenchRow row;
    row.pair = pair;
    const Result<void> done = measure_into(row, bed, isovalues, rounds);
    if (done) return row;
    const ErrorCode code = done.error().code;
    if (code != ErrorCode::out_of_memory && !is_of_device(code)) return done.error();
    row.missing = done.error().message;
    return row;
}

} // namespace isotet::cli
