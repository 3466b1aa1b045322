// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Repeated extraction on a Vulkan device, step by step, beside the CPU engine on the same machine: one table, made
// grids of growing size until the time is up. scripts/bench_gpu.sh runs it.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <isotet/fields.hpp>
#include <isotet/device.hpp>
#include <isotet/extract.hpp>
#include <isotet/make.hpp>

#include "vulkan/context.hpp"
#include "vulkan/recorder.hpp"

namespace {

using namespace isotet;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

/// Bytes a second, read and written ones counted.
double copy_bandwidth(vulkan::Context& context) {
    const std::uint64_t bytes = std::min<std::uint64_t>(context.memory().free() / 8, std::uint64_t{256} << 20) / 4 * 4;
    const vulkan::Buffer from = context.memory().take(bytes, vulkan::Where::device, "copied from").value();
    const vulkan::Buffer to = context.memory().take(bytes, vulkan::Where::device, "copied to").value();
    vulkan::Recorder recorder(context);
    recorder.copy(from, 0, to, 0, bytes);
    double best = 1e30;
    for (int round = 0; round < 5; ++round) {
        const vulkan::Timings timings = recorder.run().value();
        best = std::min(best, timings.passes.empty() ? timings.waited_seconds : timings.device_seconds);
    }
    return 2 * static_cast<double>(bytes) / best;
}

/// What one grid gives, medians in seconds.
struct Row {
    PackReport pack;
    std::uint64_t triangles = 0, selected = 0, down = 0;
    double pack_seconds = 0, upload = 0, device = 0, waited = 0, cpu = 0, must_move = 0;
    std::map<std::string, double> passes;
};

Row measure(const Device& device, std::uint64_t side, int rounds) {
    Row row;
    const std::vector<double> isovalues{0.55, 0.6, 0.65, 0.7}; // of a sphere: a smooth surface
    PackedGrid packed;
    {
        const Grid grid = make_grid({.shape = "kuhn", .side = side, .fields = {"sphere"}}).value();
        const auto begin = Clock::now();
        packed = pack(grid, find_field(grid, "sphere").value()).value();
        row.pack_seconds = seconds_since(begin);
    }
    row.pack = packed.report();
    const auto begin = Clock::now();
    DeviceGrid on_device = DeviceGrid::upload(device, packed).value();
    row.upload = seconds_since(begin);
    DeviceSurface surface;
    // Arrays grow, kernels are made, and the clock rises, which falls while the processor packs.
    for (const auto start = Clock::now(); seconds_since(start) < 1;)
        for (const double isovalue : isovalues) on_device.extract(isovalue, surface).value();
    std::vector<double> device_seconds, waited, cpu;
    std::map<std::string, std::vector<double>> passes;
    for (int round = 0; round < rounds; ++round)
        for (const double isovalue : isovalues) {
            on_device.extract(isovalue, surface).value();
            const DeviceWork& work = on_device.work();
            device_seconds.push_back(work.device_seconds);
            waited.push_back(work.waited_seconds);
            for (const DevicePass& pass : work.passes) passes[pass.name].push_back(pass.seconds);
            row.down = work.downloaded_bytes;
        }
    for (int round = 0; round < 3; ++round)
        for (const double isovalue : isovalues) {
            const auto start = Clock::now();
            const Extraction extraction = extract(packed, isovalue).value();
            cpu.push_back(seconds_since(start));
            row.selected = extraction.report.selected_clusters;
        }
    row.triangles = surface.triangle_count();
    row.device = median(device_seconds);
    row.waited = median(waited);
    row.cpu = median(cpu);
    for (const auto& [name, times] : passes) row.passes[name] = median(times);
    // Ranges and counts of all clusters, the selected ones once, the surface once.
    const auto clusters = static_cast<double>(row.pack.clusters);
    row.must_move = 16 * clusters + static_cast<double>(row.selected) * static_cast<double>(row.pack.bytes) / clusters +
                    12.0 * static_cast<double>(surface.vertex_count() + surface.triangle_count());
    return row;
}

void print(const Row& row, double bandwidth) {
    const auto milliseconds = [&](const char* pass) {
        const auto found = row.passes.find(pass);
        return found == row.passes.end() ? 0.0 : 1e3 * found->second;
    };
    std::printf("%11llu %10llu %8.2f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.1f %7.1f%% %6llu\n",
                static_cast<unsigned long long>(row.pack.tets), static_cast<unsigned long long>(row.triangles),
                row.pack_seconds, row.upload, milliseconds("select"), milliseconds("count"), milliseconds("scan"),
                milliseconds("emit"), 1e3 * row.device, 1e3 * row.waited, 1e3 * row.cpu,
                100 * row.must_move / bandwidth / std::max(row.device, 1e-9),
                static_cast<unsigned long long>(row.down));
    std::fflush(stdout);
}

} // namespace

/// gpu_bench DEVICE SECONDS MOST_TETS
int main(int count, char** words) {
    const auto begin = Clock::now();
    const std::string choice = count > 1 ? words[1] : "";
    const double budget = count > 2 ? std::atof(words[2]) : 400;
    const double max_tets = count > 3 ? std::atof(words[3]) : 1e9;
    const Result<Device> device = Device::open({choice, 0});
    if (!device) {
        std::fprintf(stderr, "gpu_bench: %s\n", device.error().message.c_str());
        return 4;
    }
    const double bandwidth = copy_bandwidth(*device->context());
    std::printf("device %s, %s; copies %.1f GB/s%s\n", device->info().name.c_str(), device->info().driver.c_str(),
                bandwidth / 1e9,
                device->info().kind == DeviceKind::software ? "; a software device says nothing of a GPU" : "");
    for (const std::string& notice : device->notices()) std::printf("notice: %s\n", notice.c_str());
    std::printf("%11s %10s %8s %8s %8s %8s %8s %8s %8s %8s %8s %8s %6s\n", "tets", "triangles", "pack s", "upload s",
                "select", "count", "scan", "emit", "all ms", "wait ms", "cpu ms", "of copy", "bus B");
    double last = 0;
    for (const std::uint64_t side : {20, 55, 94, 170, 255, 368, 550}) {
        const double tets = 6.0 * static_cast<double>(side) * static_cast<double>(side) * static_cast<double>(side);
        // The next grid is five times as large: it takes five times as long.
        if (tets > max_tets || seconds_since(begin) + 5 * last > budget) break;
        const auto start = Clock::now();
        try {
            print(measure(*device, side, 10), bandwidth);
        } catch (const Exception& e) {
            std::printf("%11.0f %s\n", tets, e.what());
            break;
        }
        last = seconds_since(start);
    }
    return 0;
}
