// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From a made grid or a file of any format to the plain arrays of a race.
#pragma once

#include <string>

#include "bench/protocol.hpp"

namespace isotet::bench {

/// Writes the arrays (arrays.hpp) of `source`, "make:kuhn:94" or a path, with the field called `field` into `folder`.
/// Cells with a corner of no data are left out, since VTK has no notion of them, and those that are not contoured.
/// The reply has the counts and the smallest and largest value.
Reply write_grid_arrays(const std::string& source, const std::string& field, const std::string& folder, int threads);

} // namespace isotet::bench
