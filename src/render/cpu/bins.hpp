// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which triangles each tile of the picture may show.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/buffer.hpp"
#include "render/cpu/sheet.hpp"

namespace isotet::render {

struct BinEntry {
    std::uint32_t sheet, triangle;
    float nearest; ///< the least depth of what is in view
};

/// How the picture is cut into tiles, row by row.
struct Tiling {
    std::uint32_t width = 0, height = 0; ///< of the picture, pixels
    std::uint32_t samples = 0, side = 0; ///< pixels of a tile, an axis

    std::uint32_t columns() const noexcept { return (width + side - 1) / side; }
    std::uint32_t rows() const noexcept { return (height + side - 1) / side; }
    std::size_t tiles() const noexcept { return std::size_t{columns()} * rows(); }
};

/// The triangles of all tiles: what is opaque, nearest first, then what is translucent in the order of sheets and
/// triangles. Opaque sheets come before translucent ones.
class Bins {
public:
    Bins(const std::vector<Sheet>& sheets, const Tiling& tiling, const Sight& sight, const Progress& progress);

    std::span<const BinEntry> of(std::size_t tile) const noexcept {
        return {entries_.data() + begins_[tile], begins_[tile + 1] - begins_[tile]};
    }

private:
    core::Buffer<BinEntry> entries_;
    std::vector<std::size_t> begins_;
};

} // namespace isotet::render
