// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A device is measured for the choice between it and the processor.
#include "api/speeds.hpp"
#include "gpu_engine/engines.hpp"

namespace isotet::test {
namespace {

using DeviceIsMeasured = Engines;

TEST_F(DeviceIsMeasured, ForUploadingCallsAndTriangles) {
    const DeviceSpeeds speeds = api::measure_speeds(device(), 12, 1, {}).value();
    for (const double positive : {speeds.upload_tet, speeds.call, speeds.triangle}) EXPECT_GT(positive, 0);
    EXPECT_GE(speeds.tet, 0);
    Task task;
    task.tets = 10'000;
    task.memory_free = 1'000'000'000;
    task.device_memory_free = 1'000'000'000;
    EXPECT_EQ(weigh(task, typical_speeds(), &speeds).size(), 3u);
}

} // namespace
} // namespace isotet::test
