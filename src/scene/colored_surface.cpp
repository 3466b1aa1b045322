// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene/colored_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include <fmt/core.h>

#include <isotet/contour.hpp>
#include <isotet/scene.hpp>

#include "base/carry_out.hpp"
#include "base/errors.hpp"

namespace isotet::scene {

namespace {

using Face = std::array<std::uint64_t, 3>;

struct FaceHash {
    std::size_t operator()(const Face& face) const noexcept {
        std::uint64_t hash = 0x9E3779B97F4A7C15U;
        for (const std::uint64_t point : face) hash = (hash ^ point) * 0xBF58476D1CE4E5B9U;
        return hash ^ hash >> 29;
    }
};

/// Some tuples.
template <class Number>
Array gathered(const Array& values, std::size_t count, const Number& number) {
    const std::size_t components = values.components();
    return values.visit([&]<class Scalar>(std::span<const Scalar> scalars) {
        std::vector<Scalar> out(count * components);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t from = number(i) * components;
            for (std::size_t c = 0; c < components; ++c) out[i * components + c] = scalars[from + c];
        }
        return Array::own(std::move(out), components);
    });
}

/// A value for each triangle; NaN where no cell was found.
Array gathered_of_cells(const Array& values, const std::vector<std::uint64_t>& cells) {
    const auto cell = [&](std::size_t i) { return cells[i]; };
    if (std::ranges::all_of(cells, [&](std::uint64_t one) { return one < values.size(); }))
        return gathered(values, cells.size(), cell);
    std::vector<double> out(cells.size(), NAN);
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (cells[i] < values.size()) out[i] = values.at(cells[i]);
    return Array::own(std::move(out));
}

Result<std::vector<std::uint64_t>> cells_at(const Surface& boundary, const Grid& grid, const Run& run) {
    const auto ends = boundary.edge_ends.as<std::int64_t>();
    std::unordered_map<Face, std::size_t, FaceHash> faces(boundary.triangle_count());
    boundary.triangles.visit([&](auto corners) {
        for (std::size_t i = 0; i < boundary.triangle_count() && !run.progress.cancelled(); ++i) {
            Face face{};
            for (std::size_t k = 0; k < 3; ++k)
                face[k] = static_cast<std::uint64_t>(ends[2 * static_cast<std::size_t>(corners[3 * i + k])]);
            std::ranges::sort(face);
            faces.emplace(face, i);
        }
    });
    const Result<LinearGrid> linear = linearize({grid.points, grid.cells, {}, {}}, {}, run);
    if (!linear) return linear.error();
    const Result<TetList> tets = split(linear->grid, run);
    if (!tets) return tets.error();
    const auto user_cell = [&](std::uint64_t cell) {
        return linear->source_cells.empty() ? cell : linear->source_cells.as<std::uint64_t>()[cell];
    };
    std::vector<std::uint64_t> cells(boundary.triangle_count(), UINT64_MAX);
    for (std::size_t tet = 0; tet < tets->tets.size(); ++tet) {
        if (tet % (1 << 14) == 0 && run.progress.cancelled())
            return Error{ErrorCode::cancelled, "finding cells at the boundary was cancelled"};
        for (std::size_t left_out = 0; left_out < 4; ++left_out) {
            Face face{};
            for (std::size_t k = 0, to = 0; k < 4; ++k)
                if (k != left_out) face[to++] = tets->tets[tet][k];
            std::ranges::sort(face);
            const auto found = faces.find(face);
            if (found != faces.end())
                cells[found->second] = std::min(cells[found->second], user_cell(tets->cells[tet]));
        }
    }
    return cells;
}

} // namespace

SurfaceColors carried_colors(const Surface& surface, const ColorField& field) {
    const auto& fields = field.association == Association::point ? surface.point_fields : surface.cell_fields;
    return {fields.front().values, field.association, field.scale};
}

} // namespace isotet::scene

namespace isotet {

Result<std::vector<std::uint64_t>> boundary_cells(const Surface& boundary, const Grid& grid, const Run& run) {
    if (!boundary.source_cells.empty()) {
        const auto known = boundary.source_cells.as<std::int64_t>();
        return std::vector<std::uint64_t>(known.begin(), known.end());
    }
    return core::carry_out("finding cells at the boundary", run, [&](const Progress& progress) {
        return scene::cells_at(boundary, grid, {.progress = progress});
    });
}

Result<std::vector<Field>> fields_at_boundary(const Surface& boundary, const Grid& grid, std::span<const Field> fields,
                                              const Run& run) {
    const auto ends = boundary.edge_ends.as<std::int64_t>();
    const std::int64_t last = ends.empty() ? -1 : *std::ranges::max_element(ends);
    const auto is_short = [&](const Field& field) { return last >= static_cast<std::int64_t>(field.values.tuples()); };
    std::optional<LinearGrid> linear;
    if (std::ranges::any_of(fields, is_short)) { // of points that linearize() has made
        Result<LinearGrid> made = linearize({grid.points, grid.cells, {}, {}}, {}, run);
        if (!made) return made.error();
        linear = *std::move(made);
    }
    std::vector<Field> found;
    for (const Field& field : fields) {
        Array values = field.values;
        if (is_short(field)) {
            Result<Array> longer = linear->extend(values, run);
            if (!longer) return longer.error();
            values = *std::move(longer);
            if (last >= static_cast<std::int64_t>(values.tuples()))
                return invalid_argument(
                    fmt::format("the boundary has point {}, but the grid has {}", last, values.tuples()));
        }
        found.push_back({field.name, scene::gathered(values, boundary.vertex_count(), [&](std::size_t i) {
                             return static_cast<std::size_t>(ends[2 * i]);
                         })});
    }
    return found;
}

Result<void> color_boundary_by_points(Surface& boundary, const Grid& grid, const ColorField& field, const Run& run) {
    const Field of_points{field.name, field.values};
    Result<std::vector<Field>> found = fields_at_boundary(boundary, grid, std::span(&of_points, 1), run);
    if (!found) return found.error();
    boundary.point_fields = *std::move(found);
    return {};
}

void color_boundary_by_cells(Surface& boundary, const std::vector<std::uint64_t>& cells, const ColorField& field) {
    boundary.cell_fields = {{field.name, scene::gathered_of_cells(field.values, cells)}};
}

Result<void> color_boundary(Surface& boundary, const Grid& grid, const ColorField& field, const Run& run) {
    const bool of_points = field.association == Association::point;
    const std::size_t needed = of_points ? grid.points.tuples() : grid.cells.count();
    if (field.values.size() != needed)
        return invalid_argument(fmt::format("{} values shall colour a grid of {} {}", field.values.size(), needed,
                                            of_points ? "points" : "cells"));
    if (of_points) return color_boundary_by_points(boundary, grid, field, run);
    const Result<std::vector<std::uint64_t>> cells = boundary_cells(boundary, grid, run);
    if (!cells) return cells.error();
    color_boundary_by_cells(boundary, *cells, field);
    return {};
}

Result<Surface> slice_of(const Grid& grid, const Plane& plane, const ColorField* field, const Run& run) {
    Result<PointField> heights = slice_field(grid.points, plane, run);
    if (!heights) return heights.error();
    ContourInput input{{grid.points, grid.cells, {}, {}}, *std::move(heights), {}, {}};
    if (field)
        (field->association == Association::point ? input.point_fields
                                                  : input.cell_fields) = {{field->name, field->values}};
    ContourOptions options;
    options.method = Method::direct;
    options.expected_isovalues = {plane.offset}; // of polyhedra only those that the plane meets are made linear
    options.surfaces = 1;
    Result<Contour> contour = Contour::create(std::move(input), options, run);
    if (!contour) return contour.error();
    Result<ContourResult> cut = contour->extract(plane.offset, run);
    if (!cut) return cut.error();
    return std::move(cut->surfaces.front().surface);
}

} // namespace isotet
