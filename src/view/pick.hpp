// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a surface says at a point.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <isotet/isosurface_scene.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet::view {

struct PickedValue {
    std::string name;
    bool cell = false;
    std::vector<double> values; ///< one a component
};

/// The point of a surface that is nearest to another one.
///
/// `values`   point fields between those of the triangle's corners; cell fields of its cell
/// `cell`     the user's, where the surface has source_cells; nothing where it was not found, a negative number there
struct Picked {
    std::array<double, 3> point{};
    std::vector<PickedValue> values;
    std::optional<std::int64_t> cell;
    std::optional<double> isovalue = {}; ///< of the surface that a ray met; nothing: a slice, the boundary, or no ray
    bool boundary = false;               ///< a ray met the grid's boundary
};

/// Nothing for a surface without triangles. Cost   O(F)
std::optional<Picked> nearest_on(const Surface& surface, const std::array<double, 3>& point);

/// How far along a ray the first triangle is, as a multiple of `direction`; nothing where there is none. Places beyond a
/// plane of `clips` do not count. Cost   O(F)
std::optional<double> first_on_ray(const Surface& surface, const std::array<double, 3>& origin,
                                   const std::array<double, 3>& direction, std::span<const Plane> clips);

} // namespace isotet::view
