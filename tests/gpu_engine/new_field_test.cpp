// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Another field, or other points, on a grid that is on the device: ranges are worked out there, byte for byte as on the
// processor, and surfaces are those of a grid that was packed with them.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <span>

#include "gpu_engine/engines.hpp"
#include "packed/packed.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"
#include "vulkan/failing_calls.hpp"

namespace isotet::test {
namespace {

template <class T>
bool same(const core::SharedBuffer<T>& a, const core::SharedBuffer<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.bytes()) == 0;
}

class NewField : public Engines {
protected:
    /// All that a field is in a packed grid.
    static void expect_same_field(const PackedGrid& found, const PackedGrid& expected) {
        const core::Packed &a = found.data(), &b = expected.data();
        EXPECT_TRUE(same(a.as<float>().values, b.as<float>().values));
        EXPECT_TRUE(same(a.as<float>().ranges, b.as<float>().ranges));
        EXPECT_TRUE(same(a.has_no_data, b.has_no_data));
        EXPECT_TRUE(same(a.group_ranges, b.group_ranges));
        EXPECT_TRUE(same(a.gradients, b.gradients));
        EXPECT_EQ(a.storage.offset, b.storage.offset);
        EXPECT_EQ(a.storage.scale, b.storage.scale);
        EXPECT_EQ(a.field.data(), b.field.data());
        EXPECT_EQ(found.field().name, expected.field().name);
        EXPECT_EQ(found.field().no_data, expected.field().no_data);
    }

    static ExtractOptions everything() {
        ExtractOptions options;
        options.normals = Normals::gradient;
        options.edge_ends = options.source_cells = true;
        return options;
    }

    static PackedGrid packed_of(const NastyGrid& g) {
        return pack(g.grid, g.field, {.source_cells = true, .gradients = true}).value();
    }

    /// Fields one after another on one grid, the values of each other seed as full of ties, NaN, -0, and tiny and
    /// infinite ones as they come; the last of all points without data.
    static std::vector<PointField> fields_for(const NastyGrid& g) {
        std::vector<PointField> fields;
        for (const std::uint32_t seed : {11, 12, 13}) {
            const NastyOptions nasty{.side = 13, .values = seed == 12 ? 0 : 3, .no_data = seed == 13 ? 0.3 : 0};
            fields.push_back(nasty_grid(seed, nasty).field);
        }
        fields.push_back(field_of(std::vector<double>(g.grid.points.tuples(), 101325.25), "constant"));
        fields.push_back(field_of(std::vector<float>(g.grid.points.tuples(), NAN), "nothing"));
        fields.push_back(g.field);
        return fields;
    }

    /// Returns how many fields were set while pages were not there.
    int expect_fields_to_follow(DeviceGrid& on_device, const NastyGrid& g) {
        PackedGrid expected = packed_of(g);
        int in_parts = 0;
        for (const PointField& field : fields_for(g)) {
            expected = expected.with_field(field).value();
            in_parts += !on_device.complete();
            on_device.set_field(field).value();
            expect_same_field(on_device.packed(), expected);
            expect_same(on_device, expected, {101325.25, 0, 0.5}, everything());
        }
        return in_parts;
    }
};

TEST_F(NewField, IsThatOfTheProcessorByteForByte) {
    const NastyGrid g = nasty_grid(5, {.side = 13, .values = 4, .no_data = 0.02, .missing = 0.05, .repeated = 0.05});
    for (const std::uint64_t page_bytes : {20'000, 1 << 25}) {
        DeviceGrid on_device =
            DeviceGrid::upload(device(), packed_of(g), {.page_bytes = page_bytes, .surface_bytes = {}}).value();
        EXPECT_EQ(expect_fields_to_follow(on_device, g), 0);
    }
}

TEST_F(NewField, OfAGridWhosePagesComeAndGoIsTheSame) {
    const NastyGrid g = nasty_grid(6, {.side = 13, .values = 0});
    PackedGrid packed = packed_of(g);
    const DeviceGridOptions small_pages{.page_bytes = 8 << 10, .surface_bytes = 0};
    const DeviceGridNeeds needs = DeviceGrid::needs(packed, small_pages);
    // Room for the largest of the surfaces, and for two pages beside it.
    std::uint64_t surface = 0;
    {
        DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
        for (const PointField& field : fields_for(g)) {
            on_device.set_field(field).value();
            surface = std::max(surface, on_device.extract(0.5, everything()).value().device_bytes());
        }
    }
    reopen(watched(), needs.resident_bytes + 2 * needs.largest_page_bytes + surface);
    DeviceGrid on_device = DeviceGrid::upload(device(), packed, small_pages).value();
    EXPECT_GE(expect_fields_to_follow(on_device, g), 2);
}

TEST_F(NewField, SendsValuesOnly) {
    const Grid grid = made_grid("kuhn", 24, {"gyroid", "plane"});
    PackedGrid packed = pack(grid, point_field(grid)).value();
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    on_device.set_field(point_field(grid, 1)).value();
    const std::uint64_t values = 4 * grid.points.tuples();
    EXPECT_GE(on_device.work().uploaded_bytes, values);
    EXPECT_LT(on_device.work().uploaded_bytes, values + 1000);
    EXPECT_LT(on_device.work().downloaded_bytes, packed.report().tets / 5);
    EXPECT_EQ(on_device.work().submissions, 1u);
}

TEST_F(NewField, PointsFollowToo) {
    const NastyGrid g = nasty_grid(8, {.side = 12, .values = 3, .no_data = 0.02, .wide = true});
    DeviceGrid on_device = DeviceGrid::upload(device(), packed_of(g), {.page_bytes = 20'000, .surface_bytes = {}}).value();
    std::vector<double> moved;
    for (std::size_t p = 0; p < g.grid.points.tuples(); ++p)
        for (std::size_t axis = 0; axis < 3; ++axis)
            moved.push_back(2.5 * g.grid.points.at(p, axis) + static_cast<double>(axis));
    const Array points = Array::own(std::move(moved), 3);
    const PackedGrid expected = packed_of(g).with_points(points).value();
    on_device.set_points(points).value();
    EXPECT_EQ(on_device.packed().data().origin, expected.data().origin);
    expect_same_field(on_device.packed(), expected);
    expect_same(on_device, expected, {0, 0.5}, everything());

    std::vector<double> turned(3 * g.grid.points.tuples());
    std::mt19937 random(1);
    for (double& x : turned) x = std::uniform_real_distribution<double>(-1, 1)(random);
    const auto refused = on_device.set_points(Array::own(std::move(turned), 3));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_data);
    expect_same(on_device, expected, {0}, everything());
}

// What is done with other handles on a packed grid does not reach the device, also when the first one is gone.
TEST_F(NewField, OfAnotherHandleLeavesTheDeviceAlone) {
    const Grid grid = made_grid("kuhn", 6, {"gyroid", "plane"});
    PackedGrid packed = pack(grid, point_field(grid)).value();
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    packed = packed.with_field(point_field(grid, 1)).value();
    EXPECT_EQ(on_device.packed().field().name, "gyroid");
    const PackedGrid again = pack(grid, point_field(grid)).value();
    expect_same(on_device, again, {0.1}, {});
    packed = pack(made_grid("kuhn", 3, {"plane"}), point_field(made_grid("kuhn", 3, {"plane"}))).value();
    expect_same(on_device, again, {0.1}, {});
}

TEST_F(NewField, OfAnotherLengthIsRefused) {
    const Grid grid = made_grid("kuhn", 6, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    const auto refused = on_device.set_field(field_of(std::vector<float>(3)));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message, "field 'value' has 3 values, but the grid has 343 points");
    expect_same(on_device, packed, {0.1}, {});
}

// A surface keeps what it was extracted with.
TEST_F(NewField, LeavesEarlierSurfacesAsTheyWere) {
    const Grid grid = made_grid("kuhn", 8, {"integer", "plane"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    const Extraction expected = isotet::extract(packed, 1).value();
    const DeviceSurface surface = on_device.extract(1).value();
    on_device.set_field(point_field(grid, 1)).value();
    const Extraction found = on_device.download(surface).value();
    EXPECT_TRUE(bytes_of(found.surface) == bytes_of(expected.surface));
    EXPECT_EQ(found.report.tied_points, expected.report.tied_points);
    EXPECT_EQ(found.report.isovalue_stored, expected.report.isovalue_stored);
    EXPECT_EQ(found.report.false_ties, expected.report.false_ties);
}

TEST_F(NewField, ThatTheDeviceDoesNotTakeLeavesThePackedGridAsItWas) {
    close();
    const Grid grid = made_grid("kuhn", 8, {"gyroid", "plane"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    for (const std::string function : {"vkQueueSubmit", "vkCreateComputePipelines", "vkWaitForFences"}) {
        CallPlan plan;
        vulkan::Settings settings = watched();
        settings.alter_functions = [&plan](vulkan::DeviceFunctions& functions) { make_calls_follow(plan, functions); };
        const auto opened = vulkan::Context::open({test_device(), 0}, settings).value();
        DeviceGrid on_device = DeviceGrid::upload(Device(opened), packed).value();
        plan = {.fail_at = 1, .with = VK_ERROR_OUT_OF_DEVICE_MEMORY, .only = function, .calls = {}};
        EXPECT_FALSE(on_device.set_field(point_field(grid, 1))) << function;
        expect_same_field(on_device.packed(), packed);
        const auto refused = on_device.extract(0.5);
        ASSERT_FALSE(refused) << function;
        if (function == "vkCreateComputePipelines") { // the others lose the device
            EXPECT_NE(refused.error().message.find("must be uploaded again"), std::string::npos)
                << refused.error().message;
        }
    }
}

} // namespace
} // namespace isotet::test
