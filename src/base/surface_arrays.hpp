// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All arrays of a surface, one after another.
#pragma once

#include <string_view>

#include <isotet/surface.hpp>

namespace isotet::core {

/// Calls visit(array, which, name) for each, empty ones too; `name` of a field, else empty.
///
/// `surface`   a Surface, const or not
template <class AnySurface, class Visit>
void each_array(AnySurface& surface, const Visit& visit) {
    constexpr std::string_view none;
    visit(surface.positions, SurfaceArray::positions, none);
    visit(surface.triangles, SurfaceArray::triangles, none);
    visit(surface.normals, SurfaceArray::normals, none);
    visit(surface.edge_ends, SurfaceArray::edge_ends, none);
    visit(surface.edge_weights, SurfaceArray::edge_weights, none);
    visit(surface.source_cells, SurfaceArray::source_cells, none);
    for (auto& field : surface.point_fields)
        visit(field.values, SurfaceArray::point_field, std::string_view(field.name));
    for (auto& field : surface.cell_fields) visit(field.values, SurfaceArray::cell_field, std::string_view(field.name));
}

} // namespace isotet::core
