// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Solids as they are drawn: smooth isosurfaces, a boundary of flat triangles.
#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "scene/scene_data.hpp"

namespace isotet {

namespace {

/// The tuples of an array with these numbers.
Array tuples_of(const Array& values, const std::vector<std::uint32_t>& rows) {
    const std::size_t n = values.components();
    return values.visit([&](auto typed) {
        core::Buffer<std::remove_cvref_t<decltype(typed[0])>> out(rows.size() * n);
        core::parallel_each(rows.size(), 1 << 14, [&](std::size_t i) {
            for (std::size_t k = 0; k < n; ++k) out[i * n + k] = typed[rows[i] * n + k];
        });
        return std::move(out).to_array(n);
    });
}

/// Triangles of the isosurface, which come first.
std::size_t smooth_triangles(const Surface& solid) {
    const auto& fields = solid.cell_fields; // the last field of that name is the solid's
    const auto parts = std::ranges::find(fields.rbegin(), fields.rend(), "boundary", &Field::name)->values.as<std::uint8_t>();
    return static_cast<std::size_t>(std::ranges::find(parts, std::uint8_t{1}) - parts.begin());
}

/// Triangles behind the first ones share no vertex.
Surface with_flat_boundary(Surface out, std::size_t smooth_count) {
    const auto corners = out.triangles.as<std::uint32_t>();
    const auto smooth = corners.first(3 * smooth_count);
    const std::uint32_t shared = smooth.empty() ? 0 : *std::ranges::max_element(smooth) + 1; // those of isosurfaces
    std::vector<std::uint32_t> rows(shared), triangles(smooth.begin(), smooth.end());
    for (std::uint32_t vertex = 0; vertex < shared; ++vertex) rows[vertex] = vertex;
    for (const std::uint32_t corner : corners.subspan(smooth.size())) {
        triangles.push_back(static_cast<std::uint32_t>(rows.size()));
        rows.push_back(corner);
    }
    out.positions = tuples_of(out.positions, rows);
    for (Field& field : out.point_fields) field.values = tuples_of(field.values, rows);
    out.triangles = Array::own(std::move(triangles), 3);
    out.normals = out.edge_ends = out.edge_weights = {};
    out.normals_kind = Normals::none;
    return out;
}

} // namespace

Result<Surface> drawn_solid(const Solid& solid, const std::optional<PartChoice>& keep, const Run& run) {
    if (!keep) return with_flat_boundary(solid.surface, solid.isosurface_triangles);
    Result<Surface> kept = keep_parts(solid.surface, *keep, PartsOf::solid, run);
    if (!kept || kept->triangle_count() == 0) return kept;
    const std::size_t smooth = smooth_triangles(*kept);
    return with_flat_boundary(*std::move(kept), smooth);
}

/// Of each isovalue, on the side that is looked at.
Result<void> IsosurfaceScene::Data::show_solids(std::span<const double> isovalues, const Run& run) {
    for (const double isovalue : isovalues) {
        Result<Solid> solid = solids->extract(
            look.solid == SolidSide::above ? SolidRange::above(isovalue) : SolidRange::below(isovalue), run);
        if (!solid) return solid.error();
        std::ranges::move(solid->contour.notes, std::back_inserter(notes));
        report.method = solid->contour.method;
        report.field = solid->contour.field;
        Result<Surface> drawn = drawn_solid(*solid, look.keep, run);
        if (!drawn) return drawn.error();
        if (Result<void> added = add_surface(*std::move(drawn)); !added) return added;
    }
    return {};
}

} // namespace isotet
