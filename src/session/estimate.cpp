// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <isotet/contour.hpp>

namespace isotet {

namespace {

// Seconds on two threads (docs/performance); those per call come once a grid or a surface, besides tets and triangles.
constexpr double pack_call = 1e-3, pack_per_tet = 120e-9, pack_gradient_per_tet = 30e-9;
constexpr double direct_call = 4e-5, direct_per_tet = 2e-9, direct_per_triangle = 50e-9,
                 direct_gradient_per_tet = 40e-9;
constexpr double clusters_call = 5e-6, clusters_per_tet = 0.2e-9, clusters_per_triangle = 25e-9;

// Bytes, from the promises of pack(), extract() and extract_direct().
constexpr double packing_per_tet = 30, packing_per_point = 50, packed_per_tet = 12;
constexpr double surface_per_triangle = 20; // 12, and half a vertex
constexpr double clusters_bytes_per_triangle = surface_per_triangle + 48;
constexpr double direct_bytes_per_triangle = surface_per_triangle + 110, direct_per_point = 1;

/// Bytes beyond all memory are as good as any number of them.
std::uint64_t whole(double bytes) { return static_cast<std::uint64_t>(std::clamp(bytes, 0.0, 1e18)); }

} // namespace

std::string_view name_of(Method method) noexcept { return method == Method::direct ? "direct" : "clusters"; }

Estimate estimate(Method method, const Workload& work) noexcept {
    const auto tets = static_cast<double>(work.tets), points = static_cast<double>(work.points);
    Estimate out;
    if (method == Method::direct) {
        out.seconds = (work.surfaces + (work.find_range ? 1 : 0)) * (direct_call + tets * direct_per_tet) +
                      work.surfaces * work.triangles * direct_per_triangle;
        if (work.gradients) out.seconds += work.surfaces * tets * direct_gradient_per_tet;
        out.bytes = whole(points * direct_per_point + work.triangles_together * direct_bytes_per_triangle);
    } else {
        out.seconds =
            pack_call + tets * (pack_per_tet + (work.gradients ? pack_gradient_per_tet : 0)) +
            work.surfaces * (clusters_call + tets * clusters_per_tet + work.triangles * clusters_per_triangle);
        out.bytes = whole(std::max(tets * packing_per_tet + points * packing_per_point,
                                   tets * packed_per_tet + work.triangles_together * clusters_bytes_per_triangle));
    }
    return out;
}

} // namespace isotet
