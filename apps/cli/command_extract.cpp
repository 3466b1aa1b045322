// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet extract`: from a grid file to surface files.
#include <algorithm>
#include <span>

#include <fmt/format.h>

#include <isotet/choose.hpp>
#include <isotet/extract.hpp>
#include <isotet/extract_once.hpp>
#include <isotet/write.hpp>

#include "cells_left_out.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "core/memory.hpp"
#include "extract_plan.hpp"
#include "extract_report.hpp"
#include "extractor.hpp"
#include "number_format.hpp"
#include "output_paths.hpp"
#include "packed_series.hpp"
#include "stopwatch.hpp"
#include "thread_count.hpp"
#include "way_choice.hpp"

namespace isotet::cli {

namespace {

/// One run of the command: what its steps share.
class ExtractRun {
public:
    ExtractRun(const ExtractCommand& command, Console& console)
        : command_(command), console_(console), extractor_(command, console) {}

    Result<void> run();
    const ExtractNumbers& numbers() const noexcept { return numbers_; }

private:
    Result<void> open();
    Result<void> load(std::size_t step);
    Result<void> choose(const Grid& grid);
    bool goes_into_one_file() const {
        return !plan_.names.none() && !plan_.names.by_value();
    } ///< of a step, all surfaces
    std::size_t isovalues_together(std::size_t isovalues) const;
    Result<void> pack(const Grid& grid);
    Result<void> choose_values(std::size_t step);
    Result<void> extract_step(std::size_t step);
    Result<std::vector<Surface>> extract_pass(std::span<const double> isovalues, std::optional<double> time);
    Result<void> write(const Surface& surface, SurfaceNumbers& numbers);
    Result<void> look_at_field();
    Result<std::vector<Extraction>> extract(std::span<const double> isovalues, const ExtractOptions& options);
    void say_what_the_step_holds(const Grid& grid);
    void say_what_rounding_moves();
    void say_what_extracting_found(const SurfaceNumbers& surface);

    const ExtractCommand& command_;
    Console& console_;
    std::optional<GridSource> source_;
    ExtractPlan plan_;
    std::optional<PackedSeries> series_;
    Extractor extractor_;
    Grid grid_; ///< of the step at hand, where nothing is packed
    PointField field_;
    StepFields fields_;
    std::vector<double> isovalues_;                ///< of the step at hand: levels follow its range
    std::uint64_t coarse_tets_ = 0;                ///< of the step at hand, where nothing is packed
    std::optional<std::uint64_t> resident_before_; ///< with the grid of the first step, when its way was chosen
    ExtractNumbers numbers_;
};

Result<void> ExtractRun::open() {
    const Stopwatch reading;
    const OutputNames names(command_.out);
    const bool fixed_name = !names.by_value() && !names.by_time();
    if (Result<void> paths =
            check_output_paths({command_.grid.file}, {fixed_name ? command_.out : "", command_.common.json});
        !paths) {
        return paths;
    }
    if (Result<void> method = check_method(command_, extractor_); !method) return method;
    if (Result<void> opened = extractor_.open(); !opened) return opened;
    console_.detail("looking at " + command_.grid.file);
    Result<GridSource> source = GridSource::open(command_.grid, command_.common, console_);
    if (!source) return source.error();
    source_ = *std::move(source);
    Result<ExtractPlan> plan = plan_extract(command_, *source_, console_);
    if (!plan) return plan.error();
    plan_ = *std::move(plan);
    series_.emplace(plan_.pack, plan_.steps.size());
    numbers_.grid = command_.grid.file;
    numbers_.format = source_->info().format;
    numbers_.precision = command_.precision;
    numbers_.threads = thread_count(command_.common.threads);
    numbers_.read_seconds = reading.seconds();
    return {};
}

/// Reads one step and packs it or keeps it as it is.
Result<void> ExtractRun::load(std::size_t step) {
    const Stopwatch reading;
    console_.detail(fmt::format("reading step {}", step));
    fields_ = {};
    grid_ = {};
    field_ = {};
    Result<Grid> grid = source_->read(plan_.read, step, console_);
    if (!grid) return grid.error();
    const auto prefer = command_.field.cell_field ? FindFieldOptions::Prefer::cell : FindFieldOptions::Prefer::point;
    Result<PointField> field =
        find_field(*grid, plan_.field.name, {.prefer = prefer, .threads = command_.common.threads});
    if (!field) return field.error();
    console_.note(field->note);
    Result<StepFields> fields = carried_fields(plan_, *grid);
    if (!fields) return fields.error();
    fields_ = *std::move(fields);
    field_ = *std::move(field);
    numbers_.read_seconds += reading.seconds();
    numbers_.cells = grid->cells.count();
    numbers_.averaged = field_.averaged;
    if (numbers_.surfaces.empty())
        if (Result<void> chosen = choose(*grid); !chosen) return chosen;
    if (!numbers_.choice.brute()) {
        const Result<void> packed = pack(*grid);
        const bool first = numbers_.surfaces.empty();
        if (!packed && !(first && numbers_.choice.takes_brute_instead(packed.error()))) return packed;
        if (!packed) {
            console_.note(packed.error().message + ": --method brute was taken instead");
            extractor_.close();
            series_.emplace(plan_.pack, plan_.steps.size());
        }
    }
    if (numbers_.choice.brute()) {
        grid_ = *std::move(grid);
        coarse_tets_ = 0;
        if (command_.isovalues.empty())
            if (Result<void> looked = look_at_field(); !looked) return looked;
    }
    return choose_values(step);
}

/// Several isovalues are cheaper in one pass; but each of their surfaces takes memory until it is written. What goes
/// into one file is in memory together anyway.
std::size_t ExtractRun::isovalues_together(std::size_t isovalues) const {
    constexpr std::size_t a_pass = 8;
    return goes_into_one_file() ? isovalues : a_pass;
}

/// How all steps are done, from a look at the first.
Result<void> ExtractRun::choose(const Grid& grid) {
    const Result<FieldSample> sample = FieldSample::take(grid, field_);
    if (!sample) return sample.error();
    const std::vector<double> levels =
        levels_of(sample->lower(), sample->upper(), std::max<std::uint64_t>(command_.levels, 1));
    const std::vector<double>& isovalues = command_.isovalues.empty() ? levels : command_.isovalues;
    const std::size_t together = isovalues_together(isovalues.size());
    double all = 0, most = 0;
    for (std::size_t i = 0; i < isovalues.size(); i += together) {
        double pass = 0;
        for (std::size_t k = i; k < std::min(i + together, isovalues.size()); ++k)
            pass += sample->triangles(isovalues[k]);
        all += pass;
        most = std::max(most, pass);
    }
    const auto count = static_cast<double>(isovalues.size());
    Task task;
    task.points = sample->points();
    task.tets = sample->tets();
    task.surfaces = count * static_cast<double>(plan_.steps.size());
    task.gradients = command_.normals == Normals::gradient;
    task.find_range = command_.isovalues.empty();
    task.triangles = all / count;
    task.triangles_together = most;
    task.memory_free = core::free_memory();
    Result<ChosenWay> choice = choose_way(command_, task, extractor_, console_);
    if (!choice) return choice.error();
    numbers_.choice = *std::move(choice);
    console_.detail(fmt::format("{} ({})", name_of(numbers_.choice.way), numbers_.choice.why));
    numbers_.peak_before = core::peak_resident_memory().value_or(0);
    if (core::forget_peak_memory()) resident_before_ = core::resident_memory();
    return {};
}

/// For isovalues that are chosen by the range of the field.
Result<void> ExtractRun::look_at_field() {
    const Stopwatch looking;
    console_.detail("looking at the field");
    const Result<ExtractedOnce> looked =
        extract_once(grid_, field_, {}, {plan_.extract, command_.precision}, console_.progress());
    if (!looked) return looked.error();
    numbers_.field = looked->field;
    numbers_.look_seconds += looking.seconds();
    return {};
}

/// The grid itself is not needed afterwards; the fields to carry stay.
Result<void> ExtractRun::pack(const Grid& grid) {
    const Stopwatch packing;
    console_.detail("packing");
    const Result<PackedSeries::Work> work = series_->load(grid, field_, extractor_, console_.progress());
    if (!work) return work.error();
    const bool packed_again = *work == PackedSeries::Work::packed;
    if (!packed_again) console_.detail("the cells are those of the step before: not packed again");
    numbers_.pack_seconds += packing.seconds();
    numbers_.pack = series_->packed().report();
    numbers_.field = series_->packed().field();
    numbers_.cells_left_out = numbers_.pack->cells_left_out;
    say_what_the_step_holds(grid);
    say_what_rounding_moves();
    if (packed_again) {
        const Stopwatch uploading;
        if (Result<void> uploaded = extractor_.load(series_->packed()); !uploaded) return uploaded;
        numbers_.upload_seconds += uploading.seconds();
    }
    return {};
}

Result<void> ExtractRun::choose_values(std::size_t step) {
    Result<std::vector<double>> isovalues = choose_isovalues(command_, field_, numbers_.field, console_);
    if (!isovalues) return isovalues.error();
    isovalues_ = *std::move(isovalues);
    if (!plan_.names.by_value() && !plan_.names.by_time()) return {};
    for (const double isovalue : isovalues_) {
        const std::string name = plan_.names.name(isovalue, time_of(source_->info(), step));
        if (Result<void> path = check_output_paths({command_.grid.file, command_.common.json}, {name}); !path)
            return path;
        if (!plan_.names.by_value()) break; // all values go into the same file
    }
    return {};
}

void ExtractRun::say_what_the_step_holds(const Grid& grid) {
    if (numbers_.cells_left_out > 0) console_.note(cells_left_out_note(grid));
    if (numbers_.field.flushed > 0) {
        console_.note(fmt::format("{} values of '{}' are too small beside the others to be told from 0",
                                  grouped(numbers_.field.flushed), numbers_.field.name));
    }
}

void ExtractRun::say_what_rounding_moves() {
    std::string where;
    if (numbers_.pack && numbers_.pack->coarse_clusters > 0)
        where = fmt::format("in {} of {} clusters", grouped(numbers_.pack->coarse_clusters),
                            grouped(numbers_.pack->clusters));
    else if (coarse_tets_ > 0) where = fmt::format("in {} cut tets", grouped(coarse_tets_));
    if (where.empty()) return;
    console_.note(
        where +
        " rounding to float32 moves points by over a thousandth of the shortest edge; --precision double keeps them");
}

void ExtractRun::say_what_extracting_found(const SurfaceNumbers& surface) {
    const FieldReport& field = numbers_.field;
    if (!(field.lower <= field.upper)) {
        console_.note(fmt::format("isovalue {} gives no surface: field '{}' has no finite value",
                                  shortest(surface.isovalue), field.name));
    } else if (surface.triangles == 0) {
        const bool outside = surface.isovalue < field.lower || surface.isovalue > field.upper;
        console_.note(fmt::format("isovalue {} {}: the surface is empty; the range of '{}' is {} to {}",
                                  shortest(surface.isovalue),
                                  outside ? "is outside the range" : "has nothing below it or is cut by no tet",
                                  field.name, shortest(field.lower), shortest(field.upper)));
    }
    if (const std::uint64_t ties = surface.report.false_ties.value_or(0); ties > 0) {
        const bool double_helps = command_.precision == Precision::single && !field.unchanged;
        console_.note(fmt::format("isovalue {}: {} point{} tied (equal to it) only by rounding{}",
                                  shortest(surface.isovalue), grouped(ties), ties == 1 ? " is" : "s are",
                                  double_helps ? "; --precision double keeps them apart" : ""));
    }
    if (surface.report.near_tie) {
        console_.note(fmt::format(
            "no point has the value {}, but points have the nearest one that the type of '{}' can hold; --snap "
            "takes that",
            shortest(surface.isovalue), field.name));
    }
}

Result<std::vector<Extraction>> ExtractRun::extract(std::span<const double> isovalues, const ExtractOptions& options) {
    if (!numbers_.choice.brute()) return extractor_.extract(isovalues, options);
    Result<ExtractedOnce> once =
        extract_once(grid_, field_, isovalues, {options, command_.precision}, console_.progress());
    if (!once) return once.error();
    numbers_.field = once->field;
    numbers_.cells_left_out = once->cells_left_out;
    coarse_tets_ += once->coarse_tets;
    return std::move(once->surfaces);
}

Result<std::vector<Surface>> ExtractRun::extract_pass(std::span<const double> isovalues, std::optional<double> time) {
    ExtractOptions options = plan_.extract;
    options.point_fields = fields_.point;
    options.cell_fields = fields_.cell;
    const Stopwatch extracting;
    for (const double isovalue : isovalues) console_.detail("extracting " + shortest(isovalue));
    Result<std::vector<Extraction>> extractions = extract(isovalues, options);
    if (!extractions) return extractions.error();
    const double seconds = extracting.seconds() / static_cast<double>(isovalues.size());
    numbers_.engine = extractor_.engine_name();
    if (!extractor_.device() && numbers_.choice.way == Way::device_clusters)
        numbers_.choice.way = Way::clusters; // the CPU stood in
    numbers_.engine_text = extractor_.engine_text();
    std::vector<Surface> surfaces;
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        const Surface& surface = surfaces.emplace_back(std::move((*extractions)[i].surface));
        SurfaceNumbers& numbers = numbers_.surfaces.emplace_back();
        numbers.extract_seconds = seconds;
        numbers.device = extractor_.last();
        numbers.isovalue = isovalues[i];
        numbers.time = time;
        numbers.report = (*extractions)[i].report;
        numbers.vertices = surface.vertices();
        numbers.triangles = surface.triangle_count();
        const Stopwatch measuring;
        numbers.area = area(surface);
        numbers_.measure_seconds += measuring.seconds();
        say_what_extracting_found(numbers);
    }
    return surfaces;
}

Result<void> ExtractRun::write(const Surface& surface, SurfaceNumbers& numbers) {
    const Stopwatch writing;
    console_.detail("writing " + numbers.file);
    const Result<WriteReport> written = write_surface(surface, numbers.file, {}, console_.progress());
    if (!written) return written.error();
    console_.notes(written->notes);
    numbers.write_seconds = writing.seconds();
    return {};
}

Result<void> ExtractRun::extract_step(std::size_t step) {
    const std::optional<double> time = time_of(source_->info(), step);
    const bool one_file = goes_into_one_file();
    std::size_t at_once = extractor_.in_one_pass() ? isovalues_together(isovalues_.size()) : 1;
    std::vector<Surface> joined;
    for (std::span<const double> left = isovalues_; !left.empty();) {
        const std::span<const double> pass = left.first(std::min(at_once, left.size()));
        Result<std::vector<Surface>> surfaces = extract_pass(pass, time);
        if (!surfaces && surfaces.error().code == ErrorCode::out_of_memory && pass.size() > 1 && !one_file) {
            at_once = pass.size() / 2;
            continue;
        }
        if (!surfaces) return surfaces.error();
        left = left.subspan(pass.size());
        const std::size_t first = numbers_.surfaces.size() - pass.size();
        for (std::size_t i = 0; i < pass.size() && !plan_.names.none(); ++i) {
            SurfaceNumbers& numbers = numbers_.surfaces[first + i];
            numbers.file = plan_.names.name(pass[i], time);
            if (one_file) joined.push_back(std::move((*surfaces)[i]));
            else if (Result<void> written = write((*surfaces)[i], numbers); !written) return written;
        }
    }
    if (numbers_.choice.brute()) {
        say_what_the_step_holds(grid_);
        say_what_rounding_moves();
    }
    if (!one_file) return {};
    return write(joined.size() == 1 ? joined.front() : join(joined, isovalues_), numbers_.surfaces.back());
}

Result<void> ExtractRun::run() {
    if (Result<void> opened = open(); !opened) return opened;
    for (const std::size_t step : plan_.steps) {
        if (console_.progress().cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
        if (Result<void> loaded = load(step); !loaded) return loaded;
        if (Result<void> extracted = extract_step(step); !extracted) return extracted;
    }
    if (const auto peak = core::peak_resident_memory(); peak && resident_before_)
        numbers_.peak_bytes = *peak - std::min(*peak, *resident_before_);
    return {};
}

} // namespace

Result<ExitCode> run_extract(const ExtractCommand& command) {
    Console console(command.common);
    ExtractRun run(command, console);
    if (Result<void> done = run.run(); !done) return done.error();
    if (Result<void> printed = console.print(extract_table(run.numbers())); !printed) return printed.error();
    Json report = extract_json(run.numbers());
    report["notes"] = json_texts(console.noted());
    if (Result<void> written = write_json(report, command.common.json, console.progress()); !written)
        return written.error();
    return ExitCode::done;
}

} // namespace isotet::cli
