// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/parts.hpp"

#include <algorithm>
#include <limits>

#include "core/buffer.hpp"
#include "core/parallel.hpp"

namespace isotet::linear {

void Parts::add_cell(std::uint8_t type, std::span<const std::uint64_t> cell_corners, std::uint64_t source) {
    corners.insert(corners.end(), cell_corners.begin(), cell_corners.end());
    ends.push_back(corners.size());
    types.push_back(type);
    sources.push_back(source);
}

std::uint64_t Parts::add_point(std::span<const std::uint64_t> points, std::span<const double> weights) {
    row_points.insert(row_points.end(), points.begin(), points.end());
    row_weights.insert(row_weights.end(), weights.begin(), weights.end());
    row_ends.push_back(row_points.size());
    return derived_bit + row_ends.size() - 1;
}

namespace {

/// Where a block's part of the arrays begins.
struct BlockPlace {
    std::uint64_t cell = 0, corner = 0, row = 0, term = 0;
};

void add(LinearizeReport& sum, const LinearizeReport& part) {
    sum.polyhedra += part.polyhedra;
    sum.known_shapes += part.known_shapes;
    sum.centred += part.centred;
    sum.moved_centres += part.moved_centres;
    sum.folded += part.folded;
    sum.open += part.open;
    sum.cells += part.cells;
    sum.high_degree += part.high_degree;
    sum.high_degree_parts += part.high_degree_parts;
}

template <class Index>
void join_cells(const std::vector<Parts>& blocks, const std::vector<BlockPlace>& places, std::uint64_t user_points,
                Cells& cells) {
    const BlockPlace& end = places.back();
    core::Buffer<Index> connectivity(end.corner), offsets(end.cell + 1);
    core::Buffer<std::uint8_t> types(end.cell);
    offsets[0] = 0;
    core::parallel_each(blocks.size(), 1, [&](std::size_t b) {
        const Parts& block = blocks[b];
        const BlockPlace& at = places[b];
        for (std::size_t i = 0; i < block.corners.size(); ++i) {
            const std::uint64_t corner = block.corners[i];
            connectivity[at.corner + i] = static_cast<Index>(
                corner & Parts::derived_bit ? user_points + at.row + (corner - Parts::derived_bit) : corner);
        }
        for (std::size_t i = 0; i < block.ends.size(); ++i)
            offsets[at.cell + i + 1] = static_cast<Index>(at.corner + block.ends[i]);
        std::ranges::copy(block.types, types.begin() + at.cell);
    });
    cells.connectivity = std::move(connectivity).to_array();
    cells.offsets = std::move(offsets).to_array();
    cells.types = std::move(types).to_array();
}

} // namespace

LinearGrid joined(std::vector<Parts>& blocks, std::uint64_t user_points) {
    LinearGrid out;
    std::vector<BlockPlace> places(blocks.size() + 1);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const BlockPlace& at = places[b];
        places[b + 1] = {at.cell + blocks[b].types.size(), at.corner + blocks[b].corners.size(),
                         at.row + blocks[b].row_ends.size(), at.term + blocks[b].row_points.size()};
        add(out.report, blocks[b].report);
    }
    const BlockPlace& end = places.back();
    constexpr std::uint64_t narrow = std::numeric_limits<std::int32_t>::max();
    if (user_points + end.row <= narrow && end.corner <= narrow)
        join_cells<std::int32_t>(blocks, places, user_points, out.grid.cells);
    else join_cells<std::int64_t>(blocks, places, user_points, out.grid.cells);

    core::Buffer<std::uint64_t> sources(end.cell), first(end.row + 1), points(end.term);
    core::Buffer<double> weights(end.term);
    first[0] = 0;
    core::parallel_each(blocks.size(), 1, [&](std::size_t b) {
        const Parts& block = blocks[b];
        const BlockPlace& at = places[b];
        std::ranges::copy(block.sources, sources.begin() + at.cell);
        for (std::size_t i = 0; i < block.row_ends.size(); ++i) first[at.row + i + 1] = at.term + block.row_ends[i];
        std::ranges::copy(block.row_points, points.begin() + at.term);
        std::ranges::copy(block.row_weights, weights.begin() + at.term);
        blocks[b] = {};
    });
    out.source_cells = std::move(sources).to_array();
    out.derived = {std::move(first).to_array(), std::move(points).to_array(), std::move(weights).to_array()};
    out.user_points = user_points;
    return out;
}

} // namespace isotet::linear
