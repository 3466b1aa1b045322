// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Progress as the user is promised it: one call at a time, and never backwards.
#pragma once

#include <isotet/export.hpp>
#include <isotet/progress.hpp>

namespace isotet::core {

/// The same progress, for one operation: of each step only fractions that rise are passed on, whichever thread reports
/// them and however often the step begins anew. A thread that reports while another does is not waited for.
///
/// `progress`   borrowed; must outlive what is returned
/// Threads      what is returned may be called from many threads
ISOTET_API Progress rising(const Progress& progress);

} // namespace isotet::core
