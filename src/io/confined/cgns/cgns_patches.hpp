// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Boundary conditions of a zone as patches.
#pragma once

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

#include "grid/patches.hpp"
#include "io/confined/cgns/cgns_zone.hpp"

namespace isotet::io::confined {

/// Each is called by its family where it states one. Those at the points of a patch, at its faces, and at ranges of both are
/// read; of structured zones lists of points are not.
///
/// `numbers`   of all zones
/// Errors      invalid_data: points or elements that are not there
Result<BoundaryPatches> cgns_patches(const CgnsTree& tree, const CgnsZone& zone, core::PatchList& numbers);

} // namespace isotet::io::confined
