// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet extract`: from a grid file to surface files.
#include <isotet/jobs/extract_files.hpp>

#include "commands.hpp"
#include "console.hpp"
#include "extract_report.hpp"

namespace isotet::cli {

Result<ExitCode> run_extract(const ExtractCommand& command) {
    Console console(command.common);
    ExtractJob job = command;
    job.other_outputs = {command.common.json};
    const Result<ExtractNumbers> done = extract_files(job, console);
    if (!done) return done.error();
    return finish(console, command.common, extract_table(*done, command.common.verbose), extract_json(*done));
}

} // namespace isotet::cli
