// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Whether cells and points are those that were seen before, of cells that come by in blocks of any size and order.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include <isotet/array.hpp>

#include "base/parallel.hpp"
#include "grid/cells.hpp"
#include "numbers/point_hash.hpp"

namespace isotet::core {

/// Threads   add() is safe from many threads
class CellPrint {
public:
    using Print = std::array<std::uint64_t, 2>;

    /// Corners from place `first` on.
    void add(std::uint64_t first, const Array& corners) {
        corners.visit([&]<class Index>(std::span<const Index> values) {
            if constexpr (std::is_integral_v<Index>)
                add_numbers(corner_key, first, values.size(), [&](std::size_t i) { return widened(values[i]); });
        });
    }

    /// When all corners were added.
    /// `types`   of the cells; empty: all are of `type`
    Print finish(const Array& points, std::span<const std::uint8_t> types, std::uint8_t type, std::uint64_t cells) {
        parallel_ranges(types.size(), grain, [&](std::size_t begin, std::size_t end) {
            add_numbers(type_key, begin, end - begin, [&](std::size_t i) { return types[begin + i]; });
        });
        const auto* bytes = static_cast<const std::byte*>(points.data());
        parallel_ranges(points.bytes() / 4, grain, [&](std::size_t begin, std::size_t end) {
            add_numbers(point_key, begin, end - begin, [&](std::size_t i) {
                std::uint32_t word = 0;
                std::memcpy(&word, bytes + 4 * (begin + i), sizeof word);
                return word;
            });
        });
        const std::array<std::uint64_t, 4> sizes{cells, types.empty() ? type : 0U, points.tuples(),
                                                 static_cast<std::uint64_t>(points.type())};
        add_numbers(size_key, 0, sizes.size(), [&](std::size_t i) { return sizes[i]; });
        return {first_.load(), second_.load()};
    }

private:
    static constexpr std::size_t grain = 1 << 16;
    static constexpr std::uint64_t corner_key = 0xA0761D6478BD642FU, type_key = 0xE7037ED1A0B428DBU,
                                   point_key = 0x8EBC6AF09C88C6E3U, size_key = 0x589965CC75374CC3U;

    /// Sums over numbers with their places, so in any order.
    template <class At>
    void add_numbers(std::uint64_t key, std::uint64_t first, std::size_t count, const At& at) {
        std::uint64_t a = 0, b = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint64_t place = (first + i + 1) * 0x9E3779B97F4A7C15U;
            const std::uint64_t number = std::uint64_t{at(i)} + key;
            a += folded_product(number ^ place, place ^ 0x1D8E4E27C47D124FU);
            b += folded_product(number + place, key ^ place);
        }
        first_ += a;
        second_ += b;
    }

    std::atomic<std::uint64_t> first_{0}, second_{0};
};

} // namespace isotet::core
