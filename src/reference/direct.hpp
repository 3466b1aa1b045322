// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The reference engine's direct extraction: its contract written down as plainly as possible, slow, serial, with maps.
#pragma once

#include "ops/direct.hpp"

namespace isotet::reference {

/// Cost     O((T + V) log V), some 50 bytes a tet
/// Errors   invalid_data for a broken grid; cancelled
template <class Real>
Result<ops::DirectResult> extract_direct(const ops::DirectInput& input, const ops::DirectRequest& request,
                                       const Progress& progress);

} // namespace isotet::reference
