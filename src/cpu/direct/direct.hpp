// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The CPU engine's direct extraction: one pass over all cells, edges welded range by range of point numbers, in parallel.
#pragma once

#include "ops/direct.hpp"

namespace isotet::cpu {

/// Guarantees   the same bytes for any thread count
/// Cost         one pass over points and cells for each isovalue; two more, and another extraction, where the points
///              that decide on the storage (the ends of the range, say) turn out to be used by no tet
/// Errors       invalid_data for a broken grid; out_of_memory before memory is taken; cancelled
template <class Real>
Result<ops::DirectResult> extract_direct(const ops::DirectInput& input, const ops::DirectRequest& request,
                                         const Progress& progress);

namespace direct {
/// From this many points on, or so many edges found by active tets, point numbers of welding have 64 bits. Tests lower it.
inline std::uint64_t wide_points_from = std::uint64_t{1} << 31;
} // namespace direct

} // namespace isotet::cpu
