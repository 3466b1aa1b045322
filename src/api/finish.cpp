// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "api/finish.hpp"

#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "api/attributes.hpp"
#include "api/vertex_normals.hpp"
#include "base/errors.hpp"
#include "base/surface_arrays.hpp"
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
Array restored(std::span<const Real> stored, std::size_t components, const core::ArraySlot& slot, const F& f) {
    constexpr std::size_t values_per_task = 1 << 14;
    core::SharedBuffer<To> out = slot.make<To>(stored.size() / components, components);
    core::worker_each(stored.size(), values_per_task, [&](std::size_t i) {
        out[i] = static_cast<To>(f(static_cast<double>(stored[i]), i % components));
    });
    return std::move(out).to_array(components);
}

/// The type follows from that of the points alone, also where the origin is 0.
template <class Real>
bool has_user_positions(const Placement& placement) {
    return placement.point_type == ScalarType::float32 || sizeof(Real) == sizeof(double);
}

template <class Real>
Array user_positions(const Array& stored, const Placement& placement, const core::ArraySlot& slot) {
    if (has_user_positions<Real>(placement)) return stored;
    return restored<double>(stored.as<Real>(), 3, slot,
                            [&](double x, std::size_t axis) { return x + placement.origin[axis]; });
}

template <class Real>
bool has_user_values(ScalarType type, const core::Storage& storage) {
    const bool single = type == ScalarType::float32 && sizeof(Real) == sizeof(float);
    return storage.scale == 1 && storage.offset == 0 && single == (sizeof(Real) == sizeof(float));
}

template <class Real>
Array user_values(const Array& stored, ScalarType type, const core::Storage& storage, const core::ArraySlot& slot) {
    if (has_user_values<Real>(type, storage)) return stored;
    const bool single = type == ScalarType::float32 && sizeof(Real) == sizeof(float);
    const auto restore = [&](double value, std::size_t) { return core::restore_value(value, storage); };
    if (single) return restored<float>(stored.as<Real>(), stored.components(), slot, restore);
    return restored<double>(stored.as<Real>(), stored.components(), slot, restore);
}

/// Carried point fields: those of the options, then those of packed grids.
const core::Packed& packed_field(const ExtractOptions& options, std::size_t field) {
    return options.packed_fields[field - options.point_fields.size()].data();
}
ScalarType type_of_field(const ExtractOptions& options, std::size_t field) {
    return field < options.point_fields.size() ? options.point_fields[field].values.type()
                                               : packed_field(options, field).field.type();
}
std::string_view name_of_field(const ExtractOptions& options, std::size_t field) {
    return field < options.point_fields.size() ? std::string_view(options.point_fields[field].name)
                                               : packed_field(options, field).field_report.name;
}

} // namespace

core::ArraySlots slots_of(const ExtractOptions& options, SurfaceSink* sink) {
    if (!sink) return {};
    return [&options, sink](std::size_t surface, SurfaceArray array, std::size_t field) {
        std::string_view name;
        if (array == SurfaceArray::point_field) name = name_of_field(options, field);
        if (array == SurfaceArray::cell_field) name = options.cell_fields[field].name;
        return core::ArraySlot(sink, surface, array, name);
    };
}

template <class Real>
core::ArraySlots slots_for_engine(core::ArraySlots all, const Placement& placement, const ExtractOptions& options,
                                  std::span<const core::Storage> storages) {
    if (!all) return {};
    const auto is_final = [&options, storages, positions = has_user_positions<Real>(placement)](SurfaceArray array,
                                                                                                std::size_t field) {
        switch (array) {
        case SurfaceArray::positions: return positions;
        case SurfaceArray::triangles: return true;
        case SurfaceArray::normals: return options.normals == Normals::gradient;
        case SurfaceArray::edge_ends:
        case SurfaceArray::edge_weights: return options.edge_ends;
        case SurfaceArray::source_cells: return options.source_cells;
        case SurfaceArray::point_field:
            return field < storages.size() && has_user_values<Real>(type_of_field(options, field), storages[field]);
        case SurfaceArray::cell_field: break;
        }
        return false;
    };
    return [all = std::move(all), is_final](std::size_t surface, SurfaceArray array, std::size_t field) {
        return is_final(array, field) ? all(surface, array, field) : core::ArraySlot();
    };
}

template core::ArraySlots slots_for_engine<float>(core::ArraySlots, const Placement&, const ExtractOptions&,
                                                  std::span<const core::Storage>);
template core::ArraySlots slots_for_engine<double>(core::ArraySlots, const Placement&, const ExtractOptions&,
                                                   std::span<const core::Storage>);

template <class Real>
Surface finish(const Placement& placement, const ExtractOptions& options, std::span<const core::Storage> storages,
               const ops::RawSurface& raw, const core::ArraySlots& slots, std::size_t number) {
    const auto slot = [&](SurfaceArray array, std::size_t field = 0) {
        return core::slot_of(slots, number, array, field);
    };
    Surface surface;
    surface.positions = user_positions<Real>(raw.positions, placement, slot(SurfaceArray::positions));
    surface.triangles = raw.triangles;
    surface.normals_kind = options.normals;
    if (options.normals == Normals::gradient) surface.normals = fill_normals<Real>(raw);
    else if (options.normals == Normals::face) surface.normals = face_normals<Real>(raw, slot(SurfaceArray::normals));
    else if (options.normals == Normals::vertex) surface.normals = *normals_of_vertices(surface);
    for (std::size_t i = 0; i < options.point_fields.size(); ++i) {
        const Field& field = options.point_fields[i];
        const core::ArraySlot place = slot(SurfaceArray::point_field, i);
        const bool as_stored = has_user_values<Real>(field.values.type(), storages[i]);
        const Array stored =
            raw.fields.empty() ? interpolate_field<Real>(field, storages[i], raw, as_stored ? place : core::ArraySlot())
                               : raw.fields[i];
        surface.point_fields.push_back(
            {field.name, user_values<Real>(stored, field.values.type(), storages[i], place)});
    }
    for (std::size_t i = 0; i < options.packed_fields.size(); ++i) {
        const std::size_t place = options.point_fields.size() + i;
        surface.point_fields.push_back({std::string(name_of_field(options, place)),
                                        user_values<Real>(raw.fields[place], type_of_field(options, place),
                                                          storages[place], slot(SurfaceArray::point_field, place))});
    }
    for (std::size_t i = 0; i < options.cell_fields.size(); ++i)
        surface.cell_fields.push_back(copy_cell_field(options.cell_fields[i], raw, slot(SurfaceArray::cell_field, i)));
    if (options.edge_ends) {
        surface.edge_ends = raw.ends;
        surface.edge_weights = raw.weights;
    }
    if (options.source_cells) surface.source_cells = raw.source_cells;
    return surface;
}

template Surface finish<float>(const Placement&, const ExtractOptions&, std::span<const core::Storage>,
                               const ops::RawSurface&, const core::ArraySlots&, std::size_t);
template Surface finish<double>(const Placement&, const ExtractOptions&, std::span<const core::Storage>,
                                const ops::RawSurface&, const core::ArraySlots&, std::size_t);

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
    core::each_array(surface, [&](const Array& array, SurfaceArray, std::string_view) { bytes += array.bytes(); });
    return bytes;
}

} // namespace isotet::api
