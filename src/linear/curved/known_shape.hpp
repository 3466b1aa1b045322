// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tetrahedra, pyramids, wedges and hexahedra that are given by their faces.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "grid/cell/split.hpp"
#include "linear/polyhedra/shell.hpp"

namespace isotet::linear {

/// The cell that has these faces; nothing where it is of no known kind.
///
/// `listed`   the cell's points in the order of the file: kept where it is that of a cell of the kind. Otherwise corners are
///            ordered by point numbers, whatever the order of the faces, and the cell is upright
std::optional<core::WholeCell> known_shape(const Shell& shell, std::span<const std::uint64_t> listed,
                                           const core::PointReader& points);

} // namespace isotet::linear
