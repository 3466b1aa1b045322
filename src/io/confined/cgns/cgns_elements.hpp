// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Elements of CGNS by their number (ElementType_t).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace isotet::io::confined {

struct CgnsElement {
    std::string_view name;
    int dimension = 0;
    std::uint32_t nodes = 0;
    std::uint8_t vtk_type = 0;            ///< 0: left out
    std::span<const std::uint16_t> order; ///< for each node in VTK's order its position in CGNS's; empty: the same
};

inline constexpr std::int64_t cgns_mixed = 20, cgns_ngon = 22, cgns_nface = 23;

/// Nothing for numbers that have no nodes of their own (mixed, faces) or are unknown.
const CgnsElement* cgns_element(std::int64_t number);

} // namespace isotet::io::confined
