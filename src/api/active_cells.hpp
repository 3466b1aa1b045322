// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What extract_direct() and ActiveCellFilter ask of the same arguments.
#pragma once

#include <cstddef>
#include <span>

#include <isotet/extract.hpp>

namespace isotet::api {

/// Errors   invalid_argument: an extraction with these options needs cells that isovalues do not cut
Result<void> check_active_cells_do(const DirectOptions& options);

/// Fields against the grid's points; the contoured one in the words of pack().
/// Errors   invalid_argument
Result<void> check_point_fields(std::size_t points, const PointField& field, std::span<const Field> carried);

} // namespace isotet::api
