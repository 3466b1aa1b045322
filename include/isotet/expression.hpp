// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Fields that are computed: find_field() takes an expression where no field has the name.
//
//   mag(U)   p - 0.5*rho*mag(U)^2   if(alpha.water > 0.5, T, 0)   qcriterion(U)   `wall distance` / 2
//
// docs/expressions.md has names, operators and functions. Computed in double; float32 where all that it is made of is
// float32, else float64. NaN is no data, so what has no value (sqrt(-1), 0/0) is left out. An expression of cell fields
// alone is computed in the cells and averaged to the points; where it has point fields, coordinates or derivatives, cell
// fields are averaged first.
//
// A derivative at a point is the mean over the cells around it of the derivative of the cell's linear interpolation at
// that corner: exact for linear fields. Cells that are not linear are made so first (linearize()).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// What an expression is made of.
struct ExpressionNeeds {
    std::vector<std::string> fields; ///< to read, each once, as files call them
    bool neighbours = false;         ///< it has derivatives: the value at a point follows from all cells around it
};

/// Reads an expression.
///
/// `names`   of the fields that there are
/// Errors    invalid_argument: what is wrong and at which character; a name that no field has, and those that there are
/// Cost      O(length); texts above 4,096 bytes are refused
ISOTET_API Result<ExpressionNeeds> needs_of_expression(std::string_view text, const std::vector<std::string>& names);

/// Whether a text has what names of fields do not: operators, brackets or backquotes.
ISOTET_API bool looks_like_expression(std::string_view text) noexcept;

} // namespace isotet
