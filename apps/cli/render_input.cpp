// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render_input.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <isotet/color_field.hpp>
#include <isotet/field_statistics.hpp>
#include <isotet/levels.hpp>

#include "exit_code.hpp"
#include "field_choice.hpp"
#include "output_names.hpp"
#include "stopwatch.hpp"

namespace isotet::cli {

namespace {

/// Whether isovalues were asked for.
bool names_isovalues(const RenderCommand& command) {
    return !command.isovalues.empty() || command.levels > 0 || !command.sweep.empty() || command.method.draw;
}

Result<std::vector<double>> choose_levels(const RenderCommand& command, const PointField& field) {
    if (!command.isovalues.empty()) return command.isovalues;
    const ValueRange range = typical_range(field.values);
    std::vector<double> levels = evenly_spaced_levels(
        range.lower, range.upper, command.levels > 0 ? command.levels : default_levels, LevelRounding::short_decimals);
    if (!levels.empty()) return levels;
    return Error{ErrorCode::invalid_data,
                 fmt::format("field '{}' has no finite value: there is nothing to contour", field.name)};
}

/// The scale that is asked for.
Result<ColorOptions> color_options(const RenderCommand& command) {
    ColorOptions options{command.scale, {}};
    if (command.range.empty()) return options;
    if (command.range.size() != 2 || !(command.range[0] < command.range[1]))
        return usage_error("--range takes two numbers, the smaller one first, such as 0,100");
    options.range = ValueRange{command.range[0], command.range[1]};
    return options;
}

/// A field of `from`, a grid or a surface, that colours.
template <class From>
Result<ColorField> colors_of(const From& from, const std::string& name, const std::vector<RegionName>& regions,
                             const RenderCommand& command, Console& console) {
    Result<ColorOptions> options = color_options(command);
    if (!options) return options.error();
    for (const RegionName& region : regions)
        if (region.field == name) options->names[static_cast<double>(region.number)] = region.name;
    Result<FoundColors> found = find_colors(from, name, *options, console.run());
    if (!found) return found.error();
    console.notes(found->notes);
    return std::move(found->field);
}

/// Points with their axes stretched.
Array stretched(const Array& points, const std::vector<double>& factors) {
    return points.visit([&]<class Scalar>(std::span<const Scalar> scalars) {
        std::vector<Scalar> out(scalars.size());
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = static_cast<Scalar>(static_cast<double>(scalars[i]) * factors[i % 3]);
        return Array::own(std::move(out), 3);
    });
}

} // namespace

struct RenderSource::Contents {
    Grid grid;
    std::optional<PointField> field; ///< that is contoured
    std::optional<ColorField> colors;
    bool model = false; ///< the boundary is what is shown: opaque, coloured where there are colours
};

Result<RenderSource> RenderSource::open(const RenderCommand& command, Console& console) {
    RenderSource source(command);
    if (!command.color_by.empty() && !command.boundary_color_by.empty() &&
        command.color_by != command.boundary_color_by)
        return usage_error("--color-by is '{}' and --boundary-color-by '{}', but a picture has one colour scale",
                           command.color_by, command.boundary_color_by);
    const FileKinds kinds = kinds_of(command.grid.file);
    if (kinds.surface && command.grid.format.empty()) {
        const Stopwatch reading;
        Result<SurfaceFile> file = read_surface(command.grid.file, {}, console.run());
        if (file) {
            source.surface_ = std::move(file->surface);
            source.surface_format_ = file->format;
            source.surface_seconds_ = reading.seconds();
            return source;
        }
        // A name such as grid.vtk can be either.
        if (!kinds.grid || file.error().code != ErrorCode::invalid_data) return file.error();
    }
    Result<GridSource> grid = GridSource::open(command.grid, console);
    if (!grid) return grid.error();
    if (auto paths = check_output_paths(grid->info().files, {command.common.json}); !paths) return paths.error();
    source.source_ = *std::move(grid);
    auto steps =
        choose_steps(source.source_->info(), command.grid, command.all_steps ? Steps::all : Steps::one, console);
    if (!steps) return steps.error();
    source.steps_ = *std::move(steps);
    return source;
}

SceneLook RenderSource::look_of(const Contents& contents) const {
    SceneLook look;
    if (contents.field || !command_.slices.empty() || surface_) look.colors = contents.colors;
    if (contents.model) look.boundary_colors = contents.colors;
    if (contents.field && !look.colors && command_.sweep.size() == 3)
        look.isovalue_range = {std::min(command_.sweep[0], command_.sweep[1]),
                               std::max(command_.sweep[0], command_.sweep[1])};
    look.map = command_.scale.map;
    look.opacity = command_.opacity;
    look.boundary_opacity = command_.boundary.value_or(contents.model ? 1 : default_boundary_opacity);
    look.outline = command_.outline;
    look.line_width = std::max(1.0, command_.picture.height / 600.0);
    look.edges = command_.edges;
    look.shade_by = command_.shade_by;
    look.clips = command_.clips;
    look.slices = command_.slices;
    for (std::vector<Plane>* planes : {&look.clips, &look.slices})
        for (Plane& plane : *planes)
            for (std::size_t axis = 0; axis < 3 && !command_.stretch.empty(); ++axis)
                plane.normal[axis] /= command_.stretch[axis];
    return look;
}

Result<RenderInput> RenderSource::take_surface(const std::optional<Device>& device, Console& console) {
    if (names_isovalues(command_) || !command_.field.name.empty() || command_.boundary || command_.method.extract ||
        !command_.boundary_color_by.empty() || !command_.slices.empty()) {
        return usage_error("{} is a surface: it has no isovalues, no field to contour (--color-by colours it), no "
                           "boundary, no slices and no tets",
                           command_.grid.file);
    }
    RenderInput input;
    input.is_surface = true;
    input.format = surface_format_;
    input.read_seconds = surface_seconds_;
    Contents contents;
    if (!command_.color_by.empty()) {
        Result<ColorField> colors = colors_of(*surface_, command_.color_by, {}, command_, console);
        if (!colors) return colors.error();
        input.colors = contents.colors = *std::move(colors);
    }
    Surface surface = *surface_;
    if (!command_.stretch.empty()) {
        surface.positions = stretched(surface.positions, command_.stretch);
        surface.normals_kind = Normals::none;
    }
    Result<IsosurfaceScene> scene = IsosurfaceScene::create(device, std::move(surface), look_of(contents));
    if (!scene) return scene.error();
    input.scene = *std::move(scene);
    return input;
}

/// The range of a field that colours over all steps becomes --range.
Result<void> RenderSource::widen_range(const std::string& color, Console& console) {
    if (steps_.size() < 2 || color.empty() || !command_.range.empty()) return {};
    const Result<FoundField> found = choose_field(*source_, {color, false});
    if (!found) return found.error();
    ValueRange all{INFINITY, -INFINITY};
    for (const std::size_t step : steps_) {
        const Result<Grid> grid = source_->read({found->point, found->cell}, step, console);
        if (!grid) return grid.error();
        Result<ColorField> colors = colors_of(*grid, color, source_->info().regions, command_, console);
        if (!colors) return colors.error();
        if (!colors->classes.empty()) return {};
        const Result<ValueRange> one = colored_range(colors->values, command_.scale.logarithmic, console.run());
        if (!one) return one.error();
        all = {std::min(all.lower, one->lower), std::max(all.upper, one->upper)};
    }
    if (all.lower < all.upper) command_.range = {all.lower, all.upper};
    return {};
}

/// A step that was read ahead, or reads it.
Result<Grid> RenderSource::read_grid(const FieldsToRead& fields, std::size_t step, Console& console) {
    const bool is_there = ahead_.valid() && ahead_step_ == step && fields == last_read_;
    last_read_ = fields;
    return is_there ? ahead_.get() : source_->read(fields, step, console);
}

void RenderSource::read_ahead(std::size_t step, Console& console) {
    Run run = console.run();
    run.progress.report = {}; // the bar is that of the picture
    ahead_step_ = step;
    ahead_ = std::async(std::launch::async, [source = *source_, fields = last_read_, step, run, &console] {
        return source.read(fields, step, console, run);
    });
}

/// Reads what the picture needs of a step, and decides what it shows.
Result<RenderSource::Contents> RenderSource::read_contents(std::size_t step, Console& console) {
    Contents contents;
    const bool asked = names_isovalues(command_);
    std::string color = command_.color_by.empty() ? command_.boundary_color_by : command_.color_by;
    std::string field = command_.field.name;
    contents.model = !command_.boundary_color_by.empty();
    bool contours = asked || (command_.slices.empty() && (!contents.model || !field.empty()));
    if (!contours && color.empty()) color = field; // of slices
    const bool unnamed = contours ? field.empty() : color.empty();
    const std::size_t fields = source_->info().fields.size();

    FieldsToRead read;
    if (!unnamed || fields == 0) read = {std::vector<std::string>(), std::vector<std::string>()};
    for (const auto& [name, is_contoured] : {std::pair(field, true), std::pair(color, false)}) {
        if (unnamed || name.empty() || (is_contoured && !contours)) continue;
        const Result<FoundField> found = choose_field(*source_, {name, is_contoured && command_.field.cell_field});
        if (!found) return found.error();
        add_names(*read.point, found->point);
        add_names(*read.cell, found->cell);
    }
    Result<Grid> grid = read_grid(read, step, console);
    if (!grid) return grid.error();
    contents.grid = *std::move(grid);
    if (unnamed) {
        const DefaultField chosen = default_field(contents.grid);
        if (chosen.name.empty() && asked)
            return Error{ErrorCode::invalid_data,
                         fmt::format("none of the {} fields has two different values: there is nothing to contour; "
                                     "-f x, y or z contours a coordinate",
                                     fields)};
        const bool as_model = contours && !asked && color.empty() && (chosen.name.empty() || chosen.whole_numbers);
        if (as_model) {
            contours = false;
            contents.model = true;
            color = chosen.name;
            console.note(
                chosen.name.empty()
                    ? std::string("no field varies: the boundary of the grid is drawn")
                    : fmt::format("no field was named: '{}', whole numbers, colours the boundary; -f contours a "
                                  "field",
                                  chosen.name));
        } else {
            (contours ? field : color) = chosen.name;
            console.note(
                fmt::format("no field was named: '{}', which varies most, was taken; -f names another", chosen.name));
        }
    }
    if (contours) {
        Result<PointField> found = find_chosen(contents.grid, field, command_.field, console);
        if (!found) return found.error();
        contents.field = *std::move(found);
    }
    if (!color.empty()) {
        if (auto widened = widen_range(color, console); !widened) return widened.error();
        Result<ColorField> colors = colors_of(contents.grid, color, source_->info().regions, command_, console);
        if (!colors) return colors.error();
        contents.colors = *std::move(colors);
    }
    return contents;
}

Result<RenderInput> RenderSource::read(std::size_t which, const std::optional<Device>& device, Console& console) {
    if (surface_) return take_surface(device, console);
    RenderInput input;
    const Stopwatch reading;
    const std::size_t step = steps_[which];
    Result<Contents> contents = read_contents(step, console);
    if (!contents) return contents.error();
    input.read_seconds = reading.seconds();
    if (which + 1 < steps_.size() && console.run().threads != 1) read_ahead(steps_[which + 1], console);
    input.format = source_->info().format;
    input.time = time_of(source_->info(), step);
    if (source_->info().times.size() > 1) input.step = step;
    input.cells = contents->grid.cells.count();
    input.colors = contents->colors;
    IsosurfaceOptions options;
    if (contents->field) {
        input.field = contents->field->name;
        Result<std::vector<double>> levels = choose_levels(command_, *contents->field);
        if (!levels) return levels.error();
        input.isovalues = *std::move(levels);
        if (steps_.size() > 1) command_.isovalues = input.isovalues;
        options.field = *contents->field;
    }
    options.grid = contents->grid;
    if (!command_.stretch.empty()) options.grid.points = stretched(options.grid.points, command_.stretch);
    options.surfaces = command_.sweep.empty() ? input.isovalues.size() : static_cast<std::uint64_t>(command_.sweep[2]);
    options.method = command_.method.extract;
    options.draw = command_.method.draw;
    options.split_cells = command_.split_cells;
    options.refine = command_.refine;
    options.index = command_.index.value_or(default_index);
    options.picture = command_.picture;
    options.where = command_.engine == EngineChoice::vulkan ? ExtractOn::device
                    : command_.engine == EngineChoice::cpu  ? ExtractOn::cpu
                                                            : ExtractOn::best;
    const SceneLook look = look_of(*contents);
    contents->grid = {};
    Result<IsosurfaceScene> scene = IsosurfaceScene::create(device, std::move(options), look, console.run());
    if (!scene) return scene.error();
    input.scene = *std::move(scene);
    return input;
}

} // namespace isotet::cli
