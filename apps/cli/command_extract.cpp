// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet extract` and `isotet slice`: from grid files to surface files.
#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/many_files.hpp>
#include <isotet/jobs/slice_files.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "each_file.hpp"
#include "output/extract_report.hpp"

namespace isotet::cli {

namespace {

/// {name} in OUT: each file by itself.
Result<ExitCode> extract_each(const ExtractJob& job, const ExtractCommand& command, Console& console) {
    const auto jobs = job_for_each_file(job);
    if (!jobs) return jobs.error();
    return do_each(*jobs, "extract", console, command.common, [&](const ExtractJob& one) -> Result<TableAndJson> {
        const Result<ExtractNumbers> done = extract_files(one, console);
        if (!done) return done.error();
        Json report = extract_json("extract", *done);
        const ExitCode status = say_broken_steps(done->broken_steps, report);
        return TableAndJson{extract_table(*done, command.common.verbose), std::move(report), status};
    });
}

} // namespace

Result<ExitCode> run_extract(const ExtractCommand& command) {
    Console console(command.common);
    ExtractJob job = command;
    job.other_outputs = {command.common.json};
    if (names_each_file(job)) return extract_each(job, command, console);
    const Result<ExtractNumbers> done = extract_files(job, console);
    if (!done) return done.error();
    Json report = extract_json("extract", *done);
    const ExitCode status = say_broken_steps(done->broken_steps, report);
    return finish(console, command.common, extract_table(*done, command.common.verbose), std::move(report), status);
}

Result<ExitCode> run_slice(const SliceCommand& command) {
    Console console(command.common);
    SliceJob job = command;
    job.other_outputs = {command.common.json};
    const Result<ExtractNumbers> done = slice_files(job, console);
    if (!done) return done.error();
    Json report = extract_json("slice", *done);
    const ExitCode status = say_broken_steps(done->broken_steps, report);
    return finish(console, command.common, extract_table(*done, command.common.verbose), std::move(report), status);
}

} // namespace isotet::cli
