// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/extract_files.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/device.hpp>
#include <isotet/fields.hpp>
#include <isotet/grid_file.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/memory.hpp>
#include <isotet/write.hpp>

#include "base/stopwatch.hpp"
#include "fields/fill_values.hpp"
#include "grid/renumber.hpp"
#include "jobs/extract_notes.hpp"
#include "jobs/extract_plan.hpp"
#include "jobs/pictures/packed_picture.hpp"
#include "jobs/part_table.hpp"
#include "jobs/surface_record.hpp"
#include "jobs/streamed_steps.hpp"
#include "jobs/refuse.hpp"
#include "jobs/vertex_colors.hpp"
#include "jobs/way_out.hpp"

namespace isotet::jobs {

namespace {

/// What the steps of one job share.
class ExtractRun {
public:
    ExtractRun(const ExtractJob& job, Caller& caller) : job_(job), caller_(caller) {}

    Result<void> run();
    ExtractNumbers take_numbers() { return std::move(numbers_); }
    /// What needs less memory.
    std::string way_out() const;
    bool reworks_cells() const;

private:
    Result<void> open();
    Result<void> open_device();
    Result<std::optional<std::uint64_t>> read_grid(std::size_t step);
    std::optional<GridPart> part_in_file(const ReadResult& read, std::size_t step);
    Result<bool> load(std::size_t step);
    Result<void> open_packed();
    Result<bool> load_packed(std::size_t step);
    std::vector<ComponentGroup> carried_of_packed(std::size_t step);
    Result<void> join_vectors(Surface& surface) const;
    void read_ahead(std::size_t step) const;
    Result<void> prepare_and_look(std::size_t step);
    Result<std::optional<std::uint64_t>> read_field_of(std::size_t step, bool& found);
    void note_what_steps_miss();
    Result<Contour> start(ContourInput input);
    Result<void> set(ContourInput input);
    Result<void> take_piece_of(ContourInput& input);
    Result<void> mark_other_pieces(const ContourInput& input);
    bool goes_into_one_file() const {
        return !plan_.names.none() && !plan_.names.by_value();
    } ///< of a step, all surfaces
    std::size_t isovalues_together(std::size_t isovalues) const;
    Result<void> find_shares();
    Result<void> measure_volumes(std::size_t first);
    Result<void> find_fill();
    Result<void> choose_values(std::size_t step);
    Result<void> extract_step(std::size_t step);
    std::vector<Field> field_data_of(const Surface& surface, std::size_t step) const;
    void add_refinement_record(std::vector<Field>& field_data) const;
    Result<void> check_that_some_meet(const ContourResult& result) const;
    Result<std::vector<Surface>> extract_pass(std::span<const double> isovalues, std::size_t step);
    Result<std::vector<Surface>> extract_solid(double isovalue, std::size_t step);
    Result<FieldReport> range_of_field();
    Method method() const { return solids_ ? solids_->method() : contour_->method(); }
    Result<void> find_parts_of(Surface& surface, SurfaceNumbers& numbers);
    Result<void> reduce_triangles(Surface& surface, SurfaceNumbers& numbers);
    Result<void> write(Surface surface, SurfaceNumbers& numbers, std::size_t step);
    OutputKey key(double isovalue, std::size_t step) const;
    std::optional<double> time_at(std::size_t step) const;
    double fraction() const {
        return static_cast<double>(between_) / (static_cast<double>(job_.interpolate) + 1);
    } ///< of the way to the next step
    Result<PackedGrid> packed_grid(const std::string& field, std::size_t step) const;
    bool is_packed_at(const std::string& field, std::size_t step) const;

    ExtractJob job_; ///< with the field that was chosen where none is named
    Caller& caller_;
    std::optional<GridSource> source_;
    std::optional<PackedFile> packed_;      ///< where chunks of it are read in place of a grid
    std::vector<ComponentGroup> vectors_;   ///< that surfaces of it carry, by component
    std::vector<std::string> packed_names_; ///< of the fields that are read from it
    std::uint64_t between_ = 0;             ///< surfaces behind the step at hand, of ExtractJob::interpolate
    ExtractPlan plan_;
    std::shared_ptr<const Engine> device_; ///< null: the CPU extracts
    std::optional<Contour> contour_;
    std::optional<Solids> solids_;                 ///< in its place where solids are made
    Grid grid_;                                    ///< of the step at hand
    std::optional<GridPart> part_;                 ///< where it is one of the file's
    PointField field_;                             ///< that is contoured there
    FillValues fill_;                              ///< of the whole field, where isovalues follow from its range
    std::optional<PointField> averaged_;           ///< ReadResult::field
    StreamedSteps streamed_;                       ///< where not all cells are read
    std::vector<double> share_isovalues_;          ///< of ExtractJob::shares
    SolidChoice solid_;                            ///< of ExtractJob::solid, with the shares of its range
    std::vector<double> isovalues_;                ///< of the step at hand: levels follow its range
    std::uint64_t first_cell_ = 0;                 ///< of the piece
    Array other_pieces_;                           ///< 1 for cells of other pieces, where solids of one are made
    std::uint64_t coarse_tets_ = 0;                ///< of the step at hand, with direct extraction
    std::optional<std::uint64_t> resident_before_; ///< with the grid of the first step
    std::vector<CollectionEntry> series_;          ///< files so far
    std::vector<Surface> animated_;                ///< of the steps that go into one file
    std::vector<std::size_t> skipped_;             ///< steps without the field
    std::set<std::string> not_carried_;            ///< fields that some steps do not have
    ExtractNumbers numbers_;
};

/// `engine` vulkan needs a device; where the engine is left open and a device is named, the CPU may stand in for it.
Result<void> ExtractRun::open_device() {
    const bool required = job_.engine == EngineChoice::vulkan;
    const bool named = !job_.device.name.empty() || job_.device.memory;
    if (named && (job_.engine == EngineChoice::cpu || job_.engine == EngineChoice::reference))
        return refusal("a device is asked for, but only `engine` vulkan and auto use one");
    const bool wanted = required || (!job_.device.name.empty() && job_.device.name != "none");
    if (!wanted) return {};
    if (job_.contour.method == Method::direct)
        return refusal("`method` direct was asked for, but devices take packed grids only: clusters");
    if (job_.device.name == "none") return refusal("`engine` vulkan needs a device, but `device` is none");
    Result<std::optional<Device>> device = jobs::open_device(job_.device, caller_);
    if (device) {
        device_ = vulkan_engine(**device);
        numbers_.device = (*device)->info().name;
        return {};
    }
    if (required || !is_of_device(device.error().code)) return device.error();
    caller_.note(device.error().message + ": the CPU extracts instead");
    return {};
}

Result<void> ExtractRun::open() {
    const core::Stopwatch reading;
    if (auto known = check_placeholders(job_.out, {"{value}", "{time}", "{step}"}); !known) return known;
    const bool fixed_name = OutputNames(job_.out).fixed();
    if (auto paths = check_output_paths({job_.grid.file}, with_others(job_, fixed_name ? job_.out : "")); !paths)
        return paths;
    if (!job_.parts_table.empty())
        if (auto writable = check_writable(job_.parts_table); !writable) return writable;
    if (Result<void> opened = open_device(); !opened) return opened;
    caller_.detail("looking at " + job_.grid.file);
    job_.grid.patches = job_.solid.has_value();
    Result<GridSource> source = GridSource::open(job_.grid, caller_);
    if (!source) return source.error();
    source_ = *std::move(source);
    if (job_.solid) source_->require_beside({"finding the boundary", 9});
    else if (job_.contour.method == Method::clusters && !job_.piece) source_->require_beside({"packing", 38});
    if (auto paths = check_output_paths(source_->info().files, with_others(job_, fixed_name ? job_.out : "")); !paths)
        return paths;
    Result<ExtractPlan> plan = plan_extract(job_, *source_, caller_);
    if (!plan) return plan.error();
    plan_ = *std::move(plan);
    if (Result<void> packed = open_packed(); !packed) return packed;
    numbers_.grid = job_.grid.file;
    numbers_.format = source_->info().format;
    numbers_.steps = plan_.steps.size();
    numbers_.precision = plan_.contour.precision;
    numbers_.threads = caller_.threads();
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
    if (device_) options.engine = device_;
    options.engine_required = job_.engine == EngineChoice::vulkan;
    numbers_.why = packed_          ? "the file is packed"
                   : device_        ? "devices take packed grids"
                   : options.method ? "asked for"
                                    : fmt::format("{} surface{}", options.surfaces, options.surfaces == 1 ? "" : "s");
    numbers_.process_bytes = peak_resident_memory().value_or(0);
    if (reset_peak_memory()) resident_before_ = resident_memory();
    const bool has_cells = !input.packed;
    const bool linear =
        has_cells && !has_cells_to_linearize(input.grid.cells); // else it is not known how many tets they become
    const double kept =
        static_cast<double>(input.grid.cells.count()) / static_cast<double>(std::max<std::size_t>(numbers_.cells, 1));
    Result<Contour> contour = Contour::create(std::move(input), options, caller_.run());
    if (contour && linear && !device_ && job_.engine != EngineChoice::reference)
        if (const Result<FieldSample> sample = contour->sample())
            numbers_.predicted =
                predict(job_, plan_, *sample, kept, isovalues_together(options.surfaces / plan_.steps.size()));
    return contour;
}

/// The piece, and the frame of the whole.
Result<void> ExtractRun::take_piece_of(ContourInput& input) {
    Result<FramedPiece> piece = take_piece(input, *job_.piece, {job_.contour.split_cells}, caller_.run());
    if (!piece) return piece.error();
    plan_.contour.frame = piece->frame;
    first_cell_ = piece->first_cell;
    input = std::move(piece->input);
    grid_ = input.grid;
    field_ = input.field;
    numbers_.cells = grid_.cells.count();
    return {};
}

/// The frame of the whole, and which of its cells are of other pieces.
Result<void> ExtractRun::mark_other_pieces(const ContourInput& input) {
    Result<FramedPiece> piece = take_piece(input, *job_.piece, {job_.contour.split_cells}, caller_.run());
    if (!piece) return piece.error();
    plan_.contour.frame = piece->frame;
    const std::size_t first = piece->first_cell, count = piece->input.grid.cells.count();
    std::vector<std::uint8_t> others(input.grid.cells.count(), 1);
    std::fill_n(others.begin() + static_cast<std::ptrdiff_t>(first), count, std::uint8_t{0});
    other_pieces_ = Array::own(std::move(others));
    return {};
}

std::optional<GridPart> ExtractRun::part_in_file(const ReadResult& read, std::size_t step) {
    const auto read_all = [this, step](const Run& run) {
        caller_.detail(fmt::format("reading all cells of step {}", step));
        return source_->read_the_rest(plan_.read, step, run);
    };
    const auto cell_fields = [this](const Grid& all, const Run& run) {
        Result<StepFields> fields = carried_fields(plan_, all, run);
        return fields ? Result<std::vector<Field>>(std::move(fields->cell)) : fields.error();
    };
    return part_of(read, plan_.contour.normals == Normals::gradient, read_all, cell_fields);
}

/// Reads one step. Returns how many cells there are where only active ones were kept.
Result<std::optional<std::uint64_t>> ExtractRun::read_grid(std::size_t step) {
    if (plan_.active_cells && !device_) {
        Result<ReadResult> read = streamed_.read(*source_, plan_.read, step, *plan_.active_cells, caller_);
        if (!read) return read.error();
        part_ = part_in_file(*read, step);
        grid_ = std::move(read->grid);
        averaged_ = std::move(read->field);
        if (read->cells_in_file) share_isovalues_ = std::move(read->share_isovalues);
        return read->cells_in_file;
    }
    Result<ReadResult> read = source_->read_numbered(plan_.read, step, caller_);
    if (!read) return with_cheaper_plan(read.error(), job_, plan_);
    part_ = part_in_file(*read, step);
    grid_ = std::move(read->grid);
    return std::optional<std::uint64_t>{};
}

/// Gives the step to the session, or starts it.
Result<void> ExtractRun::set(ContourInput input) {
    if (job_.solid) {
        caller_.detail("finding the boundary");
        Result<Solids> started =
            job_.piece ? Solids::create_piece(std::move(input), other_pieces_, plan_.contour, caller_.run())
                       : Solids::create(std::move(input), plan_.contour, caller_.run());
        if (!started) return started.error();
        solids_ = *std::move(started);
        numbers_.why = "solids";
        return {};
    }
    if (!contour_) {
        Result<Contour> started = start(std::move(input));
        if (!started) return started.error();
        contour_ = *std::move(started);
    } else {
        const Result<ContourUpdate> update = job_.piece ? contour_->set(std::move(input), plan_.contour, caller_.run())
                                                        : contour_->set(std::move(input), caller_.run());
        if (!update) return update.error();
        if (*update != ContourUpdate::grid) caller_.detail("the cells are those of the step before: not packed again");
    }
    return {};
}

Result<FieldReport> ExtractRun::range_of_field() {
    return solids_ ? solids_->field(caller_.run()) : contour_->field(caller_.run());
}

/// Reads one step. A field may be of points in one step and of cells in another, or be missing in it. Where it was left out
/// among others, reading it by name tells why.
Result<std::optional<std::uint64_t>> ExtractRun::read_field_of(std::size_t step, bool& found) {
    auto cells_in_file = read_grid(step);
    if (!cells_in_file) return cells_in_file;
    found = has_arrays_of(plan_.field, grid_);
    if (found) return cells_in_file;
    streamed_.forget();
    if (auto looked = source_->look_at_steps({step}, caller_); !looked) return looked.error();
    if (const auto chosen = choose_fields(job_, *source_, plan_); !chosen) {
        if (plan_.steps.size() == 1 || chosen.error().code != ErrorCode::invalid_argument) return chosen.error();
        return cells_in_file;
    }
    cells_in_file = read_grid(step);
    if (!cells_in_file) return cells_in_file;
    found = has_arrays_of(plan_.field, grid_);
    if (found) return cells_in_file;
    const Result<Grid> named = source_->read({plan_.field.point, plan_.field.cell}, step, caller_);
    return named ? cells_in_file : named.error();
}

/// Reads one step and gives it to the session. False: it does not have the field.
Result<bool> ExtractRun::load(std::size_t step) {
    const core::Stopwatch reading;
    caller_.detail(fmt::format("reading step {}", step));
    grid_ = {};
    averaged_.reset();
    share_isovalues_.clear();
    if (plan_.contour.refine) plan_.contour.refine->carried = {};
    bool found = false;
    Result<std::optional<std::uint64_t>> cells_in_file = read_field_of(step, found);
    if (!cells_in_file) return cells_in_file.error();
    if (!found) return false;
    Result<PointField> field = averaged_ ? *averaged_ : find_chosen(grid_, plan_.field.name, job_.field, caller_);
    if (!field) return field.error();
    Result<StepFields> fields = carried_fields(plan_, grid_, caller_.run());
    if (!fields) return fields.error();
    for (const std::string& name : plan_.carried ? plan_.carried->point : std::vector<std::string>())
        if (std::ranges::find(fields->point, name, &Field::name) == fields->point.end()) not_carried_.insert(name);
    for (const std::string& name : plan_.carried ? plan_.carried->cell : std::vector<std::string>())
        if (std::ranges::find(fields->cell, name, &Field::name) == fields->cell.end()) not_carried_.insert(name);
    numbers_.read_seconds += reading.seconds();
    numbers_.cells = static_cast<std::size_t>(cells_in_file->value_or(grid_.cells.count()));
    numbers_.averaged = field->averaged;
    if (field->averaged && plan_.contour.refine && !job_.refine_averaged) {
        plan_.contour.refine.reset();
        if (has_curved_cells(grid_.cells))
            caller_.note(fmt::format("field '{}' is averaged from cells: curved cells are split at their nodes only, "
                                     "which is what its accuracy is worth, unless a tolerance is given",
                                     field->name));
    }
    field_ = *field;
    if (auto shares = find_shares(); !shares) return shares.error();
    if (auto filled = find_fill(); !filled) return filled.error();
    coarse_tets_ = 0;
    ContourInput input{grid_, *std::move(field), std::move(fields->point), std::move(fields->cell), part_};
    if (job_.field.shape && plan_.contour.refine) plan_.contour.refine->carried = input.point_fields;
    if (plan_.active_cells && plan_.active_cells->choose)
        if (auto chosen = plan_.active_cells->choose(input.field)) // else the field has no value, which is told later
            plan_.contour.expected_isovalues = *std::move(chosen);
    if (plan_.active_cells && !job_.shares.empty()) {
        plan_.contour.expected_isovalues = share_isovalues_;
        plan_.contour.expected_isovalues.insert(plan_.contour.expected_isovalues.end(), job_.isovalues.begin(),
                                                job_.isovalues.end());
    }
    if (*cells_in_file)
        caller_.detail(fmt::format("{} of {} cells were kept: the isovalues meet no others", grid_.cells.count(),
                                   **cells_in_file));
    if (job_.piece && has_curved_cells(input.grid.cells))
        return refusal("`piece` takes grids without quadratic cells only");
    if (job_.piece && job_.solid)
        if (Result<void> marked = mark_other_pieces(input); !marked) return marked.error();
    if (job_.piece && !job_.solid)
        if (Result<void> taken = take_piece_of(input); !taken) return taken.error();
    if (Result<void> taken = set(std::move(input)); !taken) return taken.error();
    if (contour_ && contour_->method() == Method::clusters) caller_.detail("packing");
    if (Result<void> ready = prepare_and_look(step); !ready) return ready.error();
    return true;
}

/// What is packed, the range of the field, and the isovalues.
Result<void> ExtractRun::prepare_and_look(std::size_t step) {
    if (contour_ && contour_->method() == Method::clusters)
        if (Result<void> ready = contour_->prepare(caller_.run()); !ready) return ready;
    if (job_.isovalues.empty() && job_.shares.empty()) {
        const core::Stopwatch looking;
        caller_.detail("looking at the field");
        const Result<FieldReport> range = range_of_field();
        if (!range) return range.error();
        numbers_.field = *range;
        if (plan_.contour.frame) { // levels are those of the whole grid
            const FieldSurvey& whole = *plan_.contour.frame->find(range->name);
            numbers_.field.lower = whole.lower;
            numbers_.field.upper = whole.upper;
        }
        if (method() == Method::direct) numbers_.look_seconds += looking.seconds(); // else it is packing
    }
    if (!grid_.point_fields.empty() || !grid_.cell_fields.empty()) grid_.point_fields = grid_.cell_fields = {};
    return choose_values(step);
}

/// Whether a packed grid does not do.
bool ExtractRun::reworks_cells() const {
    return job_.piece || job_.solid || plan_.touched || job_.volumes || !job_.shares.empty() ||
           job_.contour.exact_vertices || job_.contour.split_cells || job_.grid.merge_points ||
           !job_.grid.displace.empty() || !job_.grid.cells.empty() || job_.contour.method == Method::direct ||
           job_.engine == EngineChoice::reference;
}

/// Opens the grid as a packed file, where surfaces as the job asks for them come from its chunks.
Result<void> ExtractRun::open_packed() {
    const auto interpolates_unless = [&](bool refused, const char* why) -> Result<void> {
        if (refused && job_.interpolate > 0) return refusal("`interpolate` is {}, but {}", job_.interpolate, why);
        return {};
    };
    if (auto ok = interpolates_unless(!job_.all_steps, "it goes with `all_steps` only"); !ok) return ok;
    if (!source_->is_packed_file())
        return interpolates_unless(
            true, "only packed files have values between steps: isotet pack IN OUT.isotet --all-steps");
    Result<PackedFile> file = PackedFile::open(job_.grid.file, {job_.memory.value_or(0)}, caller_.run());
    if (!file) return file.error();
    const PackedFileInfo& info = file->info();
    const bool needs_gradients = job_.contour.normals == Normals::gradient;
    const auto has_field = [&](const PackedFieldInfo& field) {
        if (job_.field.shape) return !needs_gradients;
        return field.report.name == plan_.field.name && (!needs_gradients || field.gradients);
    };
    const auto is_packed = [&](const FoundField& component) {
        return std::ranges::any_of(info.fields, [&](const auto& field) { return field.report.name == component.name; });
    };
    const bool has_all = std::ranges::any_of(info.fields, has_field) &&
                         (!job_.contour.source_cells || info.source_cells) &&
                         (!plan_.carried || std::ranges::all_of(plan_.carried->components, is_packed)) && !plan_.color;
    if (reworks_cells() || !has_all) {
        caller_.note(note_of_unpacking(info));
        return interpolates_unless(true, "what else was asked for needs all of the packed file, or is not packed");
    }
    if (auto ok = interpolates_unless(job_.field.shape && !info.moved_points.empty(),
                                      "the points of the file move, and slices are those of a step");
        !ok)
        return ok;
    plan_.contour.precision = info.precision;
    plan_.contour.method.reset();
    packed_ = *std::move(file);
    numbers_.packed_file_bytes = info.file_bytes;
    return {};
}

/// The fields of a step that surfaces carry.
std::vector<ComponentGroup> ExtractRun::carried_of_packed(std::size_t step) {
    if (!plan_.out_holds_fields) return {};
    std::vector<std::string> names;
    for (const PackedFieldInfo& field : packed_->info().fields)
        if (field.step == step && is_packed_at(field.report.name, step)) names.push_back(field.report.name);
    std::vector<ComponentGroup> all = joined_fields(names);
    if (!plan_.carried) return all;
    const auto& wanted = plan_.carried->point;
    for (const std::string& name : wanted)
        if (std::ranges::find(all, name, &ComponentGroup::name) == all.end()) not_carried_.insert(name);
    std::vector<ComponentGroup> carried; // in the order of the file, as those of a grid
    std::ranges::copy_if(all, std::back_inserter(carried), [&](const ComponentGroup& field) {
        return std::ranges::find(wanted, field.name) != wanted.end();
    });
    for (const FoundField& component : plan_.carried->components) {
        if (std::ranges::find(names, component.name) != names.end())
            carried.push_back({component.name, {component.name}});
        else not_carried_.insert(component.name);
    }
    return carried;
}

/// One field of the components of each vector.
Result<void> ExtractRun::join_vectors(Surface& surface) const {
    for (const ComponentGroup& vector : vectors_) {
        Result<Field> whole = gather_components(surface.point_fields, vector.name, vector.parts);
        if (!whole) return whole.error();
        const auto first = std::ranges::find(surface.point_fields, vector.parts.front(), &Field::name);
        *first = *std::move(whole);
        surface.point_fields.erase(first + 1, first + static_cast<std::ptrdiff_t>(vector.parts.size()));
    }
    return {};
}

/// Whether a step has a field, and where surfaces are between steps, the next one.
bool ExtractRun::is_packed_at(const std::string& field, std::size_t step) const {
    const auto has = [&](std::size_t wanted) {
        return std::ranges::any_of(packed_->info().fields, [&](const PackedFieldInfo& one) {
            return one.step == wanted && one.report.name == field;
        });
    };
    return has(step) && (between_ == 0 || has(step + 1));
}

Result<PackedGrid> ExtractRun::packed_grid(const std::string& field, std::size_t step) const {
    return packed_->interpolated(field, step, fraction(), caller_.run());
}

/// Gives a step of a packed file to the session.
Result<bool> ExtractRun::load_packed(std::size_t step) {
    const core::Stopwatch reading;
    const std::string& name = plan_.field.name;
    const auto& fields = packed_->info().fields;
    if (!job_.field.shape && !is_packed_at(name, step)) return false;
    if (job_.field.shape) caller_.detail("looking where the points are");
    Result<PackedGrid> grid =
        job_.field.shape ? packed_->sliced(*job_.field.shape, step, caller_.run()) : packed_grid(name, step);
    if (!grid) return grid.error();
    ContourInput input;
    input.packed = *grid;
    vectors_.clear();
    packed_names_.clear();
    if (!job_.field.shape) packed_names_ = {name};
    for (const ComponentGroup& carried : carried_of_packed(step)) {
        for (const std::string& part : carried.parts) {
            add_names(packed_names_, {part});
            Result<PackedGrid> other = part == name && !job_.field.shape ? grid : packed_grid(part, step);
            if (!other) return other.error();
            input.packed_fields.push_back(*std::move(other));
        }
        if (carried.parts.size() > 1) vectors_.push_back(carried);
    }
    std::vector<std::string> cell_fields;
    if (plan_.carried) cell_fields = plan_.carried->cell;
    else if (job_.field.shape && plan_.out_holds_cell_fields) cell_fields = source_->names(Association::cell);
    for (const std::string& carried : cell_fields) {
        Result<Field> field = packed_->cell_field(carried, step, caller_.run());
        if (field) input.cell_fields.push_back(*std::move(field));
        else if (field.error().code == ErrorCode::invalid_argument) not_carried_.insert(carried);
        else return field.error();
    }
    numbers_.cells = packed_->info().user_cells;
    numbers_.read_seconds += reading.seconds();
    coarse_tets_ = 0;
    const auto info = std::ranges::find_if(
        fields, [&](const PackedFieldInfo& field) { return field.step == step && field.report.name == name; });
    const ScalarType type = job_.field.shape ? ScalarType::float64 : info->type;
    field_ = {name, Array(type, nullptr, 0, 1, nullptr), false, {}};
    if (Result<void> taken = set(std::move(input)); !taken) return taken.error();
    if (Result<void> ready = prepare_and_look(step); !ready) return ready.error();
    return true;
}

/// The isovalues of the shares, of the whole grid.
Result<void> ExtractRun::find_shares() {
    if (job_.solid) {
        solid_ = *job_.solid;
        if (solid_.kind == SolidChoice::Kind::between) {
            const auto range = with_shares(solid_.range, solid_.shares, grid_, field_, caller_.run());
            if (!range) return range.error();
            solid_.range = *range;
        }
    }
    if (job_.shares.empty() || !share_isovalues_.empty()) return {};
    const core::Stopwatch looking;
    caller_.detail("looking for the isovalues of shares");
    Result<std::vector<double>> found = isovalues_at(grid_, field_, job_.shares, caller_.run());
    if (!found) return found.error();
    share_isovalues_ = *std::move(found);
    numbers_.look_seconds += looking.seconds();
    return {};
}

/// Of the surfaces from `first` on, which are those of one step.
Result<void> ExtractRun::measure_volumes(std::size_t first) {
    if (!job_.volumes || numbers_.surfaces.size() == first) return {};
    const core::Stopwatch measuring;
    caller_.detail("measuring volumes");
    std::vector<double> isovalues;
    for (std::size_t i = first; i < numbers_.surfaces.size(); ++i) isovalues.push_back(numbers_.surfaces[i].isovalue);
    std::ranges::sort(isovalues);
    const Result<ContourSpectrum> spectrum = contour_spectrum(grid_, field_, isovalues, caller_.run());
    if (!spectrum) return spectrum.error();
    for (std::size_t i = first; i < numbers_.surfaces.size(); ++i) {
        const auto place = std::ranges::lower_bound(isovalues, numbers_.surfaces[i].isovalue) - isovalues.begin();
        const double below = spectrum->volume_below[static_cast<std::size_t>(place)];
        numbers_.surfaces[i].volumes = SideVolumes{below, spectrum->volume - below};
    }
    numbers_.measure_seconds += measuring.seconds();
    return {};
}

/// Numbers that stand for no value do not count where isovalues are chosen.
Result<void> ExtractRun::find_fill() {
    const bool has_range = job_.solid && job_.solid->kind == SolidChoice::Kind::between;
    if (!job_.isovalues.empty() || !job_.shares.empty() || job_.field.shape || has_range) return {};
    const bool is_told = !fill_.numbers.empty();
    Result<FillValues> found = core::find_fill_values(field_, caller_.run());
    if (!found) return found.error();
    fill_ = *std::move(found);
    if (!is_told) caller_.note(fill_note(field_.name, fill_, fill_is_of(field_)));
    return {};
}

Result<void> ExtractRun::choose_values(std::size_t step) {
    if (job_.solid && job_.solid->kind == SolidChoice::Kind::between) {
        isovalues_ = {solid_.range.lower};
    } else {
        Result<std::vector<double>> isovalues =
            choose_isovalues(job_, share_isovalues_, field_.values, numbers_.field, fill_, caller_);
        if (!isovalues) return isovalues.error();
        isovalues_ = *std::move(isovalues);
    }
    if (plan_.names.fixed()) return {};
    for (const double isovalue : isovalues_) {
        const std::string name = plan_.names.name(key(isovalue, step));
        std::vector<std::string> others = source_->info().files;
        others.insert(others.end(), {job_.grid.file, plan_.collection});
        others.insert(others.end(), job_.other_outputs.begin(), job_.other_outputs.end());
        if (auto path = check_output_paths(others, {name}); !path) return path;
        if (!plan_.names.by_value()) break; // all values go into the same file
    }
    return {};
}

OutputKey ExtractRun::key(double isovalue, std::size_t step) const {
    const std::size_t each = job_.interpolate + 1, steps = std::max<std::size_t>(source_->info().times.size(), 1);
    return {isovalue, time_at(step), step * each + between_, (steps - 1) * each + 1};
}

/// Of what is extracted: at the step, or between it and the next.
std::optional<double> ExtractRun::time_at(std::size_t step) const {
    const std::optional<double> time = time_of(source_->info(), step);
    if (!time || between_ == 0) return time;
    return (1 - fraction()) * *time + fraction() * source_->info().times[step + 1];
}

/// Isovalues that are all outside the range of the field were not meant.
Result<void> ExtractRun::check_that_some_meet(const ContourResult& result) const {
    const bool is_asked = !job_.isovalues.empty() && !job_.allow_empty && !job_.fail_if_empty;
    const auto is_empty = [](const auto& one) { return one.surface.triangle_count() == 0; };
    if (!is_asked || job_.piece || plan_.steps.size() > 1 || !std::ranges::all_of(result.surfaces, is_empty)) return {};
    const std::string why = why_all_are_empty(result.field, isovalues_, job_.decimal_comma);
    if (why.empty()) return {};
    return Error{ErrorCode::invalid_data, why + "; `allow_empty` writes it nevertheless"};
}

Result<std::vector<Surface>> ExtractRun::extract_pass(std::span<const double> isovalues, std::size_t step) {
    for (const double isovalue : isovalues) caller_.detail("extracting " + shortest(isovalue));
    Result<ContourResult> result = contour_->extract(isovalues, caller_.run());
    if (!result) return result.error();
    caller_.notes(result->notes);
    const double seconds = result->extract_seconds / static_cast<double>(isovalues.size());
    numbers_.method = result->method;
    numbers_.engine = result->engine;
    numbers_.field = result->field;
    numbers_.cells_left_out =
        result->cells_left_out - std::min(result->cells_left_out, emptied_cells(grid_, job_.grid, caller_.run()));
    numbers_.pack_seconds += result->pack_seconds;
    if (const auto packed = contour_->packed()) numbers_.pack = packed->report();
    coarse_tets_ += result->coarse_tets;
    numbers_.refinement = result->refinement;
    if (Result<void> met = check_that_some_meet(*result); !met) return met.error();
    std::vector<Surface> surfaces;
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        Surface& surface = surfaces.emplace_back(std::move(result->surfaces[i].surface));
        if (auto joined = join_vectors(surface); !joined) return joined.error();
        if (job_.piece) {
            Result<Surface> numbered = number_as_whole(surface, grid_.point_numbers, first_cell_);
            if (!numbered) return numbered.error();
            surface = *std::move(numbered);
            if (part_) surface.source_cells = core::source_cells_by(surface.source_cells, part_->cell_numbers);
        }
        SurfaceNumbers& numbers = numbers_.surfaces.emplace_back();
        numbers.extract_seconds = seconds;
        if (result->engine == "vulkan") numbers.device = result->work;
        numbers.isovalue = isovalues[i];
        numbers.time = time_at(step);
        numbers.report = result->surfaces[i].report;
        numbers.vertices = surface.vertex_count();
        numbers.triangles = surface.triangle_count();
        const core::Stopwatch measuring;
        numbers.area = area(surface, caller_.run());
        numbers_.measure_seconds += measuring.seconds();
        if (numbers.triangles == 0 && job_.fail_if_empty)
            return Error{ErrorCode::invalid_data, "`fail_if_empty`: " + why_empty(numbers_.field, isovalues[i])};
        note_what_extracting_found(numbers_, numbers, caller_);
        if (auto found = find_parts_of(surface, numbers); !found) return found.error();
        if (auto reduced = reduce_triangles(surface, numbers); !reduced) return reduced.error();
    }
    return surfaces;
}

Result<std::vector<Surface>> ExtractRun::extract_solid(double isovalue, std::size_t step) {
    const SolidRange range = range_for(solid_, isovalue);
    caller_.detail(fmt::format("making the solid from {} to {}", shortest(range.lower), shortest(range.upper)));
    Result<Solid> made = solids_->extract(range, caller_.run());
    if (!made) return made.error();
    caller_.notes(made->contour.notes);
    numbers_.method = made->contour.method;
    numbers_.engine = made->contour.engine;
    numbers_.field = made->contour.field;
    numbers_.cells_left_out = made->contour.cells_left_out -
                              std::min(made->contour.cells_left_out, emptied_cells(grid_, job_.grid, caller_.run()));
    numbers_.pack_seconds += made->contour.pack_seconds;
    coarse_tets_ += made->contour.coarse_tets;
    numbers_.refinement = made->contour.refinement;
    SurfaceNumbers& numbers = numbers_.surfaces.emplace_back();
    numbers.isovalue = isovalue;
    numbers.time = time_at(step);
    numbers.report = made->contour.surfaces[0].report;
    numbers.extract_seconds = made->contour.extract_seconds;
    numbers.vertices = made->surface.vertex_count();
    numbers.triangles = made->surface.triangle_count();
    numbers.area = made->isosurface_area + made->boundary_area;
    numbers.solid = SolidNumbers{range,
                                 made->volume,
                                 solids_->grid_volume(),
                                 made->isosurface_area,
                                 made->boundary_area,
                                 made->open_edges,
                                 made->seam_edges,
                                 made->unfit_edges,
                                 std::move(made->patches)};
    if (numbers.triangles == 0 && job_.fail_if_empty)
        return Error{ErrorCode::invalid_data, "`fail_if_empty`: the solid is empty"};
    const bool may_be_empty = job_.allow_empty || job_.piece || plan_.steps.size() > 1 || isovalues_.size() > 1;
    if (numbers.triangles == 0 && !may_be_empty)
        return Error{ErrorCode::invalid_data,
                     why_solid_is_empty(numbers_.field, range) + "; `allow_empty` writes it nevertheless"};
    note_what_a_solid_is(numbers_, numbers, caller_);
    std::vector<Surface> surfaces;
    surfaces.push_back(std::move(made->surface));
    if (auto found = find_parts_of(surfaces[0], numbers); !found) return found.error();
    if (auto reduced = reduce_triangles(surfaces[0], numbers); !reduced) return reduced.error();
    if (!plan_.holds_fields) surfaces[0].cell_fields.clear(); // "boundary" alone: no note for that
    return surfaces;
}

/// Looks for the connected parts of a surface where the job asks for them, and leaves out those that are not kept.
Result<void> ExtractRun::find_parts_of(Surface& surface, SurfaceNumbers& numbers) {
    if (!job_.keep && job_.parts_table.empty()) return {};
    caller_.detail("finding the parts of the surface");
    Result<SurfaceParts> found = find_parts(surface, caller_.run());
    if (!found) return found.error();
    const Result<std::vector<std::uint64_t>> which = kept_parts(surface, *found, job_.keep, plan_.touched);
    if (!which) return which.error();
    const std::vector<std::uint64_t>& kept = *which;
    if (job_.keep && !job_.keep->numbers.empty() && std::ranges::max(job_.keep->numbers) >= found->parts.size())
        caller_.note(fmt::format("`keep` names part {}, but isovalue {} has {}, counted from 0",
                                 std::ranges::max(job_.keep->numbers), shortest(numbers.isovalue),
                                 found->parts.size()));
    Result<Surface> some = keep_parts(surface, *found, kept, caller_.run());
    if (!some) return some.error();
    surface = *std::move(some);
    if (plan_.touched && plan_.touched->field != "boundary" && !is_carried(plan_, plan_.touched->field))
        std::erase_if(surface.cell_fields, [&](const Field& field) { return field.name == plan_.touched->field; });
    if (!plan_.holds_fields)
        std::erase_if(surface.cell_fields, [](const Field& field) { return field.name == "part"; });
    numbers.vertices = surface.vertex_count();
    numbers.triangles = surface.triangle_count();
    numbers.parts_kept = kept.size();
    if (kept.size() < found->parts.size()) {
        numbers.area = area(surface, caller_.run());
        caller_.note(fmt::format("{} of {} parts are kept", grouped(kept.size()), grouped(found->parts.size())));
        if (numbers.solid) {
            note_cavities(*found, kept, caller_);
            if (auto measured = measure_again(surface, *numbers.solid, caller_.run()); !measured) return measured;
        }
    }
    found->numbers = {};
    numbers.parts = *std::move(found);
    return {};
}

/// Edge ends that are points of refined cells mean something only with what these were refined by.
void ExtractRun::add_refinement_record(std::vector<Field>& field_data) const {
    if (!plan_.contour.refine || !numbers_.refinement.refined || numbers_.refinement.isovalues.empty() ||
        !plan_.contour.refine->carried.empty())
        return;
    RefineOptions options = *plan_.contour.refine;
    options.isovalues = numbers_.refinement.isovalues;
    field_data.push_back(refinement_record(options));
}

/// What the edge ends refer to.
std::vector<Field> ExtractRun::field_data_of(const Surface& surface, std::size_t step) const {
    std::vector<Field> field_data;
    if (surface.edge_ends.empty()) return field_data;
    add_refinement_record(field_data);
    if (source_->info().times.size() > 1) field_data.push_back(time_record({*time_at(step), step}));
    return field_data;
}

/// Leaves out triangles where the job asks for it.
Result<void> ExtractRun::reduce_triangles(Surface& surface, SurfaceNumbers& numbers) {
    if (!job_.reduce || surface.triangle_count() == 0) return {};
    caller_.detail("reducing the surface");
    Result<ReducedSurface> reduced = reduce(surface, *job_.reduce, caller_.run());
    if (!reduced) return reduced.error();
    const Result<SurfaceParts> before = find_parts(surface, caller_.run());
    if (!before) return before.error();
    const Result<SurfaceParts> after = find_parts(reduced->surface, caller_.run());
    if (!after) return after.error();
    if (after->parts.size() < before->parts.size())
        caller_.note(fmt::format("{} of {} connected parts are kept: the others were too small for so few triangles",
                                 after->parts.size(), before->parts.size()));
    caller_.note(fmt::format("{} of {} triangles are kept, which moved the surface by about {:.2g}",
                             grouped(reduced->surface.triangle_count()), grouped(reduced->triangles_before),
                             reduced->error));
    if (!reduced->left_out.empty())
        caller_.note(fmt::format("reduced surfaces have no place for {}: left out", quoted_list(reduced->left_out)));
    surface = std::move(reduced->surface);
    numbers.vertices = surface.vertex_count();
    numbers.triangles = surface.triangle_count();
    numbers.area = area(surface, caller_.run());
    if (numbers.solid) return measure_again(surface, *numbers.solid, caller_.run());
    return {};
}

Result<void> ExtractRun::write(Surface surface, SurfaceNumbers& numbers, std::size_t step) {
    if (!job_.colors.by.empty()) {
        if (auto colored = add_vertex_colors(surface, job_.colors, caller_); !colored) return colored;
    }
    const core::Stopwatch writing;
    caller_.detail("writing " + numbers.file);
    std::error_code ignored;
    const bool replaces = surface.triangle_count() == 0 && std::filesystem::exists(numbers.file, ignored);
    const Result<WriteReport> written =
        write_surface(surface, numbers.file,
                      {.compression = job_.compression, .field_data = field_data_of(surface, step)}, caller_.run());
    if (!written) return written.error();
    caller_.notes(written->notes);
    if (replaces) caller_.note(fmt::format("'{}' was replaced by an empty surface", numbers.file));
    numbers.write_seconds = writing.seconds();
    const double time = numbers.time.value_or(static_cast<double>(series_.size()));
    const auto same_time = std::ranges::count(series_, time, &CollectionEntry::time);
    series_.push_back({time, static_cast<std::size_t>(same_time), numbers.file});
    return {};
}

/// What the next step needs of a packed file, while the surfaces of this one are written.
void ExtractRun::read_ahead(std::size_t step) const {
    if (!packed_ || step > plan_.steps.back()) return;
    for (const std::string& name : packed_names_) packed_->read_ahead(name, step);
}

Result<void> ExtractRun::extract_step(std::size_t step) {
    const bool one_file = goes_into_one_file();
    const std::size_t before = numbers_.surfaces.size();
    std::size_t at_once = solids_ || contour_->engine() == "vulkan" ? 1 : isovalues_together(isovalues_.size());
    std::vector<Surface> joined;
    if (const auto next = std::ranges::upper_bound(plan_.steps, step); next != plan_.steps.end())
        streamed_.read_ahead(*next);
    for (std::span<const double> left = isovalues_; !left.empty();) {
        const std::span<const double> pass = left.first(std::min(at_once, left.size()));
        Result<std::vector<Surface>> surfaces = solids_ ? extract_solid(pass[0], step) : extract_pass(pass, step);
        if (!surfaces && surfaces.error().code == ErrorCode::out_of_memory && pass.size() > 1 && !one_file) {
            at_once = pass.size() / 2;
            continue;
        }
        if (!surfaces) return surfaces.error();
        left = left.subspan(pass.size());
        if (left.empty()) read_ahead(step + 1);
        const std::size_t first = numbers_.surfaces.size() - pass.size();
        for (std::size_t i = 0; i < pass.size() && !plan_.names.none(); ++i) {
            SurfaceNumbers& numbers = numbers_.surfaces[first + i];
            numbers.file = plan_.names.name(key(pass[i], step));
            if (one_file) joined.push_back(std::move((*surfaces)[i]));
            else if (Result<void> written = write((*surfaces)[i], numbers, step); !written) return written;
        }
    }
    note_what_the_step_holds(numbers_, grid_, coarse_tets_, caller_);
    if (auto measured = measure_volumes(before); !measured) return measured;
    if (!one_file) return {};
    Surface surface = joined.size() == 1 ? joined.front() : join(joined, isovalues_);
    if (plan_.steps.size() == 1 || !is_animated(plan_.names))
        return write(std::move(surface), numbers_.surfaces.back(), step);
    const double time = time_at(step).value_or(static_cast<double>(step) + fraction());
    surface.cell_fields.push_back(
        {std::string(animation_field), Array::own(std::vector<double>(surface.triangle_count(), time))});
    animated_.push_back(std::move(surface));
    return {};
}

/// Of steps that do not have all fields.
void ExtractRun::note_what_steps_miss() {
    if (!skipped_.empty()) caller_.note(skipped_note(plan_.field.name, skipped_, plan_.steps.size()));
    if (!not_carried_.empty())
        caller_.note(fmt::format("not every time step has {}: the surfaces of the others lack {}",
                                 quoted_list({not_carried_.begin(), not_carried_.end()}),
                                 not_carried_.size() == 1 ? "it" : "them"));
}

/// Each step, and what is wanted between it and the next.
Result<void> ExtractRun::run() {
    if (Result<void> opened = open(); !opened) return opened;
    for (const std::size_t step : plan_.steps) {
        const std::uint64_t last = step == plan_.steps.back() ? 0 : job_.interpolate;
        for (between_ = 0; between_ <= last; ++between_) {
            if (caller_.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
            const Result<bool> loaded = packed_ ? load_packed(step) : load(step);
            if (!loaded && between_ > 0) break; // the next step tells of itself
            if (!loaded) {
                auto kept = keep_broken(step, loaded.error(), plan_.steps.size(), numbers_.broken_steps);
                if (!kept) return kept;
                break;
            }
            if (!*loaded) {
                if (between_ == 0) skipped_.push_back(step);
                break;
            }
            if (Result<void> extracted = extract_step(step); !extracted) return extracted;
        }
        between_ = 0;
    }
    if (skipped_.size() + numbers_.broken_steps.size() == plan_.steps.size())
        return numbers_.broken_steps.empty() ? source_->no_such_field(plan_.field.name)
                                             : numbers_.broken_steps.front().error;
    note_what_steps_miss();
    if (!animated_.empty())
        if (auto written = write(join(animated_, {}), numbers_.surfaces.back(), plan_.steps.back()); !written)
            return written;
    if (packed_) numbers_.packed_file = packed_->residency();
    if (const auto peak = peak_resident_memory()) {
        if (resident_before_) numbers_.peak_bytes = *peak - std::min(*peak, *resident_before_);
        numbers_.process_bytes = std::max(numbers_.process_bytes, *peak);
    }
    if (!job_.parts_table.empty()) {
        numbers_.parts_table = job_.parts_table;
        if (auto written = write_text(parts_csv(numbers_), job_.parts_table, caller_.run()); !written) return written;
    }
    if (plan_.collection.empty()) return {};
    numbers_.collection = plan_.collection;
    return write_collection(series_, plan_.collection, caller_.run());
}

std::string ExtractRun::way_out() const {
    std::vector<std::string_view> ways;
    if (job_.isovalues.size() > 1)
        ways.push_back(job_.field.shape ? "one surface at a time" : "one isovalue at a time");
    const bool leaves_out = job_.with && std::ranges::all_of(*job_.with, &std::string::empty);
    if (!leaves_out && plan_.out_holds_fields) ways.push_back("a surface without fields (`with` leaves them out)");
    if (job_.snap) ways.push_back("an isovalue as it is (without `snap`)");
    if (!packed_ && !reworks_cells()) ways.push_back("a packed file (isotet pack)");
    if (packed_) ways.push_back("`memory` with a smaller number");
    if (ways.empty()) ways.push_back("a part of the grid (`block`)");
    return fmt::format("{}", fmt::join(ways, ", or "));
}

} // namespace

std::uint64_t ExtractNumbers::transient_peak() const {
    std::uint64_t peak = 0;
    for (const SurfaceNumbers& surface : surfaces) peak = std::max(peak, surface.report.transient_bytes);
    return peak;
}

double ExtractNumbers::work_seconds() const {
    double seconds = pack_seconds + look_seconds;
    for (const SurfaceNumbers& surface : surfaces) seconds += surface.extract_seconds;
    return seconds;
}

Result<ExtractNumbers> extract_files(const ExtractJob& job, Caller& caller) {
    ExtractRun run(job, caller);
    const Result<void> done = core::guarded("extraction", [&] { return run.run(); });
    if (!done) return with_way_out(done.error(), run.way_out());
    return run.take_numbers();
}

} // namespace isotet::jobs
