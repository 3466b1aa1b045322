// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The command `render` in the option tree.
#pragma once

#include <CLI/CLI.hpp>

#include "options.hpp"

namespace isotet::cli {

/// Adds the command, apart from what several commands have (reading, device, --json and so on).
CLI::App& add_render_command(CLI::App& program, RenderCommand& render);

} // namespace isotet::cli
