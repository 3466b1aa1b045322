// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "api/finish.hpp"

#include <cmath>

#include <fmt/core.h>

#include "api/attributes.hpp"
#include "core/errors.hpp"

namespace isotet::api {

Result<void> check_isovalues(std::span<const double> isovalues) {
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        if (std::isfinite(isovalues[i])) continue;
        if (isovalues.size() == 1)
            return invalid_argument(fmt::format("the isovalue is {}, but must be finite", isovalues[i]));
        return invalid_argument(fmt::format("isovalues[{}] is {}, but must be finite", i, isovalues[i]));
    }
    return {};
}

template <class Real>
Surface finish(const std::array<double, 3>& origin, const ExtractOptions& options,
               std::span<const core::Storage> storages, const ops::RawSurface& raw) {
    Surface surface;
    surface.origin = origin;
    surface.positions = raw.positions;
    surface.triangles = raw.triangles;
    surface.normals_kind = options.normals;
    if (options.normals == Normals::gradient) surface.normals = fill_normals<Real>(raw);
    else if (options.normals == Normals::face) surface.normals = face_normals<Real>(raw);
    for (std::size_t i = 0; i < options.point_fields.size(); ++i) {
        const Field& field = options.point_fields[i];
        if (raw.fields.empty()) surface.point_fields.push_back(interpolate_field<Real>(field, storages[i], raw));
        else surface.point_fields.push_back({field.name, raw.fields[i], storages[i].offset, storages[i].scale});
    }
    for (const Field& field : options.cell_fields) surface.cell_fields.push_back(copy_cell_field(field, raw));
    if (options.edge_ends) {
        surface.edge_ends = raw.ends;
        surface.edge_weights = raw.weights;
    }
    if (options.source_cells) surface.source_cells = raw.source_cells;
    return surface;
}

template Surface finish<float>(const std::array<double, 3>&, const ExtractOptions&, std::span<const core::Storage>,
                               const ops::RawSurface&);
template Surface finish<double>(const std::array<double, 3>&, const ExtractOptions&, std::span<const core::Storage>,
                                const ops::RawSurface&);

MoreBytes more_bytes(const ExtractOptions& options) {
    MoreBytes more;
    if (options.normals == Normals::gradient) more.vertex += fill_normals_bytes;
    if (options.normals == Normals::face) more.triangle += 3 * sizeof(float);
    for (const Field& field : options.cell_fields)
        more.triangle += field.values.components() * size_of(field.values.type());
    return more;
}

std::uint64_t bytes_of(const Surface& surface) {
    std::uint64_t bytes = 0;
    for (const Array* array : {&surface.positions, &surface.triangles, &surface.normals, &surface.edge_ends,
                               &surface.edge_weights, &surface.source_cells})
        bytes += array->bytes();
    for (const auto* fields : {&surface.point_fields, &surface.cell_fields})
        for (const SurfaceField& field : *fields) bytes += field.values.bytes();
    return bytes;
}

} // namespace isotet::api
