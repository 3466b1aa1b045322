// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The numbers of `isotet extract`, as a table and as JSON.
#pragma once

#include <string>

#include <isotet/jobs/extract_files.hpp>

#include "output/json_output.hpp"

namespace isotet::cli {

/// The surfaces, then the grid and the field; `verbose`: also how they were made.
std::string extract_table(const ExtractNumbers& numbers, bool verbose);
Json extract_json(const char* command, const ExtractNumbers& numbers);

} // namespace isotet::cli
