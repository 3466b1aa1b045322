// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet formats`: what can be read and written.
#include <isotet/jobs/output_names.hpp>
#include <isotet/read.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "output/json_output.hpp"
#include "output/report.hpp"

namespace isotet::cli {

namespace {

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

std::string access(bool reads, bool writes) {
    if (reads && writes) return "read, write";
    return reads ? "read" : writes ? "write" : "";
}

} // namespace

Result<ExitCode> run_formats(const FormatsCommand& command) {
    Console console(command.common);
    if (Result<void> paths = check_output_paths({}, {command.common.json}); !paths) return paths.error();
    using enum Table::Align;
    Table table({left, left, left, left, left});
    table.row({"name", "grid", "surface", "endings", "what it is"});
    Json list = Json::array();
    for (const Format& format : formats()) {
        table.row({format.name, access(format.reads_grid, format.writes_grid),
                   access(format.reads_surface, format.writes_surface), joined(format.extensions), format.title});
        list.push_back({{"name", format.name},
                        {"title", format.title},
                        {"extensions", format.extensions},
                        {"reads_grid", format.reads_grid},
                        {"writes_grid", format.writes_grid},
                        {"reads_surface", format.reads_surface},
                        {"writes_surface", format.writes_surface},
                        {"reader_process", format.reader_process}});
    }
    Json report = json_report("formats");
    report["formats"] = std::move(list);
    return finish(console, command.common, table.text(), std::move(report));
}

} // namespace isotet::cli
