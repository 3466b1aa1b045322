// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// ItemType Function of XDMF: an expression of other DataItems.
#pragma once

#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/result.hpp>

namespace isotet::io::confined {

/// "JOIN($0, $1, $2)", "$0 + 2 * SQRT($1)": numbers, items from $0, + - * / and brackets, ABS, SQRT, SIN, COS, TAN, ASIN,
/// ACOS, ATAN, EXP, LOG; JOIN takes the values of its arguments by turns, with semicolons one argument after the other.
/// A single value goes with any number of values.
///
/// Errors   invalid_data: another expression, an item that is not there, numbers of values that do not go together
Result<std::vector<double>> evaluate_function(std::string_view expression, const std::vector<Array>& items);

} // namespace isotet::io::confined
