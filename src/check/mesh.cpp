// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "check/mesh.hpp"

#include <atomic>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"

namespace isotet::checking {

namespace {

constexpr std::size_t nothing = std::numeric_limits<std::size_t>::max();

/// The lowest index for which `is_bad` holds, whatever the threads do; `nothing` if there is none.
template <class Test>
std::size_t lowest_bad(std::size_t count, const Test& is_bad) {
    std::atomic<std::size_t> lowest{nothing};
    core::parallel_ranges(count, 1 << 16, [&](std::size_t begin, std::size_t end) {
        if (begin > lowest.load(std::memory_order_relaxed)) return;
        for (std::size_t i = begin; i < end; ++i) {
            if (!is_bad(i)) continue;
            std::size_t seen = lowest.load(std::memory_order_relaxed);
            while (i < seen && !lowest.compare_exchange_weak(seen, i, std::memory_order_relaxed)) {}
            return;
        }
    });
    return lowest.load();
}

} // namespace

Result<Mesh> Mesh::open(const Surface& surface) {
    const Array& positions = surface.positions;
    const Array& triangles = surface.triangles;
    if (!positions.empty() && (!is_floating(positions.type()) || positions.components() != 3))
        return invalid_data(fmt::format("positions are {} with {} components, but must be float32 or float64 with 3",
                                        name_of(positions.type()), positions.components()));
    const bool integral = !is_floating(triangles.type()) && size_of(triangles.type()) >= 4;
    if (!triangles.empty() && (!integral || triangles.components() != 3))
        return invalid_data(
            fmt::format("triangles are {} with {} components, but must be 32- or 64-bit integers with 3",
                        name_of(triangles.type()), triangles.components()));
    Mesh mesh;
    mesh.positions_ = core::PointReader(positions);
    mesh.indices_ = core::IndexColumn(triangles);
    mesh.vertices_ = positions.empty() ? 0 : positions.tuples();
    mesh.triangles_ = triangles.empty() ? 0 : triangles.tuples();

    const auto is_far = [&](std::size_t i) { return mesh.indices_[i] >= mesh.vertices_; };
    if (const std::size_t i = lowest_bad(3 * mesh.triangles_, is_far); i != nothing)
        return invalid_data(fmt::format("triangles[{}] has vertex {}, but the surface has {} vertices", i / 3,
                                        static_cast<std::int64_t>(mesh.indices_[i]), mesh.vertices_));
    const auto is_not_finite = [&](std::size_t vertex) {
        const core::Point p = mesh.positions_[vertex];
        return !std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]);
    };
    if (const std::size_t vertex = lowest_bad(mesh.vertices_, is_not_finite); vertex != nothing) {
        const core::Point p = mesh.positions_[vertex];
        return invalid_data(
            fmt::format("vertex {} is at ({}, {}, {}), but positions must be finite", vertex, p[0], p[1], p[2]));
    }
    return mesh;
}

} // namespace isotet::checking
