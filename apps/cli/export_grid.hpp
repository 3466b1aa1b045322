// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet export --as grid`: a packed grid in a page, with isotet as WebAssembly.
#pragma once

#include <isotet/result.hpp>

#include "exit_code.hpp"
#include "options.hpp"

namespace isotet::cli {

Result<ExitCode> run_export_grid(const ExportCommand& command);

} // namespace isotet::cli
