// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Single steps under Google Benchmark, for whoever makes one of them faster: 1 million tets, all threads. What users
// get is measured by the race; these numbers are published nowhere.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include <isotet/extract.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>

#include "grid/cells.hpp"
#include "numbers/storage.hpp"
#include "packed/build/cell_order.hpp"
#include "cpu/batches.hpp"
#include "cpu/steps.hpp"

namespace isotet::bench {

namespace {

constexpr std::uint64_t side = 55;
constexpr double isovalue = 0.25;
const std::vector<std::string> shapes = {"kuhn", "shuffled", "layer"};

struct Subject {
    Grid grid;
    PointField field;
    PackedGrid packed;
};

/// Made once for each shape.
const Subject& subject(benchmark::State& state) {
    static std::vector<Subject> subjects(shapes.size());
    const auto shape = static_cast<std::size_t>(state.range(0));
    Subject& made = subjects[shape];
    if (made.grid.points.empty()) {
        MakeOptions options;
        options.shape = shapes[shape];
        options.side = side;
        options.fields = {"gyroid"};
        made.grid = make_grid(options).value();
        made.field.name = "gyroid";
        made.field.values = made.grid.point_fields[0].values;
        made.packed = pack(made.grid, made.field).value();
    }
    state.SetLabel(shapes[shape]);
    return made;
}

void count_tets(benchmark::State& state, const Subject& of) {
    state.counters["tets"] =
        benchmark::Counter(static_cast<double>(of.grid.cells.count()), benchmark::Counter::kIsIterationInvariantRate);
}

void sort_tets(benchmark::State& state) {
    const Subject& of = subject(state);
    const auto cells = core::CellReader::open(of.grid).value();
    for (auto _ : state)
        benchmark::DoNotOptimize(
            core::sort_cells<core::RankedTet>(of.grid, cells, core::count_tets(cells), false, {}).value());
    count_tets(state, of);
}

void pack_all(benchmark::State& state) {
    const Subject& of = subject(state);
    for (auto _ : state) benchmark::DoNotOptimize(pack(of.grid, of.field).value());
    count_tets(state, of);
}

void select(benchmark::State& state) {
    const Subject& of = subject(state);
    const core::Packed& packed = of.packed.data();
    const core::StoredIsovalue<float> stored = core::store_isovalue<float>(isovalue, packed.storage);
    for (auto _ : state) benchmark::DoNotOptimize(cpu::select(packed, std::span(&stored, 1)).value());
    count_tets(state, of);
}

void select_and_count(benchmark::State& state) {
    const Subject& of = subject(state);
    const core::Packed& packed = of.packed.data();
    const core::StoredIsovalue<float> stored = core::store_isovalue<float>(isovalue, packed.storage);
    const cpu::Wanted<float> wanted{std::span(&stored, 1)};
    const Progress progress;
    for (auto _ : state) {
        cpu::Selection selection = cpu::select(packed, wanted.isovalues).value();
        cpu::Masks masks(selection);
        cpu::Batches batches({&packed}, selection, progress);
        benchmark::DoNotOptimize(
            cpu::count(packed, wanted, selection, masks, cpu::Keep::records, batches, progress).value());
    }
    count_tets(state, of);
}

void extract_all(benchmark::State& state) {
    const Subject& of = subject(state);
    for (auto _ : state) benchmark::DoNotOptimize(extract(of.packed, isovalue).value());
    count_tets(state, of);
}

/// Eight isovalues; the second argument is how far apart they are, in thousandths.
std::vector<double> eight_isovalues(benchmark::State& state) {
    std::vector<double> isovalues;
    for (int i = 0; i < 8; ++i) isovalues.push_back(isovalue + 1e-3 * i * static_cast<double>(state.range(1)));
    return isovalues;
}

void extract_eight_separately(benchmark::State& state) {
    const Subject& of = subject(state);
    const std::vector<double> isovalues = eight_isovalues(state);
    for (auto _ : state) {
        std::vector<Extraction> all;
        for (const double one : isovalues) all.push_back(extract(of.packed, one).value());
        benchmark::DoNotOptimize(all);
    }
    count_tets(state, of);
}

void extract_eight_in_one_pass(benchmark::State& state) {
    const Subject& of = subject(state);
    const std::vector<double> isovalues = eight_isovalues(state);
    for (auto _ : state) benchmark::DoNotOptimize(extract(of.packed, isovalues).value());
    count_tets(state, of);
}

BENCHMARK(sort_tets)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(pack_all)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(select)->DenseRange(0, 2)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(select_and_count)->DenseRange(0, 2)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(extract_all)->DenseRange(0, 2)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(extract_eight_separately)->ArgsProduct({{0, 1, 2}, {1, 100}})->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(extract_eight_in_one_pass)->ArgsProduct({{0, 1, 2}, {1, 100}})->Unit(benchmark::kMicrosecond)->UseRealTime();

} // namespace

} // namespace isotet::bench

BENCHMARK_MAIN();
