// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "check/triangle_groups.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include <fmt/core.h>

namespace isotet::checking {
namespace {

using Key = std::vector<double>;
using Groups = std::map<Key, std::vector<std::uint64_t>>;

std::vector<const Field*> present(const Surface& surface, std::span<const std::string_view> names) {
    std::vector<const Field*> found;
    for (const std::string_view name : names) {
        for (const Field& field : surface.cell_fields)
            if (field.name == name && field.values.components() == 1) found.push_back(&field);
    }
    return found;
}

/// Nothing where there are too many.
std::optional<Groups> by_values(const Surface& surface, const std::vector<const Field*>& fields,
                                const Progress& progress) {
    constexpr std::uint64_t between_looks = 1 << 16;
    Groups groups;
    auto last = groups.end();
    Key key(fields.size());
    for (std::uint64_t triangle = 0; triangle < surface.triangle_count(); ++triangle) {
        if (triangle % between_looks == 0 && progress.cancelled()) break;
        for (std::size_t i = 0; i < fields.size(); ++i) {
            const double value = fields[i]->values.at(triangle);
            key[i] = value == value ? value : 0; // keys must have an order
        }
        if (last == groups.end() || last->first != key) last = groups.try_emplace(key).first;
        last->second.push_back(triangle);
        if (groups.size() > max_groups) return {};
    }
    return groups;
}

std::string name_of_group(const Key& key, const std::vector<const Field*>& fields) {
    std::string name;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        if (i > 0) name += ", ";
        if (fields[i]->name == "boundary") name += key[i] != 0 ? "boundary" : "isosurface";
        else name += fmt::format("{} {}", fields[i]->name, key[i]);
    }
    return name;
}

} // namespace

std::vector<TriangleGroup> triangle_groups(const Surface& surface, std::span<const std::string_view> fields,
                                           const Progress& progress) {
    const std::vector<const Field*> found = present(surface, fields);
    if (!found.empty()) {
        if (auto groups = by_values(surface, found, progress)) {
            std::vector<TriangleGroup> named;
            for (auto& [key, triangles] : *groups)
                named.push_back({name_of_group(key, found), key, std::move(triangles)});
            return named;
        }
    }
    if (surface.triangle_count() == 0) return {};
    std::vector<std::uint64_t> all(surface.triangle_count());
    std::iota(all.begin(), all.end(), std::uint64_t{0});
    return {{"surface", {}, std::move(all)}};
}

} // namespace isotet::checking
