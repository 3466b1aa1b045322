// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A command that does the same to each of several files.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <isotet/jobs/output_names.hpp>

#include "output/json_output.hpp"

namespace isotet::cli {

struct TableAndJson {
    std::string table;
    Json json;
    ExitCode status = ExitCode::done;
};

/// Calls `work` with each job, prints its table, and goes on after an error, which it says; a cancelled job ends all. The
/// JSON has the report of each file, or its error, under "files". The exit status is the worst.
template <class Job, class Work>
Result<ExitCode> do_each(const std::vector<Job>& jobs, const std::string& command, Console& console,
                         const CommonOptions& common, const Work& work) {
    std::vector<std::string> inputs;
    for (const Job& job : jobs) inputs.push_back(job.grid.file);
    if (auto paths = check_output_paths(inputs, {common.json}); !paths) return paths.error();
    Json files = Json::array();
    ExitCode worst = ExitCode::done;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const std::string& file = jobs[i].grid.file;
        console.detail(fmt::format("file {} of {}: {}", i + 1, jobs.size(), file));
        const Result<TableAndJson> done = work(jobs[i]);
        if (done) {
            if (auto printed = console.print((i > 0 ? "\n" : "") + done->table); !printed) return printed.error();
            files.push_back(done->json);
            worst = std::max(worst, done->status);
            continue;
        }
        if (done.error().code == ErrorCode::cancelled) return done.error();
        say_error(file + ": " + done.error().message);
        files.push_back({{"file", json_text(file)}, {"error", json_text(done.error().message)}});
        worst = std::max(worst, exit_code_of(done.error().code));
    }
    Json report = json_report(command);
    report["files"] = std::move(files);
    return finish(console, common, "", std::move(report), worst);
}

} // namespace isotet::cli
