// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/cgns/cgns_sections.hpp"

#include <algorithm>
#include <utility>

namespace isotet::io::confined {

Result<CgnsNumbers> cgns_numbers(const CgnsTree& tree, const std::vector<CgnsNode>& nodes, const char* name) {
    const auto node = child_named(nodes, name);
    if (!node) return CgnsNumbers();
    const auto array = tree.integers(*node);
    if (!array) return array.error();
    return array->visit([](auto values) { return CgnsNumbers(values.begin(), values.end()); });
}

Result<std::vector<CgnsSection>> cgns_sections(const CgnsTree& tree, const CgnsZone& zone) {
    std::vector<CgnsSection> sections;
    for (const CgnsNode& node : zone.parts) {
        if (node.label != "Elements_t") continue;
        CgnsSection section{node};
        section.place = sections.size();
        const auto type = tree.integers(node);
        if (!type) return type.error();
        if (type->empty()) return section.wrong("has no type of elements");
        section.type = static_cast<std::int64_t>(type->at(0));
        const auto range = cgns_numbers(tree, tree.children(node), "ElementRange");
        if (!range) return range.error();
        if (range->size() != 2 || (*range)[0] < 1 || (*range)[1] < (*range)[0] || (*range)[1] > max_cgns_element)
            return section.wrong("has no range of elements, from 1 on");
        section.first = (*range)[0];
        section.last = (*range)[1];
        sections.push_back(std::move(section));
    }
    std::ranges::sort(sections, {}, [](const CgnsSection& section) { return std::pair(section.first, section.place); });
    return sections;
}

namespace {

/// Before CGNS 3.4 the number of points or faces stands before each element's.
Result<void> take_counts_out(CgnsFaceSection& section) {
    CgnsNumbers values, offsets{0};
    for (std::size_t at = 0; at < section.values.size();) {
        const std::int64_t count = section.values[at++];
        if (count < 0 || static_cast<std::uint64_t>(count) > section.values.size() - at)
            return invalid_data(fmt::format("element {} has {} points or faces, but {} numbers are left",
                                            section.first + static_cast<std::int64_t>(offsets.size()) - 1, count,
                                            section.values.size() - at));
        const auto from = section.values.begin() + static_cast<std::ptrdiff_t>(at);
        values.insert(values.end(), from, from + count);
        offsets.push_back(static_cast<std::int64_t>(values.size()));
        at += static_cast<std::size_t>(count);
    }
    section.values = std::move(values);
    section.offsets = std::move(offsets);
    return {};
}

} // namespace

Result<CgnsFaceSection> read_cgns_faces(const CgnsTree& tree, const CgnsSection& section) {
    const std::vector<CgnsNode> nodes = tree.children(section.node);
    auto values = cgns_numbers(tree, nodes, "ElementConnectivity");
    if (!values) return values.error();
    auto offsets = cgns_numbers(tree, nodes, "ElementStartOffset");
    if (!offsets) return offsets.error();
    CgnsFaceSection faces{section.first, section.last, *std::move(offsets), *std::move(values), {}};
    if (!child_named(nodes, "ElementStartOffset"))
        if (auto taken = take_counts_out(faces); !taken) return section.wrong(taken.error().message);
    const std::uint64_t elements = section.count();
    if (faces.offsets.size() != elements + 1)
        return section.wrong(fmt::format("has {} offsets for the elements {} to {}, but must have one more than elements",
                                         faces.offsets.size(), section.first, section.last));
    auto parents = cgns_numbers(tree, nodes, "ParentElements");
    if (!parents) return parents.error();
    faces.parents = *std::move(parents);
    if (!faces.parents.empty() && faces.parents.size() != 2 * elements)
        return section.wrong(
            fmt::format("has {} parents of {} faces, but must have two of each", faces.parents.size(), elements));
    return faces;
}

} // namespace isotet::io::confined
