// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet bench`: methods and search indexes against each other.
#include <algorithm>

#include <isotet/paper/measure_methods.hpp>

#include "output/bench_report.hpp"
#include "commands.hpp"
#include "output/console.hpp"
#include "output/json_output.hpp"

namespace isotet::cli {

Result<ExitCode> run_bench(const BenchCommand& command) {
    Console console(command.common);
    BenchJob job = command;
    job.other_outputs = {command.common.json};
    const Result<BenchNumbers> numbers = measure_methods(job, console);
    if (!numbers) return numbers.error();
    const Result<ExitCode> told =
        finish(console, command.common, bench_table(job, *numbers), bench_json(job, *numbers));
    if (!told) return told;
    const bool nothing = std::ranges::none_of(numbers->rows, [](const BenchRow& row) { return row.missing.empty(); });
    if (nothing) return Error{ErrorCode::system, "nothing could be measured: " + numbers->rows.front().missing};
    return told;
}

} // namespace isotet::cli
