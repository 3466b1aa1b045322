// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace isotet::io::ucd {

struct Element {
    std::string_view name;
    std::uint8_t type;
    int corners;
    std::array<int, 8> order; ///< of VTK's corners among UCD's: UCD has the apex and the upper face first
};

/// A binary file has their places here in place of their names.
constexpr std::array elements{
    Element{"pt", 1, 1, {0}},
    Element{"line", 3, 2, {0, 1}},
    Element{"tri", 5, 3, {0, 1, 2}},
    Element{"quad", 9, 4, {0, 1, 2, 3}},
    Element{"tet", 10, 4, {0, 1, 2, 3}},
    Element{"pyr", 14, 5, {1, 2, 3, 4, 0}},
    Element{"prism", 13, 6, {3, 4, 5, 0, 1, 2}},
    Element{"hex", 12, 8, {4, 5, 6, 7, 0, 1, 2, 3}},
};

} // namespace isotet::io::ucd
