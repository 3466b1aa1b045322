// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet page`: a page of one file into which grids are dropped.
#include <fmt/format.h>

#include <isotet/jobs/output_names.hpp>
#include <isotet/text.hpp>
#include <isotet/version.hpp>
#include <isotet/write.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "output/json_output.hpp"
#include "output/report.hpp"
#include "output/text.hpp"
#include "view/export/saved_grid.hpp"

namespace isotet::cli {

Result<ExitCode> run_page(const PageCommand& command) {
    Console console(command.common);
    if (ending_of(command.out) != ".html") return usage_error("OUT is '{}', but a page ends in .html", command.out);
    if (Result<void> paths = check_output_paths({}, {command.out, command.common.json}); !paths) return paths.error();
    const Result<std::string> html = view::empty_page(ISOTET_VERSION);
    if (!html) return html.error();
    if (Result<void> written = write_text(*html, command.out, console.run()); !written) return written.error();
    Table table = facts();
    table.row({"file", fmt::format("{} ({})", command.out, format_bytes(html->size()))});
    Json report = json_report("page");
    report["file"] = json_text(command.out);
    report["bytes"] = html->size();
    return finish(console, command.common, table.text(), std::move(report));
}

} // namespace isotet::cli
