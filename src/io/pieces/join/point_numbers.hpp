// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "io/pieces/join/seams.hpp"

namespace isotet::io {

/// Numbers of a piece's points in the joined grid: one after another, but for a few that are listed.
class PieceNumbers {
public:
    static constexpr std::uint64_t none = ~std::uint64_t{0}; ///< a point that the joined grid does not have

    std::uint64_t operator()(std::uint64_t point) const {
        if (is_listed_.empty()) return first_ + point;
        const std::uint64_t word = is_listed_[point / 64], bit = std::uint64_t{1} << point % 64;
        const std::uint64_t before = before_[point / 64] + static_cast<std::uint64_t>(std::popcount(word & (bit - 1)));
        return word & bit ? listed_[before] : first_ + point - before;
    }

    /// Calls visit(point, count, number) for points [begin, end), in runs whose numbers follow one another; of `none` one
    /// at a time.
    template <class Visit>
    void each_run(std::uint64_t begin, std::uint64_t end, const Visit& visit) const {
        if (is_listed_.empty()) return visit(begin, end - begin, first_ + begin);
        for (std::uint64_t i = begin, count = 0; i < end; i += count) {
            const std::uint64_t word = is_listed_[i / 64] >> i % 64;
            const auto until_listed = static_cast<std::uint64_t>(word ? std::countr_zero(word) : 64);
            count = std::max<std::uint64_t>(1, std::min({until_listed, 64 - i % 64, end - i}));
            visit(i, count, (*this)(i));
        }
    }

    /// Calls visit(point) for those that other pieces have, too.
    template <class Visit>
    void each_shared(const Visit& visit) const {
        for (std::size_t i = 0; i < is_shared_.size(); ++i)
            for (std::uint64_t word = is_shared_[i]; word != 0; word &= word - 1)
                visit(64 * i + static_cast<std::uint64_t>(std::countr_zero(word)));
    }

    /// Whether another piece has it, too.
    bool is_shared(std::uint64_t point) const {
        return !is_shared_.empty() && (is_shared_[point / 64] >> point % 64 & 1) != 0;
    }
    bool has_shared() const { return !is_shared_.empty(); }

private:
    friend struct PointNumbers;
    std::uint64_t first_ = 0;
    std::vector<std::uint64_t> is_listed_, is_shared_; ///< a bit a point; empty: none is
    std::vector<std::uint64_t> before_;                ///< listed points before each word
    std::vector<std::uint64_t> listed_;
};

/// Where the points of each piece go in the joined grid.
struct PointNumbers {
    std::vector<PieceNumbers> pieces;
    std::uint64_t count = 0;

    /// `points`   of each piece
    /// `uses`     empty, or for each piece: points that only left-out cells have are dropped
    /// `joined`   as find_seams() gives them
    static PointNumbers make(std::span<const std::uint64_t> points, std::span<const std::vector<PointUse>> uses,
                             std::span<const JoinedPoint> joined);

private:
    void list(std::span<const std::uint64_t> points, std::span<const std::vector<PointUse>> uses,
              std::span<const JoinedPoint> joined);
};

} // namespace isotet::io
