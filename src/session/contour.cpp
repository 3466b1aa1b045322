// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/contour.hpp>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "core/array_identity.hpp"
#include "core/cell_faces.hpp"
#include "core/cells.hpp"
#include "core/errors.hpp"
#include "core/frame.hpp"
#include "core/guard.hpp"
#include "core/memory.hpp"
#include "core/packed.hpp"
#include "core/parallel.hpp"
#include "session/curved_input.hpp"
#include "session/fingerprint.hpp"
#include "session/linear_input.hpp"

namespace isotet {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

bool is_same(const core::ArrayIdentity& before, const Array& now) {
    return now.empty() ? before.is_empty() : before.is(now);
}

/// Cells as they were when the grid was packed.
struct CellsMark {
    core::ArrayIdentity connectivity, offsets, types, numbers;
    CellType uniform_type;
    session::Fingerprint print, numbers_print;

    explicit CellsMark(const Grid& grid)
        : connectivity(grid.cells.connectivity),
          offsets(grid.cells.offsets),
          types(grid.cells.types),
          numbers(grid.point_numbers),
          uniform_type(grid.cells.uniform_type),
          print(session::fingerprint(grid.cells)),
          numbers_print(session::fingerprint(grid.point_numbers)) {}

    /// Equal cells in other memory are known by that memory afterwards.
    bool is(const Grid& grid) {
        const Cells& cells = grid.cells;
        if (!is_same(numbers, grid.point_numbers)) {
            if (numbers_print != session::fingerprint(grid.point_numbers)) return false;
            numbers = core::ArrayIdentity(grid.point_numbers);
        }
        const bool same_memory = is_same(connectivity, cells.connectivity) && is_same(offsets, cells.offsets) &&
                                 is_same(types, cells.types) && uniform_type == cells.uniform_type;
        if (same_memory) return true;
        if (print != session::fingerprint(cells)) return false;
        connectivity = core::ArrayIdentity(cells.connectivity);
        offsets = core::ArrayIdentity(cells.offsets);
        types = core::ArrayIdentity(cells.types);
        uniform_type = cells.uniform_type;
        return true;
    }
};

/// Points or values as they were when they were stored.
struct ArrayMark {
    core::ArrayIdentity identity;
    session::Fingerprint print;

    explicit ArrayMark(const Array& array) : identity(array), print(session::fingerprint(array)) {}
    /// Equal contents in other memory are known by that memory afterwards.
    bool is(const Array& array) {
        if (identity.is(array)) return true;
        if (print != session::fingerprint(array)) return false;
        identity = core::ArrayIdentity(array);
        return true;
    }
};

Result<void> check(const ContourOptions& options) {
    if (!options.engine) return invalid_argument("the session has no engine");
    if (!options.engine->extracts_directly() && options.method == Method::direct)
        return invalid_argument(fmt::format("the {} engine extracts from clusters, but direct extraction was asked for",
                                            options.engine->name()));
    return {};
}

ExtractOptions extract_options(const ContourOptions& options, const ContourInput& input) {
    ExtractOptions extract;
    extract.ties = options.ties;
    extract.normals = options.normals;
    extract.edge_ends = options.edge_ends;
    extract.source_cells = options.source_cells;
    extract.point_fields = input.point_fields;
    extract.cell_fields = input.cell_fields;
    return extract;
}

/// Whether surfaces as `options` ask for can be had without packing again.
bool has_what_is_needed(const PackedGrid& packed, const ContourOptions& options, const ContourInput& input) {
    const bool needs_cells = options.source_cells || !input.cell_fields.empty();
    const bool needs_gradients = options.normals == Normals::gradient;
    return packed.precision() == options.precision && (!needs_cells || packed.report().source_bytes > 0) &&
           (!needs_gradients || packed.report().gradient_bytes > 0);
}

/// What must be stored again for another frame.
ContourUpdate update_for(const std::optional<Frame>& before, const std::optional<Frame>& now) {
    if (before == now) return ContourUpdate::nothing;
    if (!before || !now || core::is_mostly_negative(*before) != core::is_mostly_negative(*now))
        return ContourUpdate::grid;
    const Survey &a = before->whole, &b = now->whole;
    const bool same_points = a.lower == b.lower && a.upper == b.upper && a.points == b.points;
    return same_points ? ContourUpdate::field : ContourUpdate::points;
}

} // namespace

struct Contour::Data {
    std::mutex mutex; ///< of all that follows
    session::LinearInput linear;
    session::CurvedInput curved; ///< where cells are refined in extract(): `input` is then what was refined last
    ContourInput input;          ///< with linear cells; without the grid when that is packed
    ContourOptions options;
    FieldSample sample;
    std::uint64_t asked = 0; ///< surfaces so far
    bool direct_for_memory = false;
    std::optional<PackedGrid> packed; ///< of the input, but for what `behind` says
    ContourUpdate behind = ContourUpdate::grid;
    std::optional<CellsMark> cells;
    std::optional<ArrayMark> points, field;
    std::unique_ptr<EngineGrid> grid; ///< of an engine that keeps one
    std::optional<FieldReport> range; ///< found by a look at the grid
    double update_seconds = 0;
    std::vector<std::string> notes;

    void note_new_cells();
    void start_over(session::CurvedInput next, FieldSample next_sample, const ContourOptions& next_options);
    Result<void> refine_for(std::span<const double> isovalues, const Run& run);
    const FieldReport& field_of_curved() {
        if (!range) range = curved.field();
        return *range;
    }
    std::shared_ptr<const LinearGrid> linear_grid() const { return curved ? curved.grid() : linear.grid(); }
    Method method_of_next(std::size_t isovalues) const;
    Result<void> prepare(std::size_t isovalues, const Run& run);
    Result<void> bring_up_to_date(const Run& run);
    Result<void> pack_grid(const Run& run);
    Result<void> change_points(const Run& run);
    Result<void> change_field(const Run& run);
    Result<void> create_grid(const Run& run);
    Result<void> without_engine(const Error& error);
    Result<void> extract_from_grid(std::span<const double> isovalues, const Run& run, ContourResult& result);
};

namespace {

Result<ContourResult> extract_directly(const ContourInput& input, const ContourOptions& options,
                                       std::span<const double> isovalues, const Run& run) {
    Result<DirectExtraction> direct = options.engine->extract_direct(
        input.grid, input.field, isovalues,
        {extract_options(options, input), options.precision, options.split_cells, options.frame}, run);
    if (!direct) return std::move(direct).error();
    ContourResult result;
    result.surfaces = std::move(direct->surfaces);
    result.field = std::move(direct->field);
    result.cells_left_out = direct->cells_left_out;
    result.coarse_tets = direct->coarse_tets;
    return result;
}

} // namespace

void Contour::Data::note_new_cells() {
    if (curved || !linear.is_new()) return;
    std::ranges::move(linear.grid()->report.notes(), std::back_inserter(notes));
    std::ranges::move(session::notes_on(linear.grid()->refinement), std::back_inserter(notes));
}

/// With an input that is refined when isovalues are known.
void Contour::Data::start_over(session::CurvedInput next, FieldSample next_sample, const ContourOptions& next_options) {
    grid.reset();
    packed.reset();
    range.reset();
    linear = {};
    input = {};
    curved = std::move(next);
    sample = std::move(next_sample);
    options = next_options;
    behind = ContourUpdate::grid;
}

/// Curved cells are refined, unless they are for these isovalues.
Result<void> Contour::Data::refine_for(std::span<const double> isovalues, const Run& run) {
    if (!curved || curved.is_good_for(isovalues)) return {};
    const auto start = std::chrono::steady_clock::now();
    grid.reset();
    packed.reset();
    input = {};
    Result<ContourInput> refined = curved.refine(isovalues, run);
    if (!refined) return refined.error();
    input = *std::move(refined);
    behind = ContourUpdate::grid;
    std::ranges::move(curved.grid()->report.notes(), std::back_inserter(notes));
    std::ranges::move(session::notes_on(curved.grid()->refinement), std::back_inserter(notes));
    update_seconds += seconds_since(start);
    return {};
}

Method Contour::Data::method_of_next(std::size_t isovalues) const {
    if (!options.engine->extracts_directly()) return Method::clusters;
    if (options.method) return *options.method;
    if (curved) return Method::direct; // for a few isovalues
    if (direct_for_memory) return Method::direct;
    if (packed) return Method::clusters;
    const std::uint64_t surfaces = options.surfaces ? options.surfaces : asked + isovalues;
    return method_for(surfaces, options.normals == Normals::gradient);
}

/// The error, or nothing after a note where the CPU may stand in.
Result<void> Contour::Data::without_engine(const Error& error) {
    if (options.engine_required || options.engine->is_stateless() || error.code == ErrorCode::cancelled) return error;
    notes.push_back(error.message + ": the CPU extracts instead");
    grid.reset();
    options.engine = cpu_engine();
    return {};
}

Result<void> Contour::Data::create_grid(const Run& run) {
    if (options.engine->is_stateless() || grid) return {};
    auto created = options.engine->create_grid(*packed, run);
    if (!created) return without_engine(created.error());
    grid = *std::move(created);
    std::ranges::move(grid->notes(), std::back_inserter(notes));
    return {};
}

Result<void> Contour::Data::pack_grid(const Run& run) {
    grid.reset();
    packed.reset(); // the old one goes before the new one comes
    PackOptions pack_options;
    pack_options.precision = options.precision;
    pack_options.source_cells = options.source_cells || !input.cell_fields.empty();
    pack_options.split_cells = options.split_cells;
    pack_options.gradients = options.normals == Normals::gradient;
    pack_options.frame = options.frame;
    Result<PackedGrid> made = pack(input.grid, input.field, pack_options, run);
    if (!made) return made.error();
    packed = *made;
    core::with_threads(run.threads, [&] {
        cells.emplace(input.grid);
        points.emplace(input.grid.points);
    });
    return {};
}

Result<void> Contour::Data::change_points(const Run& run) {
    if (grid) {
        const Result<void> changed = grid->set_points(input.grid.points, run);
        if (changed) packed = grid->packed();
        else if (changed.error().code == ErrorCode::invalid_data) return changed;
        else if (auto instead = without_engine(changed.error()); !instead) return instead;
    }
    if (!grid) {
        Result<PackedGrid> changed = packed->with_points(input.grid.points, run);
        if (!changed) return changed.error();
        packed = *changed;
    }
    core::with_threads(run.threads, [&] { points.emplace(input.grid.points); });
    return {};
}

Result<void> Contour::Data::change_field(const Run& run) {
    if (grid) {
        const Result<void> changed = grid->set_field(input.field, run);
        if (changed) {
            packed = grid->packed();
            return {};
        }
        if (auto instead = without_engine(changed.error()); !instead) return instead;
    }
    Result<PackedGrid> changed = packed->with_field(input.field, run);
    if (!changed) return changed.error();
    packed = *changed;
    return {};
}

/// Packs, or stores what has changed since.
Result<void> Contour::Data::bring_up_to_date(const Run& run) {
    const auto start = std::chrono::steady_clock::now();
    if (packed && behind != ContourUpdate::grid && packed->data().frame != options.frame) {
        packed = packed->with_frame(options.frame);
        grid.reset(); // it has the frame from before
    }
    if (packed && behind == ContourUpdate::points) {
        const Result<void> moved = change_points(run);
        // A tet that turned over, or coordinates that packing has more to say about.
        if (!moved && moved.error().code == ErrorCode::invalid_data) behind = ContourUpdate::grid;
        else if (!moved) return moved;
        else behind = ContourUpdate::field;
    }
    if (!packed || behind == ContourUpdate::grid) {
        if (auto ok = pack_grid(run); !ok) return ok;
    } else if (behind == ContourUpdate::field) {
        if (auto ok = change_field(run); !ok) return ok;
    }
    behind = ContourUpdate::nothing;
    core::with_threads(run.threads, [&] { field.emplace(input.field.values); });
    input.grid = {};
    if (auto ok = create_grid(run); !ok) return ok;
    update_seconds += seconds_since(start);
    return {};
}

/// For so many more isovalues: afterwards method_of_next() tells what can be done.
Result<void> Contour::Data::prepare(std::size_t isovalues, const Run& run) {
    if (curved && !curved.grid()) return {}; // extract() refines
    if (method_of_next(isovalues) == Method::direct) return {};
    if (packed && behind == ContourUpdate::nothing) return create_grid(run);
    const Result<void> ready = bring_up_to_date(run);
    if (ready || ready.error().code != ErrorCode::out_of_memory || options.method ||
        !options.engine->extracts_directly())
        return ready;
    Workload work;
    work.points = sample.points();
    work.tets = sample.tets();
    if (estimate(Method::direct, work).bytes > core::free_memory()) return ready;
    notes.push_back(ready.error().message + ": surfaces are extracted directly instead");
    direct_for_memory = true;
    return {};
}

/// One isovalue after another: what was extracted before an error is kept.
Result<void> Contour::Data::extract_from_grid(std::span<const double> isovalues, const Run& run,
                                              ContourResult& result) {
    const ExtractOptions extract = extract_options(options, input);
    while (grid && result.surfaces.size() < isovalues.size()) {
        auto extraction = grid->extract(isovalues.subspan(result.surfaces.size(), 1), extract, run);
        if (extraction) {
            result.surfaces.push_back(std::move(extraction->front()));
            result.engine = options.engine->name();
            result.work = grid->work();
        } else if (auto instead = without_engine(extraction.error()); !instead) {
            return instead;
        }
    }
    return {};
}

Result<Contour> Contour::create(ContourInput input, const ContourOptions& options) {
    return core::guarded("starting to contour", [&]() -> Result<Contour> {
        if (auto ok = check(options); !ok) return ok.error();
        auto data = std::make_unique<Data>();
        if (options.refine && has_curved_cells(input.grid.cells)) {
            if (auto taken = data->curved.take(std::move(input), options); !taken) return taken.error();
        } else {
            Result<ContourInput> linear = data->linear.make(std::move(input), {});
            if (!linear) return linear.error();
            data->input = *std::move(linear);
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
    return core::is_contoured(vtk_type) || vtk_type == core::polyhedron_type;
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

Result<ContourUpdate> Contour::set(ContourInput input, const ContourOptions& options, const Run& run) {
    return core::guarded("setting another grid", [&]() -> Result<ContourUpdate> {
        if (!data_) return moved_from("the session");
        if (auto ok = check(options); !ok) return ok.error();
        const std::lock_guard lock(data_->mutex);
        Data& data = *data_;
        if (options.refine && has_curved_cells(input.grid.cells)) {
            session::CurvedInput curved;
            if (auto taken = curved.take(std::move(input), options); !taken) return taken.error();
            const ContourInput& corners = curved.corners();
            Result<FieldSample> sample = FieldSample::create(corners.grid, corners.field, options.split_cells);
            if (!sample) return sample.error();
            data.start_over(std::move(curved), *std::move(sample), options);
            return ContourUpdate::grid;
        }
        session::LinearInput linear = data.linear;
        if (Result<ContourInput> made = linear.make(std::move(input), run); made) input = *std::move(made);
        else return made.error();
        ContourUpdate update = ContourUpdate::grid;
        const bool usable = data.packed && !data.curved && data.options.split_cells == options.split_cells &&
                            has_what_is_needed(*data.packed, options, input) &&
                            data.packed->user_point_count() == input.grid.points.tuples();
        if (usable && data.behind != ContourUpdate::grid) {
            core::with_threads(run.threads, [&] {
                if (!data.cells->is(input.grid)) return;
                if (!data.points->is(input.grid.points)) update = ContourUpdate::points;
                else if (data.behind != ContourUpdate::nothing || !data.field->is(input.field.values) ||
                         data.packed->field().name != input.field.name)
                    update = ContourUpdate::field;
                else update = ContourUpdate::nothing;
                update = std::max(update, update_for(data.packed->data().frame, options.frame));
                if (options.frame) update = std::max(update, data.behind); // what an error left behind
            });
        }
        if (run.progress.cancelled()) return Error{ErrorCode::cancelled, "setting another grid was cancelled"};
        if (update != ContourUpdate::nothing) {
            Result<FieldSample> sample = FieldSample::create(input.grid, input.field, options.split_cells);
            if (!sample) return sample.error();
            data.sample = *std::move(sample);
            data.range.reset();
        }
        if (data.options.engine != options.engine) data.grid.reset();
        data.options = options;
        data.behind = update;
        data.linear = std::move(linear);
        if (data.curved) data.packed.reset();
        data.curved = {};
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
        if (auto ok = data.prepare(0, run); !ok) return ok.error();
        const auto start = std::chrono::steady_clock::now();
        const Method method = data.method_of_next(0);
        const std::shared_ptr<const LinearGrid> linear = data.linear_grid();
        const std::optional<FieldReport> whole = data.curved ? std::optional(data.field_of_curved()) : std::nullopt;
        ContourResult head;
        head.notes = std::exchange(data.notes, {});
        head.pack_seconds = std::exchange(data.update_seconds, 0);
        Result<ContourResult> result = ContourResult{};
        if (method == Method::direct) {
            const ContourInput input = data.input; // shares the arrays
            const ContourOptions options = data.options;
            lock.unlock();
            result = extract_directly(input, options, isovalues, run);
            if (result) result->engine = options.engine->name();
        } else {
            if (auto ok = data.extract_from_grid(isovalues, run, *result); !ok) return ok.error();
            std::ranges::move(std::exchange(data.notes, {}), std::back_inserter(head.notes));
            const PackedGrid packed = *data.packed;
            const std::shared_ptr<const Engine> engine = data.options.engine;
            const ExtractOptions options = extract_options(data.options, data.input);
            lock.unlock();
            result->field = packed.field();
            result->cells_left_out = packed.report().cells_left_out;
            if (result->surfaces.size() < isovalues.size()) {
                const auto grid = engine->create_grid(packed, run);
                if (!grid) return grid.error();
                auto rest = (*grid)->extract(isovalues.subspan(result->surfaces.size()), options, run);
                if (!rest) return rest.error();
                result->engine = engine->name();
                std::ranges::move(*rest, std::back_inserter(result->surfaces));
            }
        }
        if (!result) return result;
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
        result->method = method;
        result->extract_seconds = seconds_since(start);
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
        return work(*data.grid, extract_options(data.options, data.input));
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

Result<FieldReport> Contour::field(const Run& run) {
    return core::guarded("looking at the field", [&]() -> Result<FieldReport> {
        if (!data_) return moved_from("the session");
        const std::lock_guard lock(data_->mutex);
        Data& data = *data_;
        if (data.range) return *data.range;
        if (data.curved) return data.field_of_curved();
        if (auto ok = data.prepare(0, run); !ok) return ok.error();
        if (data.method_of_next(0) == Method::clusters) return data.packed->field();
        const Result<ContourResult> looked = extract_directly(data.input, data.options, {}, run);
        if (!looked) return looked.error();
        data.range = looked->field;
        return looked->field;
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
