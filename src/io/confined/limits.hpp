// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Limits on memory, processor time and files of the reader process. Soft ones: they are set anew for each request.
#pragma once

#include <cstdint>

#include "io/process/messages.hpp"

namespace isotet::io::confined {

/// Limits the address space to what is mapped already and `limit` bytes; 0: what is free. `ran_out` is called when an
/// allocation fails, which then throws std::bad_alloc.
void limit_memory(std::uint64_t limit, void (*ran_out)());

/// Limits the processor time from here on by the size of what may be read, some fifty times what the slowest encoding
/// takes: on some broken files CGNS's library never comes to an end. At the end of it the process
/// says so, calls `ran_out` (in a signal handler) and ends; at a lower limit that it was started with, it is killed.
void limit_processor_time(const Request& request, void (*ran_out)());

/// No file can grow: reading writes none.
void forbid_file_growth();
void allow_file_growth();

} // namespace isotet::io::confined
