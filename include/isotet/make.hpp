// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// Test grids of any size with analytic fields of known surface, on the cube [-1, 1]^3 (float32 points).
///
/// `shape`    "kuhn": six tets a cube, side^3 cubes (Kuhn 1960); "perturbed": kuhn with inner points moved by up to a fifth of
///            the spacing, all tets upright; "shuffled": perturbed with points and tets in random order; "layer": kuhn with z
///            graded so that the thinnest cells have aspect ratio 1000; "hex", "wedge" (two a cube), "pyramid" (six a cube,
///            with a centre point); "mixed": all four types, and neighbours of different types that agree on their faces
/// `side`     cubes along an edge, 1 or more
/// `fields`   any of "sphere" (distance from the centre), "torus" (distance from a circle of radius 0.5), "plane" (along
///            (1,2,3)), "gyroid", "wavelet", "integer" (a small integer at each point: many ties); float32, integer: int32
///
/// Guarantees   the same bytes for any thread count
/// Errors       invalid_argument for an unknown shape or field (what there is), or side < 1; out_of_memory; cancelled
/// Cost         memory of the order of the grid itself
struct MakeOptions {
    std::string shape = "kuhn";
    std::uint64_t side = 32;
    std::vector<std::string> fields = {"sphere", "gyroid"};
    std::uint64_t seed = 1;
    int threads = 0;
};
Result<Grid> make_grid(const MakeOptions& options, const Progress& progress = {});

std::vector<std::string> make_shapes();
std::vector<std::string> make_fields();

/// "kuhn:64:gyroid,sphere" -> options; "make:" has been taken off. The fields may be left out.
Result<MakeOptions> parse_make(std::string_view text);

} // namespace isotet
