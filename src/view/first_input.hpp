// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a page of a grid file begins with.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "view/note_keeper.hpp"
#include "view/server/greeting.hpp"

namespace isotet::view {

/// Which cells ViewerInput::grid has.
enum class FirstCells : std::uint8_t {
    all,
    some ///< of a packed file, which is then open in ViewerInput::packed
};

/// What the user says of it.
struct ViewStart {
    const jobs::GridOptions& grid;
    const jobs::FieldChoice& field;
    const std::vector<double>& isovalues;
    const std::vector<IsovalueShare>& shares; ///< more, of the first step
    const std::string& color_by;
    FirstCells cells = FirstCells::all;
    bool isosurfaces_always = true;           ///< else the boundary may stand alone
    std::optional<double> decimal_comma = {}; ///< what two isovalues mean if their comma is a decimal sign
    std::optional<std::uint64_t> memory = {}; ///< of a packed file
};

/// Names that are no field's, before anything is read: of one step, at which the source is looked at, or of all at which it
/// was. Errors   as look_at_step_with_fields()
Result<void> check_view_fields(jobs::GridSource& source, const jobs::ChoiceWish& wish, const jobs::GridOptions& grid,
                               jobs::Caller& caller);
/// What is shown, and coloured by another field.
jobs::ChoiceWish view_wish(jobs::Steps steps, const jobs::FieldChoice& field, const std::string& color_by);

/// Reads all fields of the step to begin with, and finds the field. Errors   as choose_first()
Result<ViewerInput> read_first_input(const ViewStart& start, jobs::GridSource& source, NoteKeeper& caller,
                                     const Run& run);

} // namespace isotet::view
