// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// Which grid make_grid() makes; make_grid() says what each member means.
struct MakeOptions {
    std::string shape = "kuhn";
    std::uint64_t side = 32;
    std::vector<std::string> fields = {"sphere", "gyroid"};
    std::uint64_t seed = 1;
};

/// Test grids of any size with analytic fields of known surface, on the cube [-1, 1]^3 (float32 points).
///
/// All cells are upright in VTK's order of corners, and neighbours agree on the faces between them,
/// but for those of different size in an octree.
///
/// `shape`    "kuhn": six tets a cube, side^3 cubes (Kuhn 1960); points and cubes along x first, then y, then z
///            "perturbed": kuhn with each inner point moved, in any direction, by up to a fifth of the spacing
///            "shuffled": perturbed with points, tets and the corners of each tet in random order
///            "layer": kuhn with z graded geometrically so that the thinnest cells, at z = -1, have aspect ratio 1000
///            (from side 2 on)
///            "hex"; "wedge" (two a cube); "pyramid" (six a cube, with a centre point)
///            "mixed": layers of hexahedra, pyramids and tets, wedges, pyramids and tets, over and over: all four types
///            from side 3 on
///            "tet10": kuhn of quadratic tetrahedra, straight, with fields at the nodes; "curved": the same bent onto a
///            smooth image of the cube; "hex27": triquadratic hexahedra
///            "kelvin": truncated octahedra, polyhedra of 14 faces (Kelvin 1887), two a cube, up to 512 cubes along an edge;
///            within the cube, which they do not fill at its faces
///            "octree": hexahedra; cubes that the sphere of radius 0.6 meets are cut into eight, and of these those that it
///            meets once more: with hanging points. "octree-random": half of the cubes and a quarter of their eighths, drawn,
///            so edges of neighbours differ up to four times; "octree-bent": the same, inner corners of the cubes moved by
///            up to 0.15 of their edge along each axis, and what is in them trilinearly; "octree-tets": octree-random with six
///            tets a cube. Up to 256 cubes along an edge
/// `side`     cubes along an edge, 1 to 4096
/// `fields`   names, each once; float32, computed in double:
///            "sphere"   sqrt(x^2 + y^2 + z^2)
///            "torus"    sqrt((sqrt(x^2 + y^2) - 1/2)^2 + z^2)
///            "plane"    (x + 2y + 3z) / sqrt(14)
///            "gyroid"   sin X cos Y + sin Y cos Z + sin Z cos X, with X = 2 pi x and so on
///            "wavelet"  255 exp(-(x^2 + y^2 + z^2) / 2) + 10 sin 30x + 18 sin 15y + 5 cos 20z (VTK's wavelet source)
///            "integer"  int32, 0 to 4, drawn for each point: many ties
/// `seed`     of everything that is drawn: it changes perturbed, shuffled and drawn octree grids, and the field
///            integer
///
/// Guarantees   the same bytes for any thread count; points, cells, sphere, torus, plane and integer are the same on
///              every machine, gyroid and wavelet as far as its sin, cos and exp are
/// Errors       invalid_argument for an unknown shape or field (what there is, nearest first), a field asked for twice,
///              or a side out of range; out_of_memory; cancelled
/// Cost         memory of the grid itself: 12 bytes a point, 4 a point and field, 4 a corner (8 above 2^31 points)
ISOTET_API Result<Grid> make_grid(const MakeOptions& options, const Run& run = {});

ISOTET_API std::vector<std::string> make_shapes();
ISOTET_API std::vector<std::string> make_fields();

/// "kuhn:64:gyroid,sphere" -> options; "make:" has been taken off. The fields may be left out.
ISOTET_API Result<MakeOptions> parse_make(std::string_view text);

} // namespace isotet
