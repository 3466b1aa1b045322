// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What cannot be drawn is told, with the value and the rule; what is odd is drawn.
#include "render/drawing.hpp"

#include <limits>

namespace isotet::test {
namespace {

class Wrong : public Drawing {
protected:
    void expect_error(const std::string& part) {
        const Result<Picture> picture = renderer_->draw(scene_, options_);
        ASSERT_FALSE(picture);
        EXPECT_EQ(picture.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(picture.error().message.find(part), std::string::npos) << picture.error().message;
    }
};

TEST_F(Wrong, SurfacesAreRefused) {
    Surface surface = square_at(0);
    surface.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 4}, 3);
    Result<DeviceMesh> mesh = DeviceMesh::upload(*device_, surface);
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().message, "triangles[1] has vertex 4, but the surface has 4 vertices");
    surface = square_at(0);
    surface.positions = Array::own(std::vector<float>{0, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0}, 3);
    mesh = DeviceMesh::upload(*device_, surface);
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().message, "vertex 1 has the coordinate nan, but what is drawn must be finite");
    surface.positions = Array::own(std::vector<float>{0, 0, 0, 0}, 2);
    EXPECT_FALSE(DeviceMesh::upload(*device_, surface));
}

TEST_F(Wrong, SizesAndCamerasAreRefused) {
    options_.width = 0;
    expect_error("a picture of 0 x 64 pixels");
    options_.width = 40000;
    expect_error("each must be from 1 to 32768");
    options_.width = 64;
    options_.samples = 9;
    expect_error("9 samples an axis");
    options_.samples = 1;
    options_.camera.height = 0;
    expect_error("a height of 0");
    options_.camera.projection = Projection::perspective;
    options_.camera.distance = std::numeric_limits<double>::infinity();
    expect_error("a distance of inf");
    options_.camera.distance = 1;
    options_.camera.angle = 180;
    expect_error("180 degrees");
    options_.camera.angle = 30;
    options_.camera.up = options_.camera.direction;
    expect_error("unit vectors at right angles");
}

TEST_F(Wrong, OpacitiesLinesAndColoursAreRefused) {
    add(square_at(0), {}, 1.5);
    expect_error("an opacity of 1.5");
    scene_.surfaces.front().opacity = 1;
    color_by(scene_.surfaces.front(), {0, 1, 2}, {.lower = 0, .upper = 1});
    expect_error("3 values shall colour a mesh with 4 vertices");
    scene_.surfaces.clear();
    scene_.lines = {{.lines = {{{{0, 0, 0}, {1, 1, 1}}}}, .width = 0}};
    expect_error("0 pixels wide");
    const std::vector<float> values{1, 2};
    const auto colors = DeviceColors::of_mesh(*device_, Array::borrow(std::span(values)), Association::point,
                                              {.lower = 0, .upper = 1, .logarithmic = true});
    ASSERT_FALSE(colors);
    EXPECT_NE(colors.error().message.find("a smaller positive"), std::string::npos) << colors.error().message;
}

TEST_F(Wrong, OneTriangleAndNoneAreDrawn) {
    Surface one = square_at(0);
    one.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2}, 3);
    add(one, {0, 0, 0, 1});
    EXPECT_EQ(draw().at(40, 44), (Pixel{0, 0, 0, 255}));
    scene_.surfaces.clear();
    Surface none;
    none.positions = Array::own(std::vector<float>{}, 3);
    none.triangles = Array::own(std::vector<std::uint32_t>{}, 3);
    add(none, {});
    EXPECT_EQ(centre(draw()), (Pixel{255, 255, 255, 255}));
}

TEST_F(Wrong, DegenerateTrianglesAndNormalsDoNoHarm) {
    Surface surface = square_at(0);
    surface.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 1, 1, 1, 0, 0, 2}, 3);
    surface.normals_kind = Normals::gradient;
    surface.normals = Array::own(std::vector<float>(12, 0), 3);
    add(surface, blue);
    EXPECT_LE(difference(centre(draw()), pixel_of(blue)), 1) << "faces tell where normals are zero";
}

TEST_F(Wrong, ABoxAroundThatIsTooSmallCutsNothingNearby) {
    add(square_at(0), {0, 0, 0, 1});
    scene_.bounds = {{0, 0, 0}, {0, 0, 0}};
    EXPECT_EQ(centre(draw()), (Pixel{0, 0, 0, 255}));
}

} // namespace
} // namespace isotet::test
