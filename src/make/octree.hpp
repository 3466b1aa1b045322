// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cubes cut into eight, and some of these again: grids with hanging points.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include <isotet/make.hpp>

namespace isotet::make {

enum class Cut : std::uint8_t { at_sphere, at_random };
enum class Leaf : std::uint8_t { hexahedron, tetrahedra };

struct OctreeShape {
    std::string_view name;
    Cut cut;
    Leaf leaf;
    bool bent; ///< inner corners of cubes are moved, and points of smaller ones follow trilinearly
};

inline constexpr std::array<OctreeShape, 4> octree_shapes{
    OctreeShape{"octree", Cut::at_sphere, Leaf::hexahedron, false},
    OctreeShape{"octree-random", Cut::at_random, Leaf::hexahedron, false},
    OctreeShape{"octree-bent", Cut::at_random, Leaf::hexahedron, true},
    OctreeShape{"octree-tets", Cut::at_random, Leaf::tetrahedra, false},
};

inline constexpr std::uint64_t largest_octree_side = 256;

/// `options`   checked
/// Errors      out_of_memory; cancelled
Result<Grid> make_octree(const OctreeShape& shape, const MakeOptions& options, const Progress& progress);

} // namespace isotet::make
