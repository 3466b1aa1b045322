// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How many of several isovalues each point is above: cells whose corners do not agree are cut by some isovalue.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "cpu/direct/points.hpp"
#include "cpu/direct/side_sums.hpp"

namespace isotet::cpu::direct {

/// Two bytes a point: in the low one how many isovalues it is above, in the high one flags of side::. Numbers that are no
/// points have flags as in Sides.
class Levels {
public:
    static constexpr std::size_t max_isovalues = 255;

    explicit Levels(std::size_t points) : points_(points), words_(std::bit_ceil(points)) {
        std::fill(words_.begin(), words_.begin() + points, std::uint16_t{0});
        std::fill(words_.begin() + points, words_.end(), static_cast<std::uint16_t>(side::unsound << 8));
    }

    /// Adds an isovalue.
    void add(const Sides& sides) {
        core::parallel_ranges(points_, 1 << 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t point = begin; point < end; ++point) {
                const unsigned flags = sides[point];
                words_[point] = static_cast<std::uint16_t>((words_[point] + (flags & side::above)) |
                                                           (flags & (side::watched | side::unsound)) << 8);
            }
        });
    }

    std::uint64_t mask() const { return words_.size() - 1; }
    std::size_t points() const { return points_; }
    std::uint16_t operator[](std::size_t point) const {
        return std::atomic_ref(words_.data()[point]).load(std::memory_order_relaxed);
    }
    unsigned flags(std::size_t point) const { return (*this)[point] >> 8U; }
    void saw(std::size_t point) {
        constexpr unsigned watched = side::watched << 8;
        const unsigned now = (*this)[point];
        if (now & watched)
            std::atomic_ref(words_[point]).store(static_cast<std::uint16_t>(now & ~watched), std::memory_order_relaxed);
    }

    /// By cell of `n` corners: in the low byte not 0 where some isovalue cuts it, in the high one all flags of its corners.
    /// False as add_up_sides().
    template <std::size_t n, class Index>
    bool look_at(const Index* corners, std::size_t cells, std::uint16_t* found) const {
        using Unsigned = std::make_unsigned_t<Index>;
        const auto most = static_cast<Unsigned>(std::min<std::uint64_t>(mask(), std::numeric_limits<Index>::max()));
        std::uint64_t all = 0;
        for (std::size_t i = 0; i < cells; ++i) {
            unsigned any = 0, every = 0xFFFF;
            for (std::size_t k = 0; k < n; ++k) {
                const auto corner = static_cast<Unsigned>(corners[n * i + k]);
                all |= corner;
                const unsigned word = (*this)[corner & most];
                any |= word;
                every &= word;
            }
            found[i] = static_cast<std::uint16_t>(((any ^ every) & 0xFF) | (any & 0xFF00));
        }
        return (all & ~std::uint64_t{most}) == 0;
    }

    static bool is_cut(unsigned found, std::size_t) { return (found & 0xFF) != 0; }
    static bool asks(unsigned found) { return found >= 256; }

    template <std::size_t n>
    static std::size_t find_worth_looking(const std::array<std::uint16_t, cells_at_once>& found, std::uint32_t* places,
                                          std::uint32_t cells) {
        std::size_t count = 0;
        for (std::uint32_t i = 0; i < cells; i += 4) {
            const auto four =
                std::bit_cast<std::uint64_t>(std::array{found[i], found[i + 1], found[i + 2], found[i + 3]});
            if (four == 0) continue;
            for (std::uint32_t k = i; k < i + 4; ++k)
                if (found[k] != 0) places[count++] = k;
        }
        return count;
    }

private:
    std::size_t points_;
    mutable core::Buffer<std::uint16_t> words_;
};

/// The same of one isovalue: a byte a point.
class OneLevel {
public:
    explicit OneLevel(Sides sides) : sides_(std::move(sides)) {}

    std::uint64_t mask() const { return sides_.mask(); }
    std::size_t points() const { return sides_.points(); }
    unsigned flags(std::size_t point) const { return sides_[point]; }
    void saw(std::size_t point) { sides_.saw(point); }

    /// Flags of the corners added up.
    template <std::size_t n, class Index>
    bool look_at(const Index* corners, std::size_t cells, std::uint16_t* found) const {
        return add_up_sides<n>(sides_, corners, cells, found);
    }

    static bool is_cut(unsigned found, std::size_t corners) { return found % 16 % corners != 0; }
    static bool asks(unsigned found) { return found >= 16; }

    template <std::size_t n>
    static std::size_t find_worth_looking(const std::array<std::uint16_t, cells_at_once>& found, std::uint32_t* places,
                                          std::uint32_t cells) {
        return direct::find_worth_looking<n>(found, places, cells);
    }

private:
    Sides sides_;
};

} // namespace isotet::cpu::direct
