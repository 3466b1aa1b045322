// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The commands and options of the program, once: parsing, --help, man page, completion and docs/command-line.md all
// come from this tree.
#pragma once

#include <memory>

#include <CLI/CLI.hpp>

#include "options.hpp"

namespace isotet::cli {

/// Builds the tree; parsing it fills `line`, which must outlive it.
///
/// In the tree a type name with bars ("none|gradient|face") is a list of choices, one that ends in FILE is a file's
/// name.
std::unique_ptr<CLI::App> make_option_tree(CommandLine& line);

} // namespace isotet::cli
