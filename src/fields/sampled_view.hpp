// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// first_view() of grids whose cells are not in memory.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/first_view.hpp>

namespace isotet::core {

/// What first_view() says of a grid with all cells, of which `grid` has only those of cells_to_sample(). Cell fields have
/// the values of all cells.
///
/// `numbers`   of these cells; empty where the grid has all
/// `is_sure`   gets false where other cells may tell otherwise: a field has no value in these
ISOTET_API FirstView first_view_of_sample(const Grid& grid, const std::vector<FieldInfo>& fields,
                                          std::span<const std::uint64_t> numbers, bool* is_sure = nullptr);

/// The same of field_varies(). Nothing where other cells may tell otherwise.
ISOTET_API std::optional<bool> field_varies_in_sample(const Grid& grid, std::string_view name,
                                                      std::span<const std::uint64_t> numbers);

} // namespace isotet::core
