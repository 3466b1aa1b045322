// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Memory of this process, as the system counts it.
#pragma once

#include <cstdint>
#include <optional>

#include <isotet/export.hpp>

namespace isotet {

/// Bytes of this process that are in the machine's memory: now, and at most since the process began or
/// reset_peak_memory() was called. Nothing where the system does not tell.
/// Threads   safe from many threads
ISOTET_API std::optional<std::uint64_t> resident_memory();
ISOTET_API std::optional<std::uint64_t> peak_resident_memory();

/// Resets the peak-memory counter of the process; false where the system cannot.
ISOTET_API bool reset_peak_memory();

} // namespace isotet
