// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The triangles of a surface as the things that a scene names: an isovalue, a part, the boundary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/surface.hpp>

namespace isotet::checking {

struct TriangleGroup {
    std::string name;        ///< "isovalue 0.5, part 2"
    std::vector<double> key; ///< the values of the fields that there are
    std::vector<std::uint64_t> triangles;
};

/// Triangles by the values of those of `fields` that the surface has: cell fields of one component; ascending, first
/// field first, triangles in their order. One group "surface" where it has none of them, or where they make more than
/// `max_groups`. After a cancel some triangles are missing.
ISOTET_API std::vector<TriangleGroup> triangle_groups(const Surface& surface, std::span<const std::string_view> fields,
                                                      const Progress& progress = {});

constexpr std::size_t max_groups = 4096;

} // namespace isotet::checking
