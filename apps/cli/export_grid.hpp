// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet export` of a packed grid in a page, with isotet as WebAssembly.
#pragma once

#include <optional>

#include <isotet/result.hpp>

#include "output/console.hpp"
#include "exit_code.hpp"
#include "options/options.hpp"

namespace isotet::cli {

/// Nothing: the content is to be what fits, and that is isosurfaces; a note says why.
Result<std::optional<ExitCode>> run_export_grid(const ExportCommand& command, Console& console);

} // namespace isotet::cli
