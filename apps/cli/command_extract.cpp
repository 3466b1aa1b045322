// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet extract`: from a grid file to surface files.
#include <algorithm>
#include <filesystem>
#include <span>

#include <fmt/format.h>

#include <isotet/contour.hpp>
#include <isotet/device_grid.hpp>
#include <isotet/levels.hpp>
#include <isotet/pieces.hpp>
#include <isotet/process_memory.hpp>
#include <isotet/write.hpp>
#include <isotet/write_file.hpp>

#include "commands.hpp"
#include "console.hpp"
#include "device_choice.hpp"
#include "extract_plan.hpp"
#include "extract_report.hpp"
#include "number_format.hpp"
#include "stopwatch.hpp"
#include "thread_count.hpp"

namespace isotet::cli {

namespace {

/// One run of the command: what its steps share.
class ExtractRun {
public:
    ExtractRun(const ExtractCommand& command, Console& console) : command_(command), console_(console) {}

    Result<void> run();
    const ExtractNumbers& numbers() const noexcept { return numbers_; }

private:
    Result<void> open();
    Result<void> open_device();
    Result<void> load(std::size_t step);
    Result<Contour> start(ContourInput input);
    Result<void> take_piece_of(ContourInput& input);
    void predict(const ContourInput& input);
    bool goes_into_one_file() const {
        return !plan_.names.none() && !plan_.names.by_value();
    } ///< of a step, all surfaces
    std::size_t isovalues_together(std::size_t isovalues) const;
    Result<void> choose_values(std::size_t step);
    Result<void> extract_step(std::size_t step);
    Result<std::vector<Surface>> extract_pass(std::span<const double> isovalues, std::size_t step);
    Result<void> write(const Surface& surface, SurfaceNumbers& numbers);
    OutputKey key(double isovalue, std::size_t step) const;
    std::string why_empty(double isovalue) const;
    void note_what_the_step_holds();
    void note_what_extracting_found(const SurfaceNumbers& surface);

    const ExtractCommand& command_;
    Console& console_;
    std::optional<GridSource> source_;
    ExtractPlan plan_;
    std::shared_ptr<const Engine> device_; ///< null: the CPU extracts
    std::optional<Contour> contour_;
    Grid grid_;                                    ///< of the step at hand
    Array field_;                                  ///< its values
    std::vector<double> isovalues_;                ///< of the step at hand: levels follow its range
    std::uint64_t first_cell_ = 0;                 ///< of the piece
    std::uint64_t coarse_tets_ = 0;                ///< of the step at hand, with direct extraction
    std::optional<std::uint64_t> resident_before_; ///< with the grid of the first step
    std::vector<CollectionEntry> series_;          ///< files so far
    ExtractNumbers numbers_;
};

/// --engine vulkan needs a device; where the engine is left open and a device is named, the CPU may stand in for it.
Result<void> ExtractRun::open_device() {
    const bool required = command_.engine == EngineChoice::vulkan;
    const bool named = !command_.device.name.empty() || command_.device.memory;
    if (named && (command_.engine == EngineChoice::cpu || command_.engine == EngineChoice::reference))
        return usage_error("a device is asked for, but only --engine vulkan and auto use one");
    const bool wanted = required || (!command_.device.name.empty() && command_.device.name != "none");
    if (!wanted) return {};
    if (command_.method == Method::direct)
        return usage_error("--method direct was asked for, but devices take packed grids only: clusters");
    if (command_.device.name == "none") return usage_error("--engine vulkan needs a device, but --device is none");
    Result<std::optional<Device>> device = isotet::cli::open_device(command_.device, console_);
    if (device) {
        device_ = vulkan_engine(**device);
        numbers_.device = (*device)->info().name;
        return {};
    }
    if (required || !is_of_device(device.error().code)) return device.error();
    console_.note(device.error().message + ": the CPU extracts instead");
    return {};
}

Result<void> ExtractRun::open() {
    const Stopwatch reading;
    if (auto known = check_placeholders(command_.out, {"{value}", "{time}", "{step}"}); !known) return known;
    const bool fixed_name = OutputNames(command_.out).fixed();
    if (auto paths = check_output_paths({command_.grid.file}, {fixed_name ? command_.out : "", command_.common.json});
        !paths)
        return paths;
    if (Result<void> opened = open_device(); !opened) return opened;
    console_.detail("looking at " + command_.grid.file);
    Result<GridSource> source = GridSource::open(command_.grid, console_);
    if (!source) return source.error();
    source_ = *std::move(source);
    if (auto paths = check_output_paths(source_->info().files, {fixed_name ? command_.out : "", command_.common.json});
        !paths)
        return paths;
    Result<ExtractPlan> plan = plan_extract(command_, *source_, console_);
    if (!plan) return plan.error();
    plan_ = *std::move(plan);
    numbers_.grid = command_.grid.file;
    numbers_.format = source_->info().format;
    numbers_.steps = plan_.steps.size();
    numbers_.precision = command_.precision;
    numbers_.threads = thread_count(command_.common.threads);
    numbers_.read_seconds = reading.seconds();
    return {};
}

/// Several isovalues are cheaper in one pass; but each of their surfaces takes memory until it is written. What goes
/// into one file is in memory together anyway.
std::size_t ExtractRun::isovalues_together(std::size_t isovalues) const {
    constexpr std::size_t per_pass = 8;
    return goes_into_one_file() ? isovalues : per_pass;
}

Result<Contour> ExtractRun::start(ContourInput input) {
    ContourOptions& options = plan_.contour;
    const std::size_t isovalues =
        command_.isovalues.empty() ? std::max<std::uint64_t>(command_.levels, 1) : command_.isovalues.size();
    options.surfaces = isovalues * plan_.steps.size();
    if (device_) options.engine = device_;
    options.engine_required = command_.engine == EngineChoice::vulkan;
    numbers_.why = device_          ? "devices take packed grids"
                   : options.method ? "asked for"
                                    : fmt::format("{} surface{}", options.surfaces, options.surfaces == 1 ? "" : "s");
    predict(input);
    numbers_.peak_before = peak_resident_memory().value_or(0);
    if (reset_peak_memory()) resident_before_ = resident_memory();
    return Contour::create(std::move(input), options);
}

/// What all steps are expected to take, from a look at the first.
void ExtractRun::predict(const ContourInput& input) {
    if (device_ || command_.engine == EngineChoice::reference) return;
    const Result<FieldSample> sample = FieldSample::create(input.grid, input.field, command_.split_cells);
    if (!sample) return; // an error that Contour::create() gives, too
    const std::vector<double> levels =
        evenly_spaced_levels(sample->lower(), sample->upper(), std::max<std::uint64_t>(command_.levels, 1));
    const std::vector<double>& isovalues = command_.isovalues.empty() ? levels : command_.isovalues;
    const std::size_t together = isovalues_together(isovalues.size());
    double all = 0;
    Workload work;
    for (std::size_t i = 0; i < isovalues.size(); i += together) {
        double pass = 0;
        for (std::size_t k = i; k < std::min(i + together, isovalues.size()); ++k)
            pass += sample->triangles(isovalues[k]);
        all += pass;
        work.triangles_together = std::max(work.triangles_together, pass);
    }
    work.points = sample->points();
    work.tets = sample->tets();
    work.surfaces = static_cast<double>(isovalues.size() * plan_.steps.size());
    work.gradients = command_.normals == Normals::gradient;
    work.find_range = command_.isovalues.empty();
    work.triangles = all / static_cast<double>(isovalues.size());
    const Method method = command_.method.value_or(method_for(isovalues.size() * plan_.steps.size(), work.gradients));
    numbers_.predicted = estimate(method, work);
}

/// The piece of --piece, and the frame of the whole.
Result<void> ExtractRun::take_piece_of(ContourInput& input) {
    Result<FramedPiece> piece = take_piece(input, *command_.piece, {command_.split_cells}, console_.run());
    if (!piece) return piece.error();
    plan_.contour.frame = piece->frame;
    first_cell_ = piece->first_cell;
    input = std::move(piece->input);
    grid_ = input.grid;
    field_ = input.field.values;
    numbers_.cells = grid_.cells.count();
    return {};
}

/// Reads one step and gives it to the session.
Result<void> ExtractRun::load(std::size_t step) {
    const Stopwatch reading;
    console_.detail(fmt::format("reading step {}", step));
    grid_ = {};
    Result<Grid> grid = source_->read(plan_.read, step, console_);
    if (!grid) return grid.error();
    Result<PointField> field = find_chosen(*grid, plan_.field.name, command_.field, console_);
    if (!field) return field.error();
    Result<StepFields> fields = carried_fields(plan_, *grid, console_.run());
    if (!fields) return fields.error();
    numbers_.read_seconds += reading.seconds();
    numbers_.cells = grid->cells.count();
    numbers_.averaged = field->averaged;
    field_ = field->values;
    grid_ = *std::move(grid);
    coarse_tets_ = 0;
    ContourInput input{grid_, *std::move(field), std::move(fields->point), std::move(fields->cell)};
    if (command_.piece && has_curved_cells(input.grid.cells))
        return usage_error("--piece takes grids without quadratic cells only");
    if (command_.piece)
        if (Result<void> taken = take_piece_of(input); !taken) return taken;
    if (!contour_) {
        Result<Contour> started = start(std::move(input));
        if (!started) return started.error();
        contour_ = *std::move(started);
    } else {
        const Result<ContourUpdate> update = command_.piece
                                                 ? contour_->set(std::move(input), plan_.contour, console_.run())
                                                 : contour_->set(std::move(input), console_.run());
        if (!update) return update.error();
        if (*update != ContourUpdate::grid) console_.detail("the cells are those of the step before: not packed again");
    }
    if (contour_->method() == Method::clusters) {
        console_.detail("packing");
        if (Result<void> ready = contour_->prepare(console_.run()); !ready) return ready;
    }
    if (command_.isovalues.empty()) {
        const Stopwatch looking;
        console_.detail("looking at the field");
        const Result<FieldReport> range = contour_->field(console_.run());
        if (!range) return range.error();
        numbers_.field = *range;
        if (plan_.contour.frame) { // levels are those of the whole grid
            const FieldSurvey& whole = *plan_.contour.frame->find(range->name);
            numbers_.field.lower = whole.lower;
            numbers_.field.upper = whole.upper;
        }
        if (contour_->method() == Method::direct) numbers_.look_seconds += looking.seconds(); // else it is packing
    }
    if (!grid_.point_fields.empty() || !grid_.cell_fields.empty()) grid_.point_fields = grid_.cell_fields = {};
    return choose_values(step);
}

Result<void> ExtractRun::choose_values(std::size_t step) {
    Result<std::vector<double>> isovalues = choose_isovalues(command_, field_, numbers_.field, console_);
    if (!isovalues) return isovalues.error();
    isovalues_ = *std::move(isovalues);
    if (plan_.names.fixed()) return {};
    for (const double isovalue : isovalues_) {
        const std::string name = plan_.names.name(key(isovalue, step));
        std::vector<std::string> others = source_->info().files;
        others.insert(others.end(), {command_.grid.file, command_.common.json, plan_.collection});
        if (auto path = check_output_paths(others, {name}); !path) return path;
        if (!plan_.names.by_value()) break; // all values go into the same file
    }
    return {};
}

/// After the surfaces of a step: what was left out, and what rounding did.
void ExtractRun::note_what_the_step_holds() {
    if (const std::string note = cells_left_out_note(grid_); numbers_.cells_left_out > 0 && !note.empty())
        console_.note(note);
    if (numbers_.field.flushed > 0) {
        console_.note(fmt::format("{} values of '{}' are too small beside the others to be told from 0",
                                  grouped(numbers_.field.flushed), numbers_.field.name));
    }
    std::string where;
    if (numbers_.pack && numbers_.pack->coarse_clusters > 0)
        where = fmt::format("in {} of {} clusters", grouped(numbers_.pack->coarse_clusters),
                            grouped(numbers_.pack->clusters));
    else if (coarse_tets_ > 0) where = fmt::format("in {} active tets", grouped(coarse_tets_));
    if (where.empty()) return;
    console_.note(
        where +
        " rounding to float32 moves points by over a thousandth of the shortest edge; --precision double keeps them");
}

std::string ExtractRun::why_empty(double isovalue) const {
    const FieldReport& field = numbers_.field;
    const std::string value = shortest(isovalue);
    if (!(field.lower <= field.upper))
        return fmt::format("isovalue {} gives no surface: field '{}' has no finite value", value, field.name);
    if (isovalue == field.lower)
        return fmt::format("{} is the smallest value of '{}': nothing is below it, the surface is empty", value,
                           field.name);
    const std::string range =
        fmt::format("the range of '{}', {} to {}", field.name, shortest(field.lower), shortest(field.upper));
    if (isovalue < field.lower || isovalue > field.upper)
        return fmt::format("isovalue {} is outside {}: the surface is empty", value, range);
    return fmt::format("isovalue {} is within {}, but no tet has values on both sides of it: the surface is empty",
                       value, range);
}

OutputKey ExtractRun::key(double isovalue, std::size_t step) const {
    return {isovalue, time_of(source_->info(), step), step, std::max<std::size_t>(source_->info().times.size(), 1)};
}

void ExtractRun::note_what_extracting_found(const SurfaceNumbers& surface) {
    const FieldReport& field = numbers_.field;
    if (surface.triangles == 0) console_.note(why_empty(surface.isovalue));
    if (const std::uint64_t ties = surface.report.false_ties.value_or(0); ties > 0) {
        const bool double_helps = command_.precision == Precision::float32 && !field.unchanged;
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

Result<std::vector<Surface>> ExtractRun::extract_pass(std::span<const double> isovalues, std::size_t step) {
    for (const double isovalue : isovalues) console_.detail("extracting " + shortest(isovalue));
    Result<ContourResult> result = contour_->extract(isovalues, console_.run());
    if (!result) return result.error();
    console_.notes(result->notes);
    const double seconds = result->extract_seconds / static_cast<double>(isovalues.size());
    numbers_.method = result->method;
    numbers_.engine = result->engine;
    numbers_.field = result->field;
    numbers_.cells_left_out = result->cells_left_out;
    numbers_.pack_seconds += result->pack_seconds;
    if (const auto packed = contour_->packed()) numbers_.pack = packed->report();
    coarse_tets_ += result->coarse_tets;
    numbers_.refinement = result->refinement;
    std::vector<Surface> surfaces;
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        Surface& surface = surfaces.emplace_back(std::move(result->surfaces[i].surface));
        if (command_.piece) {
            Result<Surface> numbered = number_as_whole(surface, grid_.point_numbers, first_cell_);
            if (!numbered) return numbered.error();
            surface = *std::move(numbered);
        }
        SurfaceNumbers& numbers = numbers_.surfaces.emplace_back();
        numbers.extract_seconds = seconds;
        if (result->engine == "vulkan") numbers.device = result->work;
        numbers.isovalue = isovalues[i];
        numbers.time = time_of(source_->info(), step);
        numbers.report = result->surfaces[i].report;
        numbers.vertices = surface.vertex_count();
        numbers.triangles = surface.triangle_count();
        const Stopwatch measuring;
        numbers.area = area(surface);
        numbers_.measure_seconds += measuring.seconds();
        if (numbers.triangles == 0 && command_.fail_if_empty)
            return Error{ErrorCode::invalid_data, "--fail-if-empty: " + why_empty(isovalues[i])};
        note_what_extracting_found(numbers);
    }
    return surfaces;
}

Result<void> ExtractRun::write(const Surface& surface, SurfaceNumbers& numbers) {
    const Stopwatch writing;
    console_.detail("writing " + numbers.file);
    std::error_code ignored;
    const bool replaces = surface.triangle_count() == 0 && std::filesystem::exists(numbers.file, ignored);
    const Result<WriteReport> written =
        write_surface(surface, numbers.file, {.compression = command_.compression}, console_.run());
    if (!written) return written.error();
    console_.notes(written->notes);
    if (replaces) console_.note(fmt::format("'{}' was replaced by an empty surface", numbers.file));
    numbers.write_seconds = writing.seconds();
    const double time = numbers.time.value_or(static_cast<double>(series_.size()));
    const auto same_time = std::ranges::count(series_, time, &CollectionEntry::time);
    series_.push_back({time, static_cast<std::size_t>(same_time), numbers.file});
    return {};
}

Result<void> ExtractRun::extract_step(std::size_t step) {
    const bool one_file = goes_into_one_file();
    std::size_t at_once = contour_->engine() == "vulkan" ? 1 : isovalues_together(isovalues_.size());
    std::vector<Surface> joined;
    for (std::span<const double> left = isovalues_; !left.empty();) {
        const std::span<const double> pass = left.first(std::min(at_once, left.size()));
        Result<std::vector<Surface>> surfaces = extract_pass(pass, step);
        if (!surfaces && surfaces.error().code == ErrorCode::out_of_memory && pass.size() > 1 && !one_file) {
            at_once = pass.size() / 2;
            continue;
        }
        if (!surfaces) return surfaces.error();
        left = left.subspan(pass.size());
        const std::size_t first = numbers_.surfaces.size() - pass.size();
        for (std::size_t i = 0; i < pass.size() && !plan_.names.none(); ++i) {
            SurfaceNumbers& numbers = numbers_.surfaces[first + i];
            numbers.file = plan_.names.name(key(pass[i], step));
            if (one_file) joined.push_back(std::move((*surfaces)[i]));
            else if (Result<void> written = write((*surfaces)[i], numbers); !written) return written;
        }
    }
    note_what_the_step_holds();
    if (!one_file) return {};
    return write(joined.size() == 1 ? joined.front() : join(joined, isovalues_), numbers_.surfaces.back());
}

Result<void> ExtractRun::run() {
    if (Result<void> opened = open(); !opened) return opened;
    for (const std::size_t step : plan_.steps) {
        if (console_.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
        if (Result<void> loaded = load(step); !loaded) return loaded;
        if (Result<void> extracted = extract_step(step); !extracted) return extracted;
    }
    if (const auto peak = peak_resident_memory(); peak && resident_before_)
        numbers_.peak_bytes = *peak - std::min(*peak, *resident_before_);
    if (plan_.collection.empty()) return {};
    numbers_.collection = plan_.collection;
    return write_collection(series_, plan_.collection, console_.run());
}

} // namespace

Result<ExitCode> run_extract(const ExtractCommand& command) {
    Console console(command.common);
    ExtractRun run(command, console);
    if (Result<void> done = run.run(); !done) return done.error();
    return finish(console, command.common, extract_table(run.numbers(), command.common.verbose),
                  extract_json(run.numbers()));
}

} // namespace isotet::cli
