// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "session/contour_data.hpp"

#include <utility>

#include "base/system/memory.hpp"

namespace isotet {

namespace {

Result<FieldSample> sample_of(const session::Source& source, const ContourOptions& options) {
    return FieldSample::create(source.input().grid, source.input().field, options.split_cells);
}

} // namespace

Result<ContourUpdate> Contour::Data::set(ContourInput next, const ContourOptions& next_options, const Run& run) {
    ++asked.inputs;
    if (next.packed) {
        Result<ContourUpdate> update = state.take_given(next, options, next_options, run);
        if (!update) return update;
        source = session::Source::of_packed(std::move(next));
        look = {};
        options = next_options;
        return update;
    }
    session::Told news;
    Result<session::Source> taken =
        session::Source::take(std::move(next), next_options, source, state.packed().has_value(), run, news);
    if (!taken) return taken.error();
    const bool comparable = taken->may_be_packed() && source.may_be_packed();
    const ContourUpdate update =
        comparable ? state.what_changed(taken->input(), options, next_options, run) : ContourUpdate::grid;
    if (run.progress.cancelled()) return Error{ErrorCode::cancelled, "setting another grid was cancelled"};
    if (update != ContourUpdate::nothing) {
        Result<FieldSample> sample = sample_of(*taken, next_options);
        if (!sample) return sample.error();
        look = {*std::move(sample), {}};
    }
    if (!comparable) state.forget();
    if (options.engine != next_options.engine) state.forget_grid();
    state.fall_behind(update);
    options = next_options;
    if (update == ContourUpdate::grid && packs_aside())
        state.forget(); // what is extracted directly needs no room beside it
    source = *std::move(taken);
    told.add(std::move(news.notes));
    told.seconds += news.seconds;
    if (update == ContourUpdate::nothing && options.method != Method::direct) source.release_cells();
    return update;
}

/// Cells that these isovalues may meet and that are not there.
Result<void> Contour::Data::get_cells_for(std::span<const double> isovalues, const Run& run) {
    if (!source.suffices(isovalues, options))
        if (auto ok = get_all_cells(run); !ok) return ok;
    if (!source.is_too_coarse(isovalues)) return {};
    state.forget(); // the old one goes before the new one comes
    return source.refine_for(isovalues, run, told);
}

Result<void> Contour::Data::get_all_cells(const Run& run) {
    if (!source.is_part()) return {};
    Result<session::Source> all = source.whole(options, source, run, told);
    if (!all) return all.error();
    Result<FieldSample> sample = sample_of(*all, options);
    if (!sample) return sample.error();
    source = *std::move(all);
    look.sample = *std::move(sample);
    return {};
}

/// Another thread may have set other cells since.
Result<void> Contour::Data::keep_all_cells(const session::Source& all, const ContourOptions& of, std::uint64_t inputs) {
    Result<FieldSample> sample = sample_of(all, of);
    if (!sample) return sample.error();
    const std::lock_guard lock(mutex);
    if (asked.inputs != inputs || !source.is_part()) return {};
    source = all;
    look.sample = *std::move(sample);
    return {};
}

Method Contour::Data::method_of_next(std::size_t isovalues) const {
    if (state.is_given()) return Method::clusters;
    if (!options.engine->extracts_directly()) return Method::clusters;
    if (options.method) return *options.method;
    if (source.is_curved()) return Method::direct; // for a few isovalues
    if (packs_aside() && !state.has_cells()) return Method::direct;
    if (direct_for_memory) return Method::direct;
    if (state.packed()) return Method::clusters;
    const std::uint64_t surfaces = options.surfaces ? options.surfaces : asked.surfaces + isovalues;
    return method_for(surfaces, options.normals == Normals::gradient);
}

/// For so many more isovalues: afterwards method_of_next() tells what can be done.
Result<void> Contour::Data::prepare(std::size_t isovalues, const Run& run) {
    if (!source.is_refined()) return {}; // extract() refines
    if (method_of_next(isovalues) == Method::direct) return {};
    if (auto all = get_all_cells(run); !all) return all;
    if (state.is_current()) return state.create_grid(options, run, told);
    const Result<void> ready = state.bring_up_to_date(source, options, run, told);
    if (ready || ready.error().code != ErrorCode::out_of_memory || options.method ||
        !options.engine->extracts_directly())
        return ready;
    Workload work;
    work.points = look.sample.points();
    work.tets = look.sample.tets();
    if (estimate(Method::direct, work).bytes > core::free_memory()) return ready;
    told.notes.push_back(ready.error().message + ": surfaces are extracted directly instead");
    direct_for_memory = true;
    return {};
}

bool Contour::Data::packs_aside() const {
    return options.extract_while_packing && !options.method && options.engine->extracts_directly() &&
           options.engine->is_stateless() && !state.is_given();
}

/// Without the lock while it packs; again where another thread has set something else meanwhile.
Result<void> Contour::Data::pack_aside(const Run& run) {
    session::PackedState made;
    session::Source known;
    ContourOptions of_known;
    for (;;) {
        std::unique_lock lock(mutex);
        if (!packs_aside() || state.has_cells() || source.is_curved()) return prepare(1, run);
        session::Source all = source;
        ContourOptions now = options;
        const std::uint64_t inputs = asked.inputs;
        lock.unlock();
        session::Told news;
        std::optional<FieldSample> sample;
        if (all.is_part()) {
            Result<session::Source> whole = all.whole(now, known, run, news);
            if (!whole) return whole.error();
            all = *std::move(whole);
            Result<FieldSample> of_all = sample_of(all, now);
            if (!of_all) return of_all.error();
            sample = *std::move(of_all);
        }
        if (made.packed()) made.fall_behind(made.what_changed(all.input(), of_known, now, run));
        if (auto ok = made.bring_up_to_date(all, now, run, news); !ok) return ok;
        lock.lock();
        if (asked.inputs == inputs) {
            state = std::move(made);
            source = std::move(all);
            if (sample) look.sample = *std::move(sample);
            told.add(std::move(news.notes));
            told.seconds += news.seconds;
            return {};
        }
        known = std::move(all);
        of_known = std::move(now);
    }
}

const FieldReport& Contour::Data::field_of_curved() {
    if (!look.range) look.range = source.field_of_curved();
    return *look.range;
}

} // namespace isotet
