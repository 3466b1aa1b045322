// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/mesh_buffers.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <isotet/camera.hpp>

#include "core/buffer.hpp"
#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "render/send.hpp"

namespace isotet::render {

namespace {

constexpr std::size_t grain = std::size_t{1} << 16;
constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max() / 3; // three corners each have a 32-bit number

/// The smallest number of which `is_wrong` holds; `count` when there is none.
template <class Test>
std::size_t first_of(std::size_t count, const Test& is_wrong) {
    std::atomic<std::size_t> first = count;
    core::parallel_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
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
    if (surface.vertex_count() > most || surface.triangle_count() > most) {
        return invalid_argument(
            fmt::format("a surface of {} vertices and {} triangles, but of each {} can be drawn at most",
                        surface.vertex_count(), surface.triangle_count(), most));
    }
    return {};
}

} // namespace

Result<std::unique_ptr<MeshBuffers>> MeshBuffers::upload(std::shared_ptr<vulkan::Context> context,
                                                         const Surface& surface) {
    if (Result<void> fits = check_shapes(surface); !fits) return fits.error();
    auto mesh = std::make_unique<MeshBuffers>();
    mesh->context = std::move(context);
    mesh->vertices = static_cast<std::uint32_t>(surface.vertex_count());
    mesh->triangle_count = static_cast<std::uint32_t>(surface.triangle_count());
    if (Result<void> done = mesh->upload_positions(surface); !done) return done.error();
    if (Result<void> done = mesh->upload_triangles(surface); !done) return done.error();
    if (surface.normals_kind != Normals::gradient || surface.normals.tuples() != surface.vertex_count()) return mesh;
    Result<vulkan::Buffer> normals = send<float>(*mesh->context, surface.normals, "normals");
    if (!normals) return normals.error();
    mesh->normals = *std::move(normals);
    return mesh;
}

Result<void> MeshBuffers::upload_positions(const Surface& surface) {
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
        core::Buffer<float> relative(scalars.size());
        core::parallel_each(scalars.size(), grain, [&](std::size_t i) {
            relative[i] = static_cast<float>(static_cast<double>(scalars[i]) - origin[i % 3]);
        });
        Result<vulkan::Buffer> sent = send(*context, relative, "positions");
        if (!sent) return sent.error();
        positions = *std::move(sent);
        return {};
    });
}

Result<void> MeshBuffers::upload_triangles(const Surface& surface) {
    return surface.triangles.visit([&](auto corners) -> Result<void> {
        const std::size_t broken =
            first_of(corners.size(), [&](std::size_t i) { return static_cast<std::uint64_t>(corners[i]) >= vertices; });
        if (broken < corners.size()) {
            return Error{ErrorCode::invalid_data,
                         fmt::format("triangles[{}] has vertex {}, but the surface has {} vertices", broken / 3,
                                     corners[broken], vertices)};
        }
        core::Buffer<std::uint32_t> numbers(corners.size());
        core::parallel_each(corners.size(), grain,
                            [&](std::size_t i) { numbers[i] = static_cast<std::uint32_t>(corners[i]); });
        Result<vulkan::Buffer> sent = send(*context, numbers, "triangles");
        if (!sent) return sent.error();
        triangles = *std::move(sent);
        return {};
    });
}

} // namespace isotet::render
