// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "session/contour_data.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "packed/frame.hpp"
#include "packed/packed.hpp"

namespace isotet {

ExtractOptions session::extract_options(const ContourOptions& options, const ContourInput& input) {
    ExtractOptions extract;
    extract.ties = options.ties;
    const bool exact = options.exact_vertices; // moved vertices need these, and get their normals anew
    extract.normals = exact && options.normals != Normals::gradient ? Normals::none : options.normals;
    extract.edge_ends = options.edge_ends || exact;
    extract.source_cells = options.source_cells || exact;
    extract.point_fields = input.point_fields;
    extract.packed_fields = input.packed_fields;
    extract.cell_fields = input.cell_fields;
    return extract;
}

namespace {

bool needs_source_cells(const ContourOptions& options, const ContourInput& input) {
    return options.source_cells || options.exact_vertices || !input.cell_fields.empty();
}

/// Whether surfaces as `options` ask for can be had without packing again.
bool has_what_is_needed(const PackedGrid& packed, const ContourOptions& options, const ContourInput& input) {
    const bool needs_cells = needs_source_cells(options, input);
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

void Contour::Data::note_new_cells() {
    if (curved || !linear.is_new()) return;
    std::ranges::move(linear.grid()->report.notes(), std::back_inserter(notes));
    std::ranges::move(session::notes_on(linear.grid()->refinement), std::back_inserter(notes));
}

/// Without an input, and without what was made of the last one.
void Contour::Data::start_over(FieldSample next_sample, const ContourOptions& next_options) {
    grid.reset();
    packed.reset();
    range.reset();
    linear = {};
    met = {};
    curved = {};
    input = {};
    is_given = false;
    sample = std::move(next_sample);
    options = next_options;
    behind = ContourUpdate::grid;
}

/// Starts over with an input of which only cells that the expected isovalues meet are made linear, unless all must be, for
/// what is asked for, or since no cell is met: then nothing is done.
Result<Contour::Data::Met> Contour::Data::take_met(const ContourInput& next, const ContourOptions& next_options,
                                                   const Run& run) {
    if (!session::MetInput::suits(next, next_options)) return Met::not_chosen;
    const auto start = std::chrono::steady_clock::now();
    session::MetInput taken;
    Result<std::optional<ContourInput>> some = taken.make(next, next_options, run);
    if (!some) return some.error();
    if (!*some) return Met::not_chosen;
    std::optional<ContourInput> made = *std::move(some);
    Result<FieldSample> next_sample = FieldSample::create(made->grid, made->field, next_options.split_cells);
    if (!next_sample) return next_sample.error();
    start_over(*std::move(next_sample), next_options);
    met = std::move(taken);
    input = *std::move(made);
    std::ranges::move(met.grid()->report.notes(), std::back_inserter(notes));
    update_seconds += session::seconds_since(start);
    return Met::some;
}

/// Whether no cell that the input lacks can be met.
bool Contour::Data::is_enough_for(std::span<const double> isovalues) const {
    if (met) return met.is_good_for(isovalues);
    return !input.all_cells || std::ranges::all_of(isovalues, [&](double isovalue) {
        return std::ranges::find(options.expected_isovalues, isovalue) != options.expected_isovalues.end();
    });
}

/// Gets the cells that were left out, or makes them linear, too. Calls no member that `set` may change meanwhile.
Result<Contour::Data::Completed> Contour::Data::completed(const ContourInput& input, const session::MetInput& met,
                                                          session::LinearInput linear, const ContourOptions& options,
                                                          const Run& run) {
    const auto start = std::chrono::steady_clock::now();
    Result<ContourInput> all = met ? Result<ContourInput>(met.user()) : input.all_cells(run);
    if (!all) return all.error();
    Result<ContourInput> made = linear.make(*std::move(all), run);
    if (!made) return made.error();
    Result<FieldSample> sample = FieldSample::create(made->grid, made->field, options.split_cells);
    if (!sample) return sample.error();
    return Completed{*std::move(made), std::move(linear), *std::move(sample), session::seconds_since(start)};
}

void Contour::Data::take(Completed all) {
    sample = std::move(all.sample);
    input = std::move(all.input);
    linear = std::move(all.linear);
    met = {};
    note_new_cells();
    update_seconds += all.seconds;
}

Result<void> Contour::Data::complete(const Run& run) {
    if (!met && !input.all_cells) return {};
    Result<Completed> all = completed(input, met, linear, options, run);
    if (!all) return all.error();
    take(*std::move(all));
    return {};
}

/// Starts over with an input that is refined when isovalues are known.
Result<void> Contour::Data::take_curved(ContourInput next, const ContourOptions& next_options) {
    session::CurvedInput taken;
    if (auto ok = taken.take(std::move(next), next_options); !ok) return ok;
    const ContourInput& corners = taken.corners();
    Result<FieldSample> next_sample = FieldSample::create(corners.grid, corners.field, next_options.split_cells);
    if (!next_sample) return next_sample.error();
    start_over(*std::move(next_sample), next_options);
    curved = std::move(taken);
    return {};
}

namespace {

/// A packed grid has what it has.
Result<void> check_packed_input(const ContourInput& next, const ContourOptions& options) {
    const PackedGrid& packed = *next.packed;
    const PackReport& report = packed.report();
    const auto lacks = [](bool is, const char* what) -> Result<void> {
        if (!is) return {};
        return invalid_argument(fmt::format("{}, but the packed grid that is given has none", what));
    };
    if (packed.precision() != options.precision)
        return invalid_argument(
            fmt::format("the packed grid that is given is in {} precision, but {} was asked for",
                        packed.precision() == Precision::float32 ? "single" : "double",
                        options.precision == Precision::float32 ? "single" : "double"));
    if (options.method == Method::direct)
        return invalid_argument("direct extraction was asked for, but a packed grid is given, which has clusters");
    if (options.exact_vertices || options.split_cells)
        return invalid_argument("exact vertices or split cells were asked for, but a packed grid is given, whose cells are "
                                "as they were packed");
    if (options.frame && packed.data().frame != options.frame)
        return invalid_argument("a frame is given, but the packed grid that is given has another one");
    const bool any = report.points > 0;
    if (auto ok = lacks(any && needs_source_cells(options, next) && report.source_bytes == 0, "source cells are needed"); !ok)
        return ok;
    return lacks(any && options.normals == Normals::gradient && report.gradient_bytes == 0, "gradients are needed");
}

/// Engines that keep a grid carry the user's arrays only.
Result<ContourInput> fields_for(ContourInput next, const ContourOptions& options, const Run& run) {
    if (options.engine->is_stateless()) return next;
    for (const PackedGrid& field : std::exchange(next.packed_fields, {})) {
        Result<Field> values = unpack_field(field, run);
        if (!values) return values.error();
        next.point_fields.push_back(*std::move(values));
    }
    return next;
}

/// What is new in a packed grid beside one that was given before.
ContourUpdate update_between(const PackedGrid& before, const PackedGrid& now) {
    const core::Packed &a = before.data(), &b = now.data();
    if (&a == &b) return ContourUpdate::nothing;
    const bool same_cells = a.headers.data() == b.headers.data() && a.reals.index() == b.reals.index();
    if (!same_cells) return ContourUpdate::grid;
    const auto positions = [](const core::Packed& packed) {
        return std::visit([](const auto& reals) { return static_cast<const void*>(reals.positions.data()); },
                          packed.reals);
    };
    return positions(a) == positions(b) ? ContourUpdate::field : ContourUpdate::points;
}

} // namespace

/// Starts over with a grid that is packed.
Result<ContourUpdate> Contour::Data::take_packed(ContourInput next, const ContourOptions& next_options, const Run& run) {
    if (auto ok = check_packed_input(next, next_options); !ok) return ok.error();
    Result<ContourInput> fields = fields_for(std::move(next), next_options, run);
    if (!fields) return fields.error();
    const bool was_given = is_given && packed;
    const ContourUpdate update = was_given ? update_between(*packed, *fields->packed) : ContourUpdate::grid;
    std::unique_ptr<EngineGrid> kept;
    if (update == ContourUpdate::nothing && options.engine == next_options.engine) kept = std::move(grid);
    start_over({}, next_options);
    grid = std::move(kept);
    packed = fields->packed;
    is_given = true;
    behind = ContourUpdate::nothing;
    input = *std::move(fields);
    input.packed.reset();
    return update;
}

/// What must be stored again to extract from `next`, linear cells, as `next_options` say.
ContourUpdate Contour::Data::what_changed(const ContourInput& next, const ContourOptions& next_options,
                                          const Run& run) {
    if (!packed || is_given || curved || met || behind == ContourUpdate::grid || options.split_cells != next_options.split_cells ||
        !has_what_is_needed(*packed, next_options, next) || packed->user_point_count() != next.grid.points.tuples())
        return ContourUpdate::grid;
    ContourUpdate update = ContourUpdate::grid;
    core::with_threads(run.threads, [&] {
        if (!cells->is(next.grid)) return;
        if (!points->is(next.grid.points)) update = ContourUpdate::points;
        else if (behind != ContourUpdate::nothing || !field->is(next.field.values) ||
                 packed->field().name != next.field.name)
            update = ContourUpdate::field;
        else update = ContourUpdate::nothing;
        update = std::max(update, update_for(packed->data().frame, next_options.frame));
        if (next_options.frame) update = std::max(update, behind); // what an error left behind
    });
    return update;
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
    std::ranges::move(curved.notes(), std::back_inserter(notes));
    update_seconds += session::seconds_since(start);
    return {};
}

Method Contour::Data::method_of_next(std::size_t isovalues) const {
    if (is_given) return Method::clusters;
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
    pack_options.source_cells = options.pack_all || needs_source_cells(options, input);
    pack_options.split_cells = options.split_cells;
    pack_options.gradients = options.pack_all || options.normals == Normals::gradient;
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
    update_seconds += session::seconds_since(start);
    return {};
}

/// For so many more isovalues: afterwards method_of_next() tells what can be done.
Result<void> Contour::Data::prepare(std::size_t isovalues, const Run& run) {
    if (curved && !curved.grid()) return {}; // extract() refines
    if (method_of_next(isovalues) == Method::direct) return {};
    if (auto all = complete(run); !all) return all;
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
    const ExtractOptions extract = session::extract_options(options, input);
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

} // namespace isotet
