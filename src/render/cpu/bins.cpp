// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/cpu/bins.hpp"

#include <algorithm>
#include <tuple>

#include "base/parallel.hpp"
#include "render/cpu/clip.hpp"

namespace isotet::render {

namespace {

constexpr std::size_t triangles_per_chunk = 8192;

/// Some triangles of one sheet, and the tiles of each.
struct BinChunk {
    std::uint32_t sheet = 0;
    std::size_t begin = 0, end = 0;
    struct Pair {
        std::uint32_t tile, triangle;
        float nearest;
    };
    std::vector<Pair> pairs;
};

/// The samples, of `count`, whose centres lie from `lower` to `upper`.
struct SampleRange {
    std::int64_t first, last;

    SampleRange(std::int32_t lower, std::int32_t upper, std::int64_t count)
        : first(std::max<std::int64_t>((std::int64_t{lower} + fixed_one / 2 - 1) >> fixed_bits, 0)),
          last(std::min<std::int64_t>((std::int64_t{upper} - fixed_one / 2) >> fixed_bits, count - 1)) {}
};

void fill_chunk(BinChunk& chunk, const Sheet& sheet, const Tiling& tiling, const Sight& sight) {
    const std::int64_t tile_samples = std::int64_t{tiling.side} * tiling.samples;
    for (std::size_t triangle = chunk.begin; triangle < chunk.end; ++triangle) {
        const FixedPolygon polygon = polygon_of(sheet, triangle, sight);
        if (polygon.count < 3) continue;
        const auto points = std::span(polygon.points).first(polygon.count);
        const auto [left, right] = std::ranges::minmax(points, {}, &FixedPoint::x);
        const auto [top, bottom] = std::ranges::minmax(points, {}, &FixedPoint::y);
        const SampleRange x(left.x, right.x, std::int64_t{tiling.width} * tiling.samples),
            y(top.y, bottom.y, std::int64_t{tiling.height} * tiling.samples);
        if (x.first > x.last || y.first > y.last) continue;
        const float nearest = std::ranges::min(points, {}, &FixedPoint::depth).depth;
        for (std::int64_t row = y.first / tile_samples; row <= y.last / tile_samples; ++row)
            for (std::int64_t column = x.first / tile_samples; column <= x.last / tile_samples; ++column)
                chunk.pairs.push_back({static_cast<std::uint32_t>(row * tiling.columns() + column),
                                       static_cast<std::uint32_t>(triangle), nearest});
    }
}

} // namespace

Bins::Bins(const std::vector<Sheet>& sheets, const Tiling& tiling, const Sight& sight, const Progress& progress) {
    std::vector<BinChunk> chunks;
    for (std::size_t sheet = 0; sheet < sheets.size(); ++sheet) {
        const std::size_t count = sheets[sheet].triangle_count();
        for (std::size_t begin = 0; begin < count; begin += triangles_per_chunk)
            chunks.push_back(
                {static_cast<std::uint32_t>(sheet), begin, std::min(begin + triangles_per_chunk, count), {}});
    }
    core::parallel_pieces(chunks.size(), 1, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) fill_chunk(chunks[i], sheets[chunks[i].sheet], tiling, sight);
    });
    begins_.resize(tiling.tiles() + 1);
    for (const BinChunk& chunk : chunks)
        for (const BinChunk::Pair& pair : chunk.pairs) ++begins_[pair.tile + 1];
    for (std::size_t tile = 0; tile < tiling.tiles(); ++tile) begins_[tile + 1] += begins_[tile];
    entries_ = core::Buffer<BinEntry>(begins_.back());
    std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
    for (const BinChunk& chunk : chunks)
        for (const BinChunk::Pair& pair : chunk.pairs)
            entries_[next[pair.tile]++] = {chunk.sheet, pair.triangle, pair.nearest};
    const auto first_translucent = std::ranges::find_if(sheets, &Sheet::translucent);
    const auto opaque = static_cast<std::uint32_t>(first_translucent - sheets.begin());
    core::parallel_pieces(tiling.tiles(), 16, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t tile = begin; tile < end; ++tile) {
            const std::span<BinEntry> entries(entries_.data() + begins_[tile], begins_[tile + 1] - begins_[tile]);
            const auto rest = std::ranges::lower_bound(entries, opaque, {}, &BinEntry::sheet);
            std::sort(entries.begin(), rest, [](const BinEntry& a, const BinEntry& b) {
                return std::tie(a.nearest, a.sheet, a.triangle) < std::tie(b.nearest, b.sheet, b.triangle);
            });
        }
    });
}

} // namespace isotet::render
