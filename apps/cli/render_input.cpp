// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render_input.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <isotet/boundary.hpp>
#include <isotet/field_statistics.hpp>
#include <isotet/levels.hpp>

#include "field_choice.hpp"
#include "grid_source.hpp"
#include "render_colors.hpp"
#include "stopwatch.hpp"

namespace isotet::cli {

namespace {

Result<RenderInput> take_surface(const RenderCommand& command, SurfaceFile file, double seconds, Console& console) {
    if (!command.isovalues.empty() || !command.sweep.empty() || command.levels > 0 || !command.field.name.empty() ||
        command.boundary || command.method.draw || command.method.extract) {
        return usage_error(fmt::format("{} is a surface: it has no isovalues, no field to contour (--color-by colours it), "
                                 "no boundary and no tets",
                                 command.grid.file));
    }
    RenderInput input;
    input.format = file.format;
    input.bounds = bounds_of(file.surface);
    input.read_seconds = seconds;
    if (!command.color_by.empty()) {
        Result<ColorField> colors = colors_of(file.surface, command, console);
        if (!colors) return colors.error();
        input.colors = *std::move(colors);
    }
    input.surface = std::move(file.surface);
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

/// Starts the session. A device colours by the grid's own values; on the CPU surfaces carry the field that colours.
Result<void> start(const RenderCommand& command, const Device& device, const Run& run, ContourInput source,
                   RenderInput& input) {
    ContourOptions options;
    options.normals = Normals::gradient;
    options.method = command.method.draw ? Method::clusters : command.method.extract;
    options.surfaces = command.sweep.empty() ? input.isovalues.size() : static_cast<std::uint64_t>(command.sweep[2]);
    const bool by_cells = input.colors && input.colors->association == Association::cell;
    const bool by_points = input.colors && !by_cells;
    const bool card = device.info().kind != DeviceKind::software && options.method != Method::direct;
    const bool asked = command.engine == EngineChoice::vulkan;
    ContourInput carrying = source;
    if (by_points) carrying.point_fields.push_back({input.colors->name, input.colors->values});
    if (by_cells) carrying.cell_fields.push_back({input.colors->name, input.colors->values});
    if (!command.method.draw && (asked || (card && command.engine == EngineChoice::automatic))) {
        options.device = ContourDevice{device, asked};
        options.edge_ends = by_points;
        options.source_cells = by_cells;
        input.source = std::move(carrying);
    } else {
        source = std::move(carrying);
    }
    Result<Contour> contour = Contour::create(std::move(source), options);
    if (!contour) return contour.error();
    input.contour = *std::move(contour);
    const Stopwatch packing;
    if (Result<void> ready = input.contour->prepare(run); !ready) return ready;
    if (input.contour->packed()) input.pack_seconds = packing.seconds();
    return {};
}

/// The boundary if it is drawn, and the box around the grid.
Result<void> look_around(const RenderCommand& command, const Grid& grid, const Run& run, RenderInput& input) {
    const Stopwatch looking;
    if (command.boundary.value_or(default_boundary_opacity) > 0) {
        Result<Surface> boundary = boundary_of(grid, run);
        if (!boundary) return boundary.error();
        input.boundary = *std::move(boundary);
        input.bounds = bounds_of(*input.boundary);
    } else {
        const Result<GridReport> report = survey(grid, {.faces = false}, run);
        if (!report) return report.error();
        input.bounds.add(report->lower);
        input.bounds.add(report->upper);
    }
    input.boundary_seconds = looking.seconds();
    return {};
}

Result<RenderInput> take_grid(const RenderCommand& command, const Device& device, Console& console) {
    RenderInput input;
    const Stopwatch reading;
    const Run& run = console.run();
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
    grid.point_fields = grid.cell_fields = {};
    if (auto looked = look_around(command, grid, run, input); !looked) return looked.error();
    if (auto started = start(command, device, run, {std::move(grid), *field, {}, {}}, input); !started)
        return started.error();
    return input;
}

} // namespace

Result<RenderInput> read_render_input(const RenderCommand& command, const Device& device, Console& console) {
    const FileKinds kinds = kinds_of(command.grid.file);
    if (!kinds.surface || !command.grid.format.empty()) return take_grid(command, device, console);
    const Stopwatch reading;
    Result<SurfaceFile> file = read_surface(command.grid.file, {}, console.run());
    if (file) return take_surface(command, *std::move(file), reading.seconds(), console);
    // A name such as grid.vtk can be either.
    if (kinds.grid && file.error().code == ErrorCode::invalid_data) return take_grid(command, device, console);
    return file.error();
}

} // namespace isotet::cli
