// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join/point_numbers.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace isotet::io {
namespace {

using Bits = std::vector<std::uint64_t>;

void set_bit(Bits& bits, std::uint64_t place, std::uint64_t count) {
    if (bits.empty()) bits.resize((count + 63) / 64);
    bits[place / 64] |= std::uint64_t{1} << place % 64;
}

/// The pieces' points counted through.
std::vector<std::uint64_t> firsts(std::span<const std::uint64_t> points) {
    std::vector<std::uint64_t> first{0};
    for (const std::uint64_t count : points) first.push_back(first.back() + count);
    return first;
}

std::size_t piece_with(const std::vector<std::uint64_t>& first, std::uint64_t point) {
    return static_cast<std::size_t>(std::ranges::upper_bound(first, point) - first.begin() - 1);
}

} // namespace

void PointNumbers::list(std::span<const std::uint64_t> points, std::span<const std::vector<PointUse>> uses,
                        std::span<const JoinedPoint> joined) {
    const std::vector<std::uint64_t> first = firsts(points);
    core::parallel_each(uses.size(), 1, [&](std::size_t p) {
        for (std::size_t i = 0; i < uses[p].size(); ++i)
            if (uses[p][i] == PointUse::left_out) set_bit(pieces[p].is_listed_, i, points[p]);
    });
    for (const JoinedPoint& point : joined)
        for (const std::uint64_t one : {point.point, point.first}) {
            const std::size_t p = piece_with(first, one);
            set_bit(pieces[p].is_shared_, one - first[p], points[p]);
            if (one == point.point) set_bit(pieces[p].is_listed_, one - first[p], points[p]);
        }
}

PointNumbers PointNumbers::make(std::span<const std::uint64_t> points, std::span<const std::vector<PointUse>> uses,
                                std::span<const JoinedPoint> joined) {
    PointNumbers numbers;
    numbers.pieces.resize(points.size());
    numbers.list(points, uses, joined);
    for (std::size_t p = 0; p < points.size(); ++p) {
        PieceNumbers& piece = numbers.pieces[p];
        std::uint64_t listed = 0;
        for (const std::uint64_t word : piece.is_listed_) {
            piece.before_.push_back(listed);
            listed += static_cast<std::uint64_t>(std::popcount(word));
        }
        piece.listed_.assign(listed, PieceNumbers::none);
        piece.first_ = numbers.count;
        numbers.count += points[p] - listed;
    }
    const std::vector<std::uint64_t> first = firsts(points);
    for (const JoinedPoint& point : joined) {
        const std::size_t p = piece_with(first, point.point), q = piece_with(first, point.first);
        PieceNumbers& piece = numbers.pieces[p];
        const std::uint64_t own = point.point - first[p], bit = std::uint64_t{1} << own % 64;
        const std::uint64_t before =
            piece.before_[own / 64] + static_cast<std::uint64_t>(std::popcount(piece.is_listed_[own / 64] & (bit - 1)));
        piece.listed_[before] = numbers.pieces[q](point.first - first[q]);
    }
    return numbers;
}

} // namespace isotet::io
