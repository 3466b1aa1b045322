// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/first_choice.hpp>

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>

#include "fields/sampled_view.hpp"

namespace isotet::jobs {

namespace {

/// Looks at steps until a field varies.
class FirstLook {
public:
    FirstLook(GridSource& source, const ChoiceWish& wish, Caller& caller, const Run& run)
        : source_(source), wish_(wish), caller_(caller), run_(run) {}

    /// Whether the field, or any field where none is named, varies at a step.
    Result<bool> varies_at(std::size_t step) {
        if (source_.info().times.size() > 1 && (step > 0 || has_looked_))
            if (auto looked = source_.look_at_steps({step}, caller_); !looked) return looked.error();
        has_looked_ = true;
        return wish_.field.name.empty() ? look_for_view(step) : look_at_named(step);
    }

    const FirstView& view() const { return view_; }

    /// The named field is in none of the steps.
    const std::optional<Error>& missing() const { return missing_; }

private:
    Result<bool> look_at_named(std::size_t step) {
        const auto is_missing = [&](const Error& error) {
            if (!was_there_ && !missing_) missing_ = error;
            return false;
        };
        const Result<FoundField> found = choose_field(source_, wish_.field);
        if (!found) return is_missing(found.error());
        FieldsToRead read{found->point, found->cell};
        streams_ = may_stream() && found->cell.empty() && !found->neighbours;
        for (;;) {
            const Result<SurveyedGrid> some = read_with_twins(read, step);
            if (!some && some.error().code == ErrorCode::invalid_argument) return is_missing(some.error());
            if (!some) return some.error();
            was_there_ = true;
            missing_.reset();
            const auto varies = core::field_varies_in_sample(some->read.grid, found->name, some->sampled);
            keep(*some, read, step);
            if (varies) return *varies;
            streams_ = false;
        }
    }

    Result<bool> look_at_surveyed(std::size_t step) {
        Result<SurveyedGrid> all = source_.read_surveyed({}, step, caller_);
        if (!all) return all.error();
        view_ = core::first_view_of_sample(all->read.grid, source_.info().fields, all->sampled);
        source_.keep(*std::move(all), step);
        return shows_a_field();
    }

    /// Formats whose cells are counted tell how many corners there are.
    bool may_stream() const {
        const LeastCounts& least = source_.info().least;
        return wish_.streams && least.corners > 0 && !least.all_cells;
    }

    bool shows_a_field() const {
        return !view_.walls && (view_.draw == FirstDraw::isosurfaces || view_.draw == FirstDraw::field_on_boundary);
    }

    /// With the cell fields that have names of point fields, which tell whether these vary at the walls alone; without them
    /// where they cannot be read.
    Result<SurveyedGrid> read_with_twins(FieldsToRead& read, std::size_t step) {
        FieldsToRead both = read;
        for (const FieldInfo& field : source_.info().fields)
            if (read.point && read.cell && field.association == Association::cell &&
                std::ranges::find(*read.point, field.name) != read.point->end())
                add_names(*both.cell, {field.name});
        if (both != read) {
            Result<SurveyedGrid> some = read_with_others(both, step);
            if (some || some.error().code == ErrorCode::cancelled || some.error().code == ErrorCode::out_of_memory) {
                read = std::move(both);
                return some;
            }
        }
        return read_with_others(read, step);
    }

    /// Names that are preferred are looked at first: most often one of them is taken.
    Result<bool> look_for_view(std::size_t step) {
        if (wish_.surveys) return look_at_surveyed(step);
        constexpr std::size_t most_at_first = 4;
        const std::vector<FieldInfo>& fields = source_.info().fields;
        FieldsToRead read{std::vector<std::string>(), std::vector<std::string>()};
        std::size_t named = 0;
        for (const FirstCandidate& candidate : first_candidates(fields)) {
            if (candidate.reason == FirstReason::variation || named == most_at_first) break;
            auto& names = candidate.association == Association::point ? read.point : read.cell;
            add_names(*names, candidate.arrays);
            ++named;
        }
        if (named > 0 && fields.size() > most_at_first) {
            const Result<SurveyedGrid> some = look([&] { return read_with_twins(read, step); });
            if (!some) return some.error();
            if (!view_.rough && !view_.walls &&
                (view_.reason == FirstReason::marked || view_.reason == FirstReason::name)) {
                keep(*some, read, step);
                return true;
            }
        }
        read = {};
        const Result<SurveyedGrid> some = look([&] { return read_it(read, step); });
        if (!some) return some.error();
        keep(*some, read, step);
        return shows_a_field();
    }

    /// The view of what `read_fields()` reads; all cells where a sample does not tell.
    template <class ReadFields>
    Result<SurveyedGrid> look(const ReadFields& read_fields) {
        for (streams_ = may_stream();; streams_ = false) {
            Result<SurveyedGrid> some = read_fields();
            if (!some) return some;
            bool is_sure = true;
            view_ = core::first_view_of_sample(some->read.grid, source_.info().fields, some->sampled, &is_sure);
            if (is_sure) return some;
        }
    }

    void keep(const SurveyedGrid& some, const FieldsToRead& fields, std::size_t step) {
        if (!some.report) source_.keep(some.read, fields, step);
    }

    Result<SurveyedGrid> read_it(const FieldsToRead& fields, std::size_t step) {
        if (streams_) return source_.read_sample(fields, step, caller_, run_);
        Result<ReadResult> some = source_.read_some(fields, step, caller_, run_);
        if (!some) return some.error();
        return SurveyedGrid{*std::move(some)};
    }

    Result<SurveyedGrid> read_with_others(FieldsToRead& read, std::size_t step) {
        if (streams_) return read_it(read, step); // what is not kept need not have the others
        for (const auto& [names, more] : {std::pair(&read.point, &wish_.also.point), {&read.cell, &wish_.also.cell}}) {
            if (!*more) names->reset();
            else if (*names) add_names(**names, **more);
        }
        return read_it(read, step);
    }

    GridSource& source_;
    const ChoiceWish& wish_;
    Caller& caller_;
    const Run& run_;
    FirstView view_;
    bool has_looked_ = false, was_there_ = false;
    bool streams_ = false; ///< cells of the step at hand are not kept
    std::optional<Error> missing_;
};

bool may_look_on(const Error& error) {
    return error.code != ErrorCode::cancelled && error.code != ErrorCode::out_of_memory;
}

/// What needs no reading: the name that was given, or that of the only field, unless it numbers parts.
std::string known_name(const GridSource& source, const ChoiceWish& wish) {
    if (!wish.field.name.empty()) return wish.field.name;
    const std::vector<FieldInfo>& fields = source.info().fields;
    if (fields.size() != 1 || !wish.only_field_will_do) return {};
    const std::vector<FirstCandidate> candidates = first_candidates(fields);
    const bool may_number = fields[0].association == Association::cell && fields[0].type != ScalarType::float32 &&
                            fields[0].type != ScalarType::float64;
    if (candidates.empty() || (may_number && candidates[0].reason == FirstReason::variation)) return {};
    return candidates[0].name;
}

} // namespace

std::string note_of(const FirstView& view) {
    if (view.field.empty()) return {};
    if (view.draw == FirstDraw::regions_on_boundary)
        return fmt::format("no field was named, and none varies: '{}', numbers of regions, colours the boundary; "
                           "`field` contours a field",
                           view.field);
    const char* how = view.draw != FirstDraw::field_on_boundary ? ""
                      : view.rough ? ", and colours the boundary, for it jumps from cell to cell"
                      : view.flat  ? ", and colours the cells, which are flat"
                                   : ", and colours the boundary, for the grid is one cell thick";
    return fmt::format("no field was named: '{}' was taken ({}){}; `field` names another", view.field,
                       text_of(view.reason), how);
}

std::string note_of_field(const FirstView& view) {
    if (view.field.empty()) return {};
    return fmt::format("no field was named: '{}' was taken ({}); `field` names another", view.field,
                       text_of(view.reason));
}

Result<FirstChoice> choose_first(GridSource& source, const GridOptions& options, const ChoiceWish& wish, Caller& caller,
                                 const Run& run) {
    const std::size_t count = std::max<std::size_t>(source.info().times.size(), 1);
    const bool is_open = count > 1 && wish.steps == Steps::one && !options.time && !options.step;
    FirstChoice choice;
    if (!is_open) {
        auto steps = source.choose_steps(wish.steps, caller);
        if (!steps) return steps.error();
        choice.steps = *std::move(steps);
    }
    const std::string known = known_name(source, wish);
    if (!known.empty()) choice.view = {FirstDraw::isosurfaces, known, Association::point, FirstReason::only, false};
    const bool needs_view = known.empty() && wish.needs_view && !source.info().fields.empty();
    if (!needs_view && !is_open) return choice;
    const std::size_t first = source.first_step();
    std::vector<std::size_t> steps{first};
    if (!is_open && wish.steps == Steps::one) steps = choice.steps;
    else
        for (const std::size_t step : {first + 1, count - 1})
            if (step > steps.back() && step < count) steps.push_back(step);
    FirstLook look(source, wish, caller, run);
    std::size_t taken = steps.front();
    bool varies = false;
    for (std::size_t i = 0; i < steps.size() && !varies; ++i) {
        const Result<bool> found = look.varies_at(steps[i]);
        if (!found && (i == 0 || !may_look_on(found.error()))) return found.error();
        varies = found && *found;
        if (varies) taken = steps[i];
    }
    if (!varies && steps.size() > 1) { // as the first step is
        const Result<bool> found = look.varies_at(steps.front());
        if (!found) return found.error();
    }
    if (look.missing()) return *look.missing();
    if (needs_view) choice.view = look.view();
    if (!is_open) return choice;
    choice.steps = {taken};
    const std::string& name = wish.field.name;
    const std::string why =
        taken == first ? first == 0 ? std::string() : std::string(", the chosen blocks are not in those before")
        : name.empty() ? fmt::format(", and no field varies at step {}", first)
                       : fmt::format(", and '{}' does not vary at step {}", name, first);
    caller.note(fmt::format("the file has {} time steps{}: step {}, time {}, was taken; `time` and `step` choose "
                            "another",
                            count, why, taken, shortest(source.info().times[taken])));
    return choice;
}

} // namespace isotet::jobs
