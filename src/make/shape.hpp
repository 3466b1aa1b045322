// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The shapes that make_grid() knows.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "make/cube_cells.hpp"

namespace isotet::make {

enum class Variant : std::uint8_t { regular, perturbed, shuffled, layer, bent };

/// `layers`   the cubes of layer k are divided like layers[k % layers.size()]
struct Shape {
    std::string_view name;
    std::span<const CubeCells> layers;
    Variant variant = Variant::regular;
    bool uniform = true; ///< all cells have one type
    bool quadratic =
        false; ///< cells have a node in the middle of each edge, and of faces and cells where they are cubes
};

namespace tables {
inline constexpr std::array<CubeCells, 1> kuhn_layers{kuhn_cube}, hex_layers{hex_cube}, wedge_layers{wedge_cube},
    pyramid_layers{pyramid_cube};
}

inline constexpr std::array<Shape, 11> shapes{
    Shape{"kuhn", tables::kuhn_layers},
    Shape{"perturbed", tables::kuhn_layers, Variant::perturbed},
    Shape{"shuffled", tables::kuhn_layers, Variant::shuffled},
    Shape{"layer", tables::kuhn_layers, Variant::layer},
    Shape{"hex", tables::hex_layers},
    Shape{"wedge", tables::wedge_layers},
    Shape{"pyramid", tables::pyramid_layers},
    Shape{"mixed", mixed_layers, Variant::regular, false},
    Shape{"tet10", tables::kuhn_layers, Variant::regular, true, true},
    Shape{"curved", tables::kuhn_layers, Variant::bent, true, true},
    Shape{"hex27", tables::hex_layers, Variant::regular, true, true},
};

} // namespace isotet::make
