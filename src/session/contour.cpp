// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/contour.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/array_slot.hpp"
#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/guard.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "grid/cell/linear_names.hpp"
#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "grid/renumber.hpp"
#include "packed/packed.hpp"
#include "packed/residency.hpp"
#include "session/contour_data.hpp"
#include "session/exact_vertices.hpp"

namespace isotet {

namespace {

Result<void> check(const ContourOptions& options) {
    if (!options.engine) return invalid_argument("the session has no engine");
    if (!options.engine->extracts_directly() && options.method == Method::direct)
        return invalid_argument(fmt::format("the {} engine extracts from clusters, but direct extraction was asked for",
                                            options.engine->name()));
    return {};
}

/// The input, cells of degree 1 by their linear types; where it has only some of the cells, and `options` ask for more than these can do, that with all cells.
Result<ContourInput> input_for(ContourInput input, const ContourOptions& options, const Run& run) {
    if (input.packed) return input;
    const auto is_of_these = [&](const Field& field) { return field.values.tuples() == input.grid.cells.count(); };
    const bool some_do = input.lacks_cells() && !has_cells_to_linearize(input.grid.cells) &&
                         Contour::can_do_with_active_cells(options) &&
                         std::ranges::all_of(input.cell_fields, is_of_these) &&
                         (!options.source_cells || !input.part->cell_numbers.empty()) &&
                         (options.normals != Normals::gradient || input.part->has_cells_around);
    if (input.lacks_cells() && !some_do) {
        Result<ContourInput> all = session::with_all_cells(std::move(input), run);
        if (!all) return all;
        input = *std::move(all);
    }
    if (auto ok = session::check_cell_numbers(input); !ok) return ok.error();
    input.grid.cells = core::with_linear_names(std::move(input.grid.cells));
    return input;
}

/// Nothing where more cells are needed than the input has.
Result<std::optional<ContourResult>> extract_directly(const ContourInput& input, const ContourOptions& options,
                                                      std::span<const double> isovalues, const Run& run) {
    DirectOptions direct_options{session::extract_options(options, input), options.precision, options.split_cells,
                                 options.frame};
    direct_options.active_cells_only = input.lacks_cells();
    Result<DirectExtraction> direct =
        options.engine->extract_direct(input.grid, input.field, isovalues, direct_options, run);
    if (!direct) return std::move(direct).error();
    if (direct->needs_all_cells) return std::optional<ContourResult>{};
    ContourResult result;
    result.surfaces = std::move(direct->surfaces);
    result.field = std::move(direct->field);
    result.cells_left_out = direct->cells_left_out;
    result.coarse_tets = direct->coarse_tets;
    return std::optional(std::move(result));
}

} // namespace

bool Contour::can_do_with_active_cells(const ContourOptions& options) {
    const bool gradients = options.normals == Normals::gradient;
    const Method method = method_for(options.surfaces, gradients, options.method);
    return !options.expected_isovalues.empty() && options.surfaces > 0 && method == Method::direct && options.engine &&
           options.engine->name() == cpu_engine()->name() && !options.exact_vertices && !options.frame;
}

Result<Contour> Contour::create(ContourInput given, const ContourOptions& options, const Run& run) {
    return core::carry_out("starting to contour", run, [&](const Progress&) -> Result<Contour> {
        if (auto ok = check(options); !ok) return ok.error();
        Result<ContourInput> enough = input_for(std::move(given), options, run);
        if (!enough) return enough.error();
        auto data = std::make_unique<Data>();
        if (auto taken = data->set(*std::move(enough), options, run); !taken) return taken.error();
        return Contour(std::move(data));
    });
}

bool Contour::contours(std::uint8_t vtk_type) noexcept {
    return (core::is_contoured(vtk_type) && !core::is_ordered(vtk_type)) || core::is_polyhedral(vtk_type);
}

Contour::Contour(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Contour::Contour(Contour&&) noexcept = default;
Contour& Contour::operator=(Contour&&) noexcept = default;
Contour::~Contour() = default;

Result<ContourUpdate> Contour::set(ContourInput input, const Run& run) {
    if (!data_) return moved_from("the session");
    std::unique_lock lock(data_->mutex);
    const ContourOptions options = data_->options;
    lock.unlock();
    return set(std::move(input), options, run);
}

Result<ContourUpdate> Contour::set(ContourInput given, const ContourOptions& options, const Run& run) {
    return core::guarded("setting another grid", [&]() -> Result<ContourUpdate> {
        if (!data_) return moved_from("the session");
        if (auto ok = check(options); !ok) return ok.error();
        Result<ContourInput> enough = input_for(std::move(given), options, run);
        if (!enough) return enough.error();
        const std::lock_guard lock(data_->mutex);
        return data_->set(*std::move(enough), options, run);
    });
}

Result<void> Contour::prepare(const Run& run) {
    return core::guarded("preparing to contour", [&]() -> Result<void> {
        if (!data_) return moved_from("the session");
        return data_->pack_aside(run);
    });
}

Result<ContourResult> Contour::extract(double isovalue, const Run& run) { return extract({&isovalue, 1}, run); }

namespace {

/// What is needed of a session to extract, while another thread may set it; it shares the arrays.
struct Snapshot {
    session::Source source;
    ContourOptions options;
    std::optional<PackedGrid> packed;
    std::uint64_t inputs = 0; ///< Asked::inputs
};

void number_cells(const Array& numbers, std::vector<Extraction>& surfaces) {
    for (Extraction& one : surfaces)
        one.surface.source_cells = core::source_cells_by(one.surface.source_cells, numbers);
}

/// What of the result follows from the cells before they were made linear.
Result<void> finish(const Snapshot& now, std::span<const double> isovalues, const Run& run, ContourResult& result) {
    const std::shared_ptr<const LinearGrid>& linear = now.source.linear_grid();
    if (now.options.exact_vertices)
        if (auto ok =
                session::move_vertices(linear.get(), now.source.input(), now.options, isovalues, result.surfaces, run);
            !ok)
            return ok;
    if (linear) {
        number_cells(linear->source_cells, result.surfaces);
        session::map_edge_ends(linear->user_points, linear->derived_numbers, result.surfaces);
        result.refinement = linear->refinement;
        result.cells_left_out += linear->refinement.left_out;
    }
    if (const auto& part = now.source.input().part) number_cells(part->cell_numbers, result.surfaces);
    if (const std::optional<ValueRange> range = now.source.range()) {
        result.field.lower = range->lower;
        result.field.upper = range->upper;
    }
    return {};
}

void bring_all(core::RememberingSink& sink, std::vector<Extraction>& surfaces, const Run& run) {
    sink.begin_at(0);
    core::with_threads(run.threads, [&] {
        for (std::size_t i = 0; i < surfaces.size(); ++i) sink.bring(surfaces[i].surface, i);
    });
}

/// The isovalues that `result` lacks, by an engine that keeps no grid.
Result<void> extract_the_rest(const Snapshot& now, std::span<const double> isovalues, const Run& run,
                              ContourResult& result) {
    result.field = now.packed->field();
    result.cells_left_out = now.packed->report().cells_left_out;
    if (result.surfaces.size() == isovalues.size()) return {};
    const auto grid = now.options.engine->create_grid(*now.packed, run);
    if (!grid) return grid.error();
    auto rest = (*grid)->extract(isovalues.subspan(result.surfaces.size()),
                                 session::extract_options(now.options, now.source.input()), run);
    if (!rest) return rest.error();
    result.engine = now.options.engine->name();
    std::ranges::move(*rest, std::back_inserter(result.surfaces));
    return {};
}

/// What is read of a packed file from when this is made.
class FileUse {
public:
    explicit FileUse(const std::optional<PackedGrid>& packed)
        : residency_(packed ? packed->data().residency : nullptr), before_(residency_ ? residency_->use().read : 0) {}

    void tell(ContourResult& result) const {
        if (!residency_) return;
        const core::Residency::Use use = residency_->use();
        result.file_bytes_read = use.read - before_;
        result.file_bytes_kept = use.kept;
    }

private:
    std::shared_ptr<const core::Residency> residency_;
    std::uint64_t before_;
};

} // namespace

Result<ContourResult> Contour::extract(std::span<const double> isovalues, const Run& run) {
    return core::guarded("extraction", [&]() -> Result<ContourResult> {
        if (!data_) return moved_from("the session");
        Data& data = *data_;
        std::unique_lock lock(data.mutex);
        data.asked.surfaces += isovalues.size();
        if (auto ok = data.get_cells_for(isovalues, run); !ok) return ok.error();
        if (auto ok = data.prepare(0, run); !ok) return ok.error();
        core::Stopwatch time;
        const Method method = data.method_of_next(0);
        const std::optional<FieldReport> whole =
            data.source.is_curved() ? std::optional(data.field_of_curved()) : std::nullopt;
        const std::optional<PackedGrid>& packed = data.state.packed();
        const FileUse file(packed);
        const auto sink = data.options.sink ? std::make_shared<core::RememberingSink>(data.options.sink) : nullptr;
        ContourResult result;
        if (method != Method::direct)
            if (auto ok = data.state.extract(isovalues, data.source, data.options, sink, run, result, data.told); !ok)
                return ok.error();
        Snapshot now{data.source, data.options, packed, data.asked.inputs};
        now.options.sink = sink;
        if (sink) sink->begin_at(result.surfaces.size());
        session::Told told = std::exchange(data.told, {});
        lock.unlock();
        if (method == Method::direct) {
            Result<std::optional<ContourResult>> found =
                extract_directly(now.source.input(), now.options, isovalues, run);
            if (found && !*found) {
                Result<session::Source> all = now.source.whole(now.options, now.source, run, told);
                if (!all) return all.error();
                now.source = *std::move(all);
                if (auto ok = data.keep_all_cells(now.source, now.options, now.inputs); !ok) return ok.error();
                time = {};
                found = extract_directly(now.source.input(), now.options, isovalues, run);
            }
            if (!found) return found.error();
            result = **std::move(found);
            result.engine = now.options.engine->name();
        } else if (auto ok = extract_the_rest(now, isovalues, run, result); !ok) {
            return ok.error();
        }
        if (auto ok = finish(now, isovalues, run, result); !ok) return ok.error();
        if (sink) bring_all(*sink, result.surfaces, run);
        if (whole) {
            result.field.lower = whole->lower;
            result.field.upper = whole->upper;
            result.field.no_data = whole->no_data;
            result.field.infinite = whole->infinite;
        }
        file.tell(result);
        result.method = method;
        result.extract_seconds = time.seconds();
        result.pack_seconds = told.seconds;
        result.notes = std::move(told.notes);
        return result;
    });
}

Result<void> Contour::use_grid(std::size_t surfaces,
                               const std::function<Result<void>(EngineGrid&, const ExtractOptions&)>& work,
                               const Run& run) {
    return core::guarded("extraction", [&]() -> Result<void> {
        if (!data_) return moved_from("the session");
        const std::lock_guard lock(data_->mutex);
        Data& data = *data_;
        if (!data.source.is_refined())
            if (auto ok = data.get_cells_for({}, run); !ok) return ok;
        if (auto ok = data.prepare(surfaces, run); !ok) return ok;
        if (!data.state.has_grid())
            return invalid_argument(
                fmt::format("the session extracts by the {} engine, which keeps no grid", data.options.engine->name()));
        data.asked.surfaces += surfaces;
        return work(data.state.grid(), session::extract_options(data.options, data.source.input()));
    });
}

Method Contour::method(std::size_t isovalues) const {
    if (!data_) return Method::direct;
    const std::lock_guard lock(data_->mutex);
    return data_->method_of_next(isovalues);
}

Result<Contour::Prediction> Contour::predict(double isovalue) const {
    if (!data_) return moved_from("the session");
    const std::lock_guard lock(data_->mutex);
    const Data& data = *data_;
    Prediction prediction;
    prediction.triangles = data.look.sample.triangles(isovalue);
    Workload work;
    work.points = data.look.sample.points();
    work.tets = data.look.sample.tets();
    work.gradients = data.options.normals == Normals::gradient;
    work.triangles = work.triangles_together = prediction.triangles;
    const Method method = data.method_of_next(1);
    prediction.estimate = estimate(method, work);
    if (method == Method::clusters && data.state.is_current()) {
        work.surfaces = 0; // packing is done
        prediction.estimate.seconds -= estimate(method, work).seconds;
    }
    return prediction;
}

Result<FieldSample> Contour::sample() const {
    return core::guarded("looking at the field", [&]() -> Result<FieldSample> {
        if (!data_) return moved_from("the session");
        const std::lock_guard lock(data_->mutex);
        return data_->look.sample;
    });
}

Result<FieldReport> Contour::field(const Run& run) {
    return core::guarded("looking at the field", [&]() -> Result<FieldReport> {
        if (!data_) return moved_from("the session");
        const std::lock_guard lock(data_->mutex);
        Data& data = *data_;
        if (data.look.range) return *data.look.range;
        if (data.source.is_curved()) return data.field_of_curved();
        if (auto ok = data.prepare(0, run); !ok) return ok.error();
        if (data.method_of_next(0) == Method::clusters) return data.state.packed()->field();
        Result<std::optional<ContourResult>> looked = extract_directly(data.source.input(), data.options, {}, run);
        if (looked && !*looked) {
            if (auto ok = data.get_all_cells(run); !ok) return ok.error();
            looked = extract_directly(data.source.input(), data.options, {}, run);
        }
        if (!looked) return looked.error();
        data.look.range = (*looked)->field;
        if (const std::optional<ValueRange> range = data.source.range()) {
            data.look.range->lower = range->lower;
            data.look.range->upper = range->upper;
        }
        return *data.look.range;
    });
}

std::optional<PackedGrid> Contour::packed() const {
    if (!data_) return std::nullopt;
    const std::lock_guard lock(data_->mutex);
    return data_->state.is_current() ? data_->state.packed() : std::nullopt;
}

std::shared_ptr<const LinearGrid> Contour::linear_grid() const {
    if (!data_) return nullptr;
    const std::lock_guard lock(data_->mutex);
    return data_->source.linear_grid();
}

std::string_view Contour::engine() const {
    if (!data_) return {};
    const std::lock_guard lock(data_->mutex);
    return data_->options.engine->name();
}

} // namespace isotet
