// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pictures of volumes whose rays a device follows have the bytes of the processor's.
#include <atomic>

#include <isotet/packed_file.hpp>

#include "draw/volumes.hpp"
#include "render/device/volume_rays.hpp"
#include "render/drawing.hpp"
#include "support/random_grid.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

const OpacityCurve two_peaks{{{-0.9, 0}, {-0.6, 0.9}, {-0.42, 0}, {0.48, 0}, {0.66, 0.95}, {0.84, 0}}},
    ramp_curve{{{-1.5, 0}, {1.5, 0.6}}}, opaque_soon{{{-1.5, 0.9}, {0, 0.99999}, {1.5, 0.2}}};

/// By kernels with doubles of the device, and with those made of integers.
class VolumeRaysTest : public OnDevice, public testing::WithParamInterface<bool> {
protected:
    void SetUp() override {
        reopen(settings());
        rays_ = std::make_unique<render::VolumeRays>(shared_context());
    }
    static vulkan::Settings settings() {
        vulkan::Settings settings = watched();
        settings.wait_limit = std::chrono::minutes(5); // the software device compiles long
        if (!GetParam())
            settings.alter_capabilities = [](vulkan::Capabilities& capabilities) {
                capabilities.features.shaderFloat64 = VK_FALSE;
            };
        return settings;
    }
    void TearDown() override {
        rays_.reset();
        OnDevice::TearDown();
    }

    Picture on_device(const VolumeCase& one, const render::VolumeTuning& tuning = {}) {
        return render::draw_with(one.scene, one.picture, tuning, rays_.get(), Progress(), work_).value();
    }
    void expect_same(const VolumeCase& one, const std::string& what, const render::VolumeTuning& tuning = {}) {
        const Picture right = draw(one.scene, one.picture).value(), found = on_device(one, tuning);
        std::size_t unlike = 0;
        for (std::size_t i = 0; i < right.pixels.size(); ++i) unlike += right.pixels[i] != found.pixels[i] ? 1 : 0;
        EXPECT_EQ(unlike, 0U) << what;
        EXPECT_GT(work_.segments, 0U) << what;
    }

    std::unique_ptr<render::VolumeRays> rays_;
    VolumeWork work_;
};

TEST_P(VolumeRaysTest, GiveTheSamePicturesOfMedia) {
    for (const char* shape : {"kuhn", "perturbed", "mixed", "hex"})
        for (const Projection projection : {Projection::perspective, Projection::parallel}) {
            VolumeCase one = made_volume(shape, 6, "gyroid", two_peaks);
            one.look_from(31, 23, projection);
            expect_same(one, shape);
            one.volume().opacity = ramp_curve;
            expect_same(one, std::string(shape) + " where all contribute");
            one.volume().opacity = opaque_soon;
            one.volume().opacity_length = 0.01;
            one.volume().shaded = true;
            expect_same(one, std::string(shape) + " where pieces are halved, shaded");
            one.volume().clips = {{{1, 0.3, 0.2}, 0.2}, {{0, -1, 0}, 0.4}};
            expect_same(one, std::string(shape) + " clipped");
        }
}

TEST_P(VolumeRaysTest, GiveTheSamePicturesOfIsosurfaces) {
    for (const auto& [shape, projection] :
         {std::pair{"kuhn", Projection::perspective}, {"mixed", Projection::parallel}}) {
        VolumeCase one = made_volume(shape, 6, "gyroid", {});
        one.look_from(200, -10, projection);
        one.volume().isosurfaces = {{0.1, red}, {0, green}, {-0.7, blue}};
        expect_same(one, shape);
        one.volume().opacity = ramp_curve;
        one.volume().clips = {{{1, 0.3, 0.2}, 0.2}};
        expect_same(one, std::string(shape) + " in a medium, clipped");
    }
}

TEST_P(VolumeRaysTest, BeginInTheVolume) {
    for (const char* shape : {"kuhn", "mixed"}) {
        VolumeCase one = made_volume(shape, 5, "gyroid", ramp_curve);
        one.picture.camera.target = {0.1, 0.05, 0};
        one.picture.camera.distance = 0.3;
        one.picture.camera.angle = 80;
        one.volume().isosurfaces = {{1.2, red}};
        one.volume().shaded = true;
        expect_same(one, shape);
    }
}

TEST_P(VolumeRaysTest, AreCutBySheetsAndSharedByVolumes) {
    VolumeCase one = made_volume("kuhn", 6, "gyroid", two_peaks);
    const VolumeCase other = made_volume("mixed", 4, "sphere", {{{0, 0.1}, {2, 0.7}}});
    Surface through = square_at(0.1F), behind = square_at(-0.6F);
    one.scene.surfaces.resize(2);
    one.scene.surfaces[0].triangles = &through;
    one.scene.surfaces[0].opacity = 0.4;
    one.scene.surfaces[1].triangles = &behind;
    one.scene.lines.push_back(outline_of(one.scene.bounds));
    one.picture.occlusion = 0.5;
    expect_same(one, "sheets");
    one.scene.volumes.push_back(other.scene.volumes[0]);
    one.scene.volumes[1].isosurfaces = {{0.5, green}};
    one.scene.volumes[1].clips = {{{0, 0, 1}, 0.1}};
    one.scene.volumes[0].shaded = true;
    expect_same(one, "two volumes that overlap");
    one.scene.volumes[1].scale.logarithmic = true;
    one.scene.volumes[1].scale.lower = 0.1;
    expect_same(one, "on a logarithmic scale");
}

TEST_P(VolumeRaysTest, HaveListsThatGrow) {
    VolumeCase one = made_volume("mixed", 8, "gyroid", ramp_curve);
    for (const render::ListRoom& room : {render::ListRoom{8, 1}, {8, 8}, {16, 1000}, {512, 400}})
        for (const bool skips : {true, false}) {
            expect_same(one, std::to_string(room.capacity), {room, skips});
            one.volume().opacity = two_peaks;
        }
    one.scene.volumes[0].opacity = ramp_curve;
    on_device(one, {{16, 1000}, true});
    const std::uint64_t grown = work_.segments;
    on_device(one, {{2048, 1000}, true});
    EXPECT_EQ(work_.segments, grown) << "those of lists that were too short do not count";
}

TEST_P(VolumeRaysTest, MeetRandomGridsAsTheProcessorSays) {
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        NastyOptions options;
        options.side = 3;
        options.values = seed % 3 == 0 ? 0 : 5;
        options.no_data = seed % 4 == 0 ? 0.05 : 0;
        options.missing = options.mirrored = options.repeated = 0.1;
        options.inverted = seed % 2 == 0 ? 0.1 : 0;
        options.wide = seed % 5 == 0;
        const NastyGrid nasty = nasty_grid(seed, options);
        VolumeCase one = volume_of(nasty.grid, nasty.field, {{{-1.2, 0.1}, {0.2, 0.7}, {0.9, 0}, {2, 0.3}}},
                                   {.precision = options.wide ? Precision::float64 : Precision::float32});
        one.picture.samples = 1;
        one.look_from(seed * 37.0, 20, seed % 5 == 0 ? Projection::parallel : Projection::perspective);
        if (seed % 3 == 1) one.volume().clips = {{{1, 0.3, 0}, 0.4}, {{0, -1, 2}, 0.8}};
        if (seed % 2 == 0) one.volume().isosurfaces = {{0.5, red}, {1, green}, {2, blue}};
        one.volume().shaded = seed % 2 == 1;
        expect_same(one, "seed " + std::to_string(seed));
    }
}

TEST_P(VolumeRaysTest, FillPicturesOfManyTiles) {
    VolumeCase one = made_volume("kuhn", 3, "gyroid", ramp_curve);
    one.picture.width = 1000;
    one.picture.height = 290;
    one.picture.samples = 1;
    one.look_from(31, 23);
    expect_same(one, "more than a batch");
}

TEST_P(VolumeRaysTest, OfWhatIsTransparentAreNotFollowed) {
    VolumeCase one = made_volume("kuhn", 4, "gyroid", {{{5, 0}, {6, 1}, {7, 0}}});
    EXPECT_TRUE(on_device(one).pixels == draw(one.scene, one.picture)->pixels);
    EXPECT_EQ(work_.segments, 0U);
    one.volume().opacity = two_peaks;
    on_device(one);
    const std::uint64_t few = work_.tets;
    on_device(one, {{}, false});
    EXPECT_GT(work_.tets, few);
}

TEST_P(VolumeRaysTest, GiveTheSamePictureOfAFileOfWhichLittleIsInMemory) {
    const TemporaryFolder folder;
    VolumeCase one = made_volume("mixed", 8, "gyroid", two_peaks);
    one.volume().isosurfaces = {{-0.1, red}};
    save_packed(*one.grid, folder.file("mixed.isotet"), {.more_fields = {}, .time = {}, .chunk_bytes = 2'000}).value();
    const PackedFile file = PackedFile::open(folder.file("mixed.isotet"), {100'000}).value();
    const PackedGrid grid = file.grid().value();
    one.volume().grid = &grid;
    expect_same(one, "file");
}

TEST_P(VolumeRaysTest, AreCancelled) {
    const VolumeCase one = made_volume("kuhn", 4, "gyroid", ramp_curve);
    const std::atomic<bool> cancel = true;
    const auto drawn =
        render::draw_with(one.scene, one.picture, {}, rays_.get(), {.report = {}, .cancel = &cancel}, work_);
    ASSERT_FALSE(drawn);
    EXPECT_EQ(drawn.error().code, ErrorCode::cancelled);
}

TEST_P(VolumeRaysTest, GiveTheSamePictureThroughStaging) {
    rays_.reset();
    vulkan::Settings staged = settings();
    staged.force_staging = true;
    staged.staging_bytes = 4096;
    reopen(staged);
    rays_ = std::make_unique<render::VolumeRays>(shared_context());
    VolumeCase one = made_volume("mixed", 5, "gyroid", two_peaks);
    one.volume().isosurfaces = {{0.1, red}};
    expect_same(one, "staged");
}

TEST_P(VolumeRaysTest, NeedMemory) {
    rays_.reset();
    reopen(settings(), 1 << 20);
    rays_ = std::make_unique<render::VolumeRays>(shared_context());
    const VolumeCase one = made_volume("kuhn", 4, "gyroid", ramp_curve);
    const auto checked = rays_->check(one.scene, Projection::perspective);
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error().code, ErrorCode::out_of_memory) << checked.error().message;
}

TEST_P(VolumeRaysTest, PassTheCheckOfADriver) {
    VolumeCase one = made_volume("kuhn", 4, "gyroid", ramp_curve);
    one.volume().isosurfaces = {{0.1, red}};
    for (const Projection projection : {Projection::perspective, Projection::parallel}) {
        const auto checked = rays_->check(one.scene, projection);
        EXPECT_TRUE(checked) << (checked ? std::string() : checked.error().message);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, VolumeRaysTest, testing::Bool(),
                         [](const auto& of) { return of.param ? "DoublesOfTheDevice" : "DoublesOfIntegers"; });

class VolumeDrawing : public Drawing {};

TEST_F(VolumeDrawing, IsTheProcessors) {
    VolumeCase one = made_volume("kuhn", 6, "gyroid", two_peaks);
    one.volume().isosurfaces = {{0.1, red}};
    EXPECT_TRUE(renderer_->draw(one.scene, one.picture)->pixels == isotet::draw(one.scene, one.picture)->pixels);
    EXPECT_GT(renderer_->volume_work().segments, 100U);
    EXPECT_GT(renderer_->volume_work().clusters, 0U);
    EXPECT_GT(renderer_->work().uploaded_bytes, 0U);
    one.volume().opacity_length = 0;
    EXPECT_EQ(renderer_->draw(one.scene, one.picture).error().message,
              "the length of the opacity is 0, but it must be positive");
}

} // namespace
} // namespace isotet::test
