// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "export_grid.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include <isotet/isosurface_scene.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/version.hpp>
#include <isotet/write.hpp>

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
    job.scalars_only = true; // pages tell of fields one by one
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

/// As isotet view begins with it, of the grid that was packed.
Result<std::optional<std::array<double, 3>>> stretch_of(const PackNumbers& packed, const std::string& path,
                                                        const Run& run) {
    if (!is_of_reservoirs(packed.format)) return std::optional<std::array<double, 3>>();
    const Result<PackedFile> file = PackedFile::open(path, {}, run);
    if (!file) return file.error();
    std::vector<double> corners(file->info().lower.begin(), file->info().lower.end());
    corners.insert(corners.end(), file->info().upper.begin(), file->info().upper.end());
    return default_stretch(Array::own(std::move(corners), 3));
}

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << file.rdbuf();
    return std::move(bytes).str();
}

/// A page, and what was packed for it.
struct GridPage {
    PackNumbers packed;
    std::string html;
    std::size_t left_out = 0; ///< of the fields
};

std::vector<std::string> names_of(const std::vector<FieldReport>& fields) {
    std::vector<std::string> names;
    for (const FieldReport& field : fields) names.push_back(field.name);
    return names;
}

class GridPageMaker {
public:
    GridPageMaker(const ExportCommand& command, std::string folder, Console& console)
        : command_(command), console_(console), job_(pack_job_of(command, folder + "/grid.isotet")) {}

    /// With as many of the fields as fit, if none was named.
    /// Errors   invalid_argument: too large
    Result<GridPage> make(std::uint64_t max_bytes);

private:
    Result<GridPage> page_with(std::vector<std::string> fields);
    Result<GridPage> page_with_first(std::span<const std::string> names, std::size_t count) {
        return page_with({names.begin(), names.begin() + static_cast<std::ptrdiff_t>(count)});
    }
    Result<GridPage> with_fewer_fields(GridPage all, std::uint64_t max_bytes);

    const ExportCommand& command_;
    Console& console_;
    PackJob job_;
    std::optional<std::vector<double>> isovalues_; ///< of the first field
};

Result<GridPage> GridPageMaker::page_with(std::vector<std::string> fields) {
    PackJob job = job_;
    job.fields = std::move(fields);
    Result<PackNumbers> packed = pack_file(job, console_);
    if (!packed) return packed.error();
    view::SavedGridOptions options;
    options.file = valid_utf8(std::filesystem::path(command_.grid.file).filename().string());
    options.version = ISOTET_VERSION;
    options.state.field = packed->fields.front().name;
    if (!isovalues_) {
        auto isovalues = isovalues_of(command_, options.state.field, console_);
        if (!isovalues) return isovalues.error();
        isovalues_ = *std::move(isovalues);
    }
    options.state.isovalues = *isovalues_;
    options.state.color_by = command_.color_by;
    const auto stretch = stretch_of(*packed, job.out, console_.run());
    if (!stretch) return stretch.error();
    options.state.stretch = *stretch;
    options.notes = console_.noted_as_told();
    Result<std::string> html = view::grid_page(bytes_of(job.out), options);
    if (!html) return html.error();
    return GridPage{*std::move(packed), *std::move(html)};
}

/// Sizes are nearly linear in the number of fields: a few pages are made until one more field would be too much.
Result<GridPage> GridPageMaker::with_fewer_fields(GridPage all, std::uint64_t max_bytes) {
    std::vector<std::string> names = names_of(all.packed.fields);
    std::size_t count = 1; ///< of the first ones, which fit
    if (const auto color = std::find(names.begin() + 1, names.end(), command_.color_by); color != names.end()) {
        std::rotate(names.begin() + 1, color, color + 1);
        count = 2;
    }
    if (count == names.size()) return all;
    Result<GridPage> page = page_with_first(names, count);
    std::size_t too_many = names.size(), too_large = all.html.size(); // which do not
    while (page && page->html.size() <= max_bytes && too_many - count > 1) {
        const double share =
            static_cast<double>(max_bytes - page->html.size()) / static_cast<double>(too_large - page->html.size());
        const auto guess = count + static_cast<std::size_t>(share * static_cast<double>(too_many - count));
        const std::size_t next = std::clamp(guess, count + 1, too_many - 1);
        Result<GridPage> larger = page_with_first(names, next);
        if (!larger) return larger;
        if (larger->html.size() <= max_bytes) {
            count = next;
            page = std::move(larger);
        } else {
            too_many = next;
            too_large = larger->html.size();
        }
    }
    if (page) page->left_out = names.size() - count;
    return page;
}

Result<GridPage> GridPageMaker::make(std::uint64_t max_bytes) {
    Result<GridPage> page = page_with(job_.fields);
    if (page && page->html.size() > max_bytes && job_.fields.empty())
        page = with_fewer_fields(*std::move(page), max_bytes);
    if (!page) return page;
    const std::string largest = format_bytes(max_bytes);
    if (page->html.size() > max_bytes)
        return usage_error(
            "the page would have {} with {}, but may have {} (--max-size): --as surfaces makes smaller ones",
            format_bytes(page->html.size()), quoted_list(names_of(page->packed.fields)), largest);
    if (page->left_out > 0)
        console_.note(
            fmt::format("{} of {} fields are in the page, {}: all of them would make it larger than {} (--max-size)",
                        page->packed.fields.size(), page->packed.fields.size() + page->left_out,
                        quoted_list(names_of(page->packed.fields)), largest));
    return page;
}

std::string grid_table(const ExportCommand& command, const GridPage& page) {
    Table table = facts();
    table.row({"grid", command.grid.file});
    table.row({"cells", grouped(page.packed.cells)});
    for (const FieldReport& field : page.packed.fields)
        table.row({"field", fmt::format("{}: {} to {}", field.name, shortest(field.lower), shortest(field.upper))});
    if (page.packed.steps > 1) table.row({"time steps", grouped(page.packed.steps)});
    table.row({"packed", format_bytes(page.packed.bytes)});
    table.row({"file", fmt::format("{} ({})", command.out, format_bytes(page.html.size()))});
    return table.text();
}

Json grid_report(const ExportCommand& command, const GridPage& page) {
    Json report = json_report("export");
    report["kind"] = "grid";
    report["grid"] = json_text(command.grid.file);
    report["cells"] = page.packed.cells;
    report["fields"] = json_texts(names_of(page.packed.fields));
    report["left_out"] = page.left_out;
    report["steps"] = page.packed.steps;
    report["packed_bytes"] = page.packed.bytes;
    report["file"] = json_text(command.out);
    report["bytes"] = page.html.size();
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
    const Result<GridPage> page =
        GridPageMaker(command, folder.path(), console).make(command.max_size.value_or(20'000'000));
    if (!page) return page.error();
    console.note(fmt::format("{} will have {}", command.out, format_bytes(page->html.size())));
    if (Result<void> written = write_text(page->html, command.out, console.run()); !written) return written.error();
    return finish(console, command.common, grid_table(command, *page), grid_report(command, *page));
}

} // namespace isotet::cli
