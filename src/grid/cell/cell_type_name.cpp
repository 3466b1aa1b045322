// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What VTK's cell type numbers (vtkCellType.h) are called in messages.
#include <algorithm>
#include <array>
#include <utility>

#include <fmt/core.h>

#include <isotet/grid.hpp>

namespace isotet {

namespace {

constexpr std::array<std::pair<std::uint8_t, std::string_view>, 64> cell_type_names{{
    {0, "empty cell"},
    {1, "vertex"},
    {2, "poly vertex"},
    {3, "line"},
    {4, "poly line"},
    {5, "triangle"},
    {6, "triangle strip"},
    {7, "polygon"},
    {8, "pixel"},
    {9, "quad"},
    {10, "tetrahedron"},
    {11, "voxel"},
    {12, "hexahedron"},
    {13, "wedge"},
    {14, "pyramid"},
    {15, "pentagonal prism"},
    {16, "hexagonal prism"},
    {21, "quadratic edge"},
    {22, "quadratic triangle"},
    {23, "quadratic quad"},
    {24, "quadratic tetrahedron"},
    {25, "quadratic hexahedron"},
    {26, "quadratic wedge"},
    {27, "quadratic pyramid"},
    {28, "biquadratic quad"},
    {29, "triquadratic hexahedron"},
    {30, "quadratic linear quad"},
    {31, "quadratic linear wedge"},
    {32, "biquadratic quadratic wedge"},
    {33, "biquadratic quadratic hexahedron"},
    {34, "biquadratic triangle"},
    {35, "cubic line"},
    {36, "quadratic polygon"},
    {37, "triquadratic pyramid"},
    {41, "convex point set"},
    {42, "polyhedron"},
    {51, "parametric curve"},
    {52, "parametric surface"},
    {53, "parametric triangular surface"},
    {54, "parametric quad surface"},
    {55, "parametric tetrahedral region"},
    {56, "parametric hexahedral region"},
    {60, "higher order edge"},
    {61, "higher order triangle"},
    {62, "higher order quad"},
    {63, "higher order polygon"},
    {64, "higher order tetrahedron"},
    {65, "higher order wedge"},
    {66, "higher order pyramid"},
    {67, "higher order hexahedron"},
    {68, "Lagrange curve"},
    {69, "Lagrange triangle"},
    {70, "Lagrange quadrilateral"},
    {71, "Lagrange tetrahedron"},
    {72, "Lagrange hexahedron"},
    {73, "Lagrange wedge"},
    {74, "Lagrange pyramid"},
    {75, "Bezier curve"},
    {76, "Bezier triangle"},
    {77, "Bezier quadrilateral"},
    {78, "Bezier tetrahedron"},
    {79, "Bezier hexahedron"},
    {80, "Bezier wedge"},
    {81, "Bezier pyramid"},
}};

} // namespace

std::string name_of_cell_type(std::uint8_t vtk_type) {
    const auto found =
        std::ranges::lower_bound(cell_type_names, vtk_type, {}, &std::pair<std::uint8_t, std::string_view>::first);
    if (found != cell_type_names.end() && found->first == vtk_type) return std::string(found->second);
    return fmt::format("cell type {}", vtk_type);
}

} // namespace isotet
