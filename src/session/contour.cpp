// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/contour.hpp>

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/guard.hpp"
#include "base/parallel.hpp"
#include "grid/cell/linear_names.hpp"
#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
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
    const bool some_do = Contour::can_do_with_active_cells(options) && input.cell_fields.empty();
    if (input.all_cells && !some_do) {
        Result<ContourInput> all = input.all_cells(run);
        if (!all) return all;
        input = *std::move(all);
    }
    input.grid.cells = core::with_linear_names(std::move(input.grid.cells));
    return input;
}

/// Nothing where more cells are needed than the input has.
Result<std::optional<ContourResult>> extract_directly(const ContourInput& input, const ContourOptions& options,
                                                      std::span<const double> isovalues, const Run& run) {
    DirectOptions direct_options{session::extract_options(options, input), options.precision, options.split_cells,
                                 options.frame};
    direct_options.active_cells_only = static_cast<bool>(input.all_cells);
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
    const Method method = options.method.value_or(method_for(options.surfaces, gradients));
    return !options.expected_isovalues.empty() && options.surfaces > 0 && method == Method::direct && options.engine &&
           options.engine->name() == cpu_engine()->name() && !gradients && !options.source_cells &&
           !options.exact_vertices && !options.frame;
}

Result<Contour> Contour::create(ContourInput given, const ContourOptions& options, const Run& run) {
    return core::carry_out("starting to contour", run, [&](const Progress&) -> Result<Contour> {
        if (auto ok = check(options); !ok) return ok.error();
        Result<ContourInput> enough = input_for(std::move(given), options, run);
        if (!enough) return enough.error();
        ContourInput input = *std::move(enough);
        auto data = std::make_unique<Data>();
        if (input.packed) {
            if (auto taken = data->take_packed(std::move(input), options, run); !taken) return taken.error();
            return Contour(std::move(data));
        }
        const auto met = data->take_met(input, options, run);
        if (!met) return met.error();
        if (*met == Data::Met::some) return Contour(std::move(data));
        if (options.refine && has_curved_cells(input.grid.cells)) {
            if (auto taken = data->curved.take(std::move(input), options); !taken) return taken.error();
        } else {
            const auto start = std::chrono::steady_clock::now();
            Result<ContourInput> linear = data->linear.make(std::move(input), run);
            if (!linear) return linear.error();
            data->input = *std::move(linear);
            if (data->linear.grid()) data->update_seconds += session::seconds_since(start);
            data->note_new_cells();
        }
        const ContourInput& first = data->curved ? data->curved.corners() : data->input;
        Result<FieldSample> sample = FieldSample::create(first.grid, first.field, options.split_cells);
        if (!sample) return sample.error();
        data->options = options;
        data->sample = *std::move(sample);
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
        ContourInput input = *std::move(enough);
        const std::lock_guard lock(data_->mutex);
        Data& data = *data_;
        ++data.set_count;
        if (input.packed) return data.take_packed(std::move(input), options, run);
        if (options.refine && has_curved_cells(input.grid.cells)) {
            if (auto taken = data.take_curved(std::move(input), options); !taken) return taken.error();
            return ContourUpdate::grid;
        }
        if (!data.packed) {
            const auto taken = data.take_met(input, options, run);
            if (!taken) return taken.error();
            if (*taken == Data::Met::some) return ContourUpdate::grid;
        }
        session::LinearInput linear = data.linear;
        const auto start = std::chrono::steady_clock::now();
        if (Result<ContourInput> made = linear.make(std::move(input), run); made) input = *std::move(made);
        else return made.error();
        if (linear.grid()) data.update_seconds += session::seconds_since(start);
        const ContourUpdate update = data.what_changed(input, options, run);
        if (run.progress.cancelled()) return Error{ErrorCode::cancelled, "setting another grid was cancelled"};
        if (update != ContourUpdate::nothing) {
            Result<FieldSample> sample = FieldSample::create(input.grid, input.field, options.split_cells);
            if (!sample) return sample.error();
            data.sample = *std::move(sample);
            data.range.reset();
        }
        if (data.options.engine != options.engine) data.grid.reset();
        if (std::exchange(data.is_given, false)) data.packed.reset();
        data.options = options;
        data.behind = update;
        data.linear = std::move(linear);
        if (data.curved) data.packed.reset();
        data.curved = {};
        data.met = {};
        data.note_new_cells();
        data.input = std::move(input);
        if (update == ContourUpdate::nothing && options.method != Method::direct) data.input.grid = {};
        return update;
    });
}

Result<void> Contour::prepare(const Run& run) {
    return core::guarded("preparing to contour", [&]() -> Result<void> {
        if (!data_) return moved_from("the session");
        const std::lock_guard lock(data_->mutex);
        return data_->prepare(1, run);
    });
}

Result<ContourResult> Contour::extract(double isovalue, const Run& run) { return extract({&isovalue, 1}, run); }

Result<ContourResult> Contour::extract(std::span<const double> isovalues, const Run& run) {
    return core::guarded("extraction", [&]() -> Result<ContourResult> {
        if (!data_) return moved_from("the session");
        Data& data = *data_;
        std::unique_lock lock(data.mutex);
        data.asked += isovalues.size();
        if (auto ok = data.refine_for(isovalues, run); !ok) return ok.error();
        if (!data.is_enough_for(isovalues))
            if (auto ok = data.complete(run); !ok) return ok.error();
        if (auto ok = data.prepare(0, run); !ok) return ok.error();
        auto start = std::chrono::steady_clock::now();
        const Method method = data.method_of_next(0);
        // All that is needed of the session, which another thread may set meanwhile; it shares the arrays.
        std::shared_ptr<const LinearGrid> linear = data.linear_grid();
        ContourInput input = data.input;
        const session::MetInput met = data.met;
        const session::LinearInput linear_input = data.linear;
        const std::uint64_t set_count = data.set_count;
        const ContourOptions options = data.options;
        const std::optional<FieldReport> whole = data.curved ? std::optional(data.field_of_curved()) : std::nullopt;
        const std::shared_ptr<const core::Residency> residency = data.packed ? data.packed->data().residency : nullptr;
        const std::uint64_t read_before = residency ? residency->use().read : 0;
        const std::optional<ValueRange> range = data.met ? std::optional(data.met.range()) : std::nullopt;
        ContourResult head;
        head.notes = std::exchange(data.notes, {});
        head.pack_seconds = std::exchange(data.update_seconds, 0);
        Result<ContourResult> result = ContourResult{};
        if (method == Method::direct) {
            lock.unlock();
            Result<std::optional<ContourResult>> found = extract_directly(input, options, isovalues, run);
            if (found && !*found) {
                Result<Data::Completed> all = Data::completed(input, met, linear_input, options, run);
                if (!all) return all.error();
                input = all->input;
                linear = all->linear.grid();
                head.pack_seconds += std::exchange(all->seconds, 0);
                lock.lock();
                if (data.set_count == set_count && (data.met || data.input.all_cells)) data.take(*std::move(all));
                lock.unlock();
                start = std::chrono::steady_clock::now();
                found = extract_directly(input, options, isovalues, run);
            }
            if (!found) return found.error();
            result = **std::move(found);
            result->engine = options.engine->name();
        } else {
            if (auto ok = data.extract_from_grid(isovalues, run, *result); !ok) return ok.error();
            std::ranges::move(std::exchange(data.notes, {}), std::back_inserter(head.notes));
            const PackedGrid packed = *data.packed;
            const std::shared_ptr<const Engine> engine = data.options.engine;
            lock.unlock();
            result->field = packed.field();
            result->cells_left_out = packed.report().cells_left_out;
            if (result->surfaces.size() < isovalues.size()) {
                const auto grid = engine->create_grid(packed, run);
                if (!grid) return grid.error();
                auto rest = (*grid)->extract(isovalues.subspan(result->surfaces.size()),
                                             session::extract_options(options, input), run);
                if (!rest) return rest.error();
                result->engine = engine->name();
                std::ranges::move(*rest, std::back_inserter(result->surfaces));
            }
        }
        if (!result) return result;
        if (options.exact_vertices)
            if (auto ok = session::move_vertices(linear.get(), input, options, isovalues, result->surfaces, run); !ok)
                return ok.error();
        if (linear) {
            session::map_source_cells(*linear, result->surfaces);
            result->refinement = linear->refinement;
            result->cells_left_out += linear->refinement.left_out;
        }
        if (whole) {
            result->field.lower = whole->lower;
            result->field.upper = whole->upper;
            result->field.no_data = whole->no_data;
            result->field.infinite = whole->infinite;
        }
        if (range) {
            result->field.lower = range->lower;
            result->field.upper = range->upper;
        }
        if (residency) {
            const core::Residency::Use use = residency->use();
            result->file_bytes_read = use.read - read_before;
            result->file_bytes_kept = use.kept;
        }
        result->method = method;
        result->extract_seconds = session::seconds_since(start);
        result->pack_seconds = head.pack_seconds;
        result->notes = std::move(head.notes);
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
        if (data.curved && !data.curved.grid())
            if (auto ok = data.refine_for({}, run); !ok) return ok;
        if (auto ok = data.prepare(surfaces, run); !ok) return ok;
        if (!data.grid)
            return invalid_argument(
                fmt::format("the session extracts by the {} engine, which keeps no grid", data.options.engine->name()));
        data.asked += surfaces;
        return work(*data.grid, session::extract_options(data.options, data.input));
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
    prediction.triangles = data.sample.triangles(isovalue);
    Workload work;
    work.points = data.sample.points();
    work.tets = data.sample.tets();
    work.gradients = data.options.normals == Normals::gradient;
    work.triangles = work.triangles_together = prediction.triangles;
    const Method method = data.method_of_next(1);
    prediction.estimate = estimate(method, work);
    if (method == Method::clusters && data.packed && data.behind == ContourUpdate::nothing) {
        work.surfaces = 0; // packing is done
        prediction.estimate.seconds -= estimate(method, work).seconds;
    }
    return prediction;
}

Result<FieldSample> Contour::sample() const {
    return core::guarded("looking at the field", [&]() -> Result<FieldSample> {
        if (!data_) return moved_from("the session");
        const std::lock_guard lock(data_->mutex);
        return data_->sample;
    });
}

Result<FieldReport> Contour::field(const Run& run) {
    return core::guarded("looking at the field", [&]() -> Result<FieldReport> {
        if (!data_) return moved_from("the session");
        const std::lock_guard lock(data_->mutex);
        Data& data = *data_;
        if (data.range) return *data.range;
        if (data.curved) return data.field_of_curved();
        if (auto ok = data.prepare(0, run); !ok) return ok.error();
        if (data.method_of_next(0) == Method::clusters) return data.packed->field();
        if (data.input.all_cells)
            if (auto ok = data.complete(run); !ok) return ok.error();
        const Result<std::optional<ContourResult>> looked = extract_directly(data.input, data.options, {}, run);
        if (!looked) return looked.error();
        data.range = (*looked)->field;
        if (data.met) {
            data.range->lower = data.met.range().lower;
            data.range->upper = data.met.range().upper;
        }
        return *data.range;
    });
}

std::optional<PackedGrid> Contour::packed() const {
    if (!data_) return std::nullopt;
    const std::lock_guard lock(data_->mutex);
    return data_->behind == ContourUpdate::nothing ? data_->packed : std::nullopt;
}

std::shared_ptr<const LinearGrid> Contour::linear_grid() const {
    if (!data_) return nullptr;
    const std::lock_guard lock(data_->mutex);
    return data_->linear_grid();
}

std::string_view Contour::engine() const {
    if (!data_) return {};
    const std::lock_guard lock(data_->mutex);
    return data_->options.engine->name();
}

} // namespace isotet
