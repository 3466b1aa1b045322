// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render_input.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <isotet/field_statistics.hpp>
#include <isotet/levels.hpp>

#include "field_choice.hpp"
#include "grid_source.hpp"
#include "render_colors.hpp"
#include "stopwatch.hpp"

namespace isotet::cli {

namespace {

SceneLook look_of(const RenderCommand& command, const RenderInput& input) {
    return {.colors = input.colors,
            .map = command.scale.map,
            .opacity = command.opacity,
            .boundary_opacity = command.boundary.value_or(default_boundary_opacity),
            .outline = command.outline,
            .line_width = std::max(1.0, command.picture.height / 600.0)};
}

Result<RenderInput> take_surface(const RenderCommand& command, const Device& device, SurfaceFile file, double seconds,
                                 Console& console) {
    if (!command.isovalues.empty() || !command.sweep.empty() || command.levels > 0 || !command.field.name.empty() ||
        command.boundary || command.method.draw || command.method.extract) {
        return usage_error("{} is a surface: it has no isovalues, no field to contour (--color-by colours it), no "
                           "boundary and no tets", command.grid.file);
    }
    RenderInput input;
    input.is_surface = true;
    input.format = file.format;
    input.read_seconds = seconds;
    if (!command.color_by.empty()) {
        Result<ColorField> colors = colors_of(file.surface, command, console);
        if (!colors) return colors.error();
        input.colors = *std::move(colors);
    }
    Result<IsosurfaceScene> scene = IsosurfaceScene::create(device, std::move(file.surface), look_of(command, input));
    if (!scene) return scene.error();
    input.scene = *std::move(scene);
    return input;
}

Result<std::vector<double>> choose_levels(const RenderCommand& command, const PointField& field) {
    if (!command.isovalues.empty()) return command.isovalues;
    const ValueRange range = typical_range(field.values);
    std::vector<double> levels =
        evenly_spaced_levels(range.lower, range.upper, command.levels > 0 ? command.levels : default_levels,
                             LevelRounding::short_decimals);
    if (!levels.empty()) return levels;
    return Error{ErrorCode::invalid_data,
                 fmt::format("field '{}' has no finite value: there is nothing to contour", field.name)};
}

Result<RenderInput> take_grid(const RenderCommand& command, const Device& device, Console& console) {
    RenderInput input;
    const Stopwatch reading;
    const Result<GridSource> source = GridSource::open(command.grid, console);
    if (!source) return source.error();
    input.format = source->info().format;
    const auto steps = choose_steps(source->info(), command.grid, Steps::one, console);
    if (!steps) return steps.error();
    input.time = time_of(source->info(), steps->front());
    Grid grid;
    const Result<PointField> field =
        read_field(*source, steps->front(), command.field, command.color_by, console, grid);
    if (!field) return field.error();
    input.read_seconds = reading.seconds();
    input.cells = grid.cells.count();
    input.field = field->name;

    if (!command.color_by.empty()) {
        Result<ColorField> colors = colors_of(grid, command, console);
        if (!colors) return colors.error();
        input.colors = *std::move(colors);
    }
    Result<std::vector<double>> levels = choose_levels(command, *field);
    if (!levels) return levels.error();
    input.isovalues = *std::move(levels);
    IsosurfaceOptions options;
    options.grid = std::move(grid);
    options.field = *field;
    options.surfaces = command.sweep.empty() ? input.isovalues.size() : static_cast<std::uint64_t>(command.sweep[2]);
    options.method = command.method.extract;
    options.draw = command.method.draw;
    options.index = command.index.value_or(default_index);
    options.picture = command.picture;
    options.where = command.engine == EngineChoice::vulkan ? ExtractOn::device
                    : command.engine == EngineChoice::cpu  ? ExtractOn::cpu
                                                           : ExtractOn::best;
    Result<IsosurfaceScene> scene =
        IsosurfaceScene::create(device, std::move(options), look_of(command, input), console.run());
    if (!scene) return scene.error();
    input.scene = *std::move(scene);
    return input;
}

} // namespace

Result<RenderInput> read_render_input(const RenderCommand& command, const Device& device, Console& console) {
    const FileKinds kinds = kinds_of(command.grid.file);
    if (!kinds.surface || !command.grid.format.empty()) return take_grid(command, device, console);
    const Stopwatch reading;
    Result<SurfaceFile> file = read_surface(command.grid.file, {}, console.run());
    if (file) return take_surface(command, device, *std::move(file), reading.seconds(), console);
    // A name such as grid.vtk can be either.
    if (kinds.grid && file.error().code == ErrorCode::invalid_data) return take_grid(command, device, console);
    return file.error();
}

} // namespace isotet::cli
