// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Points that lie on each other: topology goes by number, so a surface is open where they do.
#pragma once

#include <string>

#include <isotet/grid.hpp>

namespace isotet::cli {

/// A sentence for the user when more than a thousandth of the points that cells use have the coordinates of another
/// one; empty otherwise.
///
/// On large grids one point in a few is looked at, chosen by its coordinates, so that points that coincide are all
/// looked at or none is. The grid need not have been checked. Cost   one pass over the points; one over the
/// connectivity only when there may be something to say
std::string coincident_points_note(const Grid& grid);

} // namespace isotet::cli
