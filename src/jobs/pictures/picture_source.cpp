// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/pictures/picture_source.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <isotet/active_cells.hpp>
#include <isotet/boundary.hpp>
#include <isotet/fields.hpp>
#include <isotet/grid_file.hpp>
#include <isotet/scene.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/isovalues.hpp>

#include "base/stopwatch.hpp"
#include "fields/fill_values.hpp"
#include "jobs/extract_notes.hpp"
#include "jobs/pictures/packed_picture.hpp"
#include "jobs/refuse.hpp"
#include "jobs/vertex_colors.hpp"

namespace isotet::jobs {

namespace {

/// Whether isovalues were asked for.
bool names_isovalues(const DrawJob& job) {
    return !job.isovalues.empty() || !job.shares.empty() || job.levels > 0 || !job.sweep.empty() || job.method.draw;
}

/// Whether isovalues were asked for, or a volume, which is one of a field as well.
bool asks_for_field(const DrawJob& job) { return names_isovalues(job) || draws_volume(job) || job.solid || job.keep; }

/// Isovalues that follow from the values.
RangeLevels levels_of(const DrawJob& job) {
    if (job.levels > 0) return {job.levels};
    return {job.solid ? 1 : default_levels, LevelRounding::short_decimals};
}

/// `all_values`   as ColorOptions has them
Result<ColorOptions> options_of_colors(const std::string& name, const std::vector<RegionName>& regions,
                                       const DrawJob& job, const Array& all_values) {
    Result<ColorOptions> options = color_options(job.scale, job.range);
    if (!options) return options;
    for (const RegionName& region : regions)
        if (region.field == name) options->names[static_cast<double>(region.number)] = region.name;
    options->all_values = all_values;
    return options;
}

/// A field of `from`, a grid or a surface, that colours.
template <class From>
Result<ColorField> colors_of(const From& from, const std::string& name, const std::vector<RegionName>& regions,
                             const DrawJob& job, Caller& caller, const Array& all_values = {}) {
    const Result<ColorOptions> options = options_of_colors(name, regions, job, all_values);
    if (!options) return options.error();
    Result<FoundColors> found = find_colors(from, name, *options, caller.run());
    if (!found) return found.error();
    caller.notes(found->notes);
    return std::move(found->field);
}

/// Whether a field is one of cells, which colours them as they are (cell_colors()).
bool colors_cells(const FoundField& field) {
    return field.point.empty() && !field.neighbours && !field.is_expression && field.cell == std::vector{field.name};
}

bool needs_no_cells(const FoundField& field) { return field.cell.empty() && !field.neighbours; }

/// Factors of x, y and z, which the command line gives.
std::span<const double, 3> factors_of(const std::vector<double>& stretch) { return std::span(stretch).first<3>(); }

} // namespace

struct PictureSource::Contents {
    Grid grid;
    std::optional<PointField> field; ///< that is contoured
    std::optional<ColorField> colors;
    std::optional<VolumeLook> volume;
    std::optional<ColorField> volume_colors;
    bool model = false;                     ///< the boundary is what is shown: opaque, coloured where there are colours
    std::uint64_t cells = 0;                ///< of the grid in the file
    bool streamed = false;                  ///< its cells went by
    std::optional<GridPart> part = {};      ///< where the grid has only the active cells
    Box bounds = {};                        ///< then; or of `packed`
    std::optional<Surface> boundary = {};   ///< then, where it is drawn
    std::vector<Field> digests = {};        ///< ReadResult::digests
    std::vector<double> shares = {};        ///< ReadResult::share_isovalues
    std::optional<PackedScene> packed = {}; ///< in place of the grid; `field` has values where they were needed
};

Result<PictureSource> PictureSource::open(const DrawJob& job, Caller& caller) {
    PictureSource source(job);
    if (!job.color_by.empty() && !job.boundary_color_by.empty() && job.color_by != job.boundary_color_by)
        return refusal("`color_by` is '{}' and `boundary_color_by` '{}', but a picture has one colour scale",
                       job.color_by, job.boundary_color_by);
    const FileKinds kinds = kinds_of(job.grid.file);
    if (kinds.surface && job.grid.format.empty()) {
        const core::Stopwatch reading;
        Result<SurfaceFile> file = read_surface(job.grid.file, {}, caller.run());
        if (file) {
            caller.notes(file->notes);
            source.surface_ = std::move(file->surface);
            source.surface_format_ = file->format;
            source.surface_seconds_ = reading.seconds();
            return source;
        }
        // A name such as grid.vtk can be either.
        if (!kinds.grid || file.error().code != ErrorCode::invalid_data) return file.error();
    }
    Result<GridSource> grid = GridSource::open(job.grid, caller);
    if (!grid) return grid.error();
    if (auto paths = check_output_paths(grid->info().files, job.other_outputs); !paths) return paths.error();
    source.source_ = *std::move(grid);
    if (source.source_->is_packed_file() && !needs_cells(job)) {
        Result<PackedFile> file = PackedFile::open(job.grid.file, {job.memory.value_or(0)}, caller.run());
        if (!file) return file.error();
        source.packed_ = *std::move(file);
    }
    if (auto chosen = source.choose_steps_and_view(caller); !chosen) return chosen.error();
    if (auto kept = source.keep_steps_with_fields(caller); !kept) return kept.error();
    if (auto checked = source.check_interpolation(); !checked) return checked.error();
    return source;
}

Result<void> PictureSource::check_interpolation() const {
    if (job_.interpolate == 0) return {};
    if (!job_.all_steps) return refusal("`interpolate` is {}, but it goes with `all_steps` only", job_.interpolate);
    if (!packed_)
        return refusal(
            "`interpolate` is {}, but only packed files have values between steps (isotet pack IN OUT.isotet "
            "--all-steps), and pictures of their boundary, isosurfaces and slices",
            job_.interpolate);
    if (!job_.slices.empty() && !packed_->info().moved_points.empty())
        return refusal("`interpolate` is {}, but the points of the file move, and slices are those of a step",
                       job_.interpolate);
    for (std::size_t i = 1; i < steps_.size(); ++i)
        if (steps_[i] != steps_[i - 1] + 1)
            return refusal("`interpolate` is {}, but step {} lacks a field that is drawn", job_.interpolate,
                           steps_[i - 1] + 1);
    return {};
}

/// Whether isosurfaces are drawn, as far as options say: else the boundary or slices.
bool PictureSource::wants_surfaces() const {
    return asks_for_field(job_) ||
           (job_.slices.empty() && (job_.boundary_color_by.empty() || !job_.field.name.empty()));
}

/// Whether heights may be stretched by default.
bool PictureSource::may_stretch() const {
    return job_.stretch.empty() && !surface_ && is_of_reservoirs(source_->info().format);
}

/// The field that is needed by name: contoured, or else coloured by; empty: it is to be chosen.
std::string PictureSource::needed_field() const {
    if (wants_surfaces()) return job_.field.name;
    if (!job_.color_by.empty()) return job_.color_by;
    return job_.boundary_color_by.empty() ? job_.field.name : job_.boundary_color_by;
}

Result<void> PictureSource::choose_steps_and_view(Caller& caller) {
    ChoiceWish wish{job_.all_steps ? Steps::all : Steps::one,
                    {needed_field(), wants_surfaces() && job_.field.cell_field},
                    {job_.color_by, job_.boundary_color_by}};
    wish.streams = wants_surfaces() ? options_with_active_cells().has_value() : draws_boundary_alone();
    Result<FirstChoice> choice = choose_first(*source_, job_.grid, wish, caller, caller.run());
    if (!choice) return choice.error();
    steps_ = std::move(choice->steps);
    first_ = std::move(choice->view);
    if (steps_.size() < 2 || !needed_field().empty() || first_.draw != FirstDraw::isosurfaces) return {};
    caller.note(note_of(first_)); // of all steps: those without it are not drawn
    (wants_surfaces() ? job_.field.name : job_.color_by) = first_.field;
    return {};
}

/// Steps that lack a field that is named are not drawn.
Result<void> PictureSource::keep_steps_with_fields(Caller& caller) {
    std::vector<std::string> names;
    for (const std::string* name : {&job_.field.name, &job_.color_by, &job_.boundary_color_by})
        if (!name->empty()) add_names(names, {*name});
    auto kept = steps_with_fields(*source_, std::move(steps_), names, caller);
    if (!kept) return kept.error();
    steps_ = *std::move(kept);
    return {};
}

SceneLook PictureSource::look_of(const Contents& contents) const {
    SceneLook look;
    if (contents.field || !job_.slices.empty() || surface_) look.colors = contents.colors;
    if (contents.model) look.boundary_colors = contents.colors;
    if (contents.field && !look.colors && job_.sweep.size() == 3)
        look.isovalue_range = {std::min(job_.sweep[0], job_.sweep[1]), std::max(job_.sweep[0], job_.sweep[1])};
    look.map = job_.scale.map;
    look.map_colors = job_.scale.colors;
    look.opacity = job_.opacity;
    look.volume = contents.volume;
    if (contents.volume) look.isovalue_range = {contents.volume->scale.lower, contents.volume->scale.upper};
    look.boundary_opacity = job_.boundary.value_or(contents.model ? 1 : contents.volume ? 0 : default_boundary_opacity);
    look.outline = job_.outline;
    look.line_width = std::max(1.0, job_.picture.height / 600.0);
    look.edges = job_.edges;
    look.solid = job_.solid;
    look.keep = job_.keep;
    look.shade_by = job_.shade_by;
    look.clips = job_.clips;
    look.slices = job_.slices;
    for (std::vector<Plane>* planes : {&look.clips, &look.slices})
        for (Plane& plane : *planes)
            if (!job_.stretch.empty()) plane = stretched(plane, factors_of(job_.stretch));
    return look;
}

Result<DrawInput> PictureSource::take_surface(const std::optional<Device>& device, Caller& caller) {
    if (asks_for_field(job_) || !job_.field.name.empty() || job_.boundary || job_.method.extract ||
        !job_.boundary_color_by.empty() || !job_.slices.empty() || job_.solid || job_.keep) {
        return refusal("{} is a surface: it has no isovalues, no field to contour (`color_by` colours it), no "
                       "boundary, no volume, no solids, no parts to keep, no slices and no tets",
                       job_.grid.file);
    }
    DrawInput input;
    input.is_surface = true;
    input.stretch = job_.stretch;
    input.format = surface_format_;
    input.read_seconds = surface_seconds_;
    Contents contents;
    if (!job_.color_by.empty()) {
        Result<ColorField> colors = colors_of(*surface_, job_.color_by, {}, job_, caller);
        if (!colors) return colors.error();
        input.colors = contents.colors = *std::move(colors);
    }
    Surface surface = *surface_;
    if (!job_.stretch.empty()) {
        surface.positions = stretched(surface.positions, factors_of(job_.stretch));
        surface.normals_kind = Normals::none;
    }
    Result<IsosurfaceScene> scene = IsosurfaceScene::create(device, std::move(surface), look_of(contents));
    if (!scene) return scene.error();
    input.scene = *std::move(scene);
    return input;
}

/// A grid with what a field that colours needs: with a sample of the cells where its points do, without cells where it has
/// a value for each.
Result<Grid> PictureSource::read_for(const FoundField& field, std::size_t step, Caller& caller) {
    const FieldsToRead read{field.point, field.cell};
    const bool of_cells = colors_cells(field) && !packed_;
    if (!needs_no_cells(field) && !of_cells) return source_->read(read, step, caller);
    Result<SurveyedGrid> some = source_->read_sample(read, step, caller, caller.run());
    if (!some) return some.error();
    Grid grid = std::move(some->read.grid);
    if (!of_cells || !some->report) return grid;
    if (some->report->cells_left_out > 0) return source_->read(read, step, caller); // which have values, but no colour
    grid.cells = {};
    return grid;
}

/// The values of the field that is contoured, of all points.
Result<PointField> PictureSource::field_at(std::size_t step, const std::string& name, Caller& caller) {
    const Result<FoundField> found = choose_field(*source_, {name, job_.field.cell_field});
    if (!found) return found.error();
    const Result<Grid> grid = needs_no_cells(*found) ? read_for(*found, step, caller)
                                                     : source_->read({found->point, found->cell}, step, caller);
    if (!grid) return grid.error();
    return find_chosen(*grid, name, job_.field, caller);
}

/// What a field of a step colours with. The range of a packed one is known; on a logarithmic scale its values count.
Result<ColorField> PictureSource::colors_at(std::size_t step, const std::string& name, Caller& caller) {
    const PackedFieldInfo* const packed = packed_ ? packed_field(packed_->info(), name, step, false) : nullptr;
    if (packed && (!job_.scale.logarithmic || packed->report.lower > 0)) {
        const Result<ColorOptions> options = color_options(job_.scale, job_.range);
        if (!options) return options.error();
        Result<FoundColors> found = colors_of_report(packed->report, *options, caller.run());
        if (!found) return found.error();
        caller.notes(found->notes);
        return std::move(found->field);
    }
    const Result<FoundField> found = choose_field(*source_, {name, false});
    if (!found) return found.error();
    if (packed_ && has_cell_field(*found, step)) {
        Result<Field> field = packed_->cell_field(found->name, step, caller.run());
        if (!field) return field.error();
        Grid grid;
        grid.cell_fields = {*std::move(field)};
        return colors_of(grid, name, source_->region_names(), job_, caller);
    }
    const Result<Grid> grid = read_for(*found, step, caller);
    if (!grid) return grid.error();
    return colors_of(*grid, name, source_->region_names(), job_, caller);
}

/// The range of a field that colours over all steps becomes --range.
Result<void> PictureSource::widen_range(const std::string& color, Caller& caller) {
    if (steps_.size() < 2 || color.empty() || !job_.range.empty()) return {};
    ValueRange all{INFINITY, -INFINITY};
    for (const std::size_t step : steps_) {
        const Result<ColorField> colors = colors_at(step, color, caller);
        if (!colors) return colors.error();
        if (!colors->classes.empty()) return {};
        const Result<ValueRange> one = colored_range(colors->values, job_.scale.logarithmic, caller.run());
        if (!one) return one.error();
        all = {std::min(all.lower, one->lower), std::max(all.upper, one->upper)};
    }
    if (all.lower < all.upper) job_.range = {all.lower, all.upper};
    return {};
}

/// What the values of a field mostly lie in, over all steps.
Result<ValueRange> PictureSource::typical_range_of_steps(const PointField& first, Caller& caller) {
    ValueRange all = core::typical_range_of(first);
    if (steps_.size() < 2) return all;
    for (std::size_t which = 1; which < steps_.size(); ++which) {
        const Result<PointField> field = field_at(steps_[which], first.name, caller);
        if (!field) return field.error();
        const ValueRange one = core::typical_range_of(*field);
        if (!(one.lower <= one.upper)) continue; // no finite value
        all = all.lower <= all.upper ? ValueRange{std::min(all.lower, one.lower), std::max(all.upper, one.upper)} : one;
    }
    return all;
}

/// The steps with some fields: mostly those of the step before.
core::ReadAhead<Grid>& PictureSource::grids(const FieldsToRead& fields, Caller& caller) {
    if (grids_ && fields == last_read_) return *grids_;
    last_read_ = fields;
    grids_ = std::make_unique<core::ReadAhead<Grid>>(
        [source = *source_, fields, &caller](std::size_t step, const Run& run) {
            return source.read(fields, step, caller, run);
        },
        caller.run().threads);
    return *grids_;
}

/// What is drawn where no field is named: what first_view() says, unless isovalues or colours are asked for.
Result<void> PictureSource::take_first_view(bool& contours, std::string& field, std::string& color, Contents& contents,
                                            Caller& caller) const {
    if (first_.field.empty() && asks_for_field(job_))
        return Error{ErrorCode::invalid_data,
                     fmt::format("none of the {} fields has two different values: there is nothing to contour; "
                                 "`field` x, y or z contours a coordinate",
                                 source_->info().fields.size())};
    const bool as_model = contours && !asks_for_field(job_) && color.empty() && first_.draw != FirstDraw::isosurfaces;
    caller.note(first_.field.empty()
                    ? std::string("no field varies that would be contoured: the boundary of the grid is drawn")
                    : note_of(first_));
    if (as_model) {
        contours = false;
        contents.model = true;
        color = first_.field;
    } else {
        (contours ? field : color) = first_.field;
        contours = contours && !field.empty();
    }
    return {};
}

/// Whether the boundary is all that is drawn, as far as options say.
bool PictureSource::draws_boundary_alone() const {
    return job_.slices.empty() && !draws_volume(job_) && !job_.solid && !job_.method.draw && job_.stretch.empty() &&
           !may_stretch() && job_.boundary.value_or(1) > 0;
}

/// The cells that do where nothing but the boundary and a few isosurfaces is drawn; nothing where all are needed.
std::optional<ReadActiveCells> PictureSource::active_cells(const Contents& contents, const FoundField& contoured,
                                                           const FoundField& colored) const {
    const bool of_cells = colors_cells(colored), contours = !contoured.name.empty();
    const bool averages = contours && is_averaged_while_read(contoured, job_.field);
    if (needs_all_cells_ || !(averages || needs_no_cells(contoured)) || !(of_cells || needs_no_cells(colored)))
        return std::nullopt;
    ReadActiveCells active{contoured.name, job_.isovalues, {}};
    if (contours) {
        if (steps_.size() > 1 && job_.isovalues.empty() && job_.shares.empty()) return std::nullopt; // by all steps
        const auto options = options_with_active_cells();
        const auto wanted = options ? active_cells_for(contoured.name, *options) : std::nullopt;
        if (!wanted) return std::nullopt;
        active = *wanted;
        active.isovalues = job_.isovalues;
        active.bounds = job_.boundary == 0.0;
        active.shares = job_.shares;
        if (job_.shares.empty() && job_.isovalues.empty()) active.choose = levels_of(job_);
    } else if (draws_boundary_alone()) {
        active.isovalues = {0}; // without one cells would be counted
    } else {
        return std::nullopt;
    }
    active.averages = averages;
    active.digests = of_cells;
    if (active.bounds) return active;
    streamed_boundary_->wants_cells = contents.model && of_cells;
    active.boundary = streamed_boundary_;
    return active;
}

/// Where nothing but a few isosurfaces is drawn, as far as options say.
std::optional<ContourOptions> PictureSource::options_with_active_cells() const {
    const bool draws_more = !job_.slices.empty() || draws_volume(job_) || job_.solid || job_.method.draw;
    const bool chosen = job_.isovalues.empty() && job_.shares.empty(); // by the values
    ContourOptions options;
    options.method = job_.method.extract;
    options.expected_isovalues = job_.isovalues;
    options.expected_isovalues.resize(job_.isovalues.size() + job_.shares.size());
    if (chosen) options.expected_isovalues.resize(job_.levels > 0 ? job_.levels : default_levels);
    options.surfaces = options.expected_isovalues.size();
    options.normals = job_.shade_by == ShadeBy::gradient ? Normals::gradient : Normals::none;
    if (draws_more || !job_.sweep.empty() || options.surfaces > ActiveCellFilter::max_isovalues ||
        !job_.stretch.empty() || may_stretch() || !Contour::can_do_with_active_cells(options))
        return std::nullopt;
    return options;
}

/// Fills in the grid: all cells or, if they do, active ones.
Result<void> PictureSource::read_cells(const FieldsToRead& fields, std::size_t step,
                                       const std::optional<ReadActiveCells>& active, Contents& contents,
                                       Caller& caller) {
    core::ReadAhead<Grid>& steps = grids(fields, caller);
    if (active) {
        Result<ReadResult> some = streamed_.read(*source_, fields, step, *active, caller);
        if (!some) return some.error();
        contents.grid = std::move(some->grid);
        contents.field = std::move(some->field);
        contents.digests = std::move(some->digests);
        if (some->cells_in_file) contents.shares = std::move(some->share_isovalues);
        contents.cells = some->cells_in_file.value_or(contents.grid.cells.count());
        contents.streamed = some->cells_in_file.has_value();
        needs_all_cells_ = !contents.streamed; // of the next steps, too, most likely
        if (needs_all_cells_) return {};
        const auto all = [source = *source_, fields, step](const Run& run) {
            return source.read_the_rest(fields, step, run);
        };
        const bool has_boundary = active->boundary && active->boundary->is_there;
        if (some->bounds || has_boundary) {
            if (has_boundary) {
                contents.boundary = active->boundary->surface;
            } else {
                const auto& [x, y, z, far_x, far_y, far_z] = *some->bounds;
                contents.bounds = {{x, y, z}, {far_x, far_y, far_z}};
            }
            contents.part = part_of(*some, job_.shade_by == ShadeBy::gradient, all);
            caller.detail(active->field.empty()
                              ? fmt::format("none of {} cells were kept: only the boundary is drawn", contents.cells)
                              : fmt::format("{} of {} cells were kept: the isovalues meet no others",
                                            contents.grid.cells.count(), contents.cells));
            return {};
        }
        Result<ReadResult> whole = all(caller.run());
        if (!whole) return whole.error();
        contents.grid = std::move(whole->grid);
        contents.digests.clear();
        contents.shares.clear();
        return {};
    }
    Result<Grid> grid = steps.take(step, caller.run());
    if (!grid) return grid.error();
    contents.grid = *std::move(grid);
    contents.cells = contents.grid.cells.count();
    return {};
}

/// Whether all that is drawn of a step is in the packed file as it is drawn. An empty name is no field.
bool PictureSource::is_packed(std::size_t step, const FoundField& contoured, const FoundField& colored) const {
    if (!packed_) return false;
    const auto has = [&](const FoundField& field, bool gradients) {
        return field.name.empty() || packed_field(packed_->info(), field.name, step, gradients);
    };
    const bool of_cells = (!contoured.name.empty() || !job_.slices.empty()) && job_.boundary_color_by.empty() &&
                          has_cell_field(colored, step);
    return has(contoured, job_.shade_by == ShadeBy::gradient) && (of_cells || has(colored, false));
}

/// Of planes with the same normal one serves all, as long as points do not move.
Result<PackedGrid> PictureSource::sliced(const Plane& plane, std::size_t step, const Run& run) {
    std::size_t points = 0;
    for (const PackedPointsInfo& moved : packed_->info().moved_points)
        if (moved.step <= step) points = moved.step;
    if (sliced_step_ != points) sliced_.clear();
    sliced_step_ = points;
    const auto known = std::ranges::find_if(sliced_, [&](const auto& one) { return one.first.normal == plane.normal; });
    if (known != sliced_.end()) return known->second;
    const Result<PackedGrid> made = packed_->sliced(plane, step, run);
    if (made) sliced_.emplace_back(plane, *made);
    return made;
}

/// Whether a field that colours is one of cells, which the packed file has.
bool PictureSource::has_cell_field(const FoundField& colored, std::size_t step) const {
    return colored.point.empty() && !colored.is_expression &&
           std::ranges::any_of(packed_->info().cell_fields, [&](const PackedCellFieldInfo& field) {
               return field.name == colored.name && field.step <= step && field.components == 1;
           });
}

/// Takes packed fields in place of a grid. Values are read only where isovalues follow from them.
Result<void> PictureSource::take_packed(const FoundField& contoured, const FoundField& colored, std::size_t step,
                                        Contents& contents, Caller& caller) {
    const PackedFileInfo& info = packed_->info();
    const auto grid_of = [&](const std::string& name) {
        return packed_->interpolated(name, step, fraction_, caller.run());
    };
    const bool contours = !contoured.name.empty();
    const auto first = std::ranges::find(info.fields, step, &PackedFieldInfo::step);
    const bool of_points = !colored.name.empty() && !has_cell_field(colored, step);
    Result<PackedGrid> grid = grid_of(contours ? contoured.name : of_points ? colored.name : first->report.name);
    if (!grid) return grid.error();
    const auto cut = [this, step](const Plane& plane, const Run& run) { return sliced(plane, step, run); };
    contents.packed = PackedScene{*grid, {}, contours, cut};
    contents.cells = info.user_cells;
    contents.bounds = {info.lower, info.upper};
    for (const PackedPointsInfo& points : info.moved_points)
        if (points.step <= step) contents.bounds = {points.lower, points.upper};
    if (contours) {
        contents.field = PointField{contoured.name, {}, false, {}};
        const bool chooses_isovalues =
            job_.isovalues.empty() && (!draws_volume(job_) || (names_isovalues(job_) && job_.sweep.empty()));
        if (chooses_isovalues || needs_range_of_volume()) {
            Result<PointField> values = field_at(step, contoured.name, caller);
            if (!values) return values.error();
            contents.field = *std::move(values);
        }
    }
    if (colored.name.empty()) return {};
    if (has_cell_field(colored, step)) {
        if (auto widened = widen_range(colored.name, caller); !widened) return widened;
        Result<ColorField> field = colors_at(step, colored.name, caller);
        if (!field) return field.error();
        contents.colors = *std::move(field);
        return {};
    }
    Result<PackedGrid> colors = colored.name == contoured.name ? grid : grid_of(colored.name);
    if (!colors) return colors.error();
    contents.packed->colors = *std::move(colors);
    if (auto widened = widen_range(colored.name, caller); !widened) return widened;
    Result<ColorField> field = colors_at(step, colored.name, caller);
    if (!field) return field.error();
    contents.colors = *std::move(field);
    return {};
}

/// Reads what the picture needs of a step, and decides what it shows.
Result<PictureSource::Contents> PictureSource::read_contents(std::size_t step, bool on_cpu, Caller& caller) {
    Contents contents;
    std::string color = job_.color_by.empty() ? job_.boundary_color_by : job_.color_by;
    std::string field = job_.field.name;
    contents.model = !job_.boundary_color_by.empty();
    bool contours = wants_surfaces();
    if (!contours && color.empty()) color = field; // of slices
    if (needed_field().empty())
        if (auto taken = take_first_view(contours, field, color, contents, caller); !taken) return taken.error();

    FieldsToRead read{std::vector<std::string>(), std::vector<std::string>()};
    FoundField contoured, colored;
    for (const auto& [name, is_contoured] : {std::pair(field, true), std::pair(color, false)}) {
        if (name.empty() || (is_contoured && !contours)) continue;
        const Result<FoundField> found = choose_field(*source_, {name, is_contoured && job_.field.cell_field});
        if (!found) return found.error();
        add_names(*read.point, found->point);
        add_names(*read.cell, found->cell);
        (is_contoured ? contoured : colored) = *found;
    }
    if (is_packed(step, contoured, colored)) {
        if (auto taken = take_packed(contoured, colored, step, contents, caller); !taken) return taken.error();
        if (draws_volume(job_))
            if (auto taken = take_volume(step, contents, caller); !taken) return taken.error();
        return contents;
    }
    if (source_->info().format == "isotet" && !std::exchange(told_of_cells_, true))
        if (const auto file = PackedFile::open(job_.grid.file, {}, caller.run()))
            caller.note(note_of_unpacking(file->info()));
    if (fraction_ > 0)
        return refusal("`interpolate` is {}, but what is drawn needs all of the packed file, or is not packed",
                       job_.interpolate);
    if (!streamed_boundary_) streamed_boundary_ = std::make_shared<StreamedBoundary>();
    streamed_boundary_->of_steps = steps_.size() > 1;
    if (on_cpu)
        if (auto chosen = choose_isovalues_of_steps(step, contoured, caller); !chosen) return chosen.error();
    const auto active = on_cpu ? active_cells(contents, contoured, colored) : std::nullopt;
    if (auto done = read_cells(read, step, active, contents, caller); !done) return done.error();
    if (contours && !contents.field) {
        Result<PointField> found = find_chosen(contents.grid, field, job_.field, caller);
        if (!found) return found.error();
        contents.field = *std::move(found);
    }
    if (!color.empty())
        if (auto taken = take_colors(color, contents, caller); !taken) return taken.error();
    if (draws_volume(job_))
        if (auto taken = take_volume(step, contents, caller); !taken) return taken.error();
    return contents;
}

/// Isovalues that follow from the values of all steps, before the cells that they meet are read of any.
Result<void> PictureSource::choose_isovalues_of_steps(std::size_t step, const FoundField& contoured, Caller& caller) {
    const bool chooses = job_.isovalues.empty() && job_.shares.empty() && !contoured.name.empty();
    if (!chooses || steps_.size() < 2 || !source_->may_stream() || !needs_no_cells(contoured) ||
        !options_with_active_cells())
        return {};
    const Result<PointField> field = field_at(step, contoured.name, caller);
    if (!field) return field.error();
    const Result<ValueRange> range = typical_range_of_steps(*field, caller);
    if (!range) return range.error();
    Result<std::vector<double>> levels = levels_of(job_).within(*range, *field);
    if (!levels) return levels.error();
    job_.isovalues = *std::move(levels);
    return {};
}

/// What a field colours: where not all cells were read, with the boundary among it.
Result<void> PictureSource::take_colors(const std::string& color, Contents& contents, Caller& caller) {
    if (auto widened = widen_range(color, caller); !widened) return widened;
    const std::vector<RegionName> regions = source_->region_names();
    const auto digest = std::ranges::find(contents.digests, color, &Field::name);
    const Array all_values = digest == contents.digests.end() ? Array() : digest->values;
    Result<ColorField> colors = colors_of(contents.grid, color, regions, job_, caller, all_values);
    if (!colors) return colors.error();
    contents.colors = *std::move(colors);
    if (!contents.part) return {};
    const bool of_cells = contents.colors->association == Association::cell;
    const Result<ColorOptions> options = options_of_colors(color, regions, job_, all_values);
    if (!options) return options.error();
    const auto colors_in = [color, options = *options](const Grid& grid, const Run& run) -> Result<ColorField> {
        Result<FoundColors> found = find_colors(grid, color, options, run);
        if (!found) return found.error();
        return std::move(found->field);
    };
    if (contents.boundary && contents.model) {
        const Grid& around = of_cells ? streamed_boundary_->cells : contents.grid;
        const Result<ColorField> walls = of_cells ? colors_in(around, caller.run()) : *contents.colors;
        if (!walls) return walls.error();
        if (auto done = color_boundary(*contents.boundary, around, *walls, caller.run()); !done) return done;
    }
    if (!of_cells) return {};
    contents.part->whole = [whole = contents.part->whole, color, colors_in](const Run& run) -> Result<ContourInput> {
        Result<ContourInput> all = whole(run);
        if (!all) return all;
        const Result<ColorField> found = colors_in(all->grid, run);
        if (!found) return found.error();
        all->cell_fields = {{color, found->values}};
        return all;
    };
    return {};
}

/// Whether the opacity follows from values of the field.
bool PictureSource::needs_range_of_volume() const {
    if (!draws_volume(job_) || volume_opacity_) return false;
    return job_.volume_opacity ? job_.volume_opacity->preset.has_value() : !draws_dirac(job_);
}

/// Of a packed field only the range is read.
Result<ColorScale> PictureSource::scale_of_volume(std::size_t step, const Contents& contents, Caller& caller) {
    const PointField& field = *contents.field;
    if (contents.packed) {
        const Result<ColorField> colors = colors_at(step, field.name, caller);
        return colors ? Result<ColorScale>(colors->scale) : colors.error();
    }
    const Result<ColorOptions> options = color_options(job_.scale, job_.range);
    if (!options) return options.error();
    return color_scale(std::span(&field.values, 1), *options, caller.run());
}

/// The colours and the opacity of a volume. All steps have those of the first, by the range of all.
Result<void> PictureSource::take_volume(std::size_t step, Contents& contents, Caller& caller) {
    const PointField& field = *contents.field;
    for (const std::string* name : {&job_.color_by, &job_.boundary_color_by})
        if (!name->empty() && *name != field.name)
            return refusal(
                "colours are those of '{}', but the volume is one of '{}', and a picture has one colour scale", *name,
                field.name);
    if (auto widened = widen_range(field.name, caller); !widened) return widened;
    Result<ColorScale> scale = scale_of_volume(step, contents, caller);
    if (!scale) return scale.error();
    VolumeLook look{*scale, {}, job_.opacity_length, job_.dirac, job_.volume_shading};
    if (!job_.dirac_shares.empty()) {
        const auto found = isovalues_at(contents.grid, field, job_.dirac_shares, caller.run());
        if (!found) return found.error();
        look.isosurfaces.insert(look.isosurfaces.end(), found->begin(), found->end());
    }
    if (volume_opacity_) look.opacity = *volume_opacity_;
    else if (!needs_range_of_volume()) {
        if (job_.volume_opacity) look.opacity = job_.volume_opacity->curve;
    } else {
        const Result<ValueRange> range = typical_range_of_steps(field, caller);
        if (!range) return range.error();
        if (!(range->lower <= range->upper))
            return Error{ErrorCode::invalid_data,
                         fmt::format("field '{}' has no finite value: there is nothing to draw", field.name)};
        OpacityText opacity = job_.volume_opacity.value_or(OpacityText{{}, OpacityPreset::ramp, 0});
        if (opacity.preset == OpacityPreset::peaks && opacity.peaks == 0) opacity.peaks = job_.levels;
        look.opacity = opacity_of(opacity, *range);
    }
    volume_opacity_ = look.opacity;
    contents.volume_colors = ColorField{field.name, field.values, Association::point, *scale};
    contents.volume = std::move(look);
    return {};
}

/// Shares of a sweep become isovalues, which all steps have.
Result<void> PictureSource::find_sweep(const Contents& contents, Caller& caller) {
    for (const auto& [share, end] :
         {std::pair(&job_.sweep_shares.lower, 0U), std::pair(&job_.sweep_shares.upper, 1U)}) {
        if (!*share || !contents.field) continue;
        const auto found = isovalues_at(contents.grid, *contents.field, {&**share, 1}, caller.run());
        if (!found) return found.error();
        job_.sweep[end] = found->front();
        share->reset();
    }
    return {};
}

Result<void> PictureSource::choose_isovalues(const Contents& contents, DrawInput& input, Caller& caller) {
    if (job_.isovalues.empty() && job_.shares.empty()) {
        const Result<FillValues> fill = core::find_fill_values(*contents.field, caller.run());
        if (!fill) return fill.error();
        caller.note(fill_note(contents.field->name, *fill, fill_is_of(*contents.field)));
        const Result<ValueRange> range = typical_range_of_steps(*contents.field, caller);
        if (!range) return range.error();
        Result<std::vector<double>> levels = levels_of(job_).within(*range, *contents.field);
        if (!levels) return levels.error();
        input.isovalues = *std::move(levels);
        if (steps_.size() > 1) job_.isovalues = input.isovalues;
        return {};
    }
    input.isovalues = job_.isovalues;
    if (job_.shares.empty()) return {};
    const auto found = contents.shares.empty() ? isovalues_at(contents.grid, *contents.field, job_.shares, caller.run())
                                               : contents.shares;
    if (!found) return found.error();
    input.isovalues.insert(input.isovalues.end(), found->begin(), found->end());
    return {};
}

/// By the job, or where the grid is much flatter than wide.
void PictureSource::choose_stretch(const Array& points, Caller& caller) {
    if (!may_stretch()) return;
    const auto factors = default_stretch(points);
    if (!factors) return;
    job_.stretch.assign(factors->begin(), factors->end());
    caller.note(fmt::format("heights are drawn {} times as large; `scale` 1,1,1 draws them as they are",
                            shortest(job_.stretch[2])));
}

IsosurfaceOptions PictureSource::scene_options(Contents& contents, const std::vector<double>& isovalues) {
    IsosurfaceOptions options;
    if (contents.field) options.field = *contents.field;
    options.grid = std::exchange(contents.grid, {});
    options.part = std::move(contents.part);
    options.bounds = contents.bounds;
    options.boundary = std::move(contents.boundary);
    options.packed = std::move(contents.packed);
    options.contour = job_.contour;
    if (job_.sweep.empty() && !draws_volume(job_)) options.contour.expected_isovalues = isovalues;
    if (!job_.stretch.empty()) options.grid.points = stretched(options.grid.points, factors_of(job_.stretch));
    options.contour.surfaces = job_.sweep.empty() ? isovalues.size() : static_cast<std::uint64_t>(job_.sweep[2]);
    options.contour.method = job_.method.extract;
    options.draw = job_.method.draw;
    if (options.field.averaged && !job_.refine_averaged) options.contour.refine.reset();
    options.index = job_.index.value_or(default_index);
    options.picture = job_.picture;
    options.where = draws_volume(job_)                    ? ExtractOn::cpu
                    : job_.engine == EngineChoice::vulkan ? ExtractOn::device
                    : job_.engine == EngineChoice::cpu    ? ExtractOn::cpu
                                                          : ExtractOn::best;
    if (steps_.size() > 1 && !boundary_) boundary_ = std::make_shared<KnownBoundary>();
    options.known_boundary = boundary_;
    return options;
}

Result<DrawInput> PictureSource::read(std::size_t which, const std::optional<Device>& device, Caller& caller) {
    if (surface_) return take_surface(device, caller);
    DrawInput input;
    const core::Stopwatch reading;
    const std::size_t each = static_cast<std::size_t>(job_.interpolate) + 1, step = steps_[which / each];
    fraction_ = static_cast<double>(which % each) / static_cast<double>(each);
    Result<Contents> contents = read_contents(step, !device, caller);
    if (!contents) return contents.error();
    input.read_seconds = reading.seconds();
    if (auto found = find_sweep(*contents, caller); !found) return found.error();
    input.sweep = job_.sweep;
    const bool is_last = which + 1 == steps();
    if (!is_last && caller.run().threads != 1 && !contents->packed)
        contents->streamed ? streamed_.read_ahead(steps_[which + 1]) : grids_->read_ahead(steps_[which + 1]);
    if (!is_last && contents->packed && fraction_ == 0) {
        const std::size_t next = steps_[which / each + 1];
        for (const std::string& name : {job_.field.name, job_.color_by, job_.boundary_color_by})
            if (!name.empty()) packed_->read_ahead(name, next);
    }
    input.format = source_->info().format;
    input.time = time_of(source_->info(), step);
    if (input.time && fraction_ > 0)
        input.time = (1 - fraction_) * *input.time + fraction_ * source_->info().times[step + 1];
    if (source_->info().times.size() > 1) input.step = step;
    input.cells = contents->cells;
    input.colors = contents->volume ? contents->volume_colors : contents->colors;
    input.volume = contents->volume;
    if (contents->field) {
        input.field = contents->field->name;
        if (!contents->volume || (names_isovalues(job_) && job_.sweep.empty()))
            if (auto chosen = choose_isovalues(*contents, input, caller); !chosen) return chosen.error();
    }
    choose_stretch(contents->grid.points, caller);
    input.stretch = job_.stretch;
    const SceneLook look = look_of(*contents);
    Result<IsosurfaceScene> scene =
        IsosurfaceScene::create(device, scene_options(*contents, input.isovalues), look, caller.run());
    if (!scene) return scene.error();
    input.scene = *std::move(scene);
    return input;
}

void PictureSource::tell_what_was_read(Caller& caller) const {
    if (!packed_) return;
    caller.detail(fmt::format("{} of the {} bytes of the packed file were read",
                              grouped(packed_->residency().bytes_read), grouped(packed_->info().file_bytes)));
}

} // namespace isotet::jobs
