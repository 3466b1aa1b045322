// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet extract` and `isotet slice`: from a grid file to surface files.
#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/slice_files.hpp>

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
    return finish(console, command.common, extract_table(*done, command.common.verbose), extract_json("extract", *done));
}

Result<ExitCode> run_slice(const SliceCommand& command) {
    Console console(command.common);
    SliceJob job = command;
    job.other_outputs = {command.common.json};
    const Result<ExtractNumbers> done = slice_files(job, console);
    if (!done) return done.error();
    return finish(console, command.common, extract_table(*done, command.common.verbose), extract_json("slice", *done));
}

} // namespace isotet::cli
