// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/uniform_cells.hpp"

#include <algorithm>

namespace isotet::io::vtk_xml {
namespace {

bool are_uniform(const Array& types) {
    const std::uint8_t first = types.as<std::uint8_t>().front();
    return all_pieces(types, [&](std::uint64_t, auto values) {
        return std::ranges::all_of(values, [&](auto type) { return type == first; });
    });
}

} // namespace

std::optional<std::uint64_t> corners_of_uniform(std::uint8_t type) {
    constexpr std::uint64_t corners[] = {4, 8, 8, 6, 5}; // tetrahedron, voxel, hexahedron, wedge, pyramid
    if (type < 10 || type > 14) return std::nullopt;
    return corners[type - 10];
}

void simplify(Cells& cells) {
    if (cells.types.empty() || !are_uniform(cells.types)) return;
    const std::uint8_t type = cells.types.as<std::uint8_t>().front();
    const auto corners = corners_of_uniform(type);
    if (!corners || !all_pieces(cells.offsets, [&](std::uint64_t first, auto values) {
            return first == 0 ? values[0] == 0 && are_regular(0, values.subspan(1), *corners)
                              : are_regular(first - 1, values, *corners);
        }))
        return;
    cells.offsets = cells.types = Array();
    cells.uniform_type = static_cast<CellType>(type);
}

} // namespace isotet::io::vtk_xml
