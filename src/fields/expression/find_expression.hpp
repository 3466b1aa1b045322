// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>

namespace isotet::core {

/// The field that an expression (expression.hpp) of fields of the grid is.
///
/// `names`   of all fields
/// Errors    as find_field()
Result<PointField> find_expression(const Grid& grid, std::string_view text, const std::vector<std::string>& names,
                                   const FindFieldOptions& options, const Progress& progress);

} // namespace isotet::core
