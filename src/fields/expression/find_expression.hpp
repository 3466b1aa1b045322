// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
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

/// The values of an expression in so many cells, by its text; nothing where it is not one of these fields alone, without
/// derivatives.
ISOTET_API Result<std::optional<Field>> expression_in_cells(const std::vector<Field>& cell_fields, std::size_t cells,
                                                            std::string_view text, const Progress& progress);

} // namespace isotet::core
