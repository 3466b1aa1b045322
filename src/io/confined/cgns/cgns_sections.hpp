// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The sections of elements of an unstructured zone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <isotet/result.hpp>

#include "base/errors.hpp"
#include "io/confined/cgns/cgns_elements.hpp"
#include "io/confined/cgns/cgns_zone.hpp"
#include "io/files/escape.hpp"

namespace isotet::io::confined {

using CgnsNumbers = std::vector<std::int64_t>;

inline constexpr std::int64_t max_cgns_element = std::int64_t{1} << 48;

/// Elements_t.
struct CgnsSection {
    CgnsNode node;
    std::size_t place = 0; ///< among the sections of the file
    std::int64_t type = 0;
    std::int64_t first = 0, last = 0; ///< numbers of its elements in the zone
    std::array<std::uint64_t, 4> by_dimension{};

    std::uint64_t count() const { return static_cast<std::uint64_t>(last - first) + 1; }
    bool has(int dimension) const { return by_dimension[static_cast<std::size_t>(dimension)] > 0; }
    Error wrong(const std::string& what) const {
        return invalid_data(fmt::format("section \"{}\" {}", escaped(node.name), what));
    }
};

/// A section of faces, or of cells with faces.
struct CgnsFaceSection {
    std::int64_t first = 0, last = 0;
    CgnsNumbers offsets, values; ///< points of faces, or faces of cells, as the file counts them
    CgnsNumbers parents;         ///< of faces: a cell on each side, 0 where there is none; those of the left sides first

    std::size_t count() const { return offsets.size() - 1; }
};

/// The integers of a child; empty where it is not there.
Result<CgnsNumbers> cgns_numbers(const CgnsTree& tree, const std::vector<CgnsNode>& nodes, const char* name);

/// Ascending by their first numbers.
///
/// Errors   invalid_data: sections without a type or a range
Result<std::vector<CgnsSection>> cgns_sections(const CgnsTree& tree, const CgnsZone& zone);

/// Errors   invalid_data: numbers that do not fit together
Result<CgnsFaceSection> read_cgns_faces(const CgnsTree& tree, const CgnsSection& section);

/// Calls visit(element, nodes) for each element of a section of one type, or of mixed ones, where a type stands before the
/// nodes. `nodes` is a span of integers of the file.
template <class Visit>
Result<void> each_cgns_element(const CgnsTree& tree, const CgnsSection& section, const Visit& visit) {
    const CgnsElement* const only = cgns_element(section.type);
    const auto node = child_named(tree.children(section.node), "ElementConnectivity");
    if (!node) return section.wrong("has no ElementConnectivity");
    const auto connectivity = tree.integers(*node);
    if (!connectivity) return connectivity.error();
    return connectivity->visit([&](auto values) -> Result<void> {
        std::size_t at = 0;
        for (std::uint64_t i = 0; i < section.count(); ++i) {
            const CgnsElement* element = only;
            if (!only) {
                if (at == values.size()) return section.wrong(fmt::format("has {} elements, but must have {}", i, section.count()));
                element = cgns_element(static_cast<std::int64_t>(values[at]));
                if (!element)
                    return section.wrong(fmt::format("has an element of type {} among mixed ones", values[at]));
                ++at;
            }
            if (values.size() - at < element->nodes)
                return section.wrong(fmt::format("has {} numbers in \"ElementConnectivity\", which end in its element {} of {}",
                                                 values.size(), i + 1, section.count()));
            if (auto done = visit(*element, values.subspan(at, element->nodes)); !done) return done;
            at += element->nodes;
        }
        if (at != values.size())
            return section.wrong(fmt::format("has {} numbers, but its {} elements need {}", values.size(),
                                             section.count(), at));
        return {};
    });
}

} // namespace isotet::io::confined
