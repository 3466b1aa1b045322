// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which clusters each tile may show, nearest first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <isotet/progress.hpp>

#include "base/buffer.hpp"
#include "render/cpu/bins.hpp"
#include "render/volume/placed_volume.hpp"

namespace isotet::render {

struct ClusterEntry {
    float nearest; ///< distance before which nothing of it is
    std::uint32_t volume, cluster;
};

class VolumeBins {
public:
    VolumeBins(const std::vector<PlacedVolume>& volumes, const Tiling& tiling, const Progress& progress);

    std::span<const ClusterEntry> of(std::size_t tile) const {
        return {entries_.data() + begins_[tile], begins_[tile + 1] - begins_[tile]};
    }
    std::uint64_t clusters() const { return clusters_; } ///< that some tile may show
    std::uint64_t bytes() const { return entries_.bytes() + begins_.size() * sizeof(std::size_t); }

private:
    core::Buffer<ClusterEntry> entries_;
    std::vector<std::size_t> begins_;
    std::uint64_t clusters_ = 0;
};

} // namespace isotet::render
