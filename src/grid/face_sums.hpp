// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// At which points faces may be unbalanced, or tets repeated: two numbers a point instead of a table of faces.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "grid/face_counter.hpp"
#include "numbers/point_hash.hpp"

namespace isotet::core {

/// For each point the sum of hashes of the faces that have it as their lowest one, signed by their direction: 0 where
/// each is used equally often in both. And a Bloom filter (Bloom 1970) of the tets that have it as their lowest or
/// second lowest point, for those that occur twice.
///
/// A point of which all faces are balanced and no tet is repeated is doubted at most by mistake of the filter; any
/// other is missed with probability 2^-64, that of a sum of hashes that is 0 by chance.
///
/// Threads   many may add
class FaceSums {
    struct Sums {
        std::uint64_t faces = 0, tets = 0;
    };
    /// What a tet changes.
    struct Change {
        std::uint64_t lowest, second;
        std::uint64_t at_lowest, at_second; ///< to be added to sums of faces
        std::uint64_t tet;                  ///< bits of the filter
        bool filter_of_second;
    };

public:
    explicit FaceSums(std::uint64_t points) : sums_(points), doubted_(points) {
        parallel_ranges(points, 1 << 16, [&](std::size_t begin, std::size_t end) {
            std::fill(sums_.begin() + begin, sums_.begin() + end, Sums{});
            std::fill(doubted_.begin() + begin, doubted_.begin() + end, std::uint8_t{0});
        });
    }

    /// Adds tets a few at a time: memory is asked for before it is changed.
    template <class Point>
    class Adder {
    public:
        explicit Adder(FaceSums& to) : to_(to) {}
        Adder(const Adder&) = delete;
        Adder& operator=(const Adder&) = delete;
        ~Adder() { flush(); }

        void add(const AscendingTet<Point>& tet) {
            const Change& change = changes_[count_++] = change_of(tet);
            __builtin_prefetch(&to_.sums_[change.lowest], 1);
            __builtin_prefetch(&to_.sums_[change.second], 1);
            if (count_ == changes_.size()) flush();
        }

    private:
        void flush() {
            for (std::size_t i = 0; i < count_; ++i) to_.apply(changes_[i]);
            count_ = 0;
        }

        FaceSums& to_;
        std::array<Change, 32> changes_;
        std::size_t count_ = 0;
    };

    /// Once all have been added. Returns how many points are doubted.
    std::uint64_t look() {
        std::atomic<std::uint64_t> doubted{0};
        parallel_ranges(sums_.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
            std::uint64_t here = 0;
            for (std::size_t point = begin; point < end; ++point)
                here += doubted_[point] |= static_cast<std::uint8_t>(sums_[point].faces != 0);
            doubted += here;
        });
        return doubted;
    }

    /// By point: 1 where it is doubted.
    Buffer<std::uint8_t> take_doubted() && { return std::move(doubted_); }

    static constexpr std::uint64_t bytes_per_point = 17;

private:
    template <class Point>
    static Change change_of(const AscendingTet<Point>& tet) {
        const std::array<Point, 4> p = tet.corners();
        const std::uint64_t first = mixed(p[1] + 0x9e3779b97f4a7c15u), second = mixed(p[2] + 0x9e3779b97f4a7c15u);
        // The outward faces of an upright tet are 1 2 3, 0 3 2, 0 1 3 and 0 2 1.
        const std::uint64_t p23 = mixed(second + p[3]), p13 = mixed(first + p[3]), p12 = mixed(first + p[2]);
        const std::uint64_t at_lowest = p13 - p23 - p12;
        const std::uint64_t tet_hash = mixed(first + p23 + p[0]);
        std::uint64_t bits = 0;
        for (unsigned i = 0; i < 4; ++i) bits |= std::uint64_t{1} << (tet_hash >> 6 * i & 63);
        return {p[0],
                p[1],
                tet.mirrored() ? 0 - at_lowest : at_lowest,
                tet.mirrored() ? 0 - p23 : p23,
                bits,
                (tet_hash >> 24 & 1) != 0};
    }

    void apply(const Change& change) {
        const auto at = [](std::uint64_t& number) { return std::atomic_ref(number); };
        at(sums_[change.lowest].faces).fetch_add(change.at_lowest, std::memory_order_relaxed);
        at(sums_[change.second].faces).fetch_add(change.at_second, std::memory_order_relaxed);
        std::uint64_t& filter = sums_[change.filter_of_second ? change.second : change.lowest].tets;
        if ((at(filter).fetch_or(change.tet, std::memory_order_relaxed) & change.tet) != change.tet) return;
        for (const std::uint64_t point : {change.lowest, change.second})
            std::atomic_ref(doubted_[point]).store(1, std::memory_order_relaxed);
    }

    Buffer<Sums> sums_;
    Buffer<std::uint8_t> doubted_;
};

} // namespace isotet::core
