// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a page begins with, of `isotet view` and `isotet export`.
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

#include "output/console.hpp"
#include "view/server/greeting.hpp"

namespace isotet::cli {

/// Which cells ViewerInput::grid has.
enum class FirstCells : std::uint8_t {
    all,
    some ///< of a packed file, which is then open in ViewerInput::packed
};

/// What the command line says of it.
struct ViewStart {
    const GridOptions& grid;
    const FieldChoice& field;
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
Result<void> check_view_fields(GridSource& source, const ChoiceWish& wish, const GridOptions& grid, Console& console);
/// What is shown, and coloured by another field.
ChoiceWish view_wish(Steps steps, const FieldChoice& field, const std::string& color_by);

/// Reads all fields of the step to begin with, and finds the field. Errors   as choose_first()
Result<view::ViewerInput> read_view_input(const ViewStart& start, GridSource& source, Console& console, const Run& run);

} // namespace isotet::cli
