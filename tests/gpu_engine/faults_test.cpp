// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Calls that fail while a grid is uploaded, extracted from and downloaded: an error, or the right bytes; nothing is
// left over, and the packed grid is as it was.
#include <algorithm>

#include "gpu_engine/engines.hpp"
#include "support/small_grid.hpp"
#include "vulkan/failing_calls.hpp"

namespace isotet::test {
namespace {

class EngineFaults : public Engines {
protected:
    void SetUp() override {
        const Grid grid = made_grid("kuhn", 6, {"gyroid"});
        field = point_field(grid);
        options.point_fields = {{"place", grid.points}};
        options.normals = Normals::face;
        packed = pack(grid, field).value();
        right = bytes_of(isotet::extract(packed, 0.2, options).value().surface);
    }

    /// Everything once, in small pages, with all that grows growing.
    enum class Copies { direct, staged };
    Result<std::string> work_through(CallPlan& plan, Copies copies = Copies::direct) {
        vulkan::Settings settings = watched();
        settings.force_staging = copies == Copies::staged;
        settings.alter_functions = [&plan](vulkan::DeviceFunctions& functions) { make_calls_follow(plan, functions); };
        auto context = vulkan::Context::open({test_device(), 0}, settings);
        if (!context) return context.error();
        auto result = extract_on(Device(*context));
        for (const std::string& complaint : settings.watch.complaints->all()) ADD_FAILURE() << complaint;
        return result;
    }

    Result<std::string> extract_on(const Device& opened) {
        auto grid = DeviceGrid::upload(opened, packed, {.page_bytes = 10'000, .surface_bytes = {}});
        if (!grid) return grid.error();
        if (auto set = grid->set_field(field); !set) return set.error();
        auto surface = grid->extract(0.2, options);
        if (!surface) return surface.error();
        auto extraction = grid->download(*surface);
        if (!extraction) return extraction.error();
        return bytes_of(extraction->surface);
    }

    PackedGrid packed;
    PointField field;
    ExtractOptions options;
    std::string right;
};

TEST_F(EngineFaults, AnyCallThatFailsIsAnErrorOrDoneWithout) {
    CallPlan all;
    ASSERT_EQ(work_through(all).value(), right);
    ASSERT_GT(all.calls.size(), 40u);
    std::size_t errors = 0;
    for (const VkResult with : {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_DEVICE_LOST})
        for (std::size_t i = 0; i < all.calls.size(); ++i) {
            // The first and the last call of every function; of a lost device, the first.
            const std::string& name = all.calls[i];
            const auto before = std::count(all.calls.begin(), all.calls.begin() + static_cast<std::ptrdiff_t>(i), name);
            const auto total = std::count(all.calls.begin(), all.calls.end(), name);
            if (before > 0 && (before + 1 < total || with == VK_ERROR_DEVICE_LOST)) continue;
            CallPlan plan{.fail_at = static_cast<int>(i) + 1, .with = with, .only = {}, .calls = {}};
            const auto result = work_through(plan);
            if (result) {
                EXPECT_EQ(*result, right) << name;
                continue;
            }
            ++errors;
            const ErrorCode code = result.error().code;
            EXPECT_TRUE(is_of_device(code) || code == ErrorCode::out_of_memory)
                << name << ": " << result.error().message;
            EXPECT_GT(result.error().message.size(), 20u) << name;
        }
    EXPECT_GT(errors, 20u);
    EXPECT_EQ(bytes_of(isotet::extract(packed, 0.2, options).value().surface), right) << "the packed grid is as it was";
}

/// What the layer complains about, be it that something was not given back, fails the test.
TEST_F(EngineFaults, AnyAllocationThatFailsLeavesNothingBehind) {
    for (const std::string function : {"vkAllocateMemory", "vkCreateBuffer"}) {
        CallPlan all{.fail_at = 0, .with = VK_ERROR_OUT_OF_DEVICE_MEMORY, .only = function, .calls = {}};
        ASSERT_EQ(work_through(all).value(), right);
        const int calls = static_cast<int>(all.calls.size());
        ASSERT_GE(calls, function == "vkAllocateMemory" ? 2 : 20);
        for (int i = 1; i <= calls; ++i) {
            CallPlan plan{.fail_at = i, .with = VK_ERROR_OUT_OF_DEVICE_MEMORY, .only = function, .calls = {}};
            const auto result = work_through(plan);
            if (result) EXPECT_EQ(*result, right) << function << " " << i;
            else
                EXPECT_EQ(result.error().code, ErrorCode::out_of_memory)
                    << function << " " << i << ": " << result.error().message;
        }
    }
}

/// Whatever it is doing: every wait has an end.
TEST_F(EngineFaults, ADeviceThatDoesNotAnswerIsGivenUp) {
    CallPlan all{.fail_at = 0, .with = VK_TIMEOUT, .only = "vkWaitForFences", .calls = {}};
    ASSERT_EQ(work_through(all, Copies::staged).value(), right);
    const int waits = static_cast<int>(all.calls.size());
    ASSERT_GE(waits, 10);
    for (int i = 1; i <= waits; ++i) {
        CallPlan plan{.fail_at = i, .with = VK_TIMEOUT, .only = "vkWaitForFences", .calls = {}};
        const auto result = work_through(plan, Copies::staged);
        ASSERT_FALSE(result) << i;
        EXPECT_EQ(result.error().code, ErrorCode::device_failed) << i;
        EXPECT_NE(result.error().message.find("did not answer within 30 s"), std::string::npos)
            << result.error().message;
        EXPECT_EQ(bytes_of(isotet::extract(packed, 0.2, options).value().surface), right)
            << i << ": the packed grid is as it should be";
    }
}

TEST_F(EngineFaults, ALostDeviceIsAnErrorFromThenOn) {
    CallPlan plan;
    vulkan::Settings settings = watched();
    settings.alter_functions = [&plan](vulkan::DeviceFunctions& functions) { make_calls_follow(plan, functions); };
    auto context = vulkan::Context::open({test_device(), 0}, settings).value();
    DeviceGrid grid = DeviceGrid::upload(Device(context), packed).value();
    DeviceSurface surface = grid.extract(0.2).value();
    plan = {.fail_at = 1, .with = VK_ERROR_DEVICE_LOST, .only = "vkQueueSubmit", .calls = {}};
    for (int again = 0; again < 2; ++again) {
        const auto lost = grid.extract(0.2, surface);
        ASSERT_FALSE(lost);
        EXPECT_EQ(lost.error().code, ErrorCode::device_failed);
        EXPECT_NE(lost.error().message.find("lost"), std::string::npos) << lost.error().message;
    }
}

TEST_F(EngineFaults, CancellingIsNotAFailure) {
    reopen(watched());
    std::atomic<bool> cancel{true};
    Progress progress;
    progress.cancel = &cancel;
    const auto upload = DeviceGrid::upload(device(), packed, {}, {.progress = progress});
    ASSERT_FALSE(upload);
    EXPECT_EQ(upload.error().code, ErrorCode::cancelled);
    DeviceGrid grid = DeviceGrid::upload(device(), packed).value();
    EXPECT_EQ(grid.extract(0.2, {}, {.progress = progress}).error().code, ErrorCode::cancelled);
    cancel = false;
    EXPECT_EQ(bytes_of(grid.download(grid.extract(0.2, options, {.progress = progress}).value()).value().surface),
              right);
}

} // namespace
} // namespace isotet::test
