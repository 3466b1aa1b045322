// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <isotet/pack.hpp>

namespace isotet_vtk {

/// Which solids are made in place of surfaces, as vtkIsotetContour::Solids.
enum class SolidWish : std::uint8_t {
    none,
    above,  ///< of each isovalue
    below,  ///< of each isovalue
    between ///< one: from the smallest to the largest isovalue
};

/// What a filter was told about its surfaces.
struct Wishes {
    std::vector<double> isovalues;
    bool normals = true;
    bool scalars = true;
    bool triangles = true;                   ///< without: VTK contours, and makes polygons
    int component = 0;                       ///< of images that VTK contours
    std::optional<isotet::Precision> points; ///< of the output's points; nothing: that of the input
    bool refines_carried = false;            ///< the tolerance is of the carried fields, too
    double tolerance = 0; ///< of the field in curved cells, as a share of its range; 0: VTK contours these cells
    std::uint64_t expected_surfaces = 0; ///< as ContourOptions::surfaces
    SolidWish solid = SolidWish::none;
    int threads = 0;
};

} // namespace isotet_vtk
