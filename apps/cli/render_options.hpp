// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The command `render` in the option tree.
#pragma once

namespace isotet::cli {

class Command;
struct RenderCommand;

/// Adds the command, apart from what several commands have (reading, device, --json and so on).
Command add_render_command(const Command& program, RenderCommand& render);

} // namespace isotet::cli
