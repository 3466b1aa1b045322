// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// join(): surfaces one after another.
#include <algorithm>
#include <functional>
#include <limits>
#include <optional>

#include <isotet/surface.hpp>

#include "core/cells.hpp"

namespace isotet {

namespace {

using Parts = std::vector<const Surface*>;
using Get = std::function<const Array&(const Surface&)>; // one of its arrays

bool is_alike(const Array& a, const Array& b) { return a.type() == b.type() && a.components() == b.components(); }

/// The arrays one after another; nothing unless all have one type and shape and at least one tuple.
Array concatenate(const Parts& parts, const Get& get) {
    if (parts.empty()) return {};
    const Array& first = get(*parts[0]);
    if (!std::ranges::all_of(parts, [&](const Surface* part) { return is_alike(get(*part), first); })) return {};
    return first.visit([&](auto values) {
        using Value = std::remove_const_t<typename decltype(values)::element_type>;
        std::vector<Value> all;
        std::size_t size = 0;
        for (const Surface* part : parts) size += get(*part).size();
        all.reserve(size);
        for (const Surface* part : parts) {
            const auto more = get(*part).as<Value>();
            all.insert(all.end(), more.begin(), more.end());
        }
        return Array::own(std::move(all), first.components());
    });
}

/// As concatenate(), but only if every part has a tuple for each of its vertices (or triangles).
Array concatenate_full(const Parts& parts, const Get& get, std::size_t (Surface::*count)() const noexcept) {
    const bool full =
        std::ranges::all_of(parts, [&](const Surface* part) { return get(*part).tuples() == (part->*count)(); });
    return full ? concatenate(parts, get) : Array{};
}

/// Positions relative to origin 0.
Array absolute_positions(const Parts& parts) {
    std::vector<double> all;
    for (const Surface* part : parts)
        for (std::size_t vertex = 0; vertex < part->vertices(); ++vertex)
            for (std::size_t axis = 0; axis < 3; ++axis)
                all.push_back(part->positions.at(vertex, axis) + part->origin[axis]);
    return Array::own(std::move(all), 3);
}

template <class Index>
Array join_triangles(const Parts& parts, std::size_t count) {
    std::vector<Index> all;
    all.reserve(3 * count);
    std::uint64_t first = 0;
    for (const Surface* part : parts) {
        const core::IndexColumn column(part->triangles);
        for (std::size_t i = 0; i < part->triangles.size(); ++i) all.push_back(static_cast<Index>(first + column[i]));
        first += part->vertices();
    }
    return Array::own(std::move(all), 3);
}

const SurfaceField* find(const std::vector<SurfaceField>& fields, const std::string& name) {
    const auto found = std::ranges::find(fields, name, &SurfaceField::name);
    return found == fields.end() ? nullptr : &*found;
}

/// A field in the user's unit, as doubles.
Array plain(const SurfaceField& field) {
    std::vector<double> values;
    values.reserve(field.values.size());
    for (std::size_t tuple = 0; tuple < field.values.tuples(); ++tuple)
        for (std::size_t component = 0; component < field.values.components(); ++component)
            values.push_back(field.values.at(tuple, component) / field.scale + field.offset);
    return Array::own(std::move(values), field.values.components());
}

/// One field of all parts: as stored if all store it alike, else as doubles in the user's unit.
std::optional<SurfaceField> join_field(const Parts& parts, const SurfaceField& field,
                                       std::vector<SurfaceField> Surface::* list,
                                       std::size_t (Surface::*count)() const noexcept) {
    bool alike = true;
    for (const Surface* part : parts) {
        const SurfaceField* other = find(part->*list, field.name);
        if (!other || other->values.components() != field.values.components() ||
            other->values.tuples() != (part->*count)())
            return std::nullopt;
        alike &=
            other->values.type() == field.values.type() && other->offset == field.offset && other->scale == field.scale;
    }
    if (alike)
        return SurfaceField{
            field.name,
            concatenate(parts,
                        [&](const Surface& part) -> const Array& { return find(part.*list, field.name)->values; }),
            field.offset, field.scale};
    std::vector<double> all;
    for (const Surface* part : parts) {
        const Array values = plain(*find(part->*list, field.name));
        all.insert(all.end(), values.as<double>().begin(), values.as<double>().end());
    }
    return SurfaceField{field.name, Array::own(std::move(all), field.values.components()), 0, 1};
}

std::vector<SurfaceField> join_fields(const Parts& parts, std::vector<SurfaceField> Surface::* list,
                                      std::size_t (Surface::*count)() const noexcept) {
    std::vector<SurfaceField> joined;
    for (const SurfaceField& field : parts[0]->*list)
        if (auto whole = join_field(parts, field, list, count)) joined.push_back(std::move(*whole));
    return joined;
}

Array isovalue_field(const std::vector<Surface>& surfaces, const std::vector<double>& isovalues) {
    std::vector<double> values;
    for (std::size_t i = 0; i < surfaces.size(); ++i)
        values.insert(values.end(), surfaces[i].triangle_count(), isovalues[i]);
    return Array::own(std::move(values));
}

} // namespace

Surface join(const std::vector<Surface>& surfaces, const std::vector<double>& isovalues) {
    if (surfaces.empty()) return {};
    // Empty surfaces may lack arrays; they have no say in what the result carries.
    Parts parts;
    std::uint64_t vertices = 0, triangles = 0;
    for (const Surface& surface : surfaces) {
        vertices += surface.vertices();
        triangles += surface.triangle_count();
        if (surface.vertices() > 0 || surface.triangle_count() > 0) parts.push_back(&surface);
    }
    if (parts.empty()) parts.push_back(&surfaces[0]);
    const Surface& first = *parts[0];

    Surface joined;
    const bool alike = std::ranges::all_of(parts, [&](const Surface* part) {
        return part->origin == first.origin && is_alike(part->positions, first.positions);
    });
    joined.origin = alike ? first.origin : std::array<double, 3>{};
    joined.positions = alike ? concatenate(parts, &Surface::positions) : absolute_positions(parts);
    joined.triangles = vertices <= std::numeric_limits<std::uint32_t>::max()
                           ? join_triangles<std::uint32_t>(parts, triangles)
                           : join_triangles<std::uint64_t>(parts, triangles);
    if (std::ranges::all_of(parts, [&](const Surface* part) { return part->normals_kind == first.normals_kind; })) {
        const auto count = first.normals_kind == Normals::face ? &Surface::triangle_count : &Surface::vertices;
        joined.normals = concatenate_full(parts, &Surface::normals, count);
        joined.normals_kind = joined.normals.empty() ? Normals::none : first.normals_kind;
    }
    joined.edge_ends = concatenate_full(parts, &Surface::edge_ends, &Surface::vertices);
    joined.edge_weights = concatenate_full(parts, &Surface::edge_weights, &Surface::vertices);
    joined.source_cells = concatenate_full(parts, &Surface::source_cells, &Surface::triangle_count);
    joined.point_fields = join_fields(parts, &Surface::point_fields, &Surface::vertices);
    joined.cell_fields = join_fields(parts, &Surface::cell_fields, &Surface::triangle_count);
    if (isovalues.size() == surfaces.size()) {
        std::erase_if(joined.cell_fields, [](const SurfaceField& field) { return field.name == "isovalue"; });
        joined.cell_fields.push_back({"isovalue", isovalue_field(surfaces, isovalues), 0, 1});
    }
    return joined;
}

} // namespace isotet
