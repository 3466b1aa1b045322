// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces drawn where the Vulkan engine left them: the same pictures as of the same surfaces downloaded and uploaded,
// with nothing crossing the bus but the picture.
#include "render/drawing.hpp"

#include <isotet/fields.hpp>

namespace isotet::test {
namespace {

class DeviceSurfaces : public Drawing {
protected:
    void SetUp() override {
        Drawing::SetUp();
        grid_ = make_grid({.shape = "kuhn", .side = 10, .fields = {"gyroid", "sphere"}}).value();
        packed_ = pack(grid_, find_field(grid_, "gyroid").value(), {.source_cells = true, .gradients = true}).value();
        on_device_.emplace(DeviceGrid::upload(*device_, packed_).value());
        options_.camera = camera_of(View::iso);
        options_.camera.fit(scene_.bounds, 1);
    }
    void TearDown() override {
        surface_ = {};
        on_device_.reset();
        Drawing::TearDown();
    }

    /// The picture of the surface on the device; then that of the same surface from the CPU engine, coloured alike.
    void expect_the_same(const Array& values, std::optional<Association> association) {
        const ColorScale scale{.lower = 0, .upper = 1.5};
        ExtractOptions options;
        options.normals = Normals::gradient;
        options.edge_ends = association == Association::point;
        options.source_cells = association == Association::cell;
        surface_ = on_device_->extract(0.1, options).value();
        std::optional<DeviceColors> of_grid;
        if (association) of_grid.emplace(DeviceColors::of_grid(*device_, packed_, values, *association, scale).value());
        scene_.surfaces = {{.surface = &surface_, .colors = of_grid ? &*of_grid : nullptr}};
        const Picture direct = draw();
        EXPECT_EQ(renderer_->work().downloaded_bytes, options_.width * options_.height * 4);
        EXPECT_LT(renderer_->work().uploaded_bytes, 1000u) << "parameters only";

        if (association == Association::point) options.point_fields = {{"values", values}};
        if (association == Association::cell) options.cell_fields = {{"values", values}};
        const Surface surface = extract(packed_, 0.1, options).value().surface;
        scene_.surfaces.clear();
        DrawnSurface& drawn = add(surface, DrawnSurface{}.color);
        if (association) {
            const Array& carried =
                association == Association::point ? surface.point_fields[0].values : surface.cell_fields[0].values;
            std::vector<float> floats;
            for (std::size_t i = 0; i < carried.size(); ++i) floats.push_back(static_cast<float>(carried.at(i)));
            color_by(drawn, floats, scale, *association);
        }
        const Picture uploaded = draw();
        int differing = 0;
        for (std::size_t i = 0; i < direct.pixels.size(); ++i)
            differing += difference(direct.pixels[i], uploaded.pixels[i]) > 1;
        EXPECT_EQ(differing, 0);
        EXPECT_NE(centre(direct), (Pixel{255, 255, 255, 255})) << "something is seen";
    }

    Grid grid_;
    PackedGrid packed_;
    std::optional<DeviceGrid> on_device_;
    DeviceSurface surface_;
};

TEST_F(DeviceSurfaces, AreDrawnWithoutCrossingTheBus) { expect_the_same({}, {}); }

TEST_F(DeviceSurfaces, AreColouredByPointsOfTheGrid) {
    expect_the_same(find_field(grid_, "sphere").value().values, Association::point);
}

TEST_F(DeviceSurfaces, AreColouredByCellsOfTheGrid) {
    std::vector<float> values;
    for (std::size_t cell = 0; cell < grid_.cells.count(); ++cell) values.push_back(static_cast<float>(cell % 16) / 10);
    expect_the_same(Array::own(std::move(values)), Association::cell);
}

TEST_F(DeviceSurfaces, SayWhatTheyWereExtractedWithout) {
    surface_ = on_device_->extract(0.1).value();
    const Array sphere = find_field(grid_, "sphere").value().values;
    const DeviceColors colors = DeviceColors::of_grid(*device_, packed_, sphere, Association::point, {}).value();
    scene_.surfaces = {{.surface = &surface_, .colors = &colors}};
    const Result<Picture> picture = renderer_->draw(scene_, options_);
    ASSERT_FALSE(picture);
    EXPECT_NE(picture.error().message.find("must be extracted with edge_ends"), std::string::npos)
        << picture.error().message;
}

TEST_F(DeviceSurfaces, ThatAreEmptyOrWereNeverExtractedDrawNothing) {
    surface_ = on_device_->extract(99).value();
    const DeviceSurface never;
    scene_.surfaces = {{.surface = &surface_}, {.surface = &never}, {}};
    EXPECT_EQ(centre(draw()), (Pixel{255, 255, 255, 255}));
}

} // namespace
} // namespace isotet::test
