// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is there for all isovalues: the grid's boundary, slices, and how large all is.
#include <utility>

#include <isotet/boundary.hpp>
#include <isotet/extract.hpp>

#include "base/stopwatch.hpp"
#include "scene/clip_surface.hpp"
#include "scene/colored_surface.hpp"
#include "scene/scene_data.hpp"

namespace isotet {

using scene::single_color;

/// The boundary if it is drawn, slices, and the box around the grid.
Result<void> IsosurfaceScene::Data::look_around(const Grid& grid, KnownBoundary* known, const Run& run) {
    const core::Stopwatch looking;
    if (look.boundary_opacity > 0) {
        const Result<DrawnGrid> drawn = grid_with_joined_points(grid, run);
        if (!drawn) return drawn.error();
        Result<Surface> found = known ? known->of(drawn->grid, run) : boundary_of(drawn->grid, run);
        if (!found) return found.error();
        if (look.boundary_colors)
            if (auto colored = color_boundary(*found, drawn->grid, *look.boundary_colors, run); !colored)
                return colored;
        take_boundary(*std::move(found));
    } else {
        const Result<GridReport> surveyed = survey(grid, {.faces = false}, run);
        if (!surveyed) return surveyed.error();
        bounds.add(surveyed->lower);
        bounds.add(surveyed->upper);
    }
    report.boundary_seconds = looking.seconds();
    const ColorField* colors = look.colors ? &*look.colors : nullptr;
    const auto cut = [&](const Plane& plane) { return slice_of(grid, plane, colors, run); };
    if (auto made = make_slices(cut); !made) return made;
    return add_boundary();
}

/// The same of a packed grid.
Result<void> IsosurfaceScene::Data::look_around_packed(const IsosurfaceOptions& options, const Run& run) {
    const PackedScene& packed = *options.packed;
    if (look.boundary_opacity > 0) {
        const core::Stopwatch looking;
        std::vector<PackedGrid> colors;
        if (look.boundary_colors) colors.push_back(*packed.colors);
        Result<Surface> found = boundary_of(packed.grid, colors, run);
        if (!found) return found.error();
        take_boundary(*std::move(found));
        report.boundary_seconds = looking.seconds();
    }
    ExtractOptions carried;
    if (look.colors && look.colors->association == Association::cell)
        carried.cell_fields = {{look.colors->name, look.colors->values}};
    else if (look.colors) carried.packed_fields = {*packed.colors};
    const auto cut = [&](const Plane& plane) -> Result<Surface> {
        const Result<PackedGrid> heights = packed.sliced(plane, run);
        if (!heights) return heights.error();
        Result<Extraction> slice = extract(*heights, plane.offset, carried, run);
        if (!slice) return slice.error();
        return std::move(slice->surface);
    };
    if (auto made = make_slices(cut); !made) return made;
    return add_boundary();
}

/// By cut(plane).
Result<void> IsosurfaceScene::Data::make_slices(const std::function<Result<Surface>(const Plane& plane)>& cut) {
    for (std::size_t i = 0; i < look.slices.size(); ++i) {
        Result<Surface> slice = cut(look.slices[i]);
        if (!slice) return slice.error();
        if (slice->triangle_count() == 0) report.empty_slices.push_back(i);
        report.slice_triangles += slice->triangle_count();
        if (look.edges) edges.push_back(scene::edges_of(*slice));
        slices.push_back(*std::move(slice));
    }
    for (const Surface& slice : slices)
        if (auto added = add_fixed(slice, look.colors ? &*look.colors : nullptr, single_color, 1); !added) return added;
    return {};
}

/// With its field of colours, if it has one.
void IsosurfaceScene::Data::take_boundary(Surface found) {
    bounds = bounds_of(found);
    report.boundary_faces = found.triangle_count();
    for (const Plane& plane : look.clips) found = scene::clipped(found, plane);
    boundary = std::move(found);
    if (look.edges) edges.push_back(scene::edges_of(*boundary));
}

Result<void> IsosurfaceScene::Data::add_boundary() {
    if (!boundary) return {};
    return add_fixed(*boundary, look.boundary_colors ? &*look.boundary_colors : nullptr, {0.62F, 0.66F, 0.70F, 1},
                     look.boundary_opacity);
}

/// Adds what is drawn for all isovalues. Its first field of points or cells colours it.
Result<void> IsosurfaceScene::Data::add_fixed(const Surface& one, const ColorField* field, const Color& color,
                                              double opacity) {
    DrawnSurface& drawn = fixed.emplace_back();
    drawn.color = color;
    drawn.opacity = opacity;
    if (!device) {
        drawn.triangles = &one;
        if (field) drawn.values = &fixed_values.emplace_back(scene::carried_colors(one, *field));
        return {};
    }
    Result<DeviceMesh> mesh = DeviceMesh::upload(*device, one);
    if (!mesh) return mesh.error();
    drawn.mesh = &fixed_meshes.emplace_back(*std::move(mesh));
    if (!field) return {};
    const SurfaceColors carried = scene::carried_colors(one, *field);
    Result<DeviceColors> colors = DeviceColors::of_mesh(*device, carried.values, carried.association, carried.scale);
    if (!colors) return colors.error();
    drawn.colors = &fixed_colors.emplace_back(*std::move(colors));
    return {};
}

} // namespace isotet
