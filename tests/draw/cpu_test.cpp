// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Drawing on the CPU: the same bytes everywhere, areas, order, what lies beside the camera, and what is refused.
#include <atomic>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/extract.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>
#include <isotet/picture.hpp>
#include <isotet/render.hpp>

#include "numbers/level.hpp"

namespace isotet::test {
namespace {

Surface gyroid(double isovalue, std::size_t side = 20) {
    const Grid grid = make_grid({.shape = "kuhn", .side = side, .fields = {"gyroid", "sphere"}}).value();
    const PackedGrid packed = pack(grid, find_field(grid, "gyroid").value(), {.gradients = true}).value();
    ExtractOptions options;
    options.normals = Normals::gradient;
    return extract(packed, isovalue, options).value().surface;
}

class DrawOnCpu : public ::testing::Test {
protected:
    DrawOnCpu() {
        options_.width = 120;
        options_.height = 90;
        options_.camera = camera_of(View::iso);
        scene_.bounds = {{-1, -1, -1}, {1, 1, 1}};
        options_.camera.fit(scene_.bounds, 4.0 / 3);
    }
    DrawnSurface& add(const Surface& surface, double opacity) {
        DrawnSurface& drawn = scene_.surfaces.emplace_back();
        drawn.triangles = &surface;
        drawn.opacity = opacity;
        return drawn;
    }
    static double covered(const Picture& picture) {
        double sum = 0;
        for (const auto& pixel : picture.pixels) sum += pixel[3] / 255.0;
        return sum;
    }

    Scene scene_;
    PictureOptions options_;
};

/// FNV-1a.
std::uint64_t hash_of(const Picture& picture) {
    std::uint64_t hash = 14695981039346656037U;
    for (const auto& pixel : picture.pixels)
        for (const std::uint8_t part : pixel) hash = (hash ^ part) * 1099511628211U;
    return hash;
}

TEST_F(DrawOnCpu, GivesTheSameBytesOnAnyThreadsAndMachines) {
    const Surface a = gyroid(0.2), b = gyroid(-0.3);
    const SurfaceColors colors{Array::own(std::vector<float>(a.vertex_count(), 0.4F)), Association::point, {}};
    add(a, 0.5).values = &colors;
    add(b, 1);
    scene_.lines.push_back(outline_of(scene_.bounds));
    const Picture one = draw(scene_, options_, {.threads = 1}).value();
    for (const int threads : {2, 7, 64})
        EXPECT_TRUE(draw(scene_, options_, {.threads = threads}).value().pixels == one.pixels) << threads;
    for (const core::Level level : {core::Level::portable, core::Level::avx2, core::Level::avx512}) {
        if (level > core::best_level()) continue;
        core::force_level(level);
        EXPECT_TRUE(draw(scene_, options_).value().pixels == one.pixels) << core::name_of(level);
    }
    core::force_level({});
    EXPECT_EQ(hash_of(one), 17389724797160526800U);
}

TEST_F(DrawOnCpu, CoversTheAreaOfAShadow) {
    Surface disc; // 64 triangles about 0, at right angles to x
    std::vector<float> positions{0, 0, 0};
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t i = 0; i < 64; ++i) {
        const double angle = i * std::numbers::pi / 32;
        positions.insert(positions.end(),
                         {0, static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))});
        triangles.insert(triangles.end(), {0, 1 + i, 1 + (i + 1) % 64});
    }
    disc.positions = Array::own(positions, 3);
    disc.triangles = Array::own(triangles, 3);
    add(disc, 1);
    options_.background = {0, 0, 0, 0};
    options_.camera = camera_of(View::plus_x, Projection::parallel);
    options_.camera.height = 2.5;
    options_.camera.distance = 4;
    options_.width = options_.height = 250;
    const double area = 32 * std::sin(std::numbers::pi / 32) * 100 * 100;
    for (const std::uint32_t samples : {1U, 3U, 8U}) {
        options_.samples = samples;
        EXPECT_NEAR(covered(draw(scene_, options_).value()) / area, 1, 0.003) << samples;
    }
}

TEST_F(DrawOnCpu, EdgesBetweenTrianglesNeitherLeakNorCountTwice) {
    const Surface surface = gyroid(0.1, 3);
    add(surface, 0.5);
    const Picture whole = draw(scene_, options_).value();
    // Each triangle a surface of its own: the same fragments.
    std::vector<Surface> single(surface.triangle_count(), surface);
    scene_.surfaces.clear();
    const auto corners = surface.triangles.as<std::uint32_t>();
    for (std::size_t i = 0; i < single.size(); ++i) {
        single[i].triangles =
            Array::own(std::vector<std::uint32_t>(corners.begin() + static_cast<std::ptrdiff_t>(3 * i),
                                                  corners.begin() + static_cast<std::ptrdiff_t>(3 * i + 3)),
                       3);
        add(single[i], 0.5);
    }
    EXPECT_TRUE(draw(scene_, options_).value().pixels == whole.pixels);
}

TEST_F(DrawOnCpu, TheOrderOfTranslucentSurfacesShowsNowhere) {
    const Surface a = gyroid(0.2), b = gyroid(-0.3);
    add(a, 0.5);
    add(b, 0.3).color = {1, 0, 0, 1};
    const Picture picture = draw(scene_, options_).value();
    std::swap(scene_.surfaces[0], scene_.surfaces[1]);
    EXPECT_TRUE(draw(scene_, options_).value().pixels == picture.pixels);
}

TEST_F(DrawOnCpu, OfSurfacesInTheSamePlaceTheFirstIsSeen) {
    const Surface surface = gyroid(0.2, 40);
    Surface reversed = surface;
    const auto corners = surface.triangles.as<std::uint32_t>();
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = corners.size(); i > 0; i -= 3)
        triangles.insert(triangles.end(), &corners[i - 3], &corners[i - 3] + 3);
    reversed.triangles = Array::own(std::move(triangles), 3);
    add(surface, 1);
    const Picture alone = draw(scene_, options_).value();
    add(reversed, 1).color = {1, 0, 0, 1};
    EXPECT_TRUE(draw(scene_, options_).value().pixels == alone.pixels);
    std::swap(scene_.surfaces[0], scene_.surfaces[1]);
    const Picture red = draw(scene_, options_).value();
    EXPECT_FALSE(red.pixels == alone.pixels);
    scene_.surfaces.pop_back();
    EXPECT_TRUE(draw(scene_, options_).value().pixels == red.pixels);
}

TEST_F(DrawOnCpu, WhatIsBehindAWallChangesNothing) {
    const Surface behind = gyroid(0.2, 40);
    Surface wall;
    wall.positions = Array::own(std::vector<float>{1.5F, -9, -9, 1.5F, 9, -9, 1.5F, 9, 9, 1.5F, -9, 9}, 3);
    wall.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, 3);
    options_.camera = camera_of(View::plus_x);
    options_.camera.fit({{-1, -1, -1}, {2, 1, 1}}, 4.0 / 3);
    scene_.bounds = {{-9, -9, -9}, {9, 9, 9}};
    add(wall, 1);
    const Picture alone = draw(scene_, options_).value();
    scene_.surfaces.clear();
    add(behind, 1);
    add(wall, 1);
    EXPECT_TRUE(draw(scene_, options_).value().pixels == alone.pixels);
}

TEST_F(DrawOnCpu, ACameraInsideSeesWhatIsBeforeIt) {
    const Surface surface = gyroid(0);
    add(surface, 1);
    options_.camera.target = {0.1, 0.05, 0};
    options_.camera.distance = 0.1;
    options_.camera.angle = 60;
    options_.background = {0, 0, 0, 0};
    const Picture small = draw(scene_, options_).value();
    EXPECT_GT(covered(small), 0.9 * 120 * 90) << "walls all around";
    // The middle of a picture four times as wide, from there, is the same picture: clipping moves nothing.
    options_.width = 480;
    const Picture wide = draw(scene_, options_).value();
    std::size_t other = 0;
    for (std::uint32_t y = 0; y < 90; ++y)
        for (std::uint32_t x = 0; x < 120; ++x) other += wide.at(180 + x, y) != small.at(x, y);
    EXPECT_LE(other, 10U);
}

TEST_F(DrawOnCpu, RefusesWhatItCannotDraw) {
    const Surface surface = gyroid(0, 4);
    const auto error = [&] { return draw(scene_, options_).error(); };
    add(surface, 2);
    EXPECT_EQ(error().message, "an opacity of 2, but it must be from 0 to 1");
    scene_.surfaces[0].opacity = 1;
    const SurfaceColors colors{Array::own(std::vector<float>{1}), Association::point, {}};
    scene_.surfaces[0].values = &colors;
    EXPECT_NE(error().message.find("1 values shall colour a mesh"), std::string::npos);
    scene_.surfaces[0] = {};
    EXPECT_NE(error().message.find("in a device's memory"), std::string::npos);
    scene_.surfaces.clear();
    options_.samples = 9;
    EXPECT_EQ(error().code, ErrorCode::invalid_argument);
    options_.samples = 3;
    const std::atomic<bool> cancel = true;
    EXPECT_EQ(draw(scene_, options_, {.progress = {.report = {}, .cancel = &cancel}}).error().code,
              ErrorCode::cancelled);
}

} // namespace
} // namespace isotet::test
