// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/write.hpp>

int main() {
    // Your arrays, which are not copied: points, four corners for each tetrahedron, one value for each point.
    const std::vector<double> points{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    const std::vector<int> tets{0, 1, 2, 3, 1, 2, 3, 4};
    const std::vector<float> temperature{10, 20, 30, 40, 80};

    isotet::Cells cells;
    cells.connectivity = isotet::Array::borrow(tets);
    const isotet::Result<isotet::Surface> surface =
        isotet::contour(isotet::Array::borrow(points, 3), cells, isotet::Array::borrow(temperature), 25);
    if (!surface) return std::puts(surface.error().message.c_str()), 1;
    std::printf("%zu vertices, %zu triangles\n", surface->vertex_count(), surface->triangle_count());
    const auto written = isotet::write_surface(*surface, "surface.vtp");
    if (!written) return std::puts(written.error().message.c_str()), 1;
}
