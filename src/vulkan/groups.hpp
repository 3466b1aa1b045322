// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Many workgroups, folded into three axes of limited length. kernels/shared/groups.glsl is the device's half.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace isotet::vulkan {

using Groups = std::array<std::uint32_t, 3>;

/// The smallest folding found of at least `count` groups with at most `limit` an axis: fewer than one group an axis and
/// row too many. A kernel must compare group_index() with the count. Nothing when limit^3 is too little.
constexpr std::optional<Groups> fold_groups(std::uint64_t count, std::uint64_t limit) {
    if (count == 0) return Groups{0, 1, 1};
    const auto pieces = [](std::uint64_t n, std::uint64_t size) { return (n + size - 1) / size; };
    const std::uint64_t planes = pieces(pieces(count, limit), limit);
    if (planes > limit) return {};
    const std::uint64_t plane = pieces(count, planes);
    const std::uint64_t rows = pieces(plane, limit);
    return Groups{static_cast<std::uint32_t>(pieces(plane, rows)), static_cast<std::uint32_t>(rows),
                  static_cast<std::uint32_t>(planes)};
}

} // namespace isotet::vulkan
