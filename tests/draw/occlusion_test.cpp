// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Folds that become darker: what is flat or bulges does not, whatever way it is seen.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/extract.hpp>
#include <isotet/isosurface_scene.hpp>
#include <isotet/make.hpp>
#include <isotet/render.hpp>

namespace isotet::test {
namespace {

/// Strips of length 2 along y over a profile of points (x, z).
Surface strips(const std::vector<std::array<float, 2>>& profile) {
    Surface surface;
    std::vector<float> positions;
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t i = 0; i < profile.size(); ++i) {
        for (const float y : {-1.0F, 1.0F}) positions.insert(positions.end(), {profile[i][0], y, profile[i][1]});
        if (i > 0)
            for (const std::uint32_t corner : {2 * i - 2, 2 * i - 1, 2 * i, 2 * i, 2 * i - 1, 2 * i + 1})
                triangles.push_back(corner);
    }
    surface.positions = Array::own(std::move(positions), 3);
    surface.triangles = Array::own(std::move(triangles), 3);
    return surface;
}

class OcclusionInPictures : public ::testing::TestWithParam<Projection> {
protected:
    /// Seen from above, turned by the angles.
    Picture picture(const Surface& surface, double occlusion, double azimuth = 0, double elevation = 90) const {
        Scene scene;
        scene.surfaces.emplace_back().triangles = &surface;
        scene.bounds = {{-1, -1, -1}, {1, 1, 1}};
        PictureOptions options;
        options.width = options.height = 120;
        options.occlusion = occlusion;
        options.camera = camera_of(azimuth, elevation, UpAxis::plus_z, GetParam());
        options.camera.fit(scene.bounds, 1);
        return draw(scene, options).value();
    }
    /// Where pictures differ first.
    static std::string changed(const Picture& a, const Picture& b) {
        for (std::uint32_t y = 0; y < a.height; ++y)
            for (std::uint32_t x = 0; x < a.width; ++x)
                if (a.at(x, y) != b.at(x, y)) return std::to_string(x) + ", " + std::to_string(y);
        return "";
    }
    static double light(const Picture& picture, std::uint32_t x, std::uint32_t y) {
        return (picture.at(x, y)[0] + picture.at(x, y)[1] + picture.at(x, y)[2]) / 3.0;
    }
};

TEST_P(OcclusionInPictures, LeavesWhatIsFlatAsItIs) {
    const Surface flat = strips({{-1, -0.4F}, {1, 0.7F}});
    for (const double elevation : {90.0, 40.0, 15.0})
        for (const double azimuth : {0.0, 33.0, 200.0})
            EXPECT_EQ(changed(picture(flat, 1, azimuth, elevation), picture(flat, 0, azimuth, elevation)), "")
                << azimuth << ' ' << elevation;
}

TEST_P(OcclusionInPictures, LeavesWhatBulgesAsItIs) {
    std::vector<std::array<float, 2>> profile;
    for (int i = 0; i <= 40; ++i) {
        const float x = static_cast<float>(i - 20) / 20;
        profile.push_back({x, 0.5F - x * x});
    }
    const Surface roof = strips(profile);
    EXPECT_EQ(changed(picture(roof, 1), picture(roof, 0)), "");
}

TEST_P(OcclusionInPictures, DarkensAGrooveTheMoreTheNarrowerItIs) {
    const Surface wide = strips({{-1, 0}, {-0.5F, 0}, {0, -0.3F}, {0.5F, 0}, {1, 0}}),
                  narrow = strips({{-1, 0}, {-0.3F, 0}, {0, -0.9F}, {0.3F, 0}, {1, 0}});
    const std::uint32_t at = 63; // beside the bottom of the groove
    const auto share = [&](const Surface& groove, double occlusion) {
        const Picture with = picture(groove, occlusion), without = picture(groove, 0);
        EXPECT_EQ(light(with, 20, 60), light(without, 20, 60)) << "far from it";
        return std::min(light(with, at, 60) / light(without, at, 60), light(with, 60, at) / light(without, 60, at));
    };
    const double of_wide = share(wide, 1), of_narrow = share(narrow, 1);
    EXPECT_LT(of_wide, 0.97);
    EXPECT_LT(of_narrow, of_wide - 0.1);
    EXPECT_GT(share(narrow, 0.5), of_narrow);
}

TEST_P(OcclusionInPictures, IsTheSameOnAnyThreads) {
    const Grid grid = make_grid({.shape = "kuhn", .side = 12, .fields = {"gyroid"}}).value();
    const Surface surface =
        extract_direct(grid, find_field(grid, "gyroid").value(), std::array{0.2}).value().surfaces[0].surface;
    Scene scene;
    scene.surfaces.emplace_back().triangles = &surface;
    scene.bounds = {{-1, -1, -1}, {1, 1, 1}};
    PictureOptions options;
    options.width = 121; // not a multiple of anything
    options.height = 87;
    options.occlusion = 0.8;
    options.camera = camera_of(30, 20, UpAxis::plus_z, GetParam());
    options.camera.fit(scene.bounds, 121.0 / 87);
    const Picture one = draw(scene, options, {.threads = 1}).value();
    for (const int threads : {2, 7})
        EXPECT_TRUE(draw(scene, options, {.threads = threads}).value().pixels == one.pixels);
    options.occlusion = 0;
    EXPECT_FALSE(draw(scene, options).value().pixels == one.pixels);
}

INSTANTIATE_TEST_SUITE_P(Projections, OcclusionInPictures,
                         ::testing::Values(Projection::perspective, Projection::parallel), [](const auto& which) {
                             return std::string(which.param == Projection::parallel ? "Parallel" : "Perspective");
                         });

TEST(Occlusion, OutsideOfItsRangeIsRefused) {
    Scene scene;
    scene.bounds = {{-1, -1, -1}, {1, 1, 1}};
    PictureOptions options;
    options.camera = camera_of(View::iso);
    options.camera.fit(scene.bounds, 4.0 / 3);
    for (const double wrong : {-0.1, 1.1, std::nan("")}) {
        options.occlusion = wrong;
        EXPECT_EQ(draw(scene, options).error().code, ErrorCode::invalid_argument) << wrong;
    }
}

/// A sphere's points, evenly around.
SurfacePoints sphere(double radius, std::array<double, 3> centre = {}) {
    SurfacePoints points;
    const int count = 1500;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2.0 * i + 1) / count, across = std::sqrt(1 - z * z), turn = 2.399963229728653 * i;
        points.push_back({centre[0] + radius * across * std::cos(turn), centre[1] + radius * across * std::sin(turn),
                          centre[2] + radius * z});
    }
    return points;
}

TEST(HiddenSurfaces, AreThoseInsideOthers) {
    using Hidden = std::vector<std::vector<std::size_t>>;
    EXPECT_EQ(hidden_by(std::array{sphere(1), sphere(0.5), sphere(0.8)}), (Hidden{{1, 2}, {}, {1}}));
    EXPECT_EQ(hidden_by(std::array{sphere(1), sphere(1, {2.5, 0, 0})}), (Hidden{{}, {}})) << "beside each other";
    EXPECT_EQ(hidden_by(std::array{sphere(1), SurfacePoints()}), (Hidden{{}, {}})) << "nothing is there to be hidden";
    const std::array<double, 3> far{5e5, 4e6, 1e3};
    EXPECT_EQ(hidden_by(std::array{sphere(0.4, far), sphere(1, far)}), (Hidden{{}, {0}})) << "far from the origin";
    EXPECT_EQ(hidden_by(std::span<const SurfacePoints>()), Hidden());
}

TEST(HiddenSurfaces, AreSeenThroughWhatHidesThem) {
    const std::vector<double> isovalues{0.5, 1};
    const auto looks = looks_of(isovalues, std::array{sphere(0.5), sphere(1)}, {});
    EXPECT_EQ(looks[0].opacity, 1);
    EXPECT_EQ(looks[1].opacity, 0.35);
    SceneLook opaque;
    opaque.opacity = 1;
    EXPECT_EQ(looks_of(isovalues, std::array{sphere(0.5), sphere(1)}, opaque)[1].opacity, 1);
}

} // namespace
} // namespace isotet::test
