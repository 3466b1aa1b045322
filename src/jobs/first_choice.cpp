// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/first_choice.hpp>

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>

#include "fields/sampled_view.hpp"
#include "jobs/refuse.hpp"
#include "jobs/step_choice.hpp"

namespace isotet::jobs {

namespace {

bool may_look_on(const Error& error) {
    return error.code != ErrorCode::cancelled && error.code != ErrorCode::out_of_memory;
}

/// The fields besides the one that is contoured.
Result<std::vector<std::string>> other_names(const GridSource& source, const ChoiceWish& wish) {
    std::vector<std::string> texts = wish.others;
    std::erase(texts, std::string());
    return choose_field_names(source, texts, {});
}

bool names_a_field(const ChoiceWish& wish) { return !wish.field.shape && !wish.field.name.empty(); }

/// Texts of which the step that was looked at lacks a field.
std::vector<std::string> missing_in(const GridSource& source, const ChoiceWish& wish) {
    std::vector<std::string> missing;
    if (names_a_field(wish) && !choose_field(source, wish.field)) missing.push_back(wish.field.name);
    for (const std::string& text : wish.others)
        if (!text.empty() && !choose_field_names(source, {text}, {})) add_names(missing, {text});
    return missing;
}

/// The first step behind the first that has all fields; nothing: none has them, and the source was looked at for all that
/// were looked at. A step that cannot be looked at has nothing.
Result<std::optional<std::size_t>> step_with_all_fields(GridSource& source, const ChoiceWish& wish, Caller& caller) {
    const std::size_t first = source.first_step(), count = source.info().times.size();
    const auto has_all = [&](std::size_t step) -> Result<bool> {
        if (auto looked = source.look_at_steps({step}, caller); !looked) {
            if (may_look_on(looked.error())) return false;
            return looked.error();
        }
        return missing_in(source, wish).empty();
    };
    auto found = first_step_with(first, count, has_all);
    if (!found || *found) return found;
    std::vector<std::size_t> all = steps_to_look_at(first, count);
    all.insert(all.begin(), first);
    if (auto looked = source.look_at_steps(all, caller); !looked) return looked.error();
    return found;
}

/// Why no step has all fields: the source was looked at for all of them.
Error no_step_with(const GridSource& source, const ChoiceWish& wish) {
    std::vector<std::string> all;
    if (names_a_field(wish)) {
        if (const auto found = choose_field(source, wish.field); !found) return found.error();
        all.push_back(wish.field.name);
    }
    const auto others = other_names(source, wish);
    if (!others) return others.error();
    add_names(all, *others);
    return refusal("no time step has all of these fields: {}", quoted_list(all));
}

/// Looks at steps until a field varies.
class FirstLook {
public:
    FirstLook(GridSource& source, const ChoiceWish& wish, Caller& caller, const Run& run)
        : source_(source), wish_(wish), caller_(caller), run_(run) {}

    /// Whether the field, or any field where none is named, varies at a step.
    /// `with_others`   and the step has all fields that are asked for
    Result<bool> varies_at(std::size_t step, bool with_others) {
        if (auto looked = source_.look_at_steps({step}, caller_); !looked) return looked.error();
        if (with_others && !missing_in(source_, wish_).empty()) return false;
        also_ = wish_.also;
        add_others();
        return wish_.field.name.empty() ? look_for_view(step) : look_at_named(step);
    }

    const FirstView& view() const { return view_; }

    /// The named field is in none of the steps.
    const std::optional<Error>& missing() const { return missing_; }

private:
    /// What will be read of the step in any case.
    void add_others() {
        const auto names = other_names(source_, wish_);
        for (const std::string& name : names ? *names : std::vector<std::string>()) {
            const Result<FoundField> found = choose_field(source_, {name, false});
            if (found && also_.point) add_names(*also_.point, found->point);
            if (found && also_.cell) add_names(*also_.cell, found->cell);
        }
    }

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

    bool may_stream() const { return wish_.streams && source_.may_stream(); }

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
            const bool is_sure = candidate.reason == FirstReason::marked || candidate.reason == FirstReason::name;
            if (!is_sure || named == most_at_first) break;
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
        for (const auto& [names, more] : {std::pair(&read.point, &also_.point), {&read.cell, &also_.cell}}) {
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
    FieldsToRead also_;
    bool was_there_ = false;
    bool streams_ = false; ///< cells of the step at hand are not kept
    std::optional<Error> missing_;
};

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

FirstView view_of_only(const std::string& field) {
    return {FirstDraw::isosurfaces, field, Association::point, FirstReason::only, false};
}

/// Why a step was taken, and not the first.
std::string why_taken(const GridSource& source, const ChoiceWish& wish, const StepLook& start, std::size_t taken) {
    const std::size_t first = source.first_step();
    if (!start.missing.empty()) return fmt::format(", and step {} has no {}", first, quoted_list(start.missing));
    if (taken == first) return source.why_first_step();
    if (wish.field.name.empty()) return fmt::format(", and no field varies at step {}", first);
    return fmt::format(", and '{}' does not vary at step {}", wish.field.name, first);
}

/// Of some steps the first that can be read and where a field varies, else the first that can be read: at which `look` looked
/// last. Errors   of the first step, where none can be read
Result<std::size_t> step_that_varies(FirstLook& look, const std::vector<std::size_t>& steps, bool is_open,
                                     Caller& caller) {
    std::optional<Error> failed;
    std::optional<std::size_t> sound;
    for (const std::size_t step : steps) {
        const Result<bool> varies = look.varies_at(step, is_open);
        if (!varies && !may_look_on(varies.error())) return varies.error();
        if (varies && !sound) sound = step;
        if (!varies && !sound && is_open)
            caller.note(fmt::format("step {} cannot be taken: {}", step, varies.error().message));
        if (!varies && !failed) failed = varies.error();
        if (varies && *varies) return step;
    }
    if (!sound) return *failed;
    if (steps.back() != *sound)
        if (const Result<bool> again = look.varies_at(*sound, is_open); !again) return again.error();
    return *sound;
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

Result<StepLook> look_at_step_with_fields(GridSource& source, const GridOptions& options, const ChoiceWish& wish,
                                          Caller& caller) {
    const bool is_open = source.info().times.size() > 1 && wish.steps == Steps::one && !options.time && !options.step;
    const std::size_t first = source.first_step();
    if (wish.steps == Steps::all) return StepLook{first, {}};
    if (!is_open) {
        const auto steps = choose_steps(source.info(), options, wish.steps, caller);
        if (!steps) return steps.error();
        return StepLook{steps->front(), {}};
    }
    if (auto looked = source.look_at_steps({first}, caller); !looked) return looked.error();
    ChoiceWish all = wish;
    all.others.push_back(options.displace);
    std::vector<std::string> missing = missing_in(source, all);
    if (missing.empty()) return StepLook{first, {}};
    const auto found = step_with_all_fields(source, all, caller);
    if (!found) return found.error();
    if (!*found) return no_step_with(source, all);
    return StepLook{**found, std::move(missing)};
}

Result<FirstChoice> choose_first(GridSource& source, const GridOptions& options, const ChoiceWish& wish, Caller& caller,
                                 const Run& run) {
    const std::size_t count = std::max<std::size_t>(source.info().times.size(), 1);
    const bool is_open = count > 1 && wish.steps == Steps::one && !options.time && !options.step;
    FirstChoice choice;
    StepLook start{source.first_step(), {}};
    if (is_open) {
        Result<StepLook> looked = look_at_step_with_fields(source, options, wish, caller);
        if (!looked) return looked.error();
        start = *std::move(looked);
    } else {
        auto steps = wish.steps == Steps::all ? source.choose_steps(wish.steps, caller)
                                              : choose_steps(source.info(), options, wish.steps, caller);
        if (!steps) return steps.error();
        choice.steps = *std::move(steps);
    }
    const std::string only = known_name(source, wish), &named = wish.field.name;
    const std::string known = count > 1 ? named : only; // later steps may have others
    if (!known.empty()) choice.view = view_of_only(known);
    const bool may_have_fields = count > 1 || !source.info().fields.empty(); // the first step may have none
    const bool needs_view = known.empty() && wish.needs_view && may_have_fields;
    if (!needs_view && !is_open) return choice;
    std::vector<std::size_t> steps{start.step};
    if (!is_open && wish.steps == Steps::one) steps = choice.steps;
    else if (!wish.field.shape)
        for (const std::size_t step : {start.step + 1, count - 1})
            if (step > steps.back() && step < count) steps.push_back(step);
    FirstLook look(source, wish, caller, run);
    std::size_t taken = steps.front();
    if (!wish.field.shape) {
        const Result<std::size_t> found = step_that_varies(look, steps, is_open, caller);
        if (!found) return found.error();
        taken = *found;
    }
    if (look.missing()) return *look.missing();
    if (needs_view) choice.view = look.view();
    if (needs_view && choice.view.field.empty() && !only.empty()) choice.view = view_of_only(only);
    if (!is_open) return choice;
    choice.steps = {taken};
    caller.note(note_of_step(source.info().times, taken, why_taken(source, wish, start, taken)));
    return choice;
}

} // namespace isotet::jobs
