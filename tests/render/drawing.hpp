// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Small scenes, drawn on the software device under the eyes of the validation layer, and each beside the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/extract.hpp>
#include <isotet/make.hpp>
#include <isotet/picture.hpp>
#include <isotet/render.hpp>

#include "vulkan/software_device.hpp"

namespace isotet::test {

using Pixel = std::array<std::uint8_t, 4>;

inline constexpr Color red{0.9F, 0.1F, 0.1F, 1}, green{0.1F, 0.7F, 0.2F, 1}, blue{0.1F, 0.3F, 0.8F, 1};

/// A square of two triangles at right angles to x, of half a side 1, wound to be seen from +x or -x.
inline Surface square_at(float x, bool from_minus_x = false) {
    Surface surface;
    surface.positions = Array::own(std::vector<float>{x, -1, -1, x, 1, -1, x, 1, 1, x, -1, 1}, 3);
    surface.triangles = from_minus_x ? Array::own(std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2}, 3)
                                     : Array::own(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, 3);
    return surface;
}

/// A sphere about 0 with gradient normals, of radius 0.5.
inline Surface sphere(std::size_t side = 24) {
    const Grid grid = make_grid({.shape = "kuhn", .side = side, .fields = {"sphere"}}).value();
    const PackedGrid packed = pack(grid, find_field(grid, "sphere").value(), {.gradients = true}).value();
    ExtractOptions options;
    options.normals = Normals::gradient;
    return extract(packed, 0.5, options).value().surface;
}

class Drawing : public OnDevice {
protected:
    void SetUp() override {
        OnDevice::SetUp();
        device_.emplace(shared_context());
        renderer_.emplace(Renderer::create(*device_).value());
        options_.width = options_.height = 64;
        options_.samples = 2;
        options_.camera = camera_of(View::plus_x, Projection::parallel);
        options_.camera.height = 2.5;
        options_.camera.distance = 4;
        scene_.bounds = {{-1, -1, -1}, {1, 1, 1}};
    }
    void TearDown() override {
        renderer_.reset();
        meshes_.clear();
        colors_.clear();
        device_.reset();
        OnDevice::TearDown();
    }

    DrawnSurface& add(const Surface& surface, const Color& color, double opacity = 1) {
        meshes_.push_back(std::make_unique<DeviceMesh>(DeviceMesh::upload(*device_, surface).value()));
        surfaces_.push_back(surface);
        return scene_.surfaces.emplace_back(
            DrawnSurface{.mesh = meshes_.back().get(), .color = color, .opacity = opacity});
    }
    void color_by(DrawnSurface& drawn, const std::vector<float>& values, const ColorScale& scale,
                  Association association = Association::point) {
        values_.push_back({Array::own(values), association, scale});
        colors_.push_back(std::make_unique<DeviceColors>(
            DeviceColors::of_mesh(*device_, values_.back().values, association, scale).value()));
        drawn.colors = colors_.back().get();
    }

    /// The picture of the device; that of the CPU is beside it at most 1 of 255, but for pixels at edges, of which small
    /// pictures have many.
    Picture draw() {
        Picture picture = renderer_->draw(scene_, options_).value();
        const std::optional<Scene> in_memory = scene_in_memory();
        if (!in_memory) return picture;
        const Picture on_cpu = isotet::draw(*in_memory, options_).value();
        const double few = 0.005 + 2.0 / static_cast<double>(picture.pixels.size());
        EXPECT_LE(isotet::difference(picture, on_cpu, 1).value(), few);
        return picture;
    }
    /// The scene without what is on the device only; nothing where there is such.
    std::optional<Scene> scene_in_memory() const {
        Scene scene = scene_;
        for (DrawnSurface& drawn : scene.surfaces) {
            for (std::size_t i = 0; i < meshes_.size(); ++i)
                if (drawn.mesh == meshes_[i].get()) drawn.triangles = &surfaces_[i];
            for (std::size_t i = 0; i < colors_.size(); ++i)
                if (drawn.colors == colors_[i].get()) drawn.values = &values_[i];
            if (!drawn.triangles || !drawn.colors != !drawn.values) return {};
            drawn.mesh = nullptr;
            drawn.colors = nullptr;
        }
        return scene;
    }
    static Pixel centre(const Picture& picture) { return picture.at(picture.width / 2, picture.height / 2); }

    std::optional<Device> device_;
    std::optional<Renderer> renderer_;
    Scene scene_;
    PictureOptions options_;
    std::vector<std::unique_ptr<DeviceMesh>> meshes_;
    std::vector<std::unique_ptr<DeviceColors>> colors_;
    std::deque<Surface> surfaces_; ///< of the meshes
    std::deque<SurfaceColors> values_;
};

/// A colour as a pixel has it.
inline Pixel pixel_of(const Color& color) {
    const auto byte = [](float part) { return static_cast<std::uint8_t>(part * 255 + 0.5F); };
    return {byte(color.red), byte(color.green), byte(color.blue), byte(color.opacity)};
}

/// The largest difference of a part of two pixels.
inline int difference(const Pixel& a, const Pixel& b) {
    int largest = 0;
    for (std::size_t part = 0; part < 4; ++part) largest = std::max(largest, std::abs(int{a[part]} - int{b[part]}));
    return largest;
}

} // namespace isotet::test
