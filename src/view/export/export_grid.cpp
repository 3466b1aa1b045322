// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/export/export_grid.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/isosurface_scene.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/text.hpp>
#include <isotet/version.hpp>
#include <isotet/write.hpp>

#include "view/export/saved_grid.hpp"
#include "view/first_input.hpp"

namespace isotet::view {

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
class Silent : public jobs::Caller {
public:
    explicit Silent(const Run& run) { run_ = run; }
    void note(const std::string&) override {}
    void detail(const std::string&) override {}
};

jobs::PackJob pack_job_of(const ExportJob& job, const jobs::FirstChoice& choice, const std::string& out) {
    jobs::PackJob pack;
    pack.grid = job.grid;
    if (!job.all_steps && !choice.steps.empty()) {
        pack.grid.time.reset();
        pack.grid.step = choice.steps.front();
    }
    pack.all_steps = job.all_steps;
    pack.out = out;
    pack.cell_field = job.field.cell_field;
    pack.scalars_only = true; // pages tell of fields one by one
    pack.coordinates_do = true;
    if (job.field.name.empty()) return pack;
    pack.fields = {job.field.name};
    if (!job.color_by.empty() && job.color_by != job.field.name) pack.fields.push_back(job.color_by);
    return pack;
}

/// Those by share are of the first step.
Result<std::vector<double>> isovalues_of(const ExportJob& job, const jobs::GridOptions& grid_options,
                                         const std::string& field, jobs::Caller& caller) {
    std::vector<double> isovalues = job.isovalues;
    if (job.shares.empty()) return isovalues;
    auto source = jobs::GridSource::open(grid_options, caller);
    if (!source) return source.error();
    const jobs::FieldChoice choice{field, job.field.cell_field};
    const auto look = look_at_step_with_fields(*source, grid_options, {jobs::Steps::one, choice, {}}, caller);
    if (!look) return look.error();
    Grid grid;
    const auto values = read_field(*source, look->step, choice, {}, caller, grid);
    if (!values) return values.error();
    const auto found = isovalues_at(grid, *values, job.shares, caller.run());
    if (!found) return found.error();
    isovalues.insert(isovalues.end(), found->begin(), found->end());
    return isovalues;
}

/// As isotet view begins with it, of the grid that was packed.
Result<std::optional<std::array<double, 3>>> stretch_of(const jobs::PackNumbers& packed, const std::string& path,
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
struct GridPage : ExportedGrid {
    std::string html;
};

class GridPageMaker {
public:
    GridPageMaker(const ExportJob& wish, const std::string& folder, const jobs::FirstChoice& choice, NoteKeeper& caller)
        : wish_(wish), caller_(caller), job_(pack_job_of(wish, choice, folder + "/grid.isotet")) {
        if (wish.field.name.empty()) first_ = choice.view;
        if (wish.all_steps && !choice.steps.empty()) first_step_ = choice.steps.front();
    }

    /// With as many of the fields as fit, if none was named; then with values of 16 bits. It may still be too large.
    Result<GridPage> make(std::uint64_t max_bytes);

private:
    Result<GridPage> page_with(std::vector<std::string> fields);
    Result<GridPage> page_with_all();
    ViewState state_of(const std::vector<std::string>& fields) const;
    void tell(const GridPage& page, std::uint64_t max_bytes);
    Result<GridPage> page_with_first(std::span<const std::string> names, std::size_t count) {
        return page_with({names.begin(), names.begin() + static_cast<std::ptrdiff_t>(count)});
    }
    Result<GridPage> with_fewer_fields(GridPage all, std::uint64_t max_bytes);

    const ExportJob& wish_;
    NoteKeeper& caller_;
    jobs::PackJob job_;
    std::optional<FirstView> first_;               ///< where no field was named
    std::optional<std::size_t> first_step_;        ///< of all steps: one in which the field varies
    std::optional<std::vector<double>> isovalues_; ///< of the field that is shown first
};

/// A page has no cell fields: regions are not coloured.
ViewState GridPageMaker::state_of(const std::vector<std::string>& fields) const {
    ViewState state;
    const bool isovalues_are_given = !wish_.isovalues.empty() || !wish_.shares.empty();
    if (first_ && !isovalues_are_given) {
        take_first_view(*first_, state);
        if (first_->association == Association::cell) {
            state.color_by.clear();
            state.colored_boundary = false;
        }
    }
    if (std::ranges::find(fields, state.field) == fields.end()) state.field = fields.front();
    if (!wish_.color_by.empty()) state.color_by = wish_.color_by;
    return state;
}

Result<GridPage> GridPageMaker::page_with(std::vector<std::string> fields) {
    jobs::PackJob job = job_;
    job.fields = std::move(fields);
    Result<jobs::PackNumbers> packed = jobs::pack_file(job, caller_);
    if (!packed) return packed.error();
    SavedGridOptions options;
    options.file = shown_name(wish_.grid.file);
    options.version = ISOTET_VERSION;
    options.state = state_of(names_of(packed->fields));
    if (first_step_ && packed->steps > 1) options.state.step = std::min(*first_step_, packed->steps - 1);
    if (!isovalues_) {
        auto isovalues = isovalues_of(wish_, job.grid, options.state.field, caller_);
        if (!isovalues) return isovalues.error();
        isovalues_ = *std::move(isovalues);
    }
    options.state.isovalues = *isovalues_;
    const auto stretch = stretch_of(*packed, job.out, caller_.run());
    if (!stretch) return stretch.error();
    options.state.stretch = *stretch;
    options.notes = caller_.notes_so_far();
    Result<std::string> html = grid_page(bytes_of(job.out), options);
    if (!html) return html.error();
    return GridPage{{*std::move(packed), 0, job.value_bits.has_value()}, *std::move(html)};
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
    if (const auto color = std::find(names.begin() + 1, names.end(), wish_.color_by); color != names.end()) {
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
    const std::string reason = fmt::format("larger than {} (`max_size`)", format_bytes(max_bytes));
    if (page.left_out > 0)
        caller_.note(fmt::format("{} of {} fields are in the page, {}: all of them would make it {}",
                                 page.packed.fields.size(), page.packed.fields.size() + page.left_out,
                                 jobs::quoted_list(names_of(page.packed.fields)), reason));
    if (!page.rounded) return;
    std::vector<std::string> changes;
    for (std::size_t i = 0; i < page.packed.fields.size(); ++i)
        changes.push_back(
            fmt::format("'{}' by at most {}", page.packed.fields[i].name, jobs::rounded(page.packed.rounded_by[i])));
    caller_.note(fmt::format("values are rounded to 16 bits of their range, {}: else the page would be {}",
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

/// A page with the grid, or the reason why it has isosurfaces instead.
class GridExport {
public:
    GridExport(const ExportJob& job, NoteKeeper& caller) : job_(job), caller_(caller) {}

    Result<std::optional<ExportNumbers>> run();

private:
    /// What follows says false where the page is to have isosurfaces.
    Result<bool> fits_before_reading(const FileInfo& info) const;
    Result<bool> has_colors_of_points(jobs::GridSource& source) const;
    Result<bool> fits(const GridPage& page) const;
    bool suits(const FirstView& first) const;
    bool instead(const std::string& why) const {
        caller_.note(fmt::format("{}: the page has isosurfaces in place of the grid", why));
        return false;
    }
    Result<std::optional<ExportNumbers>> write(GridPage page) const;

    const ExportJob& job_;
    NoteKeeper& caller_;
    const bool must_be_ = job_.as == PageContent::grid;
};

Result<bool> GridExport::fits_before_reading(const FileInfo& info) const {
    constexpr std::uint64_t least_bytes_a_cell = 3;
    if (must_be_ || info.cells <= job_.max_size / least_bytes_a_cell) return true;
    return instead(
        fmt::format("the grid would make the page larger than {} (`max_size`)", format_bytes(job_.max_size)));
}

Result<bool> GridExport::has_colors_of_points(jobs::GridSource& source) const {
    if (job_.color_by.empty()) return true;
    const Result<jobs::FoundField> color = choose_field(source, {job_.color_by, false});
    if (!color) return color.error();
    if (color->cell.empty()) return true;
    const std::string why = fmt::format("'{}', of cells, colours surfaces", job_.color_by);
    if (!must_be_) return instead(why);
    return Error{ErrorCode::invalid_argument,
                 why + ", but a page with the grid has fields of points only: `as` surfaces"};
}

bool GridExport::suits(const FirstView& first) const {
    if (!job_.field.name.empty() || must_be_) return true;
    if (first.field.empty()) return false;
    if (first.draw == FirstDraw::isosurfaces || first.association != Association::cell) return true;
    return instead(fmt::format("'{}', of cells, colours the boundary", first.field));
}

Result<bool> GridExport::fits(const GridPage& page) const {
    if (page.packed.curved_cells > 0) {
        const std::string cells = fmt::format("{} curved cells", jobs::grouped(page.packed.curved_cells));
        if (!must_be_) return instead(cells + " are refined for isosurfaces alone");
        caller_.note(cells + " are split at their nodes in a page with the grid: `as` surfaces refines them");
    }
    if (page.html.size() <= job_.max_size) return true;
    const std::string size = format_bytes(page.html.size()), largest = format_bytes(job_.max_size);
    if (!must_be_)
        return instead(
            fmt::format("with the grid the page would have {}, but may have {} (`max_size`)", size, largest));
    return Error{
        ErrorCode::invalid_argument,
        fmt::format("the page would have {} with {}, but may have {} (`max_size`): `as` surfaces makes smaller "
                    "ones",
                    size, jobs::quoted_list(names_of(page.packed.fields)), largest)};
}

Result<std::optional<ExportNumbers>> GridExport::write(GridPage page) const {
    if (!must_be_) caller_.note("the page has the grid: `as` surfaces makes one of isosurfaces alone");
    caller_.note(fmt::format("{} will have {}", job_.out, format_bytes(page.html.size())));
    if (Result<void> written = write_text(page.html, job_.out, caller_.run()); !written) return written.error();
    const std::uint64_t bytes = page.html.size();
    return std::optional(ExportNumbers{static_cast<ExportedGrid&&>(page), bytes});
}

Result<std::optional<ExportNumbers>> GridExport::run() {
    const std::optional<ExportNumbers> surfaces_instead;
    if (Result<void> checked = check_grid_pages(); !checked) return checked.error();
    Result<jobs::GridSource> source = jobs::GridSource::open(job_.grid, caller_);
    if (!source) return source.error();
    if (Result<void> paths = check_export_paths(job_, *source); !paths) return paths.error();
    Result<bool> goes = fits_before_reading(source->info());
    if (!goes) return goes.error();
    if (!*goes) return surfaces_instead;
    jobs::ChoiceWish wish = view_wish(jobs::Steps::one, job_.field, job_.color_by);
    if (auto found = check_view_fields(*source, wish, job_.grid, caller_); !found) return found.error();
    goes = has_colors_of_points(*source);
    if (!goes) return goes.error();
    if (!*goes) return surfaces_instead;
    wish.needs_view = job_.field.name.empty();
    Silent silent(caller_.run());
    jobs::Caller& told = job_.all_steps ? static_cast<jobs::Caller&>(silent) : caller_;
    const Result<jobs::FirstChoice> choice = choose_first(*source, job_.grid, wish, told, caller_.run());
    if (!choice) return choice.error();
    if (!suits(choice->view)) return surfaces_instead;
    const PackFolder folder;
    if (folder.path().empty()) return Error{ErrorCode::cannot_write, "no folder could be made for the packed grid"};
    Result<GridPage> page = GridPageMaker(job_, folder.path(), *choice, caller_).make(job_.max_size);
    if (!page) return page.error();
    goes = fits(*page);
    if (!goes) return goes.error();
    if (!*goes) return surfaces_instead;
    return write(*std::move(page));
}

} // namespace

Result<std::optional<ExportNumbers>> export_grid(const ExportJob& job, NoteKeeper& caller) {
    return GridExport(job, caller).run();
}

} // namespace isotet::view
