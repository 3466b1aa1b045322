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
#include <fmt/ranges.h>

#include <isotet/first_view.hpp>
#include <isotet/isosurface_scene.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/version.hpp>
#include <isotet/write.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "output/json_output.hpp"
#include "output/report.hpp"
#include "output/text.hpp"
#include "view_input.hpp"
#include "view/server/greeting.hpp"
#include "view/export/saved_grid.hpp"

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

/// Looks without telling.
class Silent : public Caller {
public:
    explicit Silent(const Run& run) { run_ = run; }
    void note(const std::string&) override {}
    void detail(const std::string&) override {}
};

PackJob pack_job_of(const ExportCommand& command, const FirstChoice& choice, const std::string& out) {
    PackJob job;
    job.grid = command.grid;
    if (!command.all_steps && !choice.steps.empty()) {
        job.grid.time.reset();
        job.grid.step = choice.steps.front();
    }
    job.all_steps = command.all_steps;
    job.out = out;
    job.cell_field = command.field.cell_field;
    job.scalars_only = true; // pages tell of fields one by one
    job.coordinates_do = true;
    if (command.field.name.empty()) return job;
    job.fields = {command.field.name};
    if (!command.color_by.empty() && command.color_by != command.field.name) job.fields.push_back(command.color_by);
    return job;
}

/// Those by share are of the first step.
Result<std::vector<double>> isovalues_of(const ExportCommand& command, const GridOptions& grid_options,
                                         const std::string& field, Console& console) {
    std::vector<double> isovalues = command.isovalues;
    if (command.shares.empty()) return isovalues;
    auto source = GridSource::open(grid_options, console);
    if (!source) return source.error();
    const FieldChoice choice{field, command.field.cell_field};
    const auto look = look_at_step_with_fields(*source, grid_options, {Steps::one, choice, {}}, console);
    if (!look) return look.error();
    Grid grid;
    const auto values = read_field(*source, look->step, choice, {}, console, grid);
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
    bool rounded = false;
};

std::vector<std::string> names_of(const std::vector<FieldReport>& fields) {
    std::vector<std::string> names;
    for (const FieldReport& field : fields) names.push_back(field.name);
    return names;
}

class GridPageMaker {
public:
    GridPageMaker(const ExportCommand& command, const std::string& folder, const FirstChoice& choice, Console& console)
        : command_(command), console_(console), job_(pack_job_of(command, choice, folder + "/grid.isotet")) {
        if (command.field.name.empty()) first_ = choice.view;
        if (command.all_steps && !choice.steps.empty()) first_step_ = choice.steps.front();
    }

    /// With as many of the fields as fit, if none was named; then with values of 16 bits. It may still be too large.
    Result<GridPage> make(std::uint64_t max_bytes);

private:
    Result<GridPage> page_with(std::vector<std::string> fields);
    Result<GridPage> page_with_all();
    view::ViewState state_of(const std::vector<std::string>& fields) const;
    void tell(const GridPage& page, std::uint64_t max_bytes);
    Result<GridPage> page_with_first(std::span<const std::string> names, std::size_t count) {
        return page_with({names.begin(), names.begin() + static_cast<std::ptrdiff_t>(count)});
    }
    Result<GridPage> with_fewer_fields(GridPage all, std::uint64_t max_bytes);

    const ExportCommand& command_;
    Console& console_;
    PackJob job_;
    std::optional<FirstView> first_;               ///< where no field was named
    std::optional<std::size_t> first_step_;        ///< of all steps: one in which the field varies
    std::optional<std::vector<double>> isovalues_; ///< of the field that is shown first
};

/// A page has no cell fields: regions are not coloured.
view::ViewState GridPageMaker::state_of(const std::vector<std::string>& fields) const {
    view::ViewState state;
    const bool isovalues_are_given = !command_.isovalues.empty() || !command_.shares.empty();
    if (first_ && !isovalues_are_given) {
        view::take_first_view(*first_, state);
        if (first_->association == Association::cell) {
            state.color_by.clear();
            state.colored_boundary = false;
        }
    }
    if (std::ranges::find(fields, state.field) == fields.end()) state.field = fields.front();
    if (!command_.color_by.empty()) state.color_by = command_.color_by;
    return state;
}

Result<GridPage> GridPageMaker::page_with(std::vector<std::string> fields) {
    PackJob job = job_;
    job.fields = std::move(fields);
    Result<PackNumbers> packed = pack_file(job, console_);
    if (!packed) return packed.error();
    view::SavedGridOptions options;
    options.file = valid_utf8(std::filesystem::path(command_.grid.file).filename().string());
    options.version = ISOTET_VERSION;
    options.state = state_of(names_of(packed->fields));
    if (first_step_ && packed->steps > 1) options.state.step = std::min(*first_step_, packed->steps - 1);
    if (!isovalues_) {
        auto isovalues = isovalues_of(command_, job.grid, options.state.field, console_);
        if (!isovalues) return isovalues.error();
        isovalues_ = *std::move(isovalues);
    }
    options.state.isovalues = *isovalues_;
    const auto stretch = stretch_of(*packed, job.out, console_.run());
    if (!stretch) return stretch.error();
    options.state.stretch = *stretch;
    options.notes = console_.noted_as_told();
    Result<std::string> html = view::grid_page(bytes_of(job.out), options);
    if (!html) return html.error();
    return GridPage{*std::move(packed), *std::move(html), 0, job.value_bits.has_value()};
}

/// The field that is shown first before others, though it may be a component or of cells.
Result<GridPage> GridPageMaker::page_with_all() {
    Result<GridPage> page = page_with(job_.fields);
    if (!page || !job_.fields.empty() || !first_ || first_->field.empty()) return page;
    std::vector<std::string> names = names_of(page->packed.fields);
    const auto first = std::ranges::find(names, first_->field);
    if (first != names.end()) return page;
    names.insert(names.begin(), first_->field);
    return page_with(std::move(names));
}

/// Sizes are nearly linear in the number of fields: a few pages are made until one more field would be too much.
Result<GridPage> GridPageMaker::with_fewer_fields(GridPage all, std::uint64_t max_bytes) {
    std::vector<std::string> names = names_of(all.packed.fields);
    if (const auto first = std::ranges::find(names, first_ ? first_->field : std::string()); first != names.end())
        std::rotate(names.begin(), first, first + 1);
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

void GridPageMaker::tell(const GridPage& page, std::uint64_t max_bytes) {
    const std::string reason = fmt::format("larger than {} (--max-size)", format_bytes(max_bytes));
    if (page.left_out > 0)
        console_.note(fmt::format("{} of {} fields are in the page, {}: all of them would make it {}",
                                  page.packed.fields.size(), page.packed.fields.size() + page.left_out,
                                  quoted_list(names_of(page.packed.fields)), reason));
    if (!page.rounded) return;
    std::vector<std::string> changes;
    for (std::size_t i = 0; i < page.packed.fields.size(); ++i)
        changes.push_back(
            fmt::format("'{}' by at most {}", page.packed.fields[i].name, rounded(page.packed.rounded_by[i])));
    console_.note(fmt::format("values are rounded to 16 bits of their range, {}: else the page would be {}",
                              fmt::join(changes, ", "), reason));
}

Result<GridPage> GridPageMaker::make(std::uint64_t max_bytes) {
    Result<GridPage> page = page_with_all();
    if (page && page->html.size() > max_bytes && job_.fields.empty())
        page = with_fewer_fields(*std::move(page), max_bytes);
    // Values are less than two thirds of a page.
    if (page && page->html.size() > max_bytes && page->html.size() / 3 < max_bytes) {
        job_.value_bits = 16;
        const std::size_t left_out = page->left_out;
        page = page_with(names_of(page->packed.fields));
        if (page) page->left_out = left_out;
    }
    if (page && page->html.size() <= max_bytes) tell(*page, max_bytes);
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
    if (page.rounded) report["rounded_by"] = page.packed.rounded_by;
    report["steps"] = page.packed.steps;
    report["packed_bytes"] = page.packed.bytes;
    report["file"] = json_text(command.out);
    report["bytes"] = page.html.size();
    return report;
}

} // namespace

Result<std::optional<ExitCode>> run_export_grid(const ExportCommand& command, Console& console) {
    const bool must_be = command.content == PageContent::grid;
    const std::optional<ExitCode> surfaces_instead;
    if (ending_of(command.out) != ".html") return usage_error("OUT is '{}', but a page ends in .html", command.out);
    if (Result<void> checked = view::check_grid_pages(); !checked) return checked.error();
    Result<GridSource> source = GridSource::open(command.grid, console);
    if (!source) return source.error();
    if (Result<void> paths = check_output_paths(source->info().files, {command.out, command.common.json}); !paths)
        return paths.error();
    const std::uint64_t max_bytes = command.max_size.value_or(20'000'000);
    const auto instead = [&](const std::string& why) {
        console.note(fmt::format("{}: the page has isosurfaces in place of the grid", why));
        return surfaces_instead;
    };
    constexpr std::uint64_t least_bytes_a_cell = 3;
    if (!must_be && source->info().cells > max_bytes / least_bytes_a_cell)
        return instead(
            fmt::format("the grid would make the page larger than {} (--max-size)", format_bytes(max_bytes)));
    ChoiceWish wish = view_wish(Steps::one, command.field, command.color_by);
    if (auto found = check_view_fields(*source, wish, command.grid, console); !found) return found.error();
    if (!command.color_by.empty()) {
        const Result<FoundField> color = choose_field(*source, {command.color_by, false});
        if (!color) return color.error();
        if (!color->cell.empty()) {
            const std::string why = fmt::format("'{}', of cells, colours surfaces", command.color_by);
            if (!must_be) return instead(why);
            return usage_error("{}, but a page with the grid has fields of points only: --as surfaces", why);
        }
    }
    wish.needs_view = command.field.name.empty();
    Silent silent(console.run());
    Caller& told = command.all_steps ? static_cast<Caller&>(silent) : console;
    const Result<FirstChoice> choice = choose_first(*source, command.grid, wish, told, console.run());
    if (!choice) return choice.error();
    if (const FirstView& view = choice->view; command.field.name.empty() && !must_be) {
        if (view.field.empty()) return surfaces_instead;
        if (view.draw != FirstDraw::isosurfaces && view.association == Association::cell)
            return instead(fmt::format("'{}', of cells, colours the boundary", view.field));
    }
    const PackFolder folder;
    if (folder.path().empty()) return Error{ErrorCode::cannot_write, "no folder could be made for the packed grid"};
    const Result<GridPage> page = GridPageMaker(command, folder.path(), *choice, console).make(max_bytes);
    if (!page) return page.error();
    if (page->packed.curved_cells > 0) {
        const std::string cells = fmt::format("{} curved cells", grouped(page->packed.curved_cells));
        if (!must_be) return instead(cells + " are refined for isosurfaces alone");
        console.note(cells + " are split at their nodes in a page with the grid: --as surfaces refines them");
    }
    if (page->html.size() > max_bytes) {
        const std::string size = format_bytes(page->html.size()), largest = format_bytes(max_bytes);
        if (!must_be)
            return instead(
                fmt::format("with the grid the page would have {}, but may have {} (--max-size)", size, largest));
        return usage_error(
            "the page would have {} with {}, but may have {} (--max-size): --as surfaces makes smaller ones", size,
            quoted_list(names_of(page->packed.fields)), largest);
    }
    if (!must_be) console.note("the page has the grid: --as surfaces makes one of isosurfaces alone");
    console.note(fmt::format("{} will have {}", command.out, format_bytes(page->html.size())));
    if (Result<void> written = write_text(page->html, command.out, console.run()); !written) return written.error();
    const Result<ExitCode> done =
        finish(console, command.common, grid_table(command, *page), grid_report(command, *page));
    if (!done) return done.error();
    return std::optional(*done);
}

} // namespace isotet::cli
