// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces made by hand, for tests of what check() finds in them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <isotet/check.hpp>
#include <isotet/surface.hpp>

namespace isotet::test {

using Vertices = std::vector<std::array<float, 3>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

struct Soup {
    Vertices vertices;
    Triangles triangles;

    /// Another one beside it, its vertices after those that are there.
    Soup& add(const Soup& other);
    Soup moved(float x, float y, float z) const;
    Soup mirrored() const; ///< every triangle in the other direction
};

Surface surface_of(const Soup& soup);
SurfaceReport check_of(const Soup& soup, const CheckOptions& options = {});

/// Eight triangles around the origin, corners at distance 1, seen counter-clockwise from outside.
Soup octahedron();

/// n x n quads, cut into triangles, around a circle of radius 2, thickness 1.
Soup torus(std::uint32_t n);

/// The two triangles of a square in the plane z = 0, facing up.
Soup square();

/// True when some finding begins with `beginning`.
bool has_finding(const SurfaceReport& report, const std::string& beginning);

} // namespace isotet::test
