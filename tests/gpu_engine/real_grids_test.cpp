// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The real grids of data/: the same bytes as the CPU engine, of every field that the golden tests contour, one after
// another on the same grid on the device.
#include "golden/golden_files.hpp"

#include <isotet/fields.hpp>
#include "gpu_engine/engines.hpp"
#include "vulkan/engine/surface_buffers.hpp"

namespace isotet::test {
namespace {

constexpr std::uint64_t max_forced_tets = 20'000;

class RealGrids : public Engines {
protected:
    static ExtractOptions options_for(const Grid& grid) {
        ExtractOptions options;
        options.normals = Normals::gradient;
        options.edge_ends = options.source_cells = true;
        options.point_fields = grid.point_fields;
        options.cell_fields = grid.cell_fields;
        return options;
    }

    /// Every field at three eighths of its range.
    void expect_same_fields(const Grid& grid, DeviceGrid& on_device) {
        for (const std::string& name : fields_to_contour(grid)) {
            SCOPED_TRACE(name);
            on_device.set_field(find_field(grid, name).value()).value();
            const PackedGrid& packed = on_device.packed();
            const double isovalue = packed.field().lower + 0.375 * (packed.field().upper - packed.field().lower);
            expect_same(on_device, packed, {isovalue}, options_for(grid));
            EXPECT_EQ(on_device.extract(isovalue).value().buffers()->result.many_edges, 0u)
                << "docs/decisions/0005 says so";
        }
    }

    /// Calls f(grid, packed) for every file with at most so many tets; returns how many there were.
    template <class F>
    int for_grids(std::uint64_t max_tets, F&& f) {
        int grids = 0;
        for (const GoldenFile& file : golden_files) {
            if (file.reader_process && !ISOTET_GOLDEN_VTK) continue;
            SCOPED_TRACE(file.path);
            const Grid grid = read_golden(file.path).value().grid;
            PackedGrid packed =
                pack(grid, find_field(grid, "x").value(), {.source_cells = true, .gradients = true}).value();
            if (packed.report().tets > max_tets) continue;
            f(grid, packed);
            ++grids;
        }
        return grids;
    }
};

TEST_F(RealGrids, GiveTheSameBytes) {
    const int grids = for_grids(~std::uint64_t{0}, [&](const Grid& grid, PackedGrid& packed) {
        DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
        expect_same_fields(grid, on_device);
    });
    EXPECT_GE(grids, 7);
}

TEST_F(RealGrids, GiveTheSameBytesWithEverythingForcedAtOnce) {
    vulkan::Settings settings = watched();
    settings.force_staging = true;
    settings.staging_bytes = 10'000;
    settings.groups_per_axis = 7;
    reopen(settings);
    const int grids = for_grids(max_forced_tets, [&](const Grid& grid, PackedGrid& packed) {
        DeviceGrid on_device =
            DeviceGrid::upload(device(), packed, {.page_bytes = 30'000, .surface_bytes = {}}).value();
        expect_same_fields(grid, on_device);
    });
    EXPECT_GE(grids, 2);
}

} // namespace
} // namespace isotet::test
