// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/mesh_arrays.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <isotet/scene.hpp>

#include "base/errors.hpp"
#include "base/parallel.hpp"

namespace isotet::render {

namespace {

constexpr std::size_t mesh_grain = std::size_t{1} << 16;
constexpr std::uint64_t most_in_mesh =
    std::numeric_limits<std::uint32_t>::max() / 3; // three corners each have a 32-bit number

/// The smallest number of which `is_wrong` holds; `count` when there is none.
template <class Test>
std::size_t first_of(std::size_t count, const Test& is_wrong) {
    std::atomic<std::size_t> first = count;
    core::parallel_ranges(count, mesh_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!is_wrong(i)) continue;
            for (std::size_t seen = first; i < seen && !first.compare_exchange_weak(seen, i);) {}
            return;
        }
    });
    return first;
}

Result<void> check_shapes(const Surface& surface) {
    if (surface.positions.components() != 3 || surface.triangles.components() != 3) {
        return invalid_argument(
            fmt::format("a surface whose positions have {} components and whose triangles {}, but both need 3",
                        surface.positions.components(), surface.triangles.components()));
    }
    if (!is_floating(surface.positions.type()) || is_floating(surface.triangles.type()))
        return invalid_argument("a surface needs positions of float32 or float64, and triangles of whole numbers");
    if (surface.vertex_count() > most_in_mesh || surface.triangle_count() > most_in_mesh) {
        return invalid_argument(
            fmt::format("a surface of {} vertices and {} triangles, but of each {} can be drawn at most",
                        surface.vertex_count(), surface.triangle_count(), most_in_mesh));
    }
    return {};
}

} // namespace

Result<MeshArrays> MeshArrays::of(const Surface& surface) {
    if (Result<void> fits = check_shapes(surface); !fits) return fits.error();
    MeshArrays mesh;
    mesh.vertices = static_cast<std::uint32_t>(surface.vertex_count());
    mesh.triangle_count = static_cast<std::uint32_t>(surface.triangle_count());
    if (Result<void> done = mesh.take_positions(surface); !done) return done.error();
    if (Result<void> done = mesh.take_triangles(surface); !done) return done.error();
    if (!are_of_vertices(surface.normals_kind) || surface.normals.tuples() != surface.vertex_count()) return mesh;
    mesh.normals = core::Buffer<float>(surface.normals.size());
    surface.normals.visit([&](auto scalars) {
        core::parallel_each(scalars.size(), mesh_grain,
                            [&](std::size_t i) { mesh.normals[i] = static_cast<float>(scalars[i]); });
    });
    return mesh;
}

Result<void> MeshArrays::take_positions(const Surface& surface) {
    return surface.positions.visit([&](auto scalars) -> Result<void> {
        const std::size_t broken =
            first_of(scalars.size(), [&](std::size_t i) { return !std::isfinite(static_cast<double>(scalars[i])); });
        if (broken < scalars.size()) {
            return Error{ErrorCode::invalid_data,
                         fmt::format("vertex {} has the coordinate {}, but what is drawn must be finite", broken / 3,
                                     static_cast<double>(scalars[broken]))};
        }
        // Far from 0, float64 positions keep their digits relative to their middle.
        if (surface.positions.type() == ScalarType::float64) {
            const Box box = bounds_of(surface);
            for (std::size_t axis = 0; axis < 3 && !box.empty(); ++axis)
                origin[axis] = box.lower[axis] / 2 + box.upper[axis] / 2;
        }
        positions = core::Buffer<float>(scalars.size());
        core::parallel_each(scalars.size(), mesh_grain, [&](std::size_t i) {
            positions[i] = static_cast<float>(static_cast<double>(scalars[i]) - origin[i % 3]);
        });
        return {};
    });
}

Result<void> MeshArrays::take_triangles(const Surface& surface) {
    return surface.triangles.visit([&](auto corners) -> Result<void> {
        const std::size_t broken =
            first_of(corners.size(), [&](std::size_t i) { return static_cast<std::uint64_t>(corners[i]) >= vertices; });
        if (broken < corners.size()) {
            return Error{ErrorCode::invalid_data,
                         fmt::format("triangles[{}] has vertex {}, but the surface has {} vertices", broken / 3,
                                     corners[broken], vertices)};
        }
        triangles = core::Buffer<std::uint32_t>(corners.size());
        core::parallel_each(corners.size(), mesh_grain,
                            [&](std::size_t i) { triangles[i] = static_cast<std::uint32_t>(corners[i]); });
        return {};
    });
}

} // namespace isotet::render
