// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "api/finish.hpp"

#include <cmath>

#include <fmt/core.h>

#include "api/attributes.hpp"
#include "api/vertex_normals.hpp"
#include "base/buffer.hpp"
#include "base/errors.hpp"
#include "base/workers.hpp"
#include "numbers/storage.hpp"
#include "packed/packed.hpp"

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

namespace {

/// Stored numbers in the user's unit: f(stored, component) as To.
template <class To, class Real, class F>
Array restored(std::span<const Real> stored, std::size_t components, const F& f) {
    constexpr std::size_t values_per_task = 1 << 14;
    core::Buffer<To> out(stored.size());
    core::worker_each(stored.size(), values_per_task, [&](std::size_t i) {
        out[i] = static_cast<To>(f(static_cast<double>(stored[i]), i % components));
    });
    return std::move(out).to_array(components);
}

/// The type follows from that of the points alone, also where the origin is 0.
template <class Real>
Array user_positions(const Array& stored, const Placement& placement) {
    if (placement.point_type == ScalarType::float32 || sizeof(Real) == sizeof(double)) return stored;
    return restored<double>(stored.as<Real>(), 3,
                            [&](double x, std::size_t axis) { return x + placement.origin[axis]; });
}

template <class Real>
Array user_values(const Array& stored, ScalarType type, const core::Storage& storage) {
    const bool single = type == ScalarType::float32 && sizeof(Real) == sizeof(float);
    const bool as_stored = storage.scale == 1 && storage.offset == 0 && single == (sizeof(Real) == sizeof(float));
    if (as_stored) return stored;
    const auto restore = [&](double value, std::size_t) { return core::restore_value(value, storage); };
    if (single) return restored<float>(stored.as<Real>(), stored.components(), restore);
    return restored<double>(stored.as<Real>(), stored.components(), restore);
}

} // namespace

template <class Real>
Surface finish(const Placement& placement, const ExtractOptions& options,
               std::span<const core::Storage> storages, const ops::RawSurface& raw) {
    Surface surface;
    surface.positions = user_positions<Real>(raw.positions, placement);
    surface.triangles = raw.triangles;
    surface.normals_kind = options.normals;
    if (options.normals == Normals::gradient) surface.normals = fill_normals<Real>(raw);
    else if (options.normals == Normals::face) surface.normals = face_normals<Real>(raw);
    else if (options.normals == Normals::vertex) surface.normals = *normals_of_vertices(surface);
    for (std::size_t i = 0; i < options.point_fields.size(); ++i) {
        const Field& field = options.point_fields[i];
        const Array stored = raw.fields.empty() ? interpolate_field<Real>(field, storages[i], raw) : raw.fields[i];
        surface.point_fields.push_back({field.name, user_values<Real>(stored, field.values.type(), storages[i])});
    }
    for (std::size_t i = 0; i < options.packed_fields.size(); ++i) {
        const std::size_t place = options.point_fields.size() + i;
        const core::Packed& packed = options.packed_fields[i].data();
        surface.point_fields.push_back(
            {packed.field_report.name, user_values<Real>(raw.fields[place], packed.field.type(), storages[place])});
    }
    for (const Field& field : options.cell_fields) surface.cell_fields.push_back(copy_cell_field(field, raw));
    if (options.edge_ends) {
        surface.edge_ends = raw.ends;
        surface.edge_weights = raw.weights;
    }
    if (options.source_cells) surface.source_cells = raw.source_cells;
    return surface;
}

template Surface finish<float>(const Placement&, const ExtractOptions&, std::span<const core::Storage>,
                               const ops::RawSurface&);
template Surface finish<double>(const Placement&, const ExtractOptions&, std::span<const core::Storage>,
                                const ops::RawSurface&);

MoreBytes more_bytes(const ExtractOptions& options, const Placement& placement) {
    MoreBytes more;
    if (placement.point_type != ScalarType::float32) more.vertex += 3 * sizeof(double);
    for (const Field& field : options.point_fields) more.vertex += field.values.components() * sizeof(double);
    more.vertex += options.packed_fields.size() * sizeof(double);
    if (options.normals == Normals::gradient) more.vertex += fill_normals_bytes;
    if (options.normals == Normals::face) more.triangle += 3 * sizeof(float);
    if (options.normals == Normals::vertex) {
        more.vertex += 3 * sizeof(float) + 8;
        more.triangle += 12;
    }
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
        for (const Field& field : *fields) bytes += field.values.bytes();
    return bytes;
}

} // namespace isotet::api
