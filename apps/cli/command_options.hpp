// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The commands and options of the program, as --help lists them.
#pragma once

namespace isotet::cli {

class Command;
struct CommandLine;

/// Adds them all; `line` is filled when the command line is parsed.
void add_commands(const Command& program, CommandLine& line);

} // namespace isotet::cli
