// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One function for each command; each lives in command_NAME.cpp.
#pragma once

#include <string>
#include <vector>

#include <isotet/result.hpp>

#include "exit_code.hpp"
#include "options/options.hpp"

namespace isotet::cli {

struct CommandText;

Result<ExitCode> run_info(const InfoCommand& command);
Result<ExitCode> run_extract(const ExtractCommand& command);
Result<ExitCode> run_slice(const SliceCommand& command);
Result<ExitCode> run_clip(const ClipCommand& command);
Result<ExitCode> run_render(const RenderCommand& command);
Result<ExitCode> run_view(const ViewCommand& command);
Result<ExitCode> run_export(const ExportCommand& command);
Result<ExitCode> run_page(const PageCommand& command);
Result<ExitCode> run_bench(const BenchCommand& command);
Result<ExitCode> run_check(const CheckCommand& command);
Result<ExitCode> run_pack(const PackCommand& command);
Result<ExitCode> run_make(const MakeCommand& command);
Result<ExitCode> run_formats(const FormatsCommand& command);
Result<ExitCode> run_devices(const DevicesCommand& command);
Result<ExitCode> run_docs(const DocsCommand& command, const std::vector<CommandText>& commands);

/// What --version prints.
std::string version_text();

} // namespace isotet::cli
