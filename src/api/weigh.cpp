// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <isotet/choose.hpp>

namespace isotet {

namespace {

// Bytes, from the promises of pack(), extract(), extract_once() and DeviceGrid.
constexpr double packing_a_tet = 30, packing_a_point = 50, packed_a_tet = 12;
constexpr double surface_a_triangle = 20; ///< 12, and half a vertex
constexpr double clusters_a_triangle = surface_a_triangle + 48;
constexpr double brute_a_triangle = surface_a_triangle + 110, brute_a_point = 1;

/// Bytes beyond all memory are as good as any number of them.
std::uint64_t whole(double bytes) { return static_cast<std::uint64_t>(std::clamp(bytes, 0.0, 1e18)); }

Forecast forecast(Way way, const Task& task, const Speeds& speeds, const DeviceSpeeds* device) {
    const auto tets = static_cast<double>(task.tets);
    const double packing =
        speeds.pack_call + tets * (speeds.pack_tet + (task.gradients ? speeds.pack_gradient_tet : 0));
    const double kept = std::max(tets * packing_a_tet + static_cast<double>(task.points) * packing_a_point,
                                 tets * packed_a_tet + task.triangles_together * clusters_a_triangle);
    Forecast out;
    out.way = way;
    switch (way) {
    case Way::brute:
        out.seconds = (task.surfaces + (task.find_range ? 1 : 0)) * (speeds.brute_call + tets * speeds.brute_tet) +
                      task.surfaces * task.triangles * speeds.brute_triangle;
        if (task.gradients) out.seconds += task.surfaces * tets * speeds.brute_gradient_tet;
        out.bytes =
            whole(static_cast<double>(task.points) * brute_a_point + task.triangles_together * brute_a_triangle);
        break;
    case Way::clusters:
        out.seconds = packing + task.surfaces * (speeds.clusters_call + tets * speeds.clusters_tet +
                                                 task.triangles * speeds.clusters_triangle);
        out.bytes = whole(kept);
        break;
    case Way::device_clusters:
        out.seconds = packing + tets * device->upload_tet +
                      task.surfaces * (device->call + tets * device->tet + task.triangles * device->triangle);
        out.bytes = whole(kept);
        out.device_bytes = whole(tets * packed_a_tet + task.triangles * clusters_a_triangle);
        break;
    }
    out.fits = out.bytes <= task.memory_free && out.device_bytes <= task.device_memory_free.value_or(0);
    return out;
}

} // namespace

std::string_view name_of(Way way) noexcept {
    switch (way) {
    case Way::brute: return "brute on the CPU";
    case Way::clusters: return "clusters on the CPU";
    case Way::device_clusters: return "clusters on the device";
    }
    return "";
}

std::vector<Forecast> weigh(const Task& task, const Speeds& speeds, const DeviceSpeeds* device) {
    std::vector<Forecast> forecasts;
    for (const Way way : all_ways)
        if (way != Way::device_clusters || (device && task.device_memory_free))
            forecasts.push_back(forecast(way, task, speeds, device));
    std::ranges::stable_sort(forecasts, [](const Forecast& a, const Forecast& b) {
        if (a.fits != b.fits) return a.fits;
        return a.fits ? a.seconds < b.seconds : a.bytes < b.bytes;
    });
    return forecasts;
}

} // namespace isotet
