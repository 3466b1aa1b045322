// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/export/export_page.hpp"

#include <filesystem>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <isotet/fields.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/text.hpp>
#include <isotet/version.hpp>
#include <isotet/write.hpp>

#include "base/stopwatch.hpp"
#include "view/export/export_grid.hpp"
#include "view/export/saved_grid.hpp"
#include "view/export/saved_surfaces.hpp"
#include "view/first_input.hpp"

namespace isotet::view {

namespace {

Error wrong_option(std::string sentence) { return {ErrorCode::invalid_argument, std::move(sentence)}; }

Result<void> check_options(const ExportJob& job) {
    if (jobs::ending_of(job.out) != ".html")
        return wrong_option(fmt::format("OUT is '{}', but a page ends in .html", job.out));
    const bool has_shares = job.between_shares.lower || job.between_shares.upper; // which are known later
    if (!job.between.empty() && (job.between.size() != 2 || (!has_shares && !(job.between[0] < job.between[1]))))
        return wrong_option("`between` takes two isovalues, the smaller one first, as in 0.1,0.5 or 5%v,95%v");
    return {};
}

/// Whether the page is to have what fits: the grid, if isosurfaces are not asked for.
bool may_have_grid(const ExportJob& job) {
    return job.as == PageContent::fitting && job.isovalues.empty() && job.shares.empty() && job.between.empty() &&
           !job.surfaces;
}

class SurfaceExport {
public:
    SurfaceExport(const ExportJob& job, NoteKeeper& caller) : job_(job), caller_(caller) {}

    Result<ExportNumbers> run();

private:
    Result<void> open();
    Result<void> choose_steps();
    Result<void> read();
    Result<std::optional<ValueRange>> range() const;
    SavedSurfacesOptions options(std::optional<ValueRange> range) const;
    Result<SavedSurfaces> extract();

    const ExportJob& job_;
    NoteKeeper& caller_;
    jobs::GridOptions grid_ = job_.grid;
    std::optional<jobs::GridSource> source_;
    std::vector<std::size_t> steps_; ///< that are shown; none: there is one
    ViewerInput input_;
    ExportedSurfaces numbers_;
};

Result<void> SurfaceExport::open() {
    if (job_.all_steps) grid_.step = 0;
    Result<jobs::GridSource> source = jobs::GridSource::open(grid_, caller_);
    if (!source) return source.error();
    source_ = *std::move(source);
    if (Result<void> chosen = choose_steps(); !chosen) return chosen;
    if (!steps_.empty()) grid_.step = steps_.front(); // is read first
    if (Result<void> paths = check_export_paths(job_, *source_); !paths) return paths;
    const jobs::Steps steps = job_.all_steps ? jobs::Steps::all : jobs::Steps::one;
    return check_view_fields(*source_, view_wish(steps, job_.field, job_.color_by), job_.grid, caller_);
}

/// Where all are asked for, those that have the fields.
Result<void> SurfaceExport::choose_steps() {
    const std::size_t count = source_->info().times.size();
    if (!job_.all_steps || count < 2) return {};
    std::vector<std::size_t> all(count);
    std::iota(all.begin(), all.end(), std::size_t{0});
    std::vector<std::string> names;
    for (const std::string* name : {&job_.field.name, &job_.color_by})
        if (!name->empty()) jobs::add_names(names, {*name});
    Result<std::vector<std::size_t>> steps = steps_with_fields(*source_, std::move(all), names, caller_);
    if (!steps) return steps.error();
    steps_ = *std::move(steps);
    return {};
}

Result<void> SurfaceExport::read() {
    const core::Stopwatch watch;
    Result<ViewerInput> input = read_first_input(
        {grid_, job_.field, job_.isovalues, job_.shares, job_.color_by, FirstCells::all, !job_.between.empty()},
        *source_, caller_, caller_.run());
    if (!input) return input.error();
    input_ = *std::move(input);
    numbers_.read_seconds = watch.seconds();
    if (!job_.field.name.empty()) return {};
    // The one that was chosen may be missing in others.
    Result<std::vector<std::size_t>> steps =
        steps_with_fields(*source_, std::move(steps_), {input_.state.field}, caller_);
    if (!steps) return steps.error();
    steps_ = *std::move(steps);
    return {};
}

/// Nothing: that of the field.
Result<std::optional<ValueRange>> SurfaceExport::range() const {
    if (job_.between.empty()) return std::optional<ValueRange>();
    const SolidRange named{job_.between[0], job_.between[1]};
    if (!job_.between_shares.lower && !job_.between_shares.upper)
        return std::optional(ValueRange{named.lower, named.upper});
    const Result<PointField> field = find_field(input_.grid, input_.state.field, {}, caller_.run());
    if (!field) return field.error();
    const Result<SolidRange> range = with_shares(named, job_.between_shares, input_.grid, *field, caller_.run());
    if (!range) return range.error();
    return std::optional(ValueRange{range->lower, range->upper});
}

SavedSurfacesOptions SurfaceExport::options(std::optional<ValueRange> range) const {
    SavedSurfacesOptions options;
    options.file = shown_name(job_.grid.file);
    options.version = ISOTET_VERSION;
    options.isovalues = input_.state.isovalues; // those that were named
    if (job_.surfaces) options.count = *job_.surfaces;
    options.range = range;
    options.refine = job_.refine;
    options.max_bytes = job_.max_size;
    options.steps = steps_;
    if (steps_.empty()) options.steps = {input_.state.step.value_or(0)};
    return options;
}

Result<SavedSurfaces> SurfaceExport::extract() {
    const core::Stopwatch watch;
    const Result<std::optional<ValueRange>> range = this->range();
    if (!range) return range.error();
    const SavedSurfacesOptions options = this->options(*range);
    const ReadStep read_step = [this](std::size_t step, const Run& run) {
        return source_->read({}, step, caller_, run);
    };
    Result<SavedSurfaces> saved = save_surfaces(std::move(input_), read_step, options, caller_.run());
    if (!saved) return saved;
    caller_.notes(saved->notes);
    numbers_.steps = options.steps.size();
    numbers_.extract_seconds = watch.seconds();
    return saved;
}

Result<ExportNumbers> SurfaceExport::run() {
    if (Result<void> opened = open(); !opened) return opened.error();
    if (Result<void> done = read(); !done) return done.error();
    Result<SavedSurfaces> saved = extract();
    if (!saved) return saved.error();
    caller_.note(fmt::format("{} will have {}", job_.out, format_bytes(saved->html.size())));
    const core::Stopwatch watch;
    if (Result<void> written = write_text(saved->html, job_.out, caller_.run()); !written) return written.error();
    numbers_.write_seconds = watch.seconds();
    numbers_.isovalues = std::move(saved->isovalues);
    numbers_.left_out = saved->left_out;
    numbers_.triangles = saved->triangles;
    numbers_.boundary = saved->boundary;
    return ExportNumbers{std::move(numbers_), saved->html.size()};
}

} // namespace

std::string shown_name(const std::string& file) { return valid_utf8(std::filesystem::path(file).filename().string()); }

std::vector<std::string> names_of(const std::vector<FieldReport>& fields) {
    std::vector<std::string> names;
    for (const FieldReport& field : fields) names.push_back(field.name);
    return names;
}

Result<void> check_export_paths(const ExportJob& job, const jobs::GridSource& source) {
    std::vector<std::string> outputs = job.other_outputs;
    outputs.push_back(job.out);
    return jobs::check_output_paths(source.info().files, outputs);
}

Result<ExportNumbers> export_page(const ExportJob& job, jobs::Caller& caller) {
    if (Result<void> checked = check_options(job); !checked) return checked.error();
    const bool may = may_have_grid(job), can = static_cast<bool>(check_grid_pages());
    if (may && !can)
        caller.note("this isotet was built without WebAssembly: the page has isosurfaces in place of the grid");
    if (job.as == PageContent::grid || (may && can)) {
        NoteKeeper notes(caller);
        Result<std::optional<ExportNumbers>> grid = export_grid(job, notes);
        if (!grid) return grid.error();
        if (*grid) return **std::move(grid);
    }
    NoteKeeper notes(caller); // readers of the page need not know what else it might have
    return SurfaceExport(job, notes).run();
}

} // namespace isotet::view
