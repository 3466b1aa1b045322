// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Types of cells in MED files, by the names of their groups.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace isotet::io::confined {

struct MedElement {
    std::string_view name;
    std::uint32_t nodes = 0; ///< 0: of polyhedra and polygons, each its own
    std::uint8_t vtk_type = 0;
    std::span<const std::uint8_t> order;  ///< for each node in VTK's order its position in MED's
};

inline constexpr std::uint8_t med_polyhedron_type = 42;

/// Which cells are read.
enum class MedCells { with_a_volume, flat };

/// Flat ones are points, lines and faces. Null for the others.
const MedElement* med_element(std::string_view name, MedCells cells);

/// Of a triangle or quadrilateral; 0 for all others.
std::uint32_t nodes_of_med_face(std::string_view name);

} // namespace isotet::io::confined
