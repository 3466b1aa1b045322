// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What find_field() and expressions do with one field.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>

#include "grid/values/scalar_of.hpp"

namespace isotet::core {

/// A field by its name; where `parts` are given, one that is gathered from these. Nothing where it is not there.
Result<std::optional<Field>> find_or_gather(const std::vector<Field>& fields, const FieldName& wanted);

/// Errors   invalid_argument: the field has not one tuple for each `what` of the grid
Result<void> check_length(const Field& field, std::string_view what, std::size_t expected);

/// A cell field averaged to the points of its grid, which is checked first; `by_value` as average_to_points() has it.
Result<Array> average_field(const Grid& grid, const Field& field, Scalar scalar, bool by_value,
                            const Progress& progress);

} // namespace isotet::core
