// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Resident memory of this process, as Linux counts it. C++17.
#pragma once

#include <cstdint>

namespace isotet::bench {

std::uint64_t resident_bytes();

/// The most since the process began, or since start_peak().
std::uint64_t peak_bytes();

/// Gives back what the allocator keeps for later, so that it is counted when it is used again, and forgets the peak.
void start_peak();

} // namespace isotet::bench
