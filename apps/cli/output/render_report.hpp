// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet render` tells: in the table for people, and in the JSON.
#pragma once

#include <string>

#include <isotet/jobs/draw_files.hpp>

#include "output/json_output.hpp"

namespace isotet::cli {

std::string render_table(const DrawJob& job, const DrawReport& report);
Json render_json(const DrawJob& job, const DrawReport& report);

} // namespace isotet::cli
