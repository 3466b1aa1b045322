// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Scenes without a device: slices, clipped surfaces, coloured boundaries, normals of vertices, cameras by angles and text.
#include <cmath>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/extract.hpp>
#include <isotet/isosurface_scene.hpp>
#include <isotet/make.hpp>
#include <isotet/render.hpp>

#include "scene/clip_surface.hpp"

namespace isotet::test {
namespace {

IsosurfaceOptions contour_of(const char* field) {
    IsosurfaceOptions options;
    options.grid = make_grid({.shape = "kuhn", .side = 10, .fields = {"gyroid", "sphere"}}).value();
    options.field = find_field(options.grid, field).value();
    return options;
}

ColorField colors_of_cells(const Grid& grid) {
    std::vector<float> values(grid.cells.count());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
    return {"cell", Array::own(values), Association::cell, {.upper = static_cast<double>(values.size())}};
}

TEST(SceneOnCpu, NeedsNoDevice) {
    IsosurfaceScene scene = IsosurfaceScene::create(std::nullopt, contour_of("sphere"), {}).value();
    ASSERT_TRUE(scene.show(std::array{0.5}));
    EXPECT_EQ(scene.scene().surfaces.size(), 2u) << "surface and boundary";
    PictureOptions options;
    options.width = options.height = 40;
    options.camera = camera_of(View::iso);
    scene.fit(options.camera, 1);
    EXPECT_TRUE(draw(scene.scene(), options));
    IsosurfaceOptions on_device = contour_of("sphere");
    on_device.where = ExtractOn::device;
    EXPECT_EQ(IsosurfaceScene::create(std::nullopt, std::move(on_device), {}).error().code,
              ErrorCode::invalid_argument);
}

TEST(SceneOnCpu, DrawsTheGridAloneWhereNothingIsContoured) {
    IsosurfaceOptions options = contour_of("sphere");
    options.field = {};
    SceneLook look;
    look.boundary_opacity = 1;
    IsosurfaceScene scene = IsosurfaceScene::create(std::nullopt, std::move(options), look).value();
    ASSERT_TRUE(scene.show({}));
    ASSERT_EQ(scene.scene().surfaces.size(), 1u);
    EXPECT_EQ(scene.scene().surfaces[0].triangles->triangle_count(), 6u * 10 * 10 * 2);
}

TEST(SceneOnCpu, SlicesAreFlatAndCarryTheColours) {
    IsosurfaceOptions options = contour_of("sphere");
    options.field = {};
    SceneLook look;
    look.colors = ColorField{"gyroid", find_field(options.grid, "gyroid").value().values, Association::point, {}};
    look.slices = {{{0, 0, 2}, 0.46}};
    IsosurfaceScene scene = IsosurfaceScene::create(std::nullopt, std::move(options), look).value();
    ASSERT_TRUE(scene.show({}));
    const DrawnSurface& slice = scene.scene().surfaces[0];
    for (std::size_t i = 0; i < slice.triangles->vertex_count(); ++i)
        EXPECT_NEAR(slice.triangles->positions.at(i, 2), 0.23, 1e-6);
    ASSERT_TRUE(slice.values);
    EXPECT_EQ(slice.values->values.tuples(), slice.triangles->vertex_count());
    EXPECT_NEAR(area(*slice.triangles), 4, 1e-5) << "the made cube has sides of 2";
    EXPECT_EQ(scene.report().slice_triangles, slice.triangles->triangle_count());
}

TEST(SceneOnCpu, SolidsAreClosedAndTheirBoundaryIsFlat) {
    const IsosurfaceOptions options = contour_of("gyroid");
    Solids solids = Solids::create({options.grid, options.field, {}, {}}).value();
    for (const SolidSide side : {SolidSide::above, SolidSide::below}) {
        SceneLook look;
        look.solid = side;
        look.boundary_opacity = 0;
        look.colors = ColorField{"sphere", find_field(options.grid, "sphere").value().values, Association::point, {}};
        IsosurfaceScene scene = IsosurfaceScene::create(std::nullopt, options, look).value();
        ASSERT_TRUE(scene.show(std::array{0.2, 0.4}));
        ASSERT_EQ(scene.scene().surfaces.size(), 2u);
        for (std::size_t i = 0; i < 2; ++i) {
            const double isovalue = *scene.surfaces()[i].isovalue;
            const Solid solid =
                solids.extract(side == SolidSide::above ? SolidRange::above(isovalue) : SolidRange::below(isovalue))
                    .value();
            const Surface& drawn = *scene.scene().surfaces[i].triangles;
            EXPECT_EQ(drawn.triangle_count(), solid.surface.triangle_count());
            EXPECT_NEAR(area(drawn), area(solid.surface), 1e-6);
            EXPECT_EQ(scene.scene().surfaces[i].values->values.tuples(), drawn.vertex_count());
            for (std::size_t t = solid.isosurface_triangles; t < drawn.triangle_count(); ++t)
                for (std::size_t k = 0; k < 3; ++k) { // sides of the cube from -1 to 1
                    const auto vertex = static_cast<std::size_t>(drawn.triangles.at(t, k));
                    double most = 0;
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        most = std::max(most, std::abs(drawn.normals.at(vertex, axis)));
                    ASSERT_NEAR(most, 1, 1e-5);
                }
        }
    }
}

TEST(SceneOnCpu, SolidsDoNotGoWithVolumesOrDevices) {
    SceneLook look;
    look.solid = SolidSide::above;
    IsosurfaceOptions on_device = contour_of("gyroid");
    on_device.where = ExtractOn::device;
    EXPECT_EQ(IsosurfaceScene::create(std::nullopt, on_device, look).error().code, ErrorCode::invalid_argument);
    look.volume = VolumeLook{};
    EXPECT_EQ(IsosurfaceScene::create(std::nullopt, contour_of("gyroid"), look).error().code,
              ErrorCode::invalid_argument);
}

TEST(SceneOnCpu, TheBoundaryHasTheColoursOfItsPointsAndCells) {
    IsosurfaceOptions options = contour_of("sphere");
    const Grid grid = options.grid;
    options.field = {};
    SceneLook look;
    look.boundary_colors = ColorField{"sphere", find_field(grid, "sphere").value().values, Association::point, {}};
    const IsosurfaceScene by_points = IsosurfaceScene::create(std::nullopt, options, look).value();
    IsosurfaceScene scene = IsosurfaceScene::create(std::nullopt, options, look).value();
    ASSERT_TRUE(scene.show({}));
    const DrawnSurface& boundary = scene.scene().surfaces[0];
    const Array& positions = boundary.triangles->positions;
    for (std::size_t i = 0; i < positions.tuples(); ++i)
        EXPECT_NEAR(boundary.values->values.at(i),
                    std::hypot(positions.at(i, 0), positions.at(i, 1), positions.at(i, 2)), 1e-5);

    look.boundary_colors = colors_of_cells(grid);
    scene = IsosurfaceScene::create(std::nullopt, std::move(options), look).value();
    ASSERT_TRUE(scene.show({}));
    const Surface& faces = *scene.scene().surfaces[0].triangles;
    const Array& cells = scene.scene().surfaces[0].values->values;
    const TetList tets = split(grid).value();
    for (std::size_t i = 0; i < faces.triangle_count(); i += 7) {
        const auto& tet = tets.tets[static_cast<std::size_t>(cells.at(i))];
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const auto vertex = static_cast<std::size_t>(faces.triangles.at(i, corner));
            const auto point = static_cast<std::uint64_t>(faces.edge_ends.at(vertex, 0));
            EXPECT_NE(std::ranges::find(tet, point), tet.end()) << "face " << i;
        }
    }
}

TEST(SceneOnCpu, ClippedSurfacesEndAtThePlane) {
    const Grid grid = make_grid({.shape = "kuhn", .side = 10, .fields = {"gyroid", "sphere"}}).value();
    DirectOptions options;
    options.extract.point_fields = {{"x", find_field(grid, "x").value().values}};
    const double isovalue = 0.7;
    const Surface sphere = extract_direct(grid, find_field(grid, "sphere").value(), std::span(&isovalue, 1), options)
                               .value()
                               .surfaces[0]
                               .surface;
    const Surface below = scene::clipped(sphere, {{1, 0, 0}, 0.21}),
                  above = scene::clipped(sphere, {{-1, 0, 0}, -0.21});
    EXPECT_NEAR(area(below) + area(above), area(sphere), 1e-5);
    EXPECT_GT(area(below), area(above));
    for (std::size_t i = 0; i < below.vertex_count(); ++i) {
        EXPECT_LE(below.positions.at(i, 0), 0.21 + 1e-6);
        EXPECT_NEAR(below.point_fields[0].values.at(i), below.positions.at(i, 0), 1e-6) << "fields are cut, too";
    }
    EXPECT_EQ(scene::clipped(sphere, {{1, 0, 0}, -5}).triangle_count(), 0u);
    EXPECT_EQ(scene::clipped(sphere, {{1, 0, 0}, 5}).triangle_count(), sphere.triangle_count());
}

TEST(SceneOnCpu, OfNestedSurfacesOnlyTheInnermostIsOpaque) {
    IsosurfaceScene scene = IsosurfaceScene::create(std::nullopt, contour_of("sphere"), {}).value();
    ASSERT_TRUE(scene.show(std::array{0.3, 0.6, 0.9}));
    EXPECT_EQ(scene.scene().surfaces[0].opacity, 1);
    EXPECT_LT(scene.scene().surfaces[1].opacity, 1);
    EXPECT_LT(scene.scene().surfaces[2].opacity, 1);
    IsosurfaceOptions planes = contour_of("sphere");
    planes.field = find_field(planes.grid, "z").value();
    scene = IsosurfaceScene::create(std::nullopt, std::move(planes), {}).value();
    ASSERT_TRUE(scene.show(std::array{-0.5, 0.0, 0.5}));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(scene.scene().surfaces[i].opacity, 1) << "seen beside each other";
}

TEST(VertexNormals, ArePerpendicularToASphere) {
    const Grid grid = make_grid({.shape = "kuhn", .side = 30, .fields = {"sphere"}}).value();
    const double isovalue = 0.7;
    const Surface sphere =
        extract_direct(grid, find_field(grid, "sphere").value(), std::span(&isovalue, 1)).value().surfaces[0].surface;
    const Array normals = vertex_normals(sphere, {.threads = 1}).value();
    ASSERT_EQ(normals.tuples(), sphere.vertex_count());
    double worst = 1;
    for (std::size_t i = 0; i < normals.tuples(); ++i) {
        double along = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) along += normals.at(i, axis) * sphere.positions.at(i, axis) / 0.7;
        worst = std::min(worst, along);
    }
    EXPECT_GT(worst, 0.99) << "towards higher values, so outwards";
    const Array again = vertex_normals(sphere, {.threads = 7}).value();
    EXPECT_TRUE(std::ranges::equal(again.as<float>(), normals.as<float>()));
    Surface broken = sphere;
    broken.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 1'000'000}, 3);
    EXPECT_EQ(vertex_normals(broken).error().code, ErrorCode::invalid_data);
}

TEST(CameraViews, ByAnglesAreTheNamedOnes) {
    const auto expect_same = [](const Camera& a, const Camera& b) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(a.direction[axis], b.direction[axis], 1e-3);
            EXPECT_NEAR(a.up[axis], b.up[axis], 1e-3);
        }
    };
    expect_same(camera_of(0, 0), camera_of(View::minus_y));
    expect_same(camera_of(90, 0), camera_of(View::plus_x));
    expect_same(camera_of(-90, 0), camera_of(View::minus_x));
    expect_same(camera_of(0, 90), camera_of(View::plus_z));
    expect_same(camera_of(33.69, 25.5), camera_of(View::iso));
    const Camera y_up = camera_of(0, 0, UpAxis::plus_y);
    EXPECT_NEAR(y_up.direction[2], 1, 1e-12);
    EXPECT_NEAR(y_up.up[1], 1, 1e-12);
    EXPECT_NEAR(camera_of(90, 0, UpAxis::plus_y).direction[0], 1, 1e-12) << "to the right";
}

TEST(CameraText, LeadsBackToTheSameCamera) {
    for (const Projection projection : {Projection::perspective, Projection::parallel}) {
        Camera camera = camera_of(20, 35, UpAxis::plus_z, projection);
        camera.fit(Box{{0.1, 0.2, 0.3}, {7, 5, 11}}, 1.3);
        const std::optional<Camera> back = parse_camera(to_text(camera));
        ASSERT_TRUE(back);
        EXPECT_EQ(to_text(*back), to_text(camera));
        EXPECT_EQ(back->direction, camera.direction);
    }
    for (const char* wrong :
         {"", "parallel", "perspective:0,0,0:0,0,1:0,1,0:1", "perspective:0,0,0:0,0,1:0,0,1:1:25",
          "parallel:0,0:0,0,1:0,1,0:1", "parallel:0,0,0:0,0,1:0,1,0:-1", "cabinet:0,0,0:0,0,1:0,1,0:1"})
        EXPECT_FALSE(parse_camera(wrong)) << wrong;
}

} // namespace
} // namespace isotet::test
