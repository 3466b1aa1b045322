// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render_input.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include <isotet/boundary.hpp>

#include "grid_source.hpp"
#include "read_field.hpp"
#include "render_colors.hpp"
#include "stopwatch.hpp"
#include "varied_field.hpp"

namespace isotet::cli {

namespace {

constexpr std::uint64_t levels_without_a_word = 3;

/// What the ending of a name can be.
struct Kinds {
    bool grid = false, surface = false;
};
Kinds kinds_of(const std::string& file) {
    if (file.starts_with("make:")) return {true, false};
    std::string ending = std::filesystem::path(file).extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    Kinds kinds;
    for (const Format& format : formats()) {
        if (std::ranges::find(format.extensions, ending) == format.extensions.end()) continue;
        kinds.grid = kinds.grid || format.reads_grid;
        kinds.surface = kinds.surface || format.reads_surface;
    }
    return kinds;
}

Result<RenderInput> take_surface(const RenderCommand& command, SurfaceFile file, double seconds, Console& console) {
    if (!command.isovalues.empty() || !command.sweep.empty() || command.levels > 0 || !command.field.name.empty() ||
        command.boundary || command.method) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("{} is a surface: it has no isovalues, no field to contour (--color-by colours it), "
                                 "no boundary and no tets",
                                 command.grid.file)};
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
    const std::uint64_t count = command.levels > 0 ? command.levels : levels_without_a_word;
    std::vector<double> levels = levels_within(field, count);
    if (!levels.empty()) return levels;
    return Error{ErrorCode::invalid_data,
                 fmt::format("field '{}' has no finite value: there is nothing to contour", field.name)};
}

Result<RenderInput> take_grid(const RenderCommand& command, Console& console) {
    RenderInput input;
    const Stopwatch reading;
    const Result<GridSource> source = GridSource::open(command.grid, command.common, console);
    if (!source) return source.error();
    input.format = source->info().format;
    const auto steps = choose_steps(source->info(), command.grid, Steps::one, console);
    if (!steps) return steps.error();
    Grid grid;
    const Result<PointField> field =
        read_field(*source, steps->front(), command.field, command.color_by, command.common.threads, console, grid);
    if (!field) return field.error();
    input.read_seconds = reading.seconds();

    if (!command.color_by.empty()) {
        Result<ColorField> colors = colors_of(grid, command, console);
        if (!colors) return colors.error();
        input.colors = *std::move(colors);
    }
    const bool by_cells = input.colors && input.colors->association == Association::cell;
    Result<std::vector<double>> levels = choose_levels(command, *field);
    if (!levels) return levels.error();
    input.isovalues = *std::move(levels);

    const Stopwatch packing;
    Result<PackedGrid> packed = pack(grid, *field, {.source_cells = by_cells, .gradients = true}, console.run());
    if (!packed) return packed.error();
    input.pack_seconds = packing.seconds();
    input.cells = grid.cells.count();
    input.field = field->name;
    input.lower = packed->field().lower;
    input.upper = packed->field().upper;
    input.bounds = bounds_of(*packed);
    if (command.boundary.value_or(boundary_without_a_word) > 0) {
        const Stopwatch looking;
        Result<Surface> boundary = boundary_of(*packed, console.run());
        if (!boundary) return boundary.error();
        input.boundary = *std::move(boundary);
        input.boundary_seconds = looking.seconds();
    }
    input.packed = *std::move(packed);
    return input;
}

} // namespace

Result<RenderInput> read_render_input(const RenderCommand& command, Console& console) {
    const Kinds kinds = kinds_of(command.grid.file);
    if (!kinds.surface || !command.grid.format.empty()) return take_grid(command, console);
    const Stopwatch reading;
    Result<SurfaceFile> file = read_surface(command.grid.file, {}, console.run());
    if (file) return take_surface(command, *std::move(file), reading.seconds(), console);
    // A name such as grid.vtk can be either.
    if (kinds.grid && file.error().code == ErrorCode::invalid_data) return take_grid(command, console);
    return file.error();
}

} // namespace isotet::cli
