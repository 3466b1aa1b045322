// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which time steps options ask for, whatever fields they have: what choose_first() begins with.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <isotet/jobs/grid_source.hpp>
#include <isotet/result.hpp>

namespace isotet::jobs {

/// "0, 0.1, 0.2 ... 4": the first few and the last.
std::string list_of(const std::vector<double>& times);

/// The step of a time; of steps of the same time, as restarted runs append them, the last.
/// Errors   invalid_argument: there is none, with those that there are
Result<std::size_t> step_at(const std::vector<double>& times, double time);

/// The steps that --time, --step or --all-steps ask for; the first, with a note, when none does and there are several.
/// Errors   invalid_argument: a step or time that the file does not have, with those that it has
Result<std::vector<std::size_t>> choose_steps(const FileInfo& info, const GridOptions& options, Steps steps,
                                              Caller& caller);

} // namespace isotet::jobs
