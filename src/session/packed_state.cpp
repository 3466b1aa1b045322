// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "session/packed_state.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "packed/frame.hpp"
#include "packed/packed.hpp"

namespace isotet::session {

ExtractOptions extract_options(const ContourOptions& options, const ContourInput& input) {
    ExtractOptions extract;
    extract.ties = options.ties;
    const bool exact = options.exact_vertices; // moved vertices need these, and get their normals anew
    extract.normals = exact && options.normals != Normals::gradient ? Normals::none : options.normals;
    extract.edge_ends = options.edge_ends || exact;
    extract.source_cells = options.source_cells || exact;
    extract.point_fields = input.point_fields;
    extract.packed_fields = input.packed_fields;
    extract.cell_fields = input.cell_fields;
    if (!exact) extract.sink = options.sink;
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

/// A packed grid has what it has.
Result<void> check_packed_input(const ContourInput& next, const ContourOptions& options) {
    const PackedGrid& packed = *next.packed;
    const PackReport& report = packed.report();
    const auto lacks = [](bool is, const char* what) -> Result<void> {
        if (!is) return {};
        return invalid_argument(fmt::format("{}, but the packed grid that is given has none", what));
    };
    if (packed.precision() != options.precision)
        return invalid_argument(fmt::format("the packed grid that is given is in {} precision, but {} was asked for",
                                            packed.precision() == Precision::float32 ? "single" : "double",
                                            options.precision == Precision::float32 ? "single" : "double"));
    if (options.method == Method::direct)
        return invalid_argument("direct extraction was asked for, but a packed grid is given, which has clusters");
    if (options.exact_vertices || options.split_cells)
        return invalid_argument(
            "exact vertices or split cells were asked for, but a packed grid is given, whose cells are "
            "as they were packed");
    if (options.frame && packed.data().frame != options.frame)
        return invalid_argument("a frame is given, but the packed grid that is given has another one");
    const bool any = report.points > 0;
    if (auto ok =
            lacks(any && needs_source_cells(options, next) && report.source_bytes == 0, "source cells are needed");
        !ok)
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

void PackedState::forget() {
    grid_.reset();
    packed_.reset();
    is_given_ = false;
    behind_ = ContourUpdate::grid;
}

Result<ContourUpdate> PackedState::take_given(ContourInput& input, const ContourOptions& before,
                                              const ContourOptions& options, const Run& run) {
    if (auto ok = check_packed_input(input, options); !ok) return ok.error();
    Result<ContourInput> fields = fields_for(std::move(input), options, run);
    if (!fields) return fields.error();
    input = *std::move(fields);
    const bool was_given = is_given_ && packed_;
    const ContourUpdate update = was_given ? update_between(*packed_, *input.packed) : ContourUpdate::grid;
    if (update != ContourUpdate::nothing || before.engine != options.engine) grid_.reset();
    packed_ = input.packed;
    is_given_ = true;
    behind_ = ContourUpdate::nothing;
    return update;
}

void PackedState::fall_behind(ContourUpdate update) {
    if (std::exchange(is_given_, false)) packed_.reset();
    behind_ = update;
}

ContourUpdate PackedState::what_changed(const ContourInput& next, const ContourOptions& before,
                                        const ContourOptions& options, const Run& run) {
    if (!packed_ || is_given_ || behind_ == ContourUpdate::grid || before.split_cells != options.split_cells ||
        !has_what_is_needed(*packed_, options, next) || packed_->user_point_count() != next.grid.points.tuples())
        return ContourUpdate::grid;
    ContourUpdate update = ContourUpdate::grid;
    core::with_threads(run.threads, [&] {
        if (!cells_->is(next.grid)) return;
        if (!points_->is(next.grid.points)) update = ContourUpdate::points;
        else if (behind_ != ContourUpdate::nothing || !field_->is(next.field.values) ||
                 packed_->field().name != next.field.name)
            update = ContourUpdate::field;
        else update = ContourUpdate::nothing;
        update = std::max(update, update_for(packed_->data().frame, options.frame));
        if (options.frame) update = std::max(update, behind_); // what an error left behind
    });
    return update;
}

/// The error, or nothing after a note where the CPU may stand in.
Result<void> PackedState::without_engine(const Error& error, ContourOptions& options, Told& told) {
    if (options.engine_required || options.engine->is_stateless() || error.code == ErrorCode::cancelled) return error;
    told.notes.push_back(error.message + ": the CPU extracts instead");
    grid_.reset();
    options.engine = cpu_engine();
    return {};
}

Result<void> PackedState::create_grid(ContourOptions& options, const Run& run, Told& told) {
    if (options.engine->is_stateless() || grid_) return {};
    auto created = options.engine->create_grid(*packed_, run);
    if (!created) return without_engine(created.error(), options, told);
    grid_ = *std::move(created);
    told.add(grid_->notes());
    return {};
}

Result<void> PackedState::pack_grid(const ContourInput& input, const ContourOptions& options, const Run& run) {
    grid_.reset();
    packed_.reset(); // the old one goes before the new one comes
    PackOptions pack_options;
    pack_options.precision = options.precision;
    pack_options.source_cells = options.pack_all || needs_source_cells(options, input);
    pack_options.split_cells = options.split_cells;
    pack_options.gradients = options.pack_all || options.normals == Normals::gradient;
    pack_options.frame = options.frame;
    Result<PackedGrid> made = pack(input.grid, input.field, pack_options, run);
    if (!made) return made.error();
    packed_ = *made;
    core::with_threads(run.threads, [&] {
        cells_.emplace(input.grid);
        points_.emplace(input.grid.points);
    });
    return {};
}

Result<void> PackedState::change_points(const ContourInput& input, ContourOptions& options, const Run& run,
                                        Told& told) {
    if (grid_) {
        const Result<void> changed = grid_->set_points(input.grid.points, run);
        if (changed) packed_ = grid_->packed();
        else if (changed.error().code == ErrorCode::invalid_data) return changed;
        else if (auto instead = without_engine(changed.error(), options, told); !instead) return instead;
    }
    if (!grid_) {
        Result<PackedGrid> changed = packed_->with_points(input.grid.points, run);
        if (!changed) return changed.error();
        packed_ = *changed;
    }
    core::with_threads(run.threads, [&] { points_.emplace(input.grid.points); });
    return {};
}

Result<void> PackedState::change_field(const ContourInput& input, ContourOptions& options, const Run& run, Told& told) {
    if (grid_) {
        const Result<void> changed = grid_->set_field(input.field, run);
        if (changed) {
            packed_ = grid_->packed();
            return {};
        }
        if (auto instead = without_engine(changed.error(), options, told); !instead) return instead;
    }
    Result<PackedGrid> changed = packed_->with_field(input.field, run);
    if (!changed) return changed.error();
    packed_ = *changed;
    return {};
}

Result<void> PackedState::bring_up_to_date(Source& source, ContourOptions& options, const Run& run, Told& told) {
    const core::Stopwatch time;
    const ContourInput& input = source.input();
    if (packed_ && behind_ != ContourUpdate::grid && packed_->data().frame != options.frame) {
        packed_ = packed_->with_frame(options.frame);
        grid_.reset(); // it has the frame from before
    }
    if (packed_ && behind_ == ContourUpdate::points) {
        const Result<void> moved = change_points(input, options, run, told);
        // A tet that turned over, or coordinates that packing has more to say about.
        if (!moved && moved.error().code == ErrorCode::invalid_data) behind_ = ContourUpdate::grid;
        else if (!moved) return moved;
        else behind_ = ContourUpdate::field;
    }
    if (!packed_ || behind_ == ContourUpdate::grid) {
        if (auto ok = pack_grid(input, options, run); !ok) return ok;
    } else if (behind_ == ContourUpdate::field) {
        if (auto ok = change_field(input, options, run, told); !ok) return ok;
    }
    behind_ = ContourUpdate::nothing;
    core::with_threads(run.threads, [&] { field_.emplace(input.field.values); });
    source.release_cells();
    if (auto ok = create_grid(options, run, told); !ok) return ok;
    told.seconds += time.seconds();
    return {};
}

Result<void> PackedState::extract(std::span<const double> isovalues, const Source& source, ContourOptions& options,
                                  const std::shared_ptr<core::RememberingSink>& sink, const Run& run,
                                  ContourResult& result, Told& told) {
    ExtractOptions extract = extract_options(options, source.input());
    if (extract.sink) extract.sink = sink;
    while (grid_ && result.surfaces.size() < isovalues.size()) {
        if (sink) sink->begin_at(result.surfaces.size());
        auto extraction = grid_->extract(isovalues.subspan(result.surfaces.size(), 1), extract, run);
        if (extraction) {
            result.surfaces.push_back(std::move(extraction->front()));
            result.engine = options.engine->name();
            result.work = grid_->work();
        } else if (auto instead = without_engine(extraction.error(), options, told); !instead) {
            return instead;
        }
    }
    return {};
}

} // namespace isotet::session
