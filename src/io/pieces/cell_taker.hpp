// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include <isotet/array.hpp>

namespace isotet::io {

/// What is made of cells that go by, and are not kept as a whole.
///
/// Threads   safe from many
class CellTaker {
public:
    virtual ~CellTaker() = default;

    /// Some whole cells. Neither types nor corners are kept.
    ///
    /// `first`     how many cells of the grid come before
    /// `types`     one each; empty where all cells of the grid are of one
    /// `corners`   numbers of points of the grid, of 32 or 64 bits
    virtual void take(std::uint64_t first, std::span<const std::uint8_t> types, const Array& corners) = 0;
};

} // namespace isotet::io
