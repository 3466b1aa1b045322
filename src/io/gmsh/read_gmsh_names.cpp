// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// $PhysicalNames: text in every version, in binary files, too.
#include <utility>

#include <fmt/core.h>

#include "io/gmsh/read_gmsh_parts.hpp"

namespace isotet::io::gmsh {

namespace {

/// What stands in quotes on the rest of a line.
std::optional<std::string> quoted_rest(TextScanner& scanner) {
    const std::string_view rest = scanner.rest();
    const std::size_t line = std::min(rest.find('\n'), rest.size());
    const std::size_t begin = rest.substr(0, line).find('"'), end = rest.substr(0, line).rfind('"');
    if (begin == std::string_view::npos || end == begin) return std::nullopt;
    return std::string(rest.substr(begin + 1, end - begin - 1));
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
        std::int32_t dimension = 0, number = 0;
        bool numbers = scanner.number(dimension);
        if (numbers && !scanner.number_of_line(number)) { // version 2.0 has no dimensions
            numbers = file.version == Version::v2;
            number = std::exchange(dimension, 3);
        }
        std::optional<std::string> name = numbers ? quoted_rest(scanner) : std::nullopt;
        if (!name)
            return broken(*section,
                          fmt::format("should have {} names, but {} is none: {}", count, i + 1, scanner.where()));
        scanner.next_line();
        if (dimension == of_dimension) names.push_back({std::string(field), number, *std::move(name)});
    }
    return names;
}

} // namespace isotet::io::gmsh
