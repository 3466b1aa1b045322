// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Calls that fail while something is uploaded and drawn: an error, or the right picture; nothing is left over.
#include "render/drawing.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include <isotet/draw_tets.hpp>

#include "support/small_grid.hpp"
#include "vulkan/failing_calls.hpp"

namespace isotet::test {
namespace {

class DrawingFaults : public testing::Test {
protected:
    void SetUp() override {
        const Grid grid = made_grid("kuhn", 3, {"gyroid"});
        packed_ = pack(grid, point_field(grid), {.split_cells = true}).value();
        for (std::uint32_t tet = 0; tet < packed_.report().tets; ++tet) list_.push_back(tet);
        right_ = work_through(none_).value();
        ASSERT_TRUE(std::ranges::any_of(right_.pixels, [&](const Pixel& pixel) { return pixel != right_.at(0, 0); }))
            << "nothing is seen";
    }

    /// Opens a device, draws, and closes it. What the validation layer complains about fails the test.
    Result<Picture> work_through(CallPlan& plan) {
        vulkan::Settings settings = watched();
        settings.alter_functions = [&plan](vulkan::DeviceFunctions& functions) { make_calls_follow(plan, functions); };
        const Result<Picture> picture = [&]() -> Result<Picture> {
            auto context = vulkan::Context::open({test_device(), 0}, settings);
            if (!context) return context.error();
            return draw(Device(*std::move(context)));
        }();
        for (const std::string& complaint : settings.watch.complaints->all()) ADD_FAILURE() << complaint;
        return picture;
    }

    /// A coloured mesh, lines, tets by mesh shaders, and translucent ones that are sent.
    Result<Picture> draw(const Device& device) const {
        auto renderer = Renderer::create(device);
        if (!renderer) return renderer.error();
        auto mesh = DeviceMesh::upload(device, square_at(0.5F));
        if (!mesh) return mesh.error();
        const std::vector<float> values{0, 0.3F, 0.6F, 1};
        auto colors = DeviceColors::of_mesh(device, Array::borrow(std::span(values)), Association::point, {});
        if (!colors) return colors.error();
        auto groups = TetStore::upload(device, packed_, DrawMethod::mesh);
        if (!groups) return groups.error();
        const TetStoreOptions nothing_there{.gradients = false,
                                            .picture_bytes = std::numeric_limits<std::uint64_t>::max()};
        auto registers = TetStore::upload(device, packed_, DrawMethod::registers, nothing_there);
        if (!registers) return registers.error();
        auto opaque = groups->at(0.3);
        if (!opaque) return opaque.error();
        auto translucent = registers->at(-0.2, list_);
        if (!translucent) return translucent.error();
        if (const auto triangles = translucent->triangles(); !triangles) return triangles.error();
        Scene scene;
        scene.bounds = {{-1, -1, -1}, {1, 1, 1}};
        scene.surfaces = {
            {.mesh = &*mesh, .colors = &*colors}, {.tets = &*opaque}, {.opacity = 0.5, .tets = &*translucent}};
        scene.lines = {outline_of(scene.bounds)};
        PictureOptions options;
        options.width = options.height = 24;
        options.samples = 1;
        options.camera = camera_of(View::iso);
        options.camera.fit(scene.bounds, 1);
        return renderer->draw(scene, options);
    }

    void expect_error_or_picture(CallPlan& plan, const std::string& what, std::size_t& errors) {
        const Result<Picture> picture = work_through(plan);
        if (picture) {
            EXPECT_TRUE(picture->pixels == right_.pixels) << what;
            return;
        }
        ++errors;
        const ErrorCode code = picture.error().code;
        EXPECT_TRUE(is_of_device(code) || code == ErrorCode::out_of_memory) << what << ": " << picture.error().message;
        EXPECT_GT(picture.error().message.size(), 20u) << what;
    }

    PackedGrid packed_;
    std::vector<std::uint32_t> list_;
    CallPlan none_;
    Picture right_;
};

TEST_F(DrawingFaults, AnyCallThatFailsIsAnErrorOrDoneWithout) {
    const std::vector<std::string>& calls = none_.calls;
    ASSERT_GT(calls.size(), 60u);
    std::size_t errors = 0;
    for (std::size_t i = 0; i < calls.size(); ++i) {
        // The first call of every function has no memory, the last one finds the device lost.
        const auto here = calls.begin() + static_cast<std::ptrdiff_t>(i);
        const bool first = std::find(calls.begin(), here, calls[i]) == here;
        const bool last = std::find(here + 1, calls.end(), calls[i]) == calls.end();
        for (const VkResult with : {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_DEVICE_LOST}) {
            if (!(with == VK_ERROR_DEVICE_LOST ? last : first)) continue;
            CallPlan plan{.fail_at = static_cast<int>(i) + 1, .with = with, .only = {}, .calls = {}};
            expect_error_or_picture(plan, calls[i], errors);
        }
    }
    EXPECT_GT(errors, 20u);
}

TEST_F(DrawingFaults, AnyAllocationThatFailsLeavesNothingBehind) {
    for (const std::string function :
         {"vkAllocateMemory", "vkCreateBuffer", "vkCreateImage", "vkCreateGraphicsPipelines"}) {
        const auto calls = std::ranges::count(none_.calls, function);
        ASSERT_GE(calls, 2) << function;
        std::size_t errors = 0;
        for (int i = 1; i <= calls; ++i) {
            CallPlan plan{.fail_at = i, .with = VK_ERROR_OUT_OF_DEVICE_MEMORY, .only = function, .calls = {}};
            expect_error_or_picture(plan, function + " " + std::to_string(i), errors);
        }
        EXPECT_GT(errors, 0u) << function;
    }
}

} // namespace
} // namespace isotet::test
