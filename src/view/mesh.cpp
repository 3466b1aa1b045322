// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/mesh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>

namespace isotet::view {

static_assert(std::endian::native == std::endian::little, "messages are little endian");

namespace {

constexpr double max_place = 65535;

std::array<std::int8_t, 2> on_octahedron(const float* normal) {
    const float sum = std::abs(normal[0]) + std::abs(normal[1]) + std::abs(normal[2]);
    if (!(sum > 0)) return {0, 0};
    float u = normal[0] / sum, v = normal[1] / sum;
    if (normal[2] < 0) {
        const float folded = (1 - std::abs(v)) * (u < 0 ? -1.0F : 1.0F);
        v = (1 - std::abs(u)) * (v < 0 ? -1.0F : 1.0F);
        u = folded;
    }
    return {static_cast<std::int8_t>(std::lround(u * 127)), static_cast<std::int8_t>(std::lround(v * 127))};
}

std::uint16_t map_place(const ColorScale& scale, double value) {
    const double place = scale.place_of(value);
    if (std::isnan(place)) return no_data_place;
    return static_cast<std::uint16_t>(std::lround(std::clamp(place, 0.0, 1.0) * max_map_place));
}

std::vector<std::uint16_t> map_places(const SurfaceColors& colors) {
    std::vector<std::uint16_t> places(colors.values.tuples());
    colors.values.visit([&](auto values) {
        for (std::size_t i = 0; i < places.size(); ++i)
            places[i] = map_place(colors.scale, static_cast<double>(values[i]));
    });
    return places;
}

template <class Scalar>
Box box_of(std::span<const Scalar> positions) {
    Box box;
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
        const std::array<double, 3> point{static_cast<double>(positions[i]), static_cast<double>(positions[i + 1]),
                                          static_cast<double>(positions[i + 2])};
        if (std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2])) box.add(point);
    }
    return box;
}

/// Places in the box; which vertices are finite.
template <class Scalar>
std::vector<bool> place_vertices(std::span<const Scalar> positions, Mesh& mesh) {
    std::vector<bool> finite(mesh.vertices.size(), true);
    std::array<double, 3> scale{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double size = mesh.box.upper[axis] - mesh.box.lower[axis];
        scale[axis] = size > 0 ? max_place / size : 0;
    }
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double place = (static_cast<double>(positions[3 * i + axis]) - mesh.box.lower[axis]) * scale[axis];
            if (place >= 0 && place <= max_place + 0.5)
                mesh.vertices[i].place[axis] = static_cast<std::uint16_t>(std::min(place + 0.5, max_place));
            else finite[i] = false;
        }
    }
    return finite;
}

/// Corners of the triangles whose vertices are finite.
void take_corners(const Surface& surface, const std::vector<bool>& finite, Mesh& mesh,
                  std::vector<std::size_t>* triangles) {
    mesh.corners.reserve(surface.triangles.size());
    surface.triangles.visit([&](auto corners) {
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            const std::array<std::size_t, 3> of{static_cast<std::size_t>(corners[i]),
                                                static_cast<std::size_t>(corners[i + 1]),
                                                static_cast<std::size_t>(corners[i + 2])};
            if (!finite[of[0]] || !finite[of[1]] || !finite[of[2]]) continue;
            for (const std::size_t corner : of) mesh.corners.push_back(static_cast<std::uint32_t>(corner));
            if (triangles) triangles->push_back(i / 3);
        }
    });
}

/// No vertex shared: each triangle's three have its colour.
void take_apart(Mesh& mesh, const std::vector<std::size_t>& triangles, const std::vector<std::uint16_t>& colors) {
    std::vector<MeshVertex> vertices(mesh.corners.size());
    mesh.colors.resize(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        vertices[i] = mesh.vertices[mesh.corners[i]];
        mesh.colors[i] = colors[triangles[i / 3]];
        mesh.corners[i] = static_cast<std::uint32_t>(i);
    }
    mesh.vertices = std::move(vertices);
    mesh.flat = true;
}

Result<Mesh> made_mesh(const Surface& surface, const SurfaceColors* colors, const Run& run) {
    const bool flat = colors && colors->association == Association::cell;
    if (std::max(surface.vertex_count(), flat ? 3 * surface.triangle_count() : 0) >= UINT32_MAX)
        return Error{ErrorCode::invalid_argument, "a page cannot show more than 2^32 - 1 vertices"};
    const Result<Array> normals = vertex_normals(surface, run);
    if (!normals) return normals.error();
    Mesh mesh;
    mesh.vertices.resize(surface.vertex_count());
    const std::vector<bool> finite = surface.positions.visit([&](auto positions) {
        mesh.box = box_of(positions);
        return place_vertices(positions, mesh);
    });
    const auto directions = normals->as<float>();
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) mesh.vertices[i].normal = on_octahedron(&directions[3 * i]);
    std::vector<std::size_t> triangles;
    take_corners(surface, finite, mesh, flat ? &triangles : nullptr);
    if (flat) take_apart(mesh, triangles, map_places(*colors));
    else if (colors) mesh.colors = map_places(*colors);
    return mesh;
}

} // namespace

Result<Mesh> mesh_of(const Surface& surface, const SurfaceColors* colors, const Run& run) {
    try {
        return made_mesh(surface, colors, run);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, "there is too little memory for the surface as a page takes it"};
    }
}

MeshPlaces add_mesh(const Mesh& mesh, Blocks& blocks) {
    MeshPlaces places;
    places.wide = mesh.vertices.size() > 65536;
    places.vertices = blocks.add(mesh.vertices);
    if (!mesh.colors.empty()) places.colors = blocks.add(mesh.colors);
    if (mesh.flat) places.corners = 0;
    else if (places.wide) places.corners = blocks.add(mesh.corners);
    else places.corners = blocks.add(std::vector<std::uint16_t>(mesh.corners.begin(), mesh.corners.end()));
    return places;
}

} // namespace isotet::view
