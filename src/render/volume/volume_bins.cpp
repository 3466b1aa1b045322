// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/volume/volume_bins.hpp"

#include <algorithm>
#include <tuple>

#include "base/parallel.hpp"

namespace isotet::render {

namespace {

/// Calls f(tile, volume, cluster) for every tile that a cluster may show.
template <class F>
void for_entries(const std::vector<PlacedVolume>& volumes, const Tiling& tiling, const F& f) {
    for (std::size_t volume = 0; volume < volumes.size(); ++volume)
        for (std::size_t cluster = 0; cluster < volumes[volume].packed().clusters(); ++cluster) {
            const TileBox& box = volumes[volume].cluster(cluster).tiles;
            if (box.empty()) continue;
            for (std::size_t row = box.first_row; row <= box.last_row; ++row)
                for (std::size_t column = box.first_column; column <= box.last_column; ++column)
                    f(row * tiling.columns() + column, volume, cluster);
        }
}

} // namespace

VolumeBins::VolumeBins(const std::vector<PlacedVolume>& volumes, const Tiling& tiling, const Progress& progress)
    : begins_(tiling.tiles() + 1) {
    for_entries(volumes, tiling, [&](std::size_t tile, std::size_t, std::size_t) { ++begins_[tile + 1]; });
    for (std::size_t tile = 0; tile < tiling.tiles(); ++tile) begins_[tile + 1] += begins_[tile];
    entries_ = core::Buffer<ClusterEntry>(begins_.back());
    std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
    for_entries(volumes, tiling, [&](std::size_t tile, std::size_t volume, std::size_t cluster) {
        entries_[next[tile]++] = {volumes[volume].cluster(cluster).nearest, static_cast<std::uint32_t>(volume),
                                  static_cast<std::uint32_t>(cluster)};
    });
    core::parallel_pieces(tiling.tiles(), 16, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t tile = begin; tile < end; ++tile)
            std::sort(entries_.data() + begins_[tile], entries_.data() + begins_[tile + 1],
                      [](const ClusterEntry& a, const ClusterEntry& b) {
                          return std::tie(a.nearest, a.volume, a.cluster) < std::tie(b.nearest, b.volume, b.cluster);
                      });
    });
    for (const PlacedVolume& volume : volumes)
        for (std::size_t cluster = 0; cluster < volume.packed().clusters(); ++cluster)
            clusters_ += volume.cluster(cluster).tiles.empty() ? 0 : 1;
}

} // namespace isotet::render
