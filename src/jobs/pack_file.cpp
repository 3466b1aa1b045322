// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/pack_file.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/contour.hpp>
#include <isotet/fields.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/memory.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/text.hpp>

#include "base/system/memory.hpp"
#include "base/stopwatch.hpp"
#include "jobs/refuse.hpp"
#include "jobs/way_out.hpp"

namespace isotet::jobs {

namespace {

class PackRun {
public:
    PackRun(PackJob job, Caller& caller) : job_(std::move(job)), caller_(caller) {}

    Result<void> run();
    PackNumbers take_numbers() { return std::move(numbers_); }
    /// What was wrong with scratch files, where that ended the run.
    Error explain(Error error) const;

private:
    Result<void> begin_scratch();
    Result<void> check_memory(std::uint64_t cells, std::uint64_t points) const;
    Result<void> check_scratch(std::uint64_t cells) const;
    Result<void> open();
    Result<void> look_at_file();
    Result<void> choose_step_or_all();
    Result<void> choose_names();
    Result<void> keep_steps_with_fields();
    std::optional<std::size_t> step_without(const std::string& field) const;
    std::string why_left_out(const FieldInfo& field) const;
    Result<void> take_all_fields();
    Result<void> choose_cell_fields();
    Result<void> leave_out_fields_that_lack(const Grid& grid);
    Result<void> write_cell_fields(const Grid& grid, std::size_t step);
    std::vector<std::string> packed_names(const std::string& name) const;
    Result<void> pack_step(std::size_t step);
    Result<PackedGrid> packed_with(const Grid& grid, PointField field, std::size_t step);
    Result<std::optional<PackedGrid>> packed_as_in_file(const Grid& grid, const PointField& field, std::size_t step);
    Result<void> write(const PackedGrid& packed, std::size_t step, bool first_field);
    FieldChoice choice(const std::string& name) const { return {name, job_.cell_field, false, {}}; }

    PackJob job_;
    Caller& caller_;
    std::optional<ScratchMemory> scratch_; ///< outlives the arrays
    std::optional<GridSource> source_;
    std::vector<std::size_t> steps_;
    std::vector<std::string> names_; ///< of fields
    std::optional<Contour> contour_; ///< which knows what must be packed again
    std::optional<PackedWriter> writer_;
    std::vector<std::string> written_cell_fields_; ///< of a step so far
    PackNumbers numbers_;
};

/// What packing takes beside arrays, and a few megabytes of each of them.
std::uint64_t least_memory(std::uint64_t cells, std::uint64_t points) { return 80'000'000 + 4 * cells + 18 * points; }

Result<void> PackRun::check_memory(std::uint64_t cells, std::uint64_t points) const {
    if (!scratch_) return {};
    const std::uint64_t least = least_memory(cells, points);
    if (*job_.memory >= least) return {};
    return Error{ErrorCode::out_of_memory, fmt::format("packing needs at least {} of memory, but `memory` is {}",
                                                       format_bytes(least), format_bytes(*job_.memory))};
}

/// Before anything is read: what a grid of tets takes at least.
Result<void> PackRun::check_scratch(std::uint64_t cells) const {
    constexpr std::uint64_t bytes_a_cell = 36;
    if (!scratch_ || bytes_a_cell * cells <= *job_.memory) return {};
    return scratch_->require("packing", bytes_a_cell * cells - *job_.memory);
}

Result<void> PackRun::begin_scratch() {
    if (!job_.memory && job_.scratch.empty()) return {};
    if (!job_.memory) job_.memory = core::free_memory() / 2;
    if (job_.scratch.empty()) job_.scratch = std::filesystem::path(job_.out).parent_path().string();
    if (job_.scratch.empty()) job_.scratch = ".";
    Result<ScratchMemory> begun = ScratchMemory::begin({job_.scratch, *job_.memory});
    if (!begun) return begun.error();
    scratch_ = *std::move(begun);
    return {};
}

Error PackRun::explain(Error error) const {
    if (!scratch_) return with_way_out(std::move(error), "`scratch`, a folder with room for files,");
    if (error.code != ErrorCode::out_of_memory) return error;
    return scratch_->failure().value_or(std::move(error));
}

Result<void> PackRun::open() {
    if (ending_of(job_.out) != ".isotet")
        return refusal("OUT, '{}', is a packed file, so its name must end in .isotet", job_.out);
    constexpr int most_value_bits = 24;
    if (job_.value_bits && (*job_.value_bits < 1 || *job_.value_bits > most_value_bits))
        return refusal("`value_bits` is {}, but it must be from 1 to {}", *job_.value_bits, most_value_bits);
    std::vector<std::string> outputs{job_.out};
    outputs.insert(outputs.end(), job_.other_outputs.begin(), job_.other_outputs.end());
    if (auto paths = check_output_paths({job_.grid.file}, outputs); !paths) return paths;
    if (auto begun = begin_scratch(); !begun) return begun;
    Result<GridSource> source = GridSource::open(job_.grid, caller_);
    if (!source) return source.error();
    source_ = *std::move(source);
    constexpr std::uint64_t packing_a_point = 38;
    if (!scratch_) source_->require_beside({"packing", packing_a_point});
    if (auto enough = check_memory(source_->info().cells, 0); !enough) return enough;
    if (auto enough = check_scratch(source_->info().cells); !enough) return enough;
    if (auto paths = check_output_paths(source_->info().files, outputs); !paths) return paths;
    numbers_.grid = job_.grid.file;
    numbers_.format = source_->info().format;
    if (job_.append)
        if (auto looked = look_at_file(); !looked) return looked;
    if (auto chosen = choose_step_or_all(); !chosen) return chosen;
    return choose_names();
}

/// One step as all commands choose it, or all.
Result<void> PackRun::choose_step_or_all() {
    ChoiceWish wish{job_.all_steps ? Steps::all : Steps::one, {}, job_.cell_fields};
    const bool names_one = job_.fields.size() == 1 && job_.fields.front().find(',') == std::string::npos;
    if (names_one) wish.field = choice(job_.fields.front());
    else wish.others.insert(wish.others.end(), job_.fields.begin(), job_.fields.end());
    wish.needs_view = false;
    const auto chosen = choose_first(*source_, job_.grid, wish, caller_, caller_.run());
    if (!chosen) return chosen.error();
    steps_ = chosen->steps;
    if (!job_.all_steps) {
        job_.grid.time.reset();
        job_.grid.step = steps_.front();
    }
    return {};
}

/// Of the file to which steps are added.
Result<void> PackRun::look_at_file() {
    const Result<PackedFile> file = PackedFile::open(job_.out, {}, caller_.run());
    if (!file) return file.error();
    const PackedFileInfo& info = file->info();
    job_.pack.precision = info.precision;
    job_.pack.source_cells = info.source_cells;
    job_.pack.gradients = info.fields.back().gradients;
    for (const PackedCellFieldInfo& field : info.cell_fields)
        for (auto* const names : {&job_.cell_fields, &written_cell_fields_}) add_names(*names, {field.name});
    if (!job_.fields.empty()) return {};
    for (const PackedFieldInfo& field : info.fields)
        if (field.step + 1 == info.steps) job_.fields.push_back(field.report.name);
    return {};
}

/// What a field is packed as: a vector as its components and its magnitude.
std::vector<std::string> PackRun::packed_names(const std::string& name) const {
    const bool is_vector =
        !job_.cell_field && !job_.scalars_only &&
        std::ranges::any_of(source_->info().fields, [&](const FieldInfo& field) {
            return field.name == name && field.association == Association::point && field.components == 3;
        });
    return is_vector ? packed_names_of_vector(name) : std::vector<std::string>{name};
}

/// The first of the steps that lacks a field.
std::optional<std::size_t> PackRun::step_without(const std::string& field) const {
    const auto found = std::ranges::find_if(steps_, [&](std::size_t step) { return !source_->has_field(step, field); });
    return found == steps_.end() ? std::nullopt : std::optional(*found);
}

std::string PackRun::why_left_out(const FieldInfo& field) const {
    if (field.association != Association::point) return "of cells";
    if (const auto step = step_without(field.name))
        return fmt::format("not in step {}: `fields` takes it, without such steps", *step);
    return fmt::format("{} components", field.components);
}

/// Takes all point fields that can be packed and that all steps have, or else the one that is shown first; the others are
/// named.
Result<void> PackRun::take_all_fields() {
    std::vector<FieldInfo> others;
    for (const FieldInfo& field : source_->info().fields) {
        const bool of_points = field.association == Association::point;
        if (of_points && !step_without(field.name) &&
            (field.components == 1 || (field.components == 3 && !job_.scalars_only)))
            add_names(names_, packed_names(field.name));
        else if (std::ranges::find(job_.cell_fields, field.name) == job_.cell_fields.end() || of_points)
            others.push_back(field);
    }
    if (names_.empty()) {
        const auto first =
            choose_first(*source_, job_.grid, {Steps::one, {}, {}, {}, true, true}, caller_, caller_.run());
        if (!first) return first.error();
        if (first->view.field.empty() && !job_.coordinates_do)
            return refusal("the grid has no field to pack with; `fields` x packs a coordinate");
        names_ = {first->view.field.empty() ? "x" : first->view.field};
        caller_.note(first->view.field.empty() ? "the grid has no field to show: the coordinate x is shown"
                                               : note_of_field(first->view));
        std::erase_if(others, [&](const FieldInfo& field) { return field.name == names_.front(); });
    }
    std::vector<std::string> left_out;
    for (const FieldInfo& field : others) left_out.push_back(fmt::format("'{}' ({})", field.name, why_left_out(field)));
    if (!left_out.empty() && !job_.scalars_only)
        caller_.note(fmt::format("not packed: {}; `fields` takes components, `cell_fields` fields of cells",
                                 fmt::join(left_out, ", ")));
    return {};
}

/// Names in lists separated by commas, or names with commas.
Result<void> PackRun::choose_cell_fields() {
    if (job_.cell_fields.empty()) return {};
    auto named = choose_field_names(*source_, std::exchange(job_.cell_fields, {}), {{}, true, false, {}});
    if (!named) return named.error();
    const std::vector<std::string> known = source_->names(Association::cell);
    for (const std::string& name : *named) {
        if (std::ranges::find(known, name) == known.end())
            return refusal("`cell_fields` got '{}', but whole cell fields are packed: {}", name, quoted_list(known));
        add_names(job_.cell_fields, {name});
    }
    job_.pack.source_cells = true;
    return {};
}

Result<void> PackRun::keep_steps_with_fields() {
    auto kept = steps_with_fields(*source_, std::move(steps_), names_, caller_);
    if (!kept) return kept.error();
    steps_ = *std::move(kept);
    return {};
}

Result<void> PackRun::choose_names() {
    if (auto looked = source_->look_at_steps(steps_, caller_); !looked) return looked;
    if (auto chosen = choose_cell_fields(); !chosen) return chosen;
    auto named = choose_field_names(*source_, job_.fields, choice({}));
    if (!named) return named.error();
    for (const std::string& name : *named) add_names(names_, packed_names(name));
    if (names_.empty())
        if (auto taken = take_all_fields(); !taken) return taken;
    if (auto kept = keep_steps_with_fields(); !kept) return kept;
    numbers_.steps = steps_.size();
    return {};
}

/// The step as the session has it: packed once, with another field where only that is new.
Result<PackedGrid> PackRun::packed_with(const Grid& grid, PointField field, std::size_t step) {
    ContourOptions options;
    options.method = Method::clusters;
    options.precision = job_.pack.precision;
    options.source_cells = job_.pack.source_cells;
    options.split_cells = job_.pack.split_cells;
    options.normals = job_.pack.gradients ? Normals::gradient : Normals::none;
    ContourInput input{grid, std::move(field), {}, {}};
    if (!contour_) {
        Result<Contour> started = Contour::create(std::move(input), options, caller_.run());
        if (!started) return started.error();
        contour_ = *std::move(started);
        if (const auto linear = contour_->linear_grid()) numbers_.curved_cells = linear->refinement.curved_cells;
        if (contour_->linear_grid() && job_.pack.source_cells)
            return refusal(
                "`source_cells` of polyhedra and quadratic cells are not kept in packed files: these cells are "
                "split first");
    } else {
        const Result<ContourUpdate> update = contour_->set(std::move(input), caller_.run());
        if (!update) return update.error();
        if (*update > ContourUpdate::points)
            return Error{
                ErrorCode::invalid_data,
                fmt::format("step {} has other cells than step {}, but a packed file has one grid for all steps: "
                            "pack it into a file of its own",
                            step, steps_.front())};
    }
    if (auto ready = contour_->prepare(caller_.run()); !ready) {
        if (step == steps_.front() || ready.error().code != ErrorCode::invalid_data) return ready.error();
        return Error{ErrorCode::invalid_data, fmt::format("step {}: {}", step, ready.error().message)};
    }
    const std::optional<PackedGrid> packed = contour_->packed();
    if (!packed) return Error{ErrorCode::internal, "the session packed nothing"};
    return *packed;
}

/// To whole multiples of a power of two.
/// Returns   the largest change
Result<double> round_values(PointField& field, int bits, const Run& run) {
    const auto statistics = statistics_of(field.values, run);
    if (!statistics) return statistics.error();
    if (statistics->empty() || !(statistics->front().lower < statistics->front().upper)) return 0.0;
    const double range = statistics->front().upper - statistics->front().lower;
    const double unit = std::exp2(std::ceil(std::log2(range)) - bits);
    if (!(unit > 0 && std::isfinite(unit))) return 0.0;
    const auto round = [&]<class Real>(Real) { // float64 may have an offset, which packing takes off
        std::vector<Real> rounded(field.values.size());
        double change = 0;
        field.values.visit([&](auto values) {
            for (std::size_t i = 0; i < rounded.size(); ++i) {
                const auto value = static_cast<double>(values[i]);
                const double nearest = std::nearbyint(value / unit) * unit;
                rounded[i] = static_cast<Real>(std::isfinite(nearest) ? nearest : value);
                if (std::isfinite(nearest))
                    change = std::max(change, std::abs(static_cast<double>(rounded[i]) - value));
            }
        });
        field.values = Array::own(std::move(rounded));
        return change;
    };
    return field.values.type() == ScalarType::float32 ? round(float{}) : round(double{});
}

/// The grid of a step that is added, packed with the first points of the file, and moved then: other points would be packed in
/// another order. Nothing where the file has another number of points.
Result<std::optional<PackedGrid>> PackRun::packed_as_in_file(const Grid& grid, const PointField& field,
                                                             std::size_t step) {
    const Result<PackedFile> file = PackedFile::open(job_.out, {}, caller_.run());
    if (!file) return file.error();
    const Result<PackedGrid> first = file->grid(file->info().fields.front().report.name, 0, caller_.run());
    if (!first) return first.error();
    Result<UnpackedSample> sample = unpack_sample(*first, 1, caller_.run());
    if (!sample) return sample.error();
    if (sample->grid.points.tuples() != grid.points.tuples()) return std::optional<PackedGrid>();
    Grid still = grid;
    still.points = std::move(sample->grid.points);
    contour_.reset();
    if (auto packed = packed_with(still, field, step); !packed) return packed.error();
    Result<PackedGrid> moved = packed_with(grid, field, step);
    if (!moved) return moved.error();
    return std::optional(*std::move(moved));
}

Result<void> PackRun::write(const PackedGrid& packed, std::size_t step, bool first_field) {
    const core::Stopwatch writing;
    const std::optional<double> time = time_of(source_->info(), step);
    Result<void> written;
    if (!writer_) {
        SavePackedOptions options;
        options.time = time;
        Result<PackedWriter> writer = job_.append ? PackedWriter::append(packed, job_.out, time, caller_.run())
                                                  : PackedWriter::create(packed, job_.out, options, caller_.run());
        if (!writer) return writer.error();
        writer_ = *std::move(writer);
    } else {
        written = first_field ? writer_->add_step(packed, time) : writer_->add_field(packed);
    }
    numbers_.write_seconds += writing.seconds();
    return written;
}

Result<void> PackRun::write_cell_fields(const Grid& grid, std::size_t step) {
    const core::Stopwatch writing;
    for (const std::string& name : job_.cell_fields) {
        const auto field = std::ranges::find(grid.cell_fields, name, &Field::name);
        const bool is_there = std::ranges::find(written_cell_fields_, name) != written_cell_fields_.end();
        if (field == grid.cell_fields.end()) {
            if (is_there)
                caller_.note(fmt::format("step {} lacks cell field '{}': in the file it has that of the step before",
                                         step, name));
            continue;
        }
        if (auto written = writer_->add_cell_field(*field); !written) return written;
        if (!is_there) written_cell_fields_.push_back(name);
    }
    numbers_.write_seconds += writing.seconds();
    return {};
}

/// Where no field was named: those of other blocks or meshes, and those that could not be read.
Result<void> PackRun::leave_out_fields_that_lack(const Grid& grid) {
    std::vector<std::string> known{"x", "y", "z"}, left_out;
    for (const auto* fields : {&grid.point_fields, &grid.cell_fields})
        for (const Field& field : *fields) known.push_back(field.name);
    std::erase_if(names_, [&](const std::string& name) {
        const bool is_there = match_field_name(name, known).has_value();
        if (!is_there) left_out.push_back(name);
        return !is_there;
    });
    const bool has_blocks = !job_.grid.blocks.empty();
    if (names_.empty())
        return refusal("no field of the file is in the {}",
                       has_blocks ? "blocks that were chosen" : "grid that was read");
    if (!left_out.empty())
        caller_.note(fmt::format("not packed: {}, which {}", quoted_list(left_out),
                                 has_blocks ? "other blocks have" : "the grid that was read lacks"));
    return {};
}

Result<void> PackRun::pack_step(std::size_t step) {
    const core::Stopwatch reading;
    caller_.detail(fmt::format("reading step {}", step));
    FieldsToRead read{std::vector<std::string>(), std::vector<std::string>()};
    for (const std::string& name : names_) {
        Result<FoundField> found = choose_field(*source_, choice(name));
        if (!found) return found.error();
        add_names(*read.point, found->point);
        add_names(*read.cell, found->cell);
    }
    add_names(*read.cell, job_.cell_fields);
    const bool may_lack = job_.fields.empty() && !writer_;
    Result<Grid> grid = source_->read(read, step, caller_);
    const auto failed_by = [&](ErrorCode code) { return !grid && grid.error().code == code; };
    if (may_lack && (failed_by(ErrorCode::invalid_data) || failed_by(ErrorCode::invalid_argument))) {
        read.point.reset(); // of all fields those that are broken are left out, and noted
        grid = source_->read(read, step, caller_);
    }
    if (!grid) return grid.error();
    if (may_lack)
        if (auto left = leave_out_fields_that_lack(*grid); !left) return left;
    numbers_.cells = grid->cells.count();
    if (auto enough = check_memory(numbers_.cells, grid->points.tuples()); !enough) return enough;
    numbers_.read_seconds += reading.seconds();
    numbers_.fields.clear();
    for (const std::string& name : names_) {
        const core::Stopwatch packing;
        caller_.detail("packing " + name);
        Result<PointField> field = find_chosen(*grid, name, choice(name), caller_);
        if (!field && steps_.size() > 1)
            return Error{field.error().code, fmt::format("step {} lacks '{}', `fields` names those to pack: {}", step,
                                                         name, field.error().message)};
        if (!field) return field.error();
        if (job_.value_bits) {
            const Result<double> change = round_values(*field, *job_.value_bits, caller_.run());
            if (!change) return change.error();
            numbers_.rounded_by.resize(names_.size(), 0);
            double& largest = numbers_.rounded_by[static_cast<std::size_t>(&name - names_.data())];
            largest = std::max(largest, *change);
        }
        Result<PackedGrid> packed = packed_with(*grid, *field, step);
        if (!packed) return packed.error();
        numbers_.pack_seconds += packing.seconds();
        const bool is_first = &name == &names_.front(), may_have_moved = job_.append && !writer_;
        Result<void> written = write(*packed, step, is_first);
        if (!written && may_have_moved && written.error().code == ErrorCode::invalid_argument) {
            auto again = packed_as_in_file(*grid, *field, step);
            if (again) {
                if (*again) packed = *std::move(*again);
                written = write(*packed, step, is_first);
            }
        }
        if (!written) return written;
        numbers_.fields.push_back(packed->field());
        numbers_.pack = packed->report();
    }
    return write_cell_fields(*grid, step);
}

Result<void> PackRun::run() {
    if (auto opened = open(); !opened) return opened;
    for (const std::size_t step : steps_)
        if (auto packed = pack_step(step); !packed) return packed;
    const core::Stopwatch writing;
    const Result<std::uint64_t> bytes = writer_->commit();
    if (!bytes) return bytes.error();
    numbers_.bytes = *bytes;
    if (scratch_) numbers_.scratch_bytes = scratch_->report().peak_bytes;
    numbers_.write_seconds += writing.seconds();
    return {};
}

} // namespace

Result<PackNumbers> pack_file(const PackJob& job, Caller& caller) {
    PackRun run(job, caller);
    if (auto done = core::guarded("packing", [&] { return run.run(); }); !done) return run.explain(done.error());
    return run.take_numbers();
}

} // namespace isotet::jobs
