// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Point fields that surfaces carry: interpolated on the device where there is room for them, the same bytes as the CPU
// engine's either way.
#include <cmath>
#include <span>

#include "gpu_engine/engines.hpp"
#include "support/random_grid.hpp"
#include "support/small_grid.hpp"
#include "vulkan/engine/surface_buffers.hpp"

namespace isotet::test {
namespace {

class CarriedFields : public Engines {
protected:
    void SetUp() override {
        Engines::SetUp();
        options.point_fields = fields_of(g);
    }

    /// Of every kind: with an offset, with a scale, vectors, whole numbers, no data, ties, infinities.
    static std::vector<Field> fields_of(const NastyGrid& g) {
        const std::size_t points = g.grid.points.tuples();
        std::vector<double> pressure, small;
        std::vector<std::int32_t> numbers;
        for (std::size_t p = 0; p < points; ++p) {
            const double x = g.grid.points.at(p, 0);
            pressure.push_back(101325 + std::sin(7 * x));
            small.insert(small.end(), {1e-40 * x, p % 5 ? x * 1e30 : NAN});
            numbers.push_back(static_cast<std::int32_t>(p * 77'777));
        }
        return {{"own", g.field.values},
                {"place", g.grid.points},
                {"pressure", Array::own(std::move(pressure))},
                {"extremes", Array::own(std::move(small), 2)},
                {"number", Array::own(std::move(numbers))}};
    }

    static std::uint64_t stored_bytes(const std::vector<Field>& fields) {
        std::uint64_t bytes = 0;
        for (const Field& field : fields) bytes += 4 * field.values.tuples() * field.values.components();
        return bytes;
    }

    const NastyGrid g = nasty_grid(3, {.side = 11, .values = 3, .no_data = 0.02, .missing = 0.05});
    PackedGrid packed = pack(g.grid, g.field).value();
    ExtractOptions options;
};

TEST_F(CarriedFields, AreInterpolatedOnTheDevice) {
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    expect_same(on_device, packed, {0, 0.5}, options);
    DeviceSurface surface = on_device.extract(0.5, options).value();
    ASSERT_EQ(surface.buffers()->fields.size(), options.point_fields.size());
    for (std::size_t i = 0; i < options.point_fields.size(); ++i)
        EXPECT_GE(surface.buffers()->fields[i].size(),
                  4 * surface.vertex_count() * options.point_fields[i].values.components());

    const std::uint64_t components = stored_bytes(options.point_fields) / (4 * g.grid.points.tuples());
    on_device.download(surface).value();
    EXPECT_EQ(on_device.work().downloaded_bytes,
              surface.vertex_count() * (12 + 4 * components) + 12 * surface.triangle_count())
        << "neither ends nor weights";
    options.edge_ends = true;
    expect_same(on_device, packed, {0.5}, options);
}

TEST_F(CarriedFields, GoUpOnce) {
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    DeviceSurface surface;
    on_device.extract(0.5, surface, options).value();
    EXPECT_GT(on_device.work().uploaded_bytes, stored_bytes(options.point_fields) / 2);
    on_device.extract(0, surface, options).value();
    EXPECT_LT(on_device.work().uploaded_bytes, 1000u);
    // They leave with their arrays.
    const std::uint64_t used = context().memory().used();
    options.point_fields.erase(options.point_fields.begin() + 2, options.point_fields.end());
    surface = {};
    on_device.extract(0, surface, options).value();
    EXPECT_LT(context().memory().used() + g.grid.points.tuples() * 8, used);
}

TEST_F(CarriedFields, OfBorrowedArraysAreReadAnew) {
    DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
    std::vector<float> values(g.grid.points.tuples());
    for (const float step : {1.f, 0.25f}) {
        for (std::size_t p = 0; p < values.size(); ++p) values[p] = step * static_cast<float>(p);
        options.point_fields = {{"borrowed", Array::borrow(std::span<const float>(values))}};
        expect_same(on_device, packed, {0.5}, options);
    }
}

TEST_F(CarriedFields, ThatDoNotFitAreInterpolatedElsewhere) {
    reopen(watched());
    ExtractOptions ends;
    ends.edge_ends = true;
    const std::uint64_t plain = DeviceGrid::upload(device(), packed).value().extract(0.5, ends).value().device_bytes();
    const DeviceGridOptions small_pages{.page_bytes = 8 << 10, .surface_bytes = 0};
    const std::uint64_t grid = DeviceGrid::needs(packed, small_pages).all(),
                        fields = stored_bytes(options.point_fields);
    int on_the_device = 0, elsewhere = 0;
    for (const std::uint64_t limit : {grid + plain, grid + plain + fields / 2, grid + 2 * fields + 8 * plain}) {
        reopen(watched(), limit);
        DeviceGrid on_device = DeviceGrid::upload(device(), packed, small_pages).value();
        expect_same(on_device, packed, {0.5}, options);
        EXPECT_LE(context().memory().peak(), limit);
        const DeviceSurface surface = on_device.extract(0.5, options).value();
        (surface.buffers()->fields.empty() ? elsewhere : on_the_device) += 1;
    }
    EXPECT_GE(elsewhere, 1);
    EXPECT_GE(on_the_device, 1);
}

} // namespace
} // namespace isotet::test
