// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Names of fields as users type them: "velocity:x" taken apart, and the names nearest to a wrong one.
#include <algorithm>
#include <numeric>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>

#include "fields/component_groups.hpp"
#include "grid/values/scalar_of.hpp"

namespace isotet {

namespace {

bool is_component(std::string_view text) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    return core::parse_scalar(text) || (!text.empty() && std::ranges::all_of(text, is_digit));
}

/// Only A to Z, whatever the locale; other bytes are compared as they are.
std::string lower_case(std::string_view text) {
    std::string lower(text.substr(0, 256)); // long enough to tell names apart, short enough for a table of distances
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

/// Fewest insertions, deletions and replacements (Wagner and Fischer 1974).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
        }
    }
    return row.back();
}

} // namespace

std::optional<FieldName> match_field_name(std::string_view name, const std::vector<std::string>& names) {
    if (std::ranges::find(names, name) != names.end()) return FieldName{std::string(name), std::nullopt};
    const std::size_t colon = name.rfind(':');
    const bool has_component = colon != std::string_view::npos && is_component(name.substr(colon + 1));
    if (has_component && std::ranges::find(names, name.substr(0, colon)) != names.end())
        return FieldName{std::string(name.substr(0, colon)), std::string(name.substr(colon + 1))};
    return core::match_component_group(name, names);
}

std::vector<std::string> nearest_first(std::string_view wanted, std::vector<std::string> names) {
    const std::string target = lower_case(wanted);
    std::vector<std::pair<std::size_t, std::string>> ranked;
    ranked.reserve(names.size());
    for (std::string& name : names) {
        const std::size_t distance = edit_distance(target, lower_case(name));
        ranked.emplace_back(distance, std::move(name));
    }
    std::ranges::stable_sort(ranked, {}, &std::pair<std::size_t, std::string>::first);
    std::ranges::transform(ranked, names.begin(), [](auto& entry) { return std::move(entry.second); });
    return names;
}

} // namespace isotet
