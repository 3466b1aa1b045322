// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The CPU engine: select, count, scan, emit over clusters, in parallel.
#pragma once

#include "ops/extraction.hpp"

namespace isotet::cpu {

/// Guarantees   the same bytes for any thread count
/// Cost         O(C + V + F); transient memory: 4 bytes a cluster; about 120 a selected cluster; 150 kB a thread
/// Errors       out_of_memory before the surface is allocated; cancelled
template <class Real>
Result<ops::RawSurfaces> extract(const core::Packed& packed, const ops::Request<Real>& request, const Progress& progress);

/// From this many vertices on indices have 64 bits. Tests lower it.
inline std::uint64_t wide_from = std::uint64_t{1} << 32;

} // namespace isotet::cpu
