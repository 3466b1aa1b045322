// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "export_grid.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/version.hpp>
#include <isotet/write_file.hpp>

#include "commands.hpp"
#include "console.hpp"
#include "json_output.hpp"
#include "report.hpp"
#include "text.hpp"
#include "view/saved_grid.hpp"

namespace isotet::cli {

namespace {

/// A folder that goes with all it holds.
class PackFolder {
public:
    PackFolder() {
        std::error_code none;
        std::string path = (std::filesystem::temp_directory_path(none) / "isotet-export-XXXXXX").string();
        if (!none && ::mkdtemp(path.data())) path_ = path;
    }
    PackFolder(const PackFolder&) = delete;
    PackFolder& operator=(const PackFolder&) = delete;
    ~PackFolder() {
        std::error_code ignored;
        if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
    }
    const std::string& path() const noexcept { return path_; } ///< empty: it could not be made

private:
    std::string path_;
};

PackJob pack_job_of(const ExportCommand& command, const std::string& out) {
    PackJob job;
    job.grid = command.grid;
    job.all_steps = command.all_steps;
    job.out = out;
    job.cell_field = command.field.cell_field;
    if (command.field.name.empty()) return job;
    job.fields = {command.field.name};
    if (!command.color_by.empty() && command.color_by != command.field.name) job.fields.push_back(command.color_by);
    return job;
}

/// Those by share are of the first step.
Result<std::vector<double>> isovalues_of(const ExportCommand& command, const std::string& field, Console& console) {
    std::vector<double> isovalues = command.isovalues;
    if (command.shares.empty()) return isovalues;
    const auto source = GridSource::open(command.grid, console);
    if (!source) return source.error();
    const auto steps = choose_steps(source->info(), command.grid, Steps::one, console);
    if (!steps) return steps.error();
    Grid grid;
    const auto values = read_field(*source, steps->front(), {field, command.field.cell_field}, {}, console, grid);
    if (!values) return values.error();
    const auto found = isovalues_at(grid, *values, command.shares, console.run());
    if (!found) return found.error();
    isovalues.insert(isovalues.end(), found->begin(), found->end());
    return isovalues;
}

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << file.rdbuf();
    return std::move(bytes).str();
}

std::string grid_table(const ExportCommand& command, const PackNumbers& packed, std::size_t bytes) {
    Table table = facts();
    table.row({"grid", command.grid.file});
    table.row({"cells", grouped(packed.cells)});
    for (const FieldReport& field : packed.fields)
        table.row({"field", fmt::format("{}: {} to {}", field.name, shortest(field.lower), shortest(field.upper))});
    if (packed.steps > 1) table.row({"time steps", grouped(packed.steps)});
    table.row({"packed", format_bytes(packed.bytes)});
    table.row({"file", fmt::format("{} ({})", command.out, format_bytes(bytes))});
    return table.text();
}

Json grid_report(const ExportCommand& command, const PackNumbers& packed, std::size_t bytes) {
    std::vector<std::string> names;
    for (const FieldReport& field : packed.fields) names.push_back(field.name);
    Json report = json_report("export");
    report["kind"] = "grid";
    report["grid"] = json_text(command.grid.file);
    report["cells"] = packed.cells;
    report["fields"] = json_texts(names);
    report["steps"] = packed.steps;
    report["packed_bytes"] = packed.bytes;
    report["file"] = json_text(command.out);
    report["bytes"] = bytes;
    return report;
}

} // namespace

Result<ExitCode> run_export_grid(const ExportCommand& command) {
    Console console(command.common);
    if (ending_of(command.out) != ".html") return usage_error("OUT is '{}', but a page ends in .html", command.out);
    if (Result<void> checked = view::check_grid_pages(); !checked) return checked.error();
    if (Result<void> paths = check_output_paths({command.grid.file}, {command.out, command.common.json}); !paths)
        return paths.error();
    const PackFolder folder;
    if (folder.path().empty()) return Error{ErrorCode::cannot_write, "no folder could be made for the packed grid"};
    const std::string file = folder.path() + "/grid.isotet";
    const Result<PackNumbers> packed = pack_file(pack_job_of(command, file), console);
    if (!packed) return packed.error();

    view::SavedGridOptions options;
    options.file = valid_utf8(std::filesystem::path(command.grid.file).filename().string());
    options.version = ISOTET_VERSION;
    options.state.field = packed->fields.front().name;
    const auto isovalues = isovalues_of(command, options.state.field, console);
    if (!isovalues) return isovalues.error();
    options.state.isovalues = *isovalues;
    options.state.color_by = command.color_by;
    options.notes = console.noted();
    const Result<std::string> html = view::grid_page(bytes_of(file), options);
    if (!html) return html.error();
    const std::uint64_t most = command.max_size.value_or(20'000'000);
    if (html->size() > most)
        return usage_error("the page would have {}, but may have {} (--max-size): name the fields that are wanted, or "
                           "take --as surfaces",
                           format_bytes(html->size()), format_bytes(most));
    console.note(fmt::format("{} will have {}", command.out, format_bytes(html->size())));
    if (Result<void> written = write_text(*html, command.out, console.run()); !written) return written.error();
    return finish(console, command.common, grid_table(command, *packed, html->size()),
                  grid_report(command, *packed, html->size()));
}

} // namespace isotet::cli
