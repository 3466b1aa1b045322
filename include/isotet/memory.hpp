// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <isotet/export.hpp>

namespace isotet {

/// Returns memory that isotet keeps for its next call to the system: large arrays that were given back, at most 1/64 of
/// the machine's memory. Worth a call before the program does something else for long.
///
/// Returns      how many bytes that were; 0 also when there was no memory for that
/// Guarantees   nothing that an object of yours holds is touched
/// Threads      safe from many threads, also while operations run
ISOTET_API std::size_t release_memory() noexcept;

} // namespace isotet
