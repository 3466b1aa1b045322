// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A session on a device gives what a session on the CPU gives, and goes on without the device where it may.
#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/device.hpp>
#include <isotet/surface.hpp>

#include "gpu_engine/engines.hpp"
#include "support/small_grid.hpp"
#include "vulkan/failing_calls.hpp"

namespace isotet::test {
namespace {

ContourInput session_input(const Grid& grid, std::size_t field) { return {grid, point_field(grid, field), {}, {}}; }

std::vector<std::string> surfaces_of(Contour& contour, std::string_view engine) {
    std::vector<std::string> bytes;
    const ContourResult result = contour.extract(std::array{0.1, 0.2}).value();
    EXPECT_EQ(result.engine, engine);
    for (const Extraction& extraction : result.surfaces) bytes.push_back(bytes_of(extraction.surface));
    return bytes;
}

class SessionOnDevice : public Engines {
protected:
    const Grid grid = made_grid("perturbed", 9, {"gyroid", "sphere"});
    const ContourOptions on_cpu{.method = Method::clusters};

    /// A session whose device does what `plan` says from now on.
    Contour session(CallPlan& plan, bool required) {
        vulkan::Settings settings = watched();
        settings.alter_functions = [&plan](vulkan::DeviceFunctions& functions) { make_calls_follow(plan, functions); };
        const Device device(vulkan::Context::open({test_device(), 0}, settings).value());
        return Contour::create(session_input(grid, 0), {.engine = vulkan_engine(device), .engine_required = required})
            .value();
    }
};

TEST_F(SessionOnDevice, GivesTheBytesOfTheCpuThroughChanges) {
    Contour cpu = Contour::create(session_input(grid, 0), on_cpu).value();
    Contour device = Contour::create(session_input(grid, 0), {.engine = vulkan_engine(this->device())}).value();
    EXPECT_EQ(surfaces_of(device, "vulkan"), surfaces_of(cpu, "cpu"));
    for (Contour* contour : {&cpu, &device})
        EXPECT_EQ(contour->set(session_input(grid, 1)).value(), ContourUpdate::field);
    EXPECT_EQ(surfaces_of(device, "vulkan"), surfaces_of(cpu, "cpu"));
    Grid moved = grid;
    std::vector<float> coordinates;
    for (const float x : grid.points.as<float>()) coordinates.push_back(2 * x);
    moved.points = Array::own(std::move(coordinates), 3);
    for (Contour* contour : {&cpu, &device})
        EXPECT_EQ(contour->set(session_input(moved, 1)).value(), ContourUpdate::points);
    EXPECT_EQ(surfaces_of(device, "vulkan"), surfaces_of(cpu, "cpu"));
}

TEST_F(SessionOnDevice, BringsSurfacesIntoTheCallersMemory) {
    struct Segment final : SurfaceSink {
        std::shared_ptr<void> take(const Wanted& wanted) override {
            auto bytes = std::make_shared<std::vector<std::max_align_t>>(wanted.bytes() / sizeof(std::max_align_t) + 1);
            taken.push_back({wanted.surface, bytes->data()});
            return {bytes, bytes->data()};
        }
        std::vector<std::pair<std::size_t, const void*>> taken;
    };
    const auto segment = std::make_shared<Segment>();
    ContourOptions options{.engine = vulkan_engine(device()), .engine_required = true, .edge_ends = true};
    Contour plain = Contour::create(session_input(grid, 0), options).value();
    options.sink = segment;
    Contour device = Contour::create(session_input(grid, 0), options).value();
    EXPECT_EQ(surfaces_of(device, "vulkan"), surfaces_of(plain, "vulkan"));
    segment->taken.clear();
    const ContourResult result = device.extract(std::array{0.1, 0.2}).value();
    EXPECT_EQ(segment->taken.size(), 8u);
    for (std::size_t i = 0; i < 2; ++i)
        for (const Array* array : {&result.surfaces[i].surface.positions, &result.surfaces[i].surface.triangles,
                                   &result.surfaces[i].surface.edge_ends, &result.surfaces[i].surface.edge_weights})
            EXPECT_EQ(std::ranges::count(segment->taken, std::pair<std::size_t, const void*>(i, array->data())), 1);
}

TEST_F(SessionOnDevice, LeavesSurfacesOnTheDevice) {
    Contour contour = Contour::create(session_input(grid, 0), {.engine = vulkan_engine(device())}).value();
    const SurfacesOnDevice found = extract_on_device(contour, std::array{0.1, 0.2}).value();
    ASSERT_EQ(found.surfaces.size(), 2u);
    EXPECT_GT(found.work.submissions, 0u);
    const ContourResult expected = contour.extract(0.2).value();
    EXPECT_EQ(found.surfaces[1].triangle_count(), expected.surfaces[0].surface.triangle_count());
    Contour cpu = Contour::create(session_input(grid, 0), on_cpu).value();
    EXPECT_EQ(extract_on_device(cpu, std::array{0.1}).error().message,
              "the session extracts by the cpu engine, which keeps no grid");
}

TEST_F(SessionOnDevice, GoesOnOnTheCpuWhenTheDeviceIsLost) {
    Contour cpu = Contour::create(session_input(grid, 0), on_cpu).value();
    CallPlan plan;
    Contour contour = session(plan, false);
    const std::vector<std::string> right = surfaces_of(cpu, "cpu");
    EXPECT_EQ(surfaces_of(contour, "vulkan"), right);
    plan = {.fail_at = 1, .with = VK_ERROR_DEVICE_LOST, .only = "vkQueueSubmit", .calls = {}};
    const ContourResult after = contour.extract(0.1).value();
    EXPECT_EQ(after.engine, "cpu");
    EXPECT_EQ(bytes_of(after.surfaces[0].surface), right[0]);
    ASSERT_EQ(after.notes.size(), 1u);
    EXPECT_NE(after.notes[0].find("lost"), std::string::npos) << after.notes[0];
    EXPECT_TRUE(after.notes[0].ends_with(": the CPU extracts instead")) << after.notes[0];
    EXPECT_EQ(contour.engine(), "cpu");
}

TEST_F(SessionOnDevice, EndsWithAnErrorWhereTheDeviceIsRequired) {
    CallPlan plan;
    Contour contour = session(plan, true);
    surfaces_of(contour, "vulkan");
    plan = {.fail_at = 1, .with = VK_ERROR_DEVICE_LOST, .only = "vkQueueSubmit", .calls = {}};
    EXPECT_EQ(contour.extract(0.1).error().code, ErrorCode::device_failed);
    EXPECT_EQ(Contour::create(session_input(grid, 0), {.method = Method::direct, .engine = vulkan_engine(device())})
                  .error()
                  .message,
              "the vulkan engine extracts from clusters, but direct extraction was asked for");
}

} // namespace
} // namespace isotet::test
