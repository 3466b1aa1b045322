// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The reference engine's `brute`: its contract written down as plainly as possible, slow, serial, with maps.
#pragma once

#include "ops/brute.hpp"

namespace isotet::reference {

/// Cost     O((T + V) log V), some 50 bytes a tet
/// Errors   invalid_data for a broken grid; cancelled
template <class Real>
Result<ops::BruteResult> extract_brute(const ops::BruteInput& input, const ops::BruteRequest& request,
                                       const Progress& progress);

} // namespace isotet::reference
