// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/face_normals.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/core.h>

#include <isotet/surface.hpp>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"

namespace isotet {

namespace {

constexpr std::size_t face_grain = 1 << 14;

template <class Real, class Index>
Result<Array> normals_of_faces(std::span<const Real> positions, std::span<const Index> corners) {
    const std::uint64_t vertices = positions.size() / 3;
    const auto bad = std::ranges::find_if(corners, [&](Index v) { return static_cast<std::uint64_t>(v) >= vertices; });
    if (bad != corners.end())
        return invalid_data(fmt::format("triangles[{}] has vertex {}, but the surface has {} vertices",
                                        (bad - corners.begin()) / 3, *bad, vertices));
    core::Buffer<float> normals(corners.size());
    core::parallel_ranges(corners.size() / 3, face_grain, [&](std::size_t begin, std::size_t end) {
        cpu::face_normals(positions.data(), corners.data() + 3 * begin, end - begin, normals.data() + 3 * begin);
    });
    return std::move(normals).to_array(3);
}

template <class Real>
Result<Array> normals_of_faces(std::span<const Real> positions, const Array& triangles) {
    if (triangles.type() == ScalarType::uint64) return normals_of_faces(positions, triangles.as<std::uint64_t>());
    return normals_of_faces(positions, triangles.as<std::uint32_t>());
}

} // namespace

Result<Array> face_normals(const Surface& surface, const Run& run) {
    return core::carry_out("normals of triangles", run, [&](const Progress&) -> Result<Array> {
        const Array &positions = surface.positions, &triangles = surface.triangles;
        if (triangles.type() != ScalarType::uint32 && triangles.type() != ScalarType::uint64)
            return invalid_data("the surface's triangles are not uint32 or uint64");
        if (positions.type() == ScalarType::float32) return normals_of_faces(positions.as<float>(), triangles);
        if (positions.type() == ScalarType::float64) return normals_of_faces(positions.as<double>(), triangles);
        return invalid_data("the surface's positions are not float32 or float64");
    });
}

} // namespace isotet
