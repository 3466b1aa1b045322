// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet extract` will do, decided and checked before anything large is read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/result.hpp>

#include "console.hpp"
#include "field_choice.hpp"
#include "grid_source.hpp"
#include "options.hpp"
#include "output_names.hpp"

namespace isotet::cli {

struct ExtractPlan {
    OutputNames names{""};
    std::string collection; ///< a .pvd file for the series; empty: none
    std::vector<std::size_t> steps;
    FoundField field;
    std::optional<CarriedFields> carried; ///< nothing: all point fields
    FieldsToRead read;
    ContourOptions contour; ///< but for the device and the number of surfaces
};

/// Errors   invalid_argument: OUT, a field, a step or a combination of options is wrong
Result<ExtractPlan> plan_extract(const ExtractCommand& command, const GridSource& source, Console& console);

/// The isovalues to extract: those given (snapped if asked to), --levels of the packed field's range, or its middle.
/// Errors   invalid_data: levels of a field without a finite value
Result<std::vector<double>> choose_isovalues(const ExtractCommand& command, const Array& field,
                                             const FieldReport& packed, Console& console);

/// The fields of the plan, taken from the grid of one step.
struct StepFields {
    std::vector<Field> point, cell;
};
Result<StepFields> carried_fields(const ExtractPlan& plan, const Grid& grid, const Run& run);

} // namespace isotet::cli
