// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "check/surface_rows.hpp"

#include <type_traits>
#include <utility>

#include "base/buffer.hpp"
#include "base/parallel.hpp"

namespace isotet::checking {

Array rows_of(const Array& array, const std::vector<std::uint64_t>& rows) {
    if (array.empty()) return array;
    const std::size_t components = array.components();
    return array.visit([&](auto values) {
        using Value = std::remove_cvref_t<decltype(values[0])>;
        core::Buffer<Value> out(rows.size() * components);
        core::parallel_each(rows.size(), 1 << 14, [&](std::size_t i) {
            for (std::size_t k = 0; k < components; ++k) out[i * components + k] = values[rows[i] * components + k];
        });
        return std::move(out).to_array(components);
    });
}

Surface with_rows(const Surface& surface, const std::vector<std::uint64_t>& vertices,
                  const std::vector<std::uint64_t>& triangles) {
    Surface out;
    std::vector<std::uint64_t> place(surface.vertex_count());
    for (std::uint64_t i = 0; i < vertices.size(); ++i) place[vertices[i]] = i;
    out.positions = rows_of(surface.positions, vertices);
    out.triangles = rows_of(surface.triangles, triangles).visit([&](auto corners) {
        using Value = std::remove_cvref_t<decltype(corners[0])>;
        core::Buffer<Value> numbers(corners.size());
        core::parallel_each(corners.size(), 1 << 14, [&](std::size_t i) {
            numbers[i] = static_cast<Value>(place[static_cast<std::size_t>(corners[i])]);
        });
        return std::move(numbers).to_array(3);
    });
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

} // namespace isotet::checking
