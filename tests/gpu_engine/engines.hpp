// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The Vulkan engine beside the CPU engine.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/device.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/surface_bytes.hpp"
#include "vulkan/software_device.hpp"

namespace isotet::test {

/// A test with packed grids on the software device.
class Engines : public OnDevice {
protected:
    /// In tests with subgroups of a size that the environment forces, they have that size.
    void SetUp() override {
        OnDevice::SetUp();
        const char* size = std::getenv("ISOTET_EXPECTED_SUBGROUP");
        ASSERT_TRUE(!size || std::to_string(context().info().subgroup_size) == size) << context().info().subgroup_size;
    }

    Device device() { return Device(shared_context()); }

    /// Both engines give the same bytes and the same report, for every isovalue.
    void expect_same(DeviceGrid& grid, const PackedGrid& packed, const std::vector<double>& isovalues,
                     ExtractOptions options) {
        for (const double isovalue : isovalues)
            for (const Ties ties : {Ties::merge, Ties::keep}) {
                options.ties = ties;
                const Extraction expected = isotet::extract(packed, isovalue, options).value();
                const DeviceSurface surface = grid.extract(isovalue, options).value();
                const std::string where =
                    "isovalue " + std::to_string(isovalue) + ", ties " + std::to_string(int(ties));
                ASSERT_EQ(surface.vertex_count(), expected.surface.vertex_count()) << where;
                ASSERT_EQ(surface.triangle_count(), expected.surface.triangle_count()) << where;
                const Extraction found = grid.download(surface).value();
                ASSERT_TRUE(bytes_of(found.surface) == bytes_of(expected.surface)) << where;
                ASSERT_EQ(found.report.selected_clusters, expected.report.selected_clusters) << where;
                ASSERT_EQ(found.report.tied_points, expected.report.tied_points) << where;
                ASSERT_EQ(found.report.false_ties, expected.report.false_ties) << where;
            }
    }
};

} // namespace isotet::test
