// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Compiles every pipeline for the one device that a driver has, without a card, and prints all that its compiler tells: what
// bench/kernels/vendors.sh makes its tables of. Ends with 1 where the device would not be used or a pipeline is refused.
//
// usage: isotet_device_kernels DRIVER
#include <cstdio>
#include <string>

#include "bench/kernels/null_device.hpp"

namespace {

using namespace isotet;

/// A line for each stage, its parts apart by tabs. What the driver itself writes stands between the lines.
bool print(bench::NullDevice& device, const bench::Pipeline& pipeline) {
    std::printf("pipeline\t%s\t%s\n", pipeline.name.c_str(), pipeline.variant.c_str());
    std::fflush(stdout);
    const auto figures = device.compile(pipeline);
    if (!figures) return std::printf("refused\t%s\n", figures.error().message.c_str()), false;
    for (const bench::Figures& one : *figures) {
        std::printf("stage\t%s\t%u", one.code->name, one.subgroup);
        for (const auto& [name, value] : one.all) std::printf("\t%s=%.15g", name.c_str(), value);
        std::printf("\n");
    }
    return true;
}

} // namespace

int main(int count, char** arguments) {
    if (count != 2) return std::fprintf(stderr, "usage: isotet_device_kernels DRIVER\n"), 2;
    const auto device = bench::NullDevice::open(arguments[1]);
    if (!device) return std::fprintf(stderr, "%s\n", device.error().message.c_str()), 1;
    const DeviceInfo info = vulkan::describe((*device)->capabilities(), 0);
    std::printf("device\t%s\t%s\t%s\n", info.name.c_str(), info.driver.c_str(), info.api.c_str());
    if (!info.unusable.empty()) return std::printf("unusable\t%s\n", info.unusable.c_str()), 1;
    std::size_t taken = 0, refused = 0;
    for (const bench::Pipeline& pipeline : bench::all_pipelines()) {
        if (!(*device)->takes(pipeline)) continue;
        ++(print(**device, pipeline) ? taken : refused);
    }
    std::printf("pipelines\t%zu\trefused\t%zu\n", taken, refused);
    return taken == 0 || refused != 0;
}
