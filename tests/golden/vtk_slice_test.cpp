// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Slices have the area of VTK's cutter.
#include <array>

#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/slice.hpp>

#include "golden/golden_files.hpp"
#include "golden/vtk_contour.hpp"

namespace isotet::test {
namespace {

/// Planes of three directions, off the middle of the grid, so that they meet no points by intent.
std::vector<Plane> planes_through(const Grid& grid) {
    std::vector<Plane> planes;
    const GridReport bounds = survey(grid, {.faces = false}).value();
    for (const std::array<double, 3>& normal : {std::array<double, 3>{1, 0, 0}, {0, 0, -1}, {0.3, 1, 0.2}}) {
        Plane plane{normal, 0};
        for (std::size_t axis = 0; axis < 3; ++axis)
            plane.offset += normal[axis] * (0.5371 * bounds.lower[axis] + 0.4629 * bounds.upper[axis]);
        planes.push_back(plane);
    }
    return planes;
}

TEST(SlicesOfRealGrids, HaveTheAreaOfVtksCutter) {
    int compared = 0;
    for (const char* path : {"medit/cube_sphere_26k.meshb", "tetgen/ellipsoid_16k.node", "vtu/artery_flow_tet_wedge.vtu",
                             "vtu/stokes_channel_tets.vtu", "gocad/geomodel3d_tsolid.so"}) {
        const auto read = read_golden(path);
        ASSERT_TRUE(read) << read.error().message;
        for (const Plane& plane : planes_through(read->grid)) {
            SCOPED_TRACE(testing::Message() << path << " " << plane.normal[0] << " at " << plane.offset);
            const PointField field = slice_field(read->grid.points, plane).value();
            const std::array isovalues{plane.offset};
            DirectOptions options;
            options.split_cells = true;
            const auto cut = extract_direct(read->grid, field, isovalues, options).value();
            const VtkSurface vtk = vtk_cut(read->grid, field.values, plane);
            EXPECT_NEAR(area(cut.surfaces[0].surface), vtk.area, 1e-5 * vtk.area);
            compared += vtk.area > 0 ? 1 : 0;
        }
    }
    EXPECT_GE(compared, 12);
}

} // namespace
} // namespace isotet::test
