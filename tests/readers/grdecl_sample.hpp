// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Corner-point grids made by program: two blocks of layers with or without a throw between them, layers that end.
#pragma once

#include <functional>
#include <string>

namespace isotet::test {

/// Cells of 10 x 10 between inclined pillars. The depth of a corner: `depth(x, y, z, block)` for the pillar x, y, the
/// layer's upper side z (nz: the lowest side), and the block of the cell, 0 where its x is below `fault`, else 1.
struct CornerPointBox {
    int nx = 4, ny = 3, nz = 2, fault = 2;
    std::function<double(int, int, int, int)> depth;
};

/// The depths of even layers of 4 from 100, the second block deeper by `throw_`.
std::function<double(int, int, int, int)> even_layers(double throw_);

/// SPECGRID, COORD and ZCORN, and then `rest`.
std::string grdecl_box(const CornerPointBox& box, const std::string& rest);

/// A small one with all that the reader knows.
std::string grdecl_sample();

} // namespace isotet::test
