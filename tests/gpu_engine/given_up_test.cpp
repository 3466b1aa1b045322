// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The packed grid goes, the grid on the device stays: the same surfaces, and errors where its numbers are missed.
#include "gpu_engine/engines.hpp"
#include "support/random_grid.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

class GivenUp : public Engines {
protected:
    const NastyGrid g = nasty_grid(9, {.side = 11, .values = 3, .no_data = 0.02});
    PackedGrid packed = pack(g.grid, g.field, {.source_cells = true, .gradients = true}).value();

    static void expect_refused(const Result<DeviceSurface>& result, const char* part) {
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
    }
};

TEST_F(GivenUp, PackedGridsAreNotMissed) {
    ExtractOptions options;
    options.normals = Normals::gradient;
    options.point_fields = {{"place", g.grid.points}};
    const Extraction expected = isotet::extract(packed, 0.5, options).value();
    DeviceGrid on_device = DeviceGrid::upload(device(), packed, {.page_bytes = 20'000, .surface_bytes = {}}).value();
    on_device.extract(0, options).value(); // takes the field along
    on_device.give_up_packed().value();
    packed = PackedGrid();
    const Extraction found = on_device.download(on_device.extract(0.5, options).value()).value();
    EXPECT_TRUE(bytes_of(found.surface) == bytes_of(expected.surface));
    EXPECT_EQ(found.report.tied_points, expected.report.tied_points);
    EXPECT_EQ(found.report.isovalue_stored, expected.report.isovalue_stored);
    EXPECT_FALSE(found.report.false_ties.has_value());
    on_device.give_up_packed().value();
}

TEST_F(GivenUp, PackedGridsAreMissedForTheirNumbers) {
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    ExtractOptions ends, cells, fields, wrong;
    ends.edge_ends = cells.source_cells = true;
    fields.point_fields = {{"place", g.grid.points}};
    wrong.point_fields = {{"short", Array::own(std::vector<float>(3))}};
    const DeviceSurface earlier = on_device.extract(0, ends).value();
    PackedGrid other = pack(g.grid, g.field).value();
    on_device.give_up_packed().value();
    expect_refused(on_device.extract(0, ends), "it was given up");
    expect_refused(on_device.extract(0, cells), "it was given up");
    expect_refused(on_device.extract(0, fields), "point field 'place' is not on the device");
    expect_refused(on_device.extract(0, wrong), "point field 'short' has 3 tuples");
    EXPECT_EQ(on_device.download(earlier).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(on_device.set_field(packed, g.field).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(on_device.set_points(packed, g.grid.points).error().code, ErrorCode::invalid_argument);
    packed.set_field(g.field).value();
    EXPECT_TRUE(on_device.extract(0)) << "the packed grid is its own master now";

    DeviceGrid without_gradients = DeviceGrid::upload(device(), other).value();
    without_gradients.give_up_packed().value();
    ExtractOptions normals;
    normals.normals = Normals::gradient;
    expect_refused(without_gradients.extract(0, normals), "packed with gradients");
}

TEST_F(GivenUp, PackedGridsOfWhichPartsAreYetToComeCannotBe) {
    const DeviceGridOptions small_pages{.page_bytes = 8 << 10, .surface_bytes = 0};
    const DeviceGridNeeds needs = DeviceGrid::needs(packed, small_pages);
    reopen(watched(), needs.all() - needs.largest_page_bytes);
    const auto refused = DeviceGrid::upload(device(), packed, small_pages).value().give_up_packed();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_argument);

    // What there is stays: a surface that does not fit beside it is refused, and no page goes for it.
    reopen(watched(), needs.all() + 4096);
    DeviceGrid whole = DeviceGrid::upload(device(), packed, small_pages).value();
    whole.give_up_packed().value();
    EXPECT_EQ(whole.extract(0.5).error().code, ErrorCode::out_of_memory);
    EXPECT_TRUE(whole.complete());
}

} // namespace
} // namespace isotet::test
