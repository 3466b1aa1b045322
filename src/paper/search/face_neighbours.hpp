// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "base/buffer.hpp"
#include "packed/tet_table.hpp"

namespace isotet::search {

/// The tet on the other side of the face opposite each corner.
class FaceNeighbours {
public:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    /// Only tets that some isovalue cuts have neighbours and are some. Where more than two share a face, the first and
    /// the second are neighbours, the third and the fourth, and so on.
    ///
    /// Guarantees   if a is b's neighbour, b is a's
    /// Cost         O(n), 48 bytes a tet meanwhile; 16 stay
    explicit FaceNeighbours(const core::TetTable& table);

    const std::array<std::uint32_t, 4>& of(std::uint32_t tet) const { return neighbours_[tet]; }
    std::uint64_t bytes() const { return neighbours_.bytes(); }

private:
    core::Buffer<std::array<std::uint32_t, 4>> neighbours_;
};

} // namespace isotet::search
