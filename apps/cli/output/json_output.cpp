// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output/json_output.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <isotet/text.hpp>
#include <isotet/write.hpp>

#include "output/standard_streams.hpp"

namespace isotet::cli {

namespace {

/// Where --json says: standard output ("-"), a file, which is replaced as a whole, or nowhere ("").
Result<void> write_json(const Json& report, const std::string& where, const Run& run) {
    if (where.empty()) return {};
    // All texts are valid UTF-8 by now; "replace" is for one that was forgotten.
    const std::string text = report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    if (where == "-") {
        if (stdout_was_closed()) {
            return Error{ErrorCode::cannot_write,
                         "--json - writes to standard output, which was closed when isotet started"};
        }
        return write_to_stdout(text);
    }
    return write_text(text, where, run);
}

} // namespace

Json json_report(const std::string& command) { return {{"schema", json_schema}, {"command", command}}; }

Json json_text(const std::string& text) { return valid_utf8(text); }

Json json_texts(const std::vector<std::string>& texts) {
    Json list = Json::array();
    for (const std::string& text : texts) list.push_back(json_text(text));
    return list;
}

ExitCode say_broken_steps(const std::vector<BrokenStep>& broken, Json& report) {
    if (broken.empty()) return ExitCode::done;
    ExitCode worst = ExitCode::done;
    Json list = Json::array();
    for (const auto& [step, error] : broken) {
        say_error(fmt::format("time step {} is left out: {}", step, error.message));
        list.push_back({{"step", step}, {"error", json_text(error.message)}});
        worst = std::max(worst, exit_code_of(error.code));
    }
    report["broken_steps"] = std::move(list);
    return worst;
}

Result<ExitCode> finish(Console& console, const CommonOptions& common, std::string_view table, Json report,
                        ExitCode status) {
    if (Result<void> printed = console.print(table); !printed) return printed.error();
    report["notes"] = json_texts(console.noted());
    if (Result<void> written = write_json(report, common.json, console.run()); !written) return written.error();
    return status;
}

} // namespace isotet::cli
