// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/surface_rows.hpp"

#include <type_traits>
#include <utility>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "grid/renumber.hpp"

namespace isotet::core {

Array rows_of(const Array& array, const std::vector<std::uint64_t>& rows) {
    return array.empty() ? array : in_order(array, rows);
}

Surface with_triangles(const Surface& surface, const std::vector<std::uint64_t>& triangles) {
    Surface out;
    std::vector<std::uint64_t> vertices;
    out.triangles = rows_of(surface.triangles, triangles).visit([&](auto corners) {
        using Value = std::remove_cvref_t<decltype(corners[0])>;
        std::vector<std::uint64_t> place(surface.vertex_count()); // plus one
        for (const Value vertex : corners) place[static_cast<std::size_t>(vertex)] = 1;
        for (std::uint64_t vertex = 0; vertex < place.size(); ++vertex) {
            if (!place[vertex]) continue;
            vertices.push_back(vertex);
            place[vertex] = vertices.size();
        }
        Buffer<Value> numbers(corners.size());
        parallel_each(corners.size(), 1 << 14, [&](std::size_t i) {
            numbers[i] = static_cast<Value>(place[static_cast<std::size_t>(corners[i])] - 1);
        });
        return std::move(numbers).to_array(3);
    });
    out.positions = rows_of(surface.positions, vertices);
    out.normals_kind = surface.normals_kind;
    out.normals = rows_of(surface.normals, surface.normals_kind == Normals::face ? triangles : vertices);
    out.edge_ends = rows_of(surface.edge_ends, vertices);
    out.edge_weights = rows_of(surface.edge_weights, vertices);
    out.source_cells = rows_of(surface.source_cells, triangles);
    for (const Field& field : surface.point_fields)
        out.point_fields.push_back({field.name, rows_of(field.values, vertices)});
    for (const Field& field : surface.cell_fields)
        out.cell_fields.push_back({field.name, rows_of(field.values, triangles)});
    return out;
}

} // namespace isotet::core
