// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Lists of numbers with repeat counts: "12*0.3 5 3*" are twelve times 0.3, a 5, and three defaults.
#pragma once

#include <cstdint>
#include <span>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/grdecl/deck.hpp"

namespace isotet::io::grdecl {

/// How many numbers a record stands for, repeats counted; what is no number counts, too.
///
/// Errors   invalid_data: a repeat count that is none, or more than 2^48 numbers; cancelled
/// Cost     parallel
ISOTET_API Result<std::uint64_t> count_values(const Record& record, const Progress& progress);

/// Reads all of them: `to` has room for count_values().
///
/// `unset`   stands for defaults ("3*")
/// Errors    invalid_data: a word that is no number; cancelled
/// Cost      parallel
ISOTET_API Result<void> read_values(const Record& record, double unset, std::span<double> to, const Progress& progress);

} // namespace isotet::io::grdecl
