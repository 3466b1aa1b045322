// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/named_components.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

namespace isotet::io {
namespace {

using ComponentNames = std::span<const std::string>;

/// What a name ends in: "D" and 0 of "DX".
struct AxisName {
    std::string_view before;
    std::size_t axis = 0;
};

std::optional<AxisName> axis_named(std::string_view name) {
    if (name.empty()) return std::nullopt;
    for (const std::string_view axes : {"xyz", "XYZ", "123"})
        if (const auto at = axes.find(name.back()); at != std::string_view::npos)
            return AxisName{name.substr(0, name.size() - 1), at};
    return std::nullopt;
}

/// Whether names are of the same word with an axis, numbers of one letter: PRIN_1 is no axis.
std::size_t leading_axes(ComponentNames names) {
    constexpr std::string_view velocities = "UVW";
    std::size_t count = 0;
    std::string_view before;
    for (; count < std::min<std::size_t>(names.size(), 3); ++count) {
        const std::string& name = names[count];
        if (name.size() == 1 && name[0] == velocities[count]) continue;
        const auto found = axis_named(name);
        if (!found || found->axis != count || (count > 0 && found->before != before)) break;
        if (name.back() <= '9' && found->before.size() != 1) break;
        before = found->before;
    }
    return count;
}

/// Whether the first ones are those of a tensor: of 9 row by row, of 6 in any order.
bool begins_with_tensor(ComponentNames names, std::size_t components) {
    if (names.size() < components) return false;
    std::set<std::pair<std::size_t, std::size_t>> pairs;
    std::string_view before;
    for (std::size_t i = 0; i < components; ++i) {
        const auto column = axis_named(names[i]);
        const auto row = column ? axis_named(column->before) : std::nullopt;
        if (!row || (i > 0 && row->before != before)) return false;
        before = row->before;
        std::pair place(row->axis, column->axis);
        if (components == 9 && place != std::pair(i / 3, i % 3)) return false;
        if (components == 6 && place.first > place.second) std::swap(place.first, place.second);
        pairs.insert(place);
    }
    return pairs.size() == components;
}

bool are_numbered(ComponentNames names) {
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i].empty() || names[i][0] != names[0][0] || names[i].substr(1) != std::to_string(i + 1)) return false;
    return true;
}

/// How many components at the beginning are one vector or tensor.
std::size_t leading_components(ComponentNames names) {
    if (std::set<std::string_view>(names.begin(), names.end()).size() < names.size()) return names.size();
    if (std::ranges::any_of(names, &std::string::empty) || are_numbered(names)) return names.size();
    for (const std::size_t components : {9U, 6U})
        if (begins_with_tensor(names, components)) return components;
    const std::size_t axes = leading_axes(names);
    if (names.size() <= 3) return axes > 0 ? names.size() : 0;
    return axes == 3 ? axes : 0;
}

} // namespace

std::vector<NamedComponents> fields_of_components(const std::string& array, ComponentNames names) {
    const std::size_t leading = names.size() == 1 ? 1 : leading_components(names);
    std::vector<NamedComponents> fields;
    if (leading > 0) fields.push_back({array, 0, leading});
    for (std::size_t i = leading; i < names.size(); ++i) fields.push_back({array + ":" + names[i], i, 1});
    return fields;
}

} // namespace isotet::io
