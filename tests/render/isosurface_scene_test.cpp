// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Scenes of isosurfaces: the same surfaces wherever they are extracted, and nothing packed that need not be.
#include <atomic>

#include <isotet/fields.hpp>
#include <isotet/isosurface_scene.hpp>
#include <isotet/picture.hpp>

#include "render/drawing.hpp"

namespace isotet::test {
namespace {

class IsosurfaceScenes : public Drawing {
protected:
    IsosurfaceOptions options(ExtractOn where = ExtractOn::cpu) const {
        IsosurfaceOptions options;
        options.grid = make_grid({.shape = "kuhn", .side = 10, .fields = {"gyroid", "sphere"}}).value();
        options.field = find_field(options.grid, "gyroid").value();
        options.where = where;
        return options;
    }
    SceneLook colored() const {
        const Grid grid = options().grid;
        SceneLook look;
        look.shade_by = ShadeBy::gradient; // the device has no other smooth normals
        look.opacity = 0.5;                // which hides another is told by boxes, which the device does not give
        look.colors =
            ColorField{"sphere", find_field(grid, "sphere").value().values, Association::point, {.upper = 1.7}};
        return look;
    }
    Picture picture_of(IsosurfaceScene& scene) {
        PictureOptions picture = options_;
        picture.camera = camera_of(View::iso);
        scene.fit(picture.camera, 1);
        return renderer_->draw(scene.scene(), picture).value();
    }
};

TEST_F(IsosurfaceScenes, LookTheSameWhereverTheyAreExtracted) {
    IsosurfaceScene on_cpu = IsosurfaceScene::create(*device_, options(), colored()).value();
    IsosurfaceScene on_device = IsosurfaceScene::create(*device_, options(ExtractOn::device), colored()).value();
    for (IsosurfaceScene* scene : {&on_cpu, &on_device}) ASSERT_TRUE(scene->show(std::array{0.2, -0.3}));
    EXPECT_EQ(on_cpu.report().method, Method::direct);
    EXPECT_EQ(on_cpu.report().pack_seconds, 0);
    EXPECT_FALSE(on_cpu.report().on_device);
    EXPECT_TRUE(on_device.report().on_device);
    EXPECT_GT(on_device.report().extract_work.device_seconds, 0);
    ASSERT_EQ(on_cpu.surfaces().size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(on_cpu.surfaces()[i].triangles, on_device.surfaces()[i].triangles);
        EXPECT_EQ(on_cpu.surfaces()[i].isovalue, i == 0 ? 0.2 : -0.3);
    }
    EXPECT_EQ(on_cpu.report().boundary_faces, 6u * 10 * 10 * 2);
    EXPECT_LT(difference(picture_of(on_cpu), picture_of(on_device)).value(), 0.002);
}

TEST_F(IsosurfaceScenes, PackForManySurfaces) {
    IsosurfaceOptions many = options();
    many.contour.surfaces = 50;
    SceneLook look;
    look.boundary_opacity = 0;
    IsosurfaceScene scene = IsosurfaceScene::create(*device_, std::move(many), look).value();
    EXPECT_GT(scene.report().pack_seconds, 0);
    ASSERT_TRUE(scene.show(std::array{0.0}));
    EXPECT_EQ(scene.report().method, Method::clusters);
    EXPECT_EQ(scene.report().boundary_faces, 0u);
    EXPECT_NEAR(scene.scene().bounds.upper[0], 1, 1e-6);
    ASSERT_TRUE(scene.show(std::array{99.0})) << "an empty surface is a surface";
    EXPECT_EQ(scene.surfaces()[0].triangles, 0u);
}

TEST_F(IsosurfaceScenes, DrawTetsWithoutASurface) {
    IsosurfaceOptions tets = options();
    tets.draw = DrawMethod::registers;
    tets.index = SearchIndex::interval_tree;
    IsosurfaceScene scene = IsosurfaceScene::create(*device_, std::move(tets), {}).value();
    ASSERT_TRUE(scene.show(std::array{0.2}));
    ASSERT_TRUE(scene.report().store);
    EXPECT_GT(scene.surfaces()[0].tets, 0u);
    EXPECT_LT(scene.surfaces()[0].tets, 6000u);
    EXPECT_EQ(scene.surfaces()[0].triangles, 0u);
}

TEST_F(IsosurfaceScenes, ShowASurfaceThatIsThere) {
    IsosurfaceScene scene = IsosurfaceScene::create(*device_, sphere(), {}).value();
    ASSERT_TRUE(scene.show({}));
    ASSERT_EQ(scene.surfaces().size(), 1u);
    EXPECT_FALSE(scene.surfaces()[0].isovalue);
    EXPECT_EQ(scene.scene().surfaces.size(), 1u) << "no boundary";
}

TEST_F(IsosurfaceScenes, RefuseWhatDoesNotFitAndCanBeCancelled) {
    IsosurfaceOptions wrong = options(ExtractOn::device);
    wrong.contour.method = Method::direct;
    EXPECT_EQ(IsosurfaceScene::create(*device_, std::move(wrong), {}).error().code, ErrorCode::invalid_argument);
    IsosurfaceScene scene = IsosurfaceScene::create(*device_, options(), {}).value();
    const std::atomic<bool> cancel = true;
    EXPECT_EQ(scene.show(std::array{0.0}, {.progress = {.report = {}, .cancel = &cancel}}).error().code,
              ErrorCode::cancelled);
    EXPECT_TRUE(scene.show(std::array{0.0})) << "the scene stays usable";
}

} // namespace
} // namespace isotet::test
