// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fields/component_groups.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <unordered_set>

#include <fmt/core.h>

#include <isotet/fields.hpp>

#include "base/buffer.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/values/scalar_of.hpp"

namespace isotet {

namespace {

using Endings = std::span<const std::string_view>;

constexpr std::array<std::string_view, 9> full_tensor{"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"};
constexpr std::array<std::string_view, 6> symmetric_xz{"xx", "yy", "zz", "xy", "yz", "xz"};
constexpr std::array<std::string_view, 6> symmetric_zx{"xx", "yy", "zz", "xy", "yz", "zx"};
constexpr std::array<std::string_view, 3> vector_axes{"x", "y", "z"};

std::string capitals_of(std::string_view text) {
    std::string capitals(text);
    for (char& c : capitals) c = static_cast<char>(c - 'a' + 'A');
    return capitals;
}

/// Finds groups among names, larger ones first: a part of a tensor is not one of a vector.
class GroupFinder {
public:
    explicit GroupFinder(const std::vector<std::string>& names) : names_(names), known_(names.begin(), names.end()) {
        for (const Endings endings :
             {Endings(full_tensor), Endings(symmetric_xz), Endings(symmetric_zx), Endings(vector_axes)})
            for (std::size_t i = 0; i < names_.size(); ++i)
                for (const bool capital : {false, true}) look_for(i, endings, capital);
    }

    std::vector<ComponentGroup> take() {
        std::ranges::stable_sort(found_, {}, &Found::first);
        std::vector<ComponentGroup> groups;
        for (Found& one : found_) groups.push_back(std::move(one.group));
        return groups;
    }

private:
    struct Found {
        std::size_t first;
        ComponentGroup group;
    };

    void look_for(std::size_t index, Endings endings, bool capital) {
        const auto spelled = [&](std::string_view ending) {
            return capital ? capitals_of(ending) : std::string(ending);
        };
        const std::string& name = names_[index];
        const std::string first = spelled(endings[0]);
        if (name.size() <= first.size() || !name.ends_with(first)) return;
        ComponentGroup group{name.substr(0, name.size() - first.size()), {}};
        if (known_.contains(group.name)) return;
        for (const std::string_view ending : endings) {
            group.parts.push_back(group.name + spelled(ending));
            if (!known_.contains(group.parts.back()) || taken_.contains(group.parts.back())) return;
        }
        taken_.insert(group.parts.begin(), group.parts.end());
        found_.push_back({index, std::move(group)});
    }

    const std::vector<std::string>& names_;
    std::unordered_set<std::string> known_, taken_;
    std::vector<Found> found_;
};

/// A group's name as people type it: "disp" for "disp_".
std::string_view without_separator(std::string_view name) {
    while (!name.empty() && (name.back() == '_' || name.back() == '.' || name.back() == ':' || name.back() == ' '))
        name.remove_suffix(1);
    return name;
}

/// "velocity_x", "StressYZ" for "velocity:x", "Stress:yz" or "Stress:4", though others of the group are missing: where one
/// component is asked for, it alone is read.
std::optional<std::string> one_component(std::string_view group, std::string_view component,
                                         const std::vector<std::string>& names) {
    group = without_separator(group);
    const auto scalar = core::parse_scalar(component);
    if (group.empty() || !scalar || scalar->magnitude) return std::nullopt;
    const bool is_axis = std::ranges::find(vector_axes, component) != vector_axes.end();
    const auto is_of_group = [&](std::string_view name, std::string_view ending) {
        return name.size() > ending.size() && name.ends_with(ending) &&
               without_separator(name.substr(0, name.size() - ending.size())) == group;
    };
    for (const Endings endings :
         {Endings(vector_axes), Endings(full_tensor), Endings(symmetric_xz), Endings(symmetric_zx)}) {
        const auto place = scalar->place_in(endings.size());
        if (!place || (is_axis && endings.size() != vector_axes.size())) continue;
        for (const std::string& name : names)
            if (is_of_group(name, endings[*place]) || is_of_group(name, capitals_of(endings[*place]))) return name;
    }
    return std::nullopt;
}

/// "SIEQ:VMIS", "SIEQ:TRESCA" and so on for "SIEQ", "SIEQ:1" or "SIEQ:mag": readers make such fields of an array whose
/// components have names, which is no tensor.
std::optional<FieldName> match_named_components(std::string_view array, std::optional<std::string_view> component,
                                                const std::vector<std::string>& names) {
    FieldName match{std::string(array), std::nullopt, {}};
    for (const std::string& name : names)
        if (name.size() > array.size() + 1 && name.starts_with(array) && name[array.size()] == ':')
            match.parts.push_back(name);
    if (array.empty() || match.parts.size() < 2) return std::nullopt;
    if (!component) return match;
    match.component = std::string(*component);
    const auto scalar = core::parse_scalar(*component);
    const bool is_there = scalar && !scalar->of_tensor && scalar->place_in(match.parts.size());
    return is_there ? std::optional(match) : std::nullopt;
}

/// Copies scalar arrays of the same length into the components of one.
template <class Scalar>
Array interleaved(const std::vector<Array>& parts) {
    constexpr std::size_t grain = std::size_t{1} << 16U;
    const std::size_t components = parts.size(), tuples = parts[0].tuples();
    core::Buffer<Scalar> all(components * tuples);
    for (std::size_t c = 0; c < components; ++c)
        parts[c].visit([&](auto values) {
            core::parallel_each(tuples, grain,
                                [&](std::size_t i) { all[components * i + c] = static_cast<Scalar>(values[i]); });
        });
    return std::move(all).to_array(components);
}

} // namespace

std::vector<ComponentGroup> component_groups(const std::vector<std::string>& names) {
    return GroupFinder(names).take();
}

std::vector<std::string> packed_names_of_vector(const std::string& name) {
    return {name + ":x", name + ":y", name + ":z", name + ":mag"};
}

std::vector<ComponentGroup> joined_fields(const std::vector<std::string>& names) {
    const std::unordered_set<std::string> known(names.begin(), names.end());
    const auto vector_of = [&](const std::string& part) { // or nothing
        const std::string base = part.substr(0, part.rfind(':'));
        const std::vector<std::string> parts = packed_names_of_vector(base);
        const bool is_part = base != part && std::ranges::find(parts, part) != parts.end();
        const bool all =
            std::all_of(parts.begin(), parts.end() - 1, [&](const auto& one) { return known.contains(one); });
        return is_part && all && !known.contains(base) ? base : std::string();
    };
    std::vector<ComponentGroup> fields;
    std::unordered_set<std::string> joined;
    for (const std::string& name : names) {
        const std::string base = vector_of(name);
        if (base.empty()) fields.push_back({name, {name}});
        else if (joined.insert(base).second) {
            fields.push_back({base, packed_names_of_vector(base)});
            fields.back().parts.pop_back(); // the magnitude follows from the others
        }
    }
    return fields;
}

std::vector<std::string> scalar_names(const std::vector<Field>& fields) {
    std::vector<std::string> names;
    for (const Field& field : fields)
        if (field.values.components() == 1) names.push_back(field.name);
    return names;
}

Result<Field> gather_components(const std::vector<Field>& fields, const std::string& name,
                                const std::vector<std::string>& parts) {
    std::vector<Array> arrays;
    for (const std::string& part : parts) {
        const auto field = std::ranges::find(fields, part, &Field::name);
        if (field == fields.end())
            return invalid_argument(fmt::format("'{}' needs the field '{}', which is not there", name, part));
        const Array& values = field->values;
        if (values.components() != 1 || (!arrays.empty() && values.tuples() != arrays[0].tuples()))
            return invalid_argument(
                fmt::format("'{}' takes the field '{}' for a component, but it has {} tuples of {} components", name,
                            part, values.tuples(), values.components()));
        arrays.push_back(values);
    }
    if (arrays.empty()) return invalid_argument(fmt::format("'{}' has no components", name));
    const bool is_single =
        std::ranges::all_of(arrays, [](const Array& one) { return one.type() == ScalarType::float32; });
    return Field{name, is_single ? interleaved<float>(arrays) : interleaved<double>(arrays)};
}

namespace core {

std::optional<FieldName> match_component_group(std::string_view name, const std::vector<std::string>& names) {
    const std::size_t colon = name.rfind(':');
    for (const ComponentGroup& group : component_groups(names)) {
        const auto is_called = [&](std::string_view text) {
            return text == group.name || text == without_separator(group.name);
        };
        if (is_called(name)) return FieldName{group.name, std::nullopt, group.parts};
        if (colon == std::string_view::npos || !is_called(name.substr(0, colon))) continue;
        const auto scalar = parse_scalar(name.substr(colon + 1));
        if (!scalar) continue;
        if (scalar->magnitude) return FieldName{group.name, "mag", group.parts};
        if (const auto place = scalar->place_in(group.parts.size()))
            return FieldName{group.parts[*place], std::nullopt};
    }
    if (auto named = match_named_components(name, std::nullopt, names)) return named;
    if (colon == std::string_view::npos) return std::nullopt;
    if (auto named = match_named_components(name.substr(0, colon), name.substr(colon + 1), names)) return named;
    auto alone = one_component(name.substr(0, colon), name.substr(colon + 1), names);
    return alone ? std::optional(FieldName{*std::move(alone), std::nullopt}) : std::nullopt;
}

} // namespace core

} // namespace isotet
