// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces as a browser draws them: few bytes, and exact enough for a screen.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/isosurface_scene.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/scene.hpp>
#include <isotet/surface.hpp>

namespace isotet::view {

/// A vertex, as it is sent.
///
/// `place`    65535ths of the box's edges
/// `normal`   on an octahedron: both its places, 127ths
struct MeshVertex {
    std::array<std::uint16_t, 3> place{};
    std::array<std::int8_t, 2> normal{};
};
static_assert(sizeof(MeshVertex) == 8);

inline constexpr std::uint16_t no_data_place = 65535; ///< where a value is NaN
inline constexpr std::uint16_t max_map_place = 65534; ///< the upper end of the map

/// V vertices, F triangles.
struct Mesh {
    Box box;                            ///< of the vertices; empty where there is none
    std::vector<MeshVertex> vertices;   ///< V
    std::vector<std::uint32_t> corners; ///< 3 F, counter-clockwise seen from the side of higher values
    std::vector<std::uint16_t> colors;  ///< empty, or V places in the colour map, 65534ths
    bool flat = false; ///< triangles have a colour each: no vertex is shared, and `corners` count from 0 on

    std::size_t triangle_count() const noexcept { return corners.size() / 3; }
};

/// Shaded by vertex_normals(). Triangles with a vertex that is not finite are left out.
///
/// `colors`   of the surface, or null
/// Errors     as vertex_normals(); out_of_memory; invalid_argument where there are more than 2^32 - 1 vertices
/// Cost       O(V + F)
Result<Mesh> mesh_of(const Surface& surface, const SurfaceColors* colors, const Run& run = {});

/// The same with about `triangles` triangles, for a hand that moves: vertices in one cell of a lattice become one.
/// A mesh that is flat, or has no more triangles than that, stays as it is.
///
/// Guarantees   the same for the same mesh; no triangle has a vertex twice
/// Cost         O(V + F)
/// Method       vertex clustering (Rossignac and Borrel 1993)
Mesh preview_of(const Mesh& mesh, std::size_t triangles);

/// As those of a surface.
SurfacePoints some_points_of(const Mesh& mesh);

/// Bytes behind one another, each block at a multiple of 8.
class Blocks {
public:
    /// Returns where the block begins.
    template <class T>
    std::size_t add(const std::vector<T>& values) {
        bytes_.resize((bytes_.size() + 7) / 8 * 8);
        const std::size_t at = bytes_.size();
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        return at;
    }
    const std::string& bytes() const noexcept { return bytes_; }

private:
    std::string bytes_;
};

/// Where a mesh stands in a message: bytes from the beginning of the blocks, little endian.
struct MeshPlaces {
    std::size_t vertices = 0, corners = 0;
    std::optional<std::size_t> colors;
    bool wide = false; ///< corners have 32 bits, else 16
};
MeshPlaces add_mesh(const Mesh& mesh, Blocks& blocks);

} // namespace isotet::view
