// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From a made grid or a file of any format to the plain arrays of a race.
#pragma once

#include <string>

#include "bench/protocol.hpp"

namespace isotet::bench {

/// Writes the arrays (arrays.hpp) of `source`, "make:kuhn:94" or a path, with the field called `field` into `folder`.
/// Cells with a corner of no data are left out, since VTK has no notion of them, and those that are not contoured.
/// The reply has the counts and the smallest and largest value.
///
/// `variant`  "" as it is; "double": points and values of float64 that float32 cannot hold; "rounded": values are
///            multiples of 1/16, so that many points have an isovalue that is one, too; "no_data": every 97th point has no
///            value (NaN), and no cell is left out for that
Reply write_grid_arrays(const std::string& source, const std::string& field, const std::string& variant,
                        const std::string& folder, int threads);

} // namespace isotet::bench
