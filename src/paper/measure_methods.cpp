// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/paper/measure_methods.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <isotet/fields.hpp>
#include <isotet/jobs/draw_files.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/make.hpp>

#include "jobs/refuse.hpp"

namespace isotet::jobs {

namespace {

constexpr double isovalue_of_paper = 0.25; ///< of the gyroid: near its middle, where the surface is large

class BenchRun {
public:
    BenchRun(const BenchJob& job, Caller& caller) : job_(job), caller_(caller) {}

    Result<void> run();
    BenchNumbers take_numbers() { return std::move(numbers_); }

private:
    Result<void> open_device();
    Result<void> choose_pairs();
    Result<void> choose_isovalues(const Grid& grid, const PointField& field);
    Result<void> run_file();
    Result<void> run_paper();
    Result<void> measure_all(const std::string& name, const Grid& grid, const PointField& field);

    const BenchJob& job_;
    Caller& caller_;
    std::optional<Device> device_;
    std::vector<BenchPair> pairs_;
    BenchNumbers numbers_;
};

/// Without a device that can draw, what needs none is measured; unless a device was asked for.
Result<void> BenchRun::open_device() {
    if (job_.device.name == "none") return {};
    Result<Device> device = open_drawing_device(job_.device, caller_);
    if (device) {
        device_ = *std::move(device);
        numbers_.device = device_->info();
        return {};
    }
    if (!job_.device.name.empty() || !is_of_device(device.error().code)) return device.error();
    caller_.note(
        fmt::format("{}: only what needs no device is measured, and no pictures are drawn", device.error().message));
    return {};
}

Result<void> BenchRun::choose_pairs() {
    std::vector<BenchMethod> methods = job_.methods;
    if (methods.empty())
        for (const BenchMethod method : all_bench_methods)
            if (device_ || !needs_device(method)) methods.push_back(method);
    for (const BenchMethod method : methods)
        if (needs_device(method) && !device_)
            return refusal("`methods` has {}, which needs a device, but there is none", name_of(method));
    const std::vector<SearchIndex> indexes =
        job_.indexes.empty() ? std::vector{SearchIndex::none, SearchIndex::interval_tree} : job_.indexes;
    if (!job_.indexes.empty() &&
        std::ranges::none_of(methods, [](BenchMethod method) { return draw_method_of(method).has_value(); }))
        return refusal("`indexes` was given, but none of the methods takes lists of tets: registers, "
                       "registers_instanced, textures and mesh do");
    pairs_ = pairs_of(methods, indexes);
    return {};
}

Result<void> BenchRun::measure_all(const std::string& name, const Grid& grid, const PointField& field) {
    Result<GridBench> bench = GridBench::create(grid, field, device_);
    if (!bench) return bench.error();
    for (const BenchPair& pair : pairs_) {
        caller_.detail(fmt::format("measuring {}: {}", name, pair.name()));
        Result<BenchRow> row = bench->measure(pair, numbers_.isovalues, job_.rounds, caller_.run());
        if (!row) return row.error();
        row->grid = name;
        numbers_.rows.push_back(*std::move(row));
    }
    return {};
}

Result<void> BenchRun::choose_isovalues(const Grid& grid, const PointField& field) {
    if (job_.isovalues.empty() && job_.shares.empty()) {
        const ValueRange range = typical_range(field.values);
        numbers_.isovalues =
            evenly_spaced_levels(range.lower, range.upper, default_levels, LevelRounding::short_decimals);
        return {};
    }
    const auto found = isovalues_at(grid, field, job_.shares, caller_.run());
    if (!found) return found.error();
    numbers_.isovalues = job_.isovalues;
    numbers_.isovalues.insert(numbers_.isovalues.end(), found->begin(), found->end());
    return {};
}

Result<void> BenchRun::run_file() {
    GridOptions options = job_.grid;
    options.hanging_points = HangingChoice::not_sought; // polyhedra are not measured
    Result<GridSource> source = GridSource::open(options, caller_);
    if (!source) return source.error();
    if (auto paths = check_output_paths(source->info().files, job_.other_outputs); !paths) return paths;
    ChoiceWish wish{Steps::one, job_.field, {}};
    wish.needs_view = false;
    const Result<FirstChoice> choice = choose_first(*source, job_.grid, wish, caller_, caller_.run());
    if (!choice) return choice.error();
    Grid grid;
    const Result<PointField> field = read_field(*source, choice->steps.front(), job_.field, {}, caller_, grid);
    if (!field) return field.error();
    numbers_.field = field->name;
    if (auto chosen = choose_isovalues(grid, *field); !chosen) return chosen;
    if (numbers_.isovalues.empty())
        return Error{ErrorCode::invalid_data,
                     fmt::format("field '{}' has no finite value: there is nothing to contour", field->name)};
    for (double& isovalue : numbers_.isovalues)
        if (isovalue == 0) isovalue = 0; // -0 is called 0
    if (Result<void> done = measure_all(job_.grid.file, grid, *field); !done) return done;
    const auto empty = [](const BenchRow& row) {
        return row.missing.empty() && row.outcome.triangles == std::uint64_t{0};
    };
    if (std::ranges::any_of(numbers_.rows, empty))
        caller_.note("there is no surface: what was measured is how long it takes to find that out");
    return {};
}

/// Sides of regular grids from 100 thousand tets on, the sizes of the figure and beyond, ascending: the last is the
/// largest grid that has no more than `most` tets.
std::vector<std::uint64_t> sides_of_paper(std::uint64_t most) {
    const auto tets = [](std::uint64_t side) { return 6 * side * side * side; };
    auto largest = static_cast<std::uint64_t>(std::lround(std::cbrt(static_cast<double>(most) / 6)));
    while (largest > 1 && tets(largest) > most) --largest;
    std::vector<std::uint64_t> sides;
    for (double decade = 1e5; decade <= static_cast<double>(most); decade *= 10)
        for (const double step : {1.0, 2.0, 4.0, 6.0})
            if (const auto side = static_cast<std::uint64_t>(std::lround(std::cbrt(decade * step / 6))); side < largest)
                sides.push_back(side);
    sides.push_back(largest);
    return sides;
}

Result<void> BenchRun::run_paper() {
    numbers_.field = "gyroid";
    numbers_.isovalues = {isovalue_of_paper};
    for (const std::uint64_t side : sides_of_paper(job_.max_tets)) {
        MakeOptions options;
        options.side = side;
        options.fields = {numbers_.field};
        const Result<Grid> grid = make_grid(options, caller_.run());
        if (!grid) return grid.error();
        const Result<PointField> field = find_field(*grid, numbers_.field);
        if (!field) return field.error();
        if (Result<void> done = measure_all(fmt::format("make:kuhn:{}:gyroid", side), *grid, *field); !done)
            return done;
    }
    return {};
}

Result<void> BenchRun::run() {
    if (job_.paper == !job_.grid.file.empty()) return refusal("isotet bench takes a FILE, or `paper`");
    if (job_.device.name == "none" && job_.device.memory)
        return refusal("`device_memory` is given, but `device` is none");
    if (Result<void> paths = check_output_paths({job_.grid.file}, job_.other_outputs); !paths) return paths;
    numbers_.threads = caller_.threads();
    if (Result<void> opened = open_device(); !opened) return opened;
    if (Result<void> chosen = choose_pairs(); !chosen) return chosen;
    return job_.paper ? run_paper() : run_file();
}

} // namespace

Result<BenchNumbers> measure_methods(const BenchJob& job, Caller& caller) {
    BenchRun run(job, caller);
    if (Result<void> done = run.run(); !done) return done.error();
    return run.take_numbers();
}

} // namespace isotet::jobs
