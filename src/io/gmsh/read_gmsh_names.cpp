// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// $PhysicalNames: text in every version, in binary files, too.
#include <utility>

#include <fmt/core.h>

#include "io/gmsh/read_gmsh_parts.hpp"

namespace isotet::io::gmsh {

namespace {

struct Group {
    std::int32_t dimension = 0, number = 0;
    std::string name;
};

/// What the rest of a line says, as in 3 7 "steel"; version 2.0 has no dimensions, and a blank need not stand before the name.
std::optional<Group> group_of(std::string_view line, Version version) {
    const std::size_t begin = line.find('"'), end = line.rfind('"');
    if (begin == std::string_view::npos || end == begin) return std::nullopt;
    Group group{0, 0, std::string(line.substr(begin + 1, end - begin - 1))};
    TextScanner numbers(line.substr(0, begin));
    if (!numbers.number(group.dimension)) return std::nullopt;
    if (!numbers.number(group.number)) {
        if (version != Version::v2) return std::nullopt;
        group.number = std::exchange(group.dimension, 3);
    }
    return group;
}

} // namespace

Result<std::vector<RegionName>> names_of_groups(const File& file, std::int32_t of_dimension, std::string_view field) {
    std::vector<RegionName> names;
    const Section* const section = file.find("PhysicalNames");
    if (!section) return names;
    TextScanner scanner(section->body);
    std::int64_t count = 0;
    if (!scanner.number(count) || count < 0)
        return broken(*section, "has " + scanner.where() + " where the number of names should stand");
    for (std::int64_t i = 0; i < count; ++i) {
        const std::size_t begin = scanner.position();
        std::optional<Group> group = group_of(scanner.line(), file.version);
        if (!group) {
            scanner.seek(begin);
            scanner.at_end();
            return broken(*section,
                          fmt::format("should have {} names, but {} is none: {}", count, i + 1, scanner.where()));
        }
        if (group->dimension == of_dimension)
            names.push_back({std::string(field), group->number, std::move(group->name)});
    }
    return names;
}

} // namespace isotet::io::gmsh
