// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// join(): surfaces one after another.
#include <algorithm>
#include <functional>
#include <limits>
#include <optional>

#include <isotet/surface.hpp>

#include "grid/cells.hpp"

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

/// The arrays one after another: in their type if they have one in common, else as float64.
Array concatenate_any(const Parts& parts, const Get& get) {
    const Array& first = get(*parts[0]);
    if (std::ranges::all_of(parts, [&](const Surface* part) { return is_alike(get(*part), first); }))
        return concatenate(parts, get);
    std::vector<double> all;
    for (const Surface* part : parts)
        get(*part).visit([&](auto values) {
            for (const auto value : values) all.push_back(static_cast<double>(value));
        });
    return Array::own(std::move(all), first.components());
}

template <class Index>
Array join_triangles(const Parts& parts, std::size_t count) {
    std::vector<Index> all;
    all.reserve(3 * count);
    std::uint64_t first = 0;
    for (const Surface* part : parts) {
        const core::IndexColumn column(part->triangles);
        for (std::size_t i = 0; i < part->triangles.size(); ++i) all.push_back(static_cast<Index>(first + column[i]));
        first += part->vertex_count();
    }
    return Array::own(std::move(all), 3);
}

const Field* find(const std::vector<Field>& fields, const std::string& name) {
    const auto found = std::ranges::find(fields, name, &Field::name);
    return found == fields.end() ? nullptr : &*found;
}

/// One field of all parts; nothing unless all have it, of full length.
std::optional<Field> join_field(const Parts& parts, const Field& field, std::vector<Field> Surface::* list,
                                std::size_t (Surface::*count)() const noexcept) {
    for (const Surface* part : parts) {
        const Field* other = find(part->*list, field.name);
        if (!other || other->values.components() != field.values.components() ||
            other->values.tuples() != (part->*count)())
            return std::nullopt;
    }
    return Field{field.name, concatenate_any(parts, [&](const Surface& part) -> const Array& {
                     return find(part.*list, field.name)->values;
                 })};
}

std::vector<Field> join_fields(const Parts& parts, std::vector<Field> Surface::* list,
                               std::size_t (Surface::*count)() const noexcept) {
    std::vector<Field> joined;
    for (const Field& field : parts[0]->*list)
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
    if (surfaces.empty()) {
        Surface none;
        none.positions = Array::own(std::vector<float>(), 3);
        none.triangles = Array::own(std::vector<std::uint32_t>(), 3);
        return none;
    }
    // Empty surfaces may lack arrays; they have no say in what the result carries.
    Parts parts;
    std::uint64_t vertices = 0, triangles = 0;
    for (const Surface& surface : surfaces) {
        vertices += surface.vertex_count();
        triangles += surface.triangle_count();
        if (surface.vertex_count() > 0 || surface.triangle_count() > 0) parts.push_back(&surface);
    }
    if (parts.empty()) parts.push_back(&surfaces[0]);
    const Surface& first = *parts[0];

    Surface joined;
    joined.positions = concatenate_any(parts, &Surface::positions);
    joined.triangles = vertices <= std::numeric_limits<std::uint32_t>::max()
                           ? join_triangles<std::uint32_t>(parts, triangles)
                           : join_triangles<std::uint64_t>(parts, triangles);
    if (std::ranges::all_of(parts, [&](const Surface* part) { return part->normals_kind == first.normals_kind; })) {
        const auto count = first.normals_kind == Normals::face ? &Surface::triangle_count : &Surface::vertex_count;
        joined.normals = concatenate_full(parts, &Surface::normals, count);
        joined.normals_kind = joined.normals.empty() ? Normals::none : first.normals_kind;
    }
    joined.edge_ends = concatenate_full(parts, &Surface::edge_ends, &Surface::vertex_count);
    joined.edge_weights = concatenate_full(parts, &Surface::edge_weights, &Surface::vertex_count);
    joined.source_cells = concatenate_full(parts, &Surface::source_cells, &Surface::triangle_count);
    joined.point_fields = join_fields(parts, &Surface::point_fields, &Surface::vertex_count);
    joined.cell_fields = join_fields(parts, &Surface::cell_fields, &Surface::triangle_count);
    if (isovalues.size() == surfaces.size()) {
        std::erase_if(joined.cell_fields, [](const Field& field) { return field.name == "isovalue"; });
        joined.cell_fields.push_back({"isovalue", isovalue_field(surfaces, isovalues)});
    }
    return joined;
}

} // namespace isotet
