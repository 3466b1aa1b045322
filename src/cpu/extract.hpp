// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The CPU engine: select, count, scan, emit over clusters, in parallel.
#pragma once

#include "ops/extraction.hpp"

namespace isotet::cpu {

/// Guarantees   the same bytes for any thread count
/// Cost         O(C + V + F). Transient memory: 4 bytes a cluster; for each cluster and isovalue that selects it about
///              100, with the masks of its seam edges (one bit each); about 10 bytes a triangle, at most 40; 0.7 MB a
///              thread
/// Errors       out_of_memory, before records and surfaces take any; invalid_argument when isovalues select clusters
///              2^32 times or more; cancelled
template <class Real>
Result<ops::RawSurfaces> extract(const core::Packed& packed, const ops::Request<Real>& request,
                                 const Progress& progress);

/// From this many vertices on indices have 64 bits. Tests lower it.
inline std::uint64_t wide_from = std::uint64_t{1} << 32;

} // namespace isotet::cpu
