// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The parent's side: one request, one reader process, one reply.
#pragma once

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/process/messages.hpp"

namespace isotet::io::confined {

/// Sends a request to a new reader process and takes its reply.
///
/// Errors   what the reader found; invalid_data when it crashed, or ended by itself without a reply; out_of_memory when
///          it hit its limit; machine when it cannot be started or took longer than ReadOptions::time_limit; cancelled
Result<Reply> ask_reader_process(Request request, const Progress& progress);

} // namespace isotet::io::confined
