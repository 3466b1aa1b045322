// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From the words of the command line to an exit status.
#pragma once

#include <string>
#include <vector>

#include "exit_code.hpp"

namespace isotet::cli {

/// Runs one command line, argv[0] first. What went wrong has been said on standard error.
ExitCode run_program(std::vector<std::string> words);

} // namespace isotet::cli
