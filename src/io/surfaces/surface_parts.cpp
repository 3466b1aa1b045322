// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/surfaces/surface_parts.hpp"

#include <cstdint>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "io/files/scalars.hpp"

namespace isotet::io {
namespace {

template <class To>
Array converted_to(const Array& array) {
    if (array.type() == scalar_type_of<To>()) return array;
    return array.visit([&](auto values) {
        std::vector<To> result(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            if constexpr (std::is_same_v<To, float>) result[i] = to_float(static_cast<double>(values[i]));
            else result[i] = static_cast<To>(values[i]);
        }
        return Array::own(std::move(result), array.components());
    });
}

Result<void> check_length(const Attribute& attribute, std::uint64_t tuples, std::string_view what) {
    if (attribute.values.tuples() == tuples) return {};
    return Error{ErrorCode::invalid_data,
                 fmt::format("the array {} has {} tuples, but the file has {} {}", in_quotes(attribute.name),
                             attribute.values.tuples(), tuples, what)};
}

bool are_integers(const Attribute& attribute, std::string_view name, std::size_t components) {
    return attribute.name == name && attribute.values.components() == components &&
           !is_floating(attribute.values.type());
}

bool are_normals(const Attribute& attribute) {
    return attribute.normals && attribute.values.components() == 3 && is_floating(attribute.values.type());
}

/// False if the attribute is a field like any other.
bool place_point_attribute(Surface& surface, const Attribute& attribute) {
    if (are_integers(attribute, "edge_ends", 2)) surface.edge_ends = converted_to<std::int64_t>(attribute.values);
    else if (attribute.name == "edge_weights" && attribute.values.components() == 1 &&
             is_floating(attribute.values.type())) {
        surface.edge_weights = attribute.values;
    } else if (are_normals(attribute)) {
        surface.normals = converted_to<float>(attribute.values);
        surface.normals_kind = Normals::gradient;
    } else {
        return false;
    }
    return true;
}

bool place_cell_attribute(Surface& surface, const Attribute& attribute, const Array& values) {
    if (are_integers(attribute, "source_cell", 1)) surface.source_cells = converted_to<std::int64_t>(values);
    else if (are_normals(attribute) && surface.normals_kind == Normals::none) {
        surface.normals = converted_to<float>(values);
        surface.normals_kind = Normals::face;
    } else {
        return false;
    }
    return true;
}

} // namespace

Result<Surface> assemble(SurfaceParts&& parts) {
    Surface surface;
    surface.positions = std::move(parts.positions);
    for (const auto& attribute : parts.point_data) {
        if (auto fits = check_length(attribute, surface.vertex_count(), "vertices"); !fits) return fits.error();
        if (place_point_attribute(surface, attribute)) continue;
        surface.point_fields.push_back({attribute.name, attribute.values});
    }
    for (const auto& attribute : parts.cell_data) {
        if (auto fits = check_length(attribute, parts.cells.cells(), "cells"); !fits) return fits.error();
        Array values = parts.cells.spread(attribute.values);
        if (place_cell_attribute(surface, attribute, values)) continue;
        surface.cell_fields.push_back({attribute.name, std::move(values)});
    }
    auto triangles = parts.cells.take(surface.vertex_count());
    if (!triangles) return triangles.error();
    surface.triangles = std::move(*triangles);
    return surface;
}

} // namespace isotet::io
