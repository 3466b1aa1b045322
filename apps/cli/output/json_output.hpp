// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What --json writes. docs/json.md is the list of keys; they are a promise.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <isotet/jobs/grid_source.hpp>
#include <isotet/result.hpp>

#include "output/console.hpp"
#include "exit_code.hpp"
#include "options/options.hpp"

namespace isotet::cli {

/// An object keeps the order of its keys.
using Json = nlohmann::ordered_json;

/// The number under "schema": it grows when a key changes its meaning or goes; new keys leave it as it is.
constexpr int json_schema = 4;

/// An object with "schema" and "command".
Json json_report(const std::string& command);

/// Text from a file or the command line: bytes that are not UTF-8 become \xNN.
Json json_text(const std::string& text);
Json json_texts(const std::vector<std::string>& texts);

/// Says which time steps could not be read, and adds them to the report. Returns the exit status.
ExitCode say_broken_steps(const std::vector<BrokenStep>& broken, Json& report);

/// The end of a command: prints the table, and writes the report with the notes of the console where --json says.
Result<ExitCode> finish(Console& console, const CommonOptions& common, std::string_view table, Json report,
                        ExitCode status = ExitCode::done);

} // namespace isotet::cli
