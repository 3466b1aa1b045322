// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which step of a file is shown, and which field where none is named: one rule for all commands.
#pragma once

#include <string>
#include <vector>

#include <isotet/first_view.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/result.hpp>

namespace isotet::jobs {

/// What a command shows.
struct FirstChoice {
    std::vector<std::size_t> steps; ///< one, or all of them
    FirstView view; ///< of the first step that was looked at where no field is named; else only the name
};

/// What a choice is asked for.
struct ChoiceWish {
    Steps steps = Steps::one;
    FieldChoice field;               ///< whose variation counts; with a shape that of none
    std::vector<std::string> others; ///< texts as choose_field_names() takes them: the step has these, too. Without a
                                     ///< default: each command says which it needs
    FieldsToRead also{std::vector<std::string>(), std::vector<std::string>()}; ///< will be read in any case
    bool needs_view = true;          ///< where no field is named; else it is not looked for
    bool only_field_will_do = false; ///< the only field of a file is taken unseen
    bool streams =
        false; ///< cells will be read by GridSource::read_active(): none is kept, where a sample tells as much
    bool surveys = false; ///< the grid will be read by GridSource::read_surveyed(), with all fields
};

/// Looks at the step that the options ask for, and else at the first that has all fields that are asked for: of long series
/// at the first that has them of 32 steps, spread evenly, and back from there to where they begin; of up to 1,000 steps then
/// at the first of all others. Nothing is read or noted.
///
/// Returns   the step; of Steps::all the first of all
/// Errors    invalid_argument: a step or time that the file does not have, with those that it has; and as choose_field() of
///           all steps that were looked at, where none has the fields
struct StepLook {
    std::size_t step = 0;
    std::vector<std::string> missing; ///< texts that are not in the first step, where that is another
};
Result<StepLook> look_at_step_with_fields(GridSource& source, const GridOptions& options, const ChoiceWish& wish,
                                          Caller& caller);

/// Chooses the step that the options ask for; else of look_at_step_with_fields() and the step behind it and the last the
/// first where a field varies, and notes which. What is read for that is kept by `source`, if it has all cells; where step and
/// field are known without it, nothing is read.
///
/// Errors   as look_at_step_with_fields(), choose_field() and of reading
Result<FirstChoice> choose_first(GridSource& source, const GridOptions& options, const ChoiceWish& wish, Caller& caller,
                                 const Run& run);

/// "no field was named: 'p', its name, ...": empty where nothing is to be said.
std::string note_of(const FirstView& view);

/// The same where it is not drawn: only which field was taken.
std::string note_of_field(const FirstView& view);

} // namespace isotet::jobs
