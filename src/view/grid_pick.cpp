// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The point of a surface that a page asks about.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <mutex>
#include <span>
#include <utility>

#include <isotet/boundary.hpp>
#include <isotet/scene.hpp>

#include "view/grid_view.hpp"

namespace isotet::view {

namespace {

/// The tuples of these cells; NaN where no cell was found.
Array tuples_of_cells(const Array& values, const std::vector<std::uint64_t>& cells) {
    const std::size_t components = values.components();
    const auto gather = [&]<class Out, class Scalar>(std::vector<Out> some, std::span<const Scalar> all) {
        for (std::size_t i = 0; i < cells.size(); ++i)
            for (std::size_t c = 0; c < components && cells[i] < values.tuples(); ++c)
                some[i * components + c] = static_cast<Out>(all[cells[i] * components + c]);
        return Array::own(std::move(some), components);
    };
    const bool all_found = std::ranges::all_of(cells, [&](std::uint64_t cell) { return cell < values.tuples(); });
    return values.visit([&]<class Scalar>(std::span<const Scalar> all) {
        const std::size_t count = cells.size() * components;
        return all_found ? gather(std::vector<Scalar>(count), all) : gather(std::vector<double>(count, NAN), all);
    });
}

} // namespace

/// The boundary with all fields.
Result<Surface> GridView::boundary_of_pick(const Run& run) {
    std::unique_lock lock(boundary_mutex_);
    const std::shared_ptr<const Surface> found = boundary_surface_;
    const std::uint64_t number = boundary_number_;
    lock.unlock();
    if (!found) return Error{ErrorCode::cancelled, "the boundary is not there yet"}; // a page is told nothing
    if (Result<void> here = need_cells(run); !here) return here.error();
    Surface boundary = *found;
    if (is_of_file() && cells_.empty()) { // its faces are cut in another way
        Result<Surface> again = boundary_of(grid_, run);
        if (!again) return again;
        boundary = *std::move(again);
    }
    if (Result<void> cells = find_boundary_cells(boundary, number, run); !cells) return cells.error();
    std::vector<Field> of_points;
    std::ranges::copy_if(grid_.point_fields, std::back_inserter(of_points),
                         [](const Field& field) { return field.values.tuples() > 0; });
    Result<std::vector<Field>> at_vertices = fields_at_boundary(boundary, grid_, of_points, run);
    if (!at_vertices) return at_vertices.error();
    boundary.point_fields = *std::move(at_vertices);
    for (const Field& field : grid_.cell_fields)
        if (field.values.tuples() > 0)
            boundary.cell_fields.push_back({field.name, tuples_of_cells(field.values, boundary_cells_)});
    boundary.source_cells = Array::own(std::vector<std::int64_t>(boundary_cells_.begin(), boundary_cells_.end()));
    return boundary;
}

/// A solid with all fields.
Result<Surface> GridView::solid_of_pick(const PickMessage& message, const Run& run) {
    if (Result<void> here = need_cells(run); !here) return here.error();
    Result<PointField> field = field_of(message.state.field, run);
    if (!field) return field.error();
    ContourOptions options;
    options.method = Method::direct;
    options.source_cells = true;
    Result<Solids> solids =
        Solids::create({grid_, *std::move(field), grid_.point_fields, grid_.cell_fields}, options, run);
    if (!solids) return solids.error();
    const double isovalue = message.state.isovalues.front();
    Result<Solid> solid = solids->extract(
        message.state.solid == SolidSide::above ? SolidRange::above(isovalue) : SolidRange::below(isovalue), run);
    if (!solid) return solid.error();
    return std::move(solid->surface);
}

Result<Surface> GridView::surface_of_pick(const PickMessage& message, const Run& run) {
    const bool packed = uses_packed() && lean_;
    ExtractOptions with_all;
    with_all.source_cells = !packed || lean_->knows_cells();
    with_all.point_fields = grid_.point_fields;
    with_all.cell_fields = grid_.cell_fields;
    if (packed && is_of_file()) {
        with_all.cell_fields.clear();
        for (const auto& [name, field] : file_cells_) with_all.cell_fields.push_back(field);
    }
    if (message.boundary) return boundary_of_pick(run);
    const Plane* plane = message.slice ? &message.state.slices[*message.slice] : nullptr;
    if (message.state.solid && !plane) return solid_of_pick(message, run);
    if (packed && plane) return lean_->slice(grid_.points, *plane, step_, with_all, run);
    Result<PointField> field = plane ? slice_field(grid_.points, *plane, run) : field_of(message.state.field, run);
    if (!field) return field.error();
    const double isovalue = plane ? plane->offset : message.state.isovalues.front();
    if (packed) return lean_->isosurface(*field, step_, isovalue, with_all, run);
    ContourOptions options;
    options.method = Method::direct;
    options.source_cells = true;
    options.expected_isovalues = {isovalue};
    options.surfaces = 1;
    Result<Contour> contour =
        Contour::create({grid_, *std::move(field), grid_.point_fields, grid_.cell_fields}, options);
    if (!contour) return contour.error();
    Result<ContourResult> extracted = contour->extract(isovalue, run);
    if (!extracted) return extracted.error();
    return std::move(extracted->surfaces.front().surface);
}

/// Without the parts that are left out; with their numbers where the page asks for these.
Result<Surface> GridView::shown_surface(const PickMessage& message, const Run& run) {
    Result<Surface> surface = surface_of_pick(message, run);
    if (!surface || message.slice || message.boundary) return surface;
    const bool is_solid = message.state.solid.has_value();
    if (message.parts || message.state.keep) {
        const Result<SurfaceParts> parts = find_parts(*surface, run);
        if (!parts) return parts.error();
        const auto kept =
            chosen_parts(*surface, *parts, message.state.keep.value_or(PartChoice{PartChoice::Kind::others}),
                         is_solid ? PartsOf::solid : PartsOf::isosurface);
        if (!kept) return kept.error();
        surface = keep_parts(*surface, *parts, *kept, run);
        if (!surface) return surface;
    }
    if (is_solid) { // which part of the solid a triangle is of: the last field of that name
        const auto last = std::ranges::find(surface->cell_fields.rbegin(), surface->cell_fields.rend(), "boundary", &Field::name);
        surface->cell_fields.erase(std::next(last).base());
    }
    return surface;
}

Result<Picked> GridView::pick_along(const PickMessage& message, const Run& run) {
    std::optional<Picked> first;
    double nearest = INFINITY;
    const auto look = [&](const PickMessage& one, std::span<const Plane> clips) -> Result<void> {
        const Result<Surface> surface = shown_surface(one, run);
        if (!surface) return surface.error();
        const auto along = first_on_ray(*surface, message.point, *message.ray, clips);
        if (!along || *along >= nearest) return {};
        nearest = *along;
        std::array<double, 3> place = message.point;
        for (std::size_t axis = 0; axis < 3; ++axis) place[axis] += nearest * (*message.ray)[axis];
        first = nearest_on(*surface, place);
        if (first && !one.slice && !one.boundary) first->isovalue = one.state.isovalues.front();
        if (first) first->boundary = one.boundary;
        return {};
    };
    PickMessage one = message;
    if (message.boundary) {
        if (Result<void> ok = look(one, message.state.clips); !ok) return ok.error();
    }
    one.boundary = false;
    const auto& volume = message.state.volume;
    if (volume ? volume->surfaces : message.state.isosurfaces)
        for (const double isovalue : message.state.isovalues) {
            one.state.isovalues = {isovalue};
            if (Result<void> ok = look(one, message.state.clips); !ok) return ok.error();
        }
    for (std::size_t i = 0; i < message.state.slices.size(); ++i) {
        one.slice = i;
        if (Result<void> ok = look(one, {}); !ok) return ok.error();
    }
    if (!first) return Error{ErrorCode::cancelled, "the ray meets nothing"}; // a page is told nothing
    return *std::move(first);
}

Result<Picked> GridView::pick(const PickMessage& message, const Run& run) {
    if (Result<void> there = show_grid({}, message.state.cells, run); !there) return there.error();
    if (message.ray) return pick_along(message, run);
    const Result<Surface> surface = shown_surface(message, run);
    if (!surface) return surface.error();
    std::optional<Picked> picked = nearest_on(*surface, message.point);
    if (!picked) return Error{ErrorCode::invalid_data, "the surface has no triangle here"};
    return *std::move(picked);
}

} // namespace isotet::view
