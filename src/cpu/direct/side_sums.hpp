// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which cells of as many corners each are worth a look: the flags of their corners, added up some cells at a time.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "cpu/direct/points.hpp"

namespace isotet::cpu::direct {

constexpr std::size_t cells_at_once =
    1 << 10; ///< few enough that their corners are still near when cut ones are fetched

/// Adds up the flags of the corners of each cell, of which it has `n`. False when a number has no flags, and so is no
/// point; numbers that have none are masked before they are looked up.
template <std::size_t n, class Index>
bool add_up_sides(const Sides& sides, const Index* corners, std::size_t cells, std::uint16_t* sums) {
    using Unsigned = std::make_unsigned_t<Index>; // a negative number becomes one that is too large
    const auto mask = static_cast<Unsigned>(std::min<std::uint64_t>(sides.mask(), std::numeric_limits<Index>::max()));
    std::uint64_t all = 0;
    if constexpr (sizeof(Index) == 4 && n % 2 == 0) {
        // Two corners at once: half as many words to load, check and mask.
        const std::uint64_t both = mask * std::uint64_t{0x1'0000'0001};
        for (std::size_t i = 0; i < cells; ++i) {
            unsigned sum = 0;
#pragma GCC unroll 4
            for (std::size_t k = 0; k < n; k += 2) {
                std::uint64_t word;
                std::memcpy(&word, corners + n * i + k, sizeof word);
                all |= word;
                const std::uint64_t pair = word & both;
                sum += sides[static_cast<std::uint32_t>(pair)];
                sum += sides[pair >> 32];
            }
            sums[i] = static_cast<std::uint16_t>(sum);
        }
        return (all & ~both) == 0;
    } else {
        for (std::size_t i = 0; i < cells; ++i) {
            unsigned sum = 0;
            for (std::size_t k = 0; k < n; ++k) {
                const auto corner = static_cast<Unsigned>(corners[n * i + k]);
                all |= corner;
                sum += sides[corner & mask];
            }
            sums[i] = static_cast<std::uint16_t>(sum);
        }
        return (all & ~std::uint64_t{mask}) == 0;
    }
}

/// Whether a cell of `n` corners whose flags add up to `sum` has some above and some below.
template <std::size_t n>
constexpr bool has_both_sides(unsigned sum) {
    return sum % 16 % n != 0;
}

/// Writes the places of cells of `n` corners on both sides, or with one that needs attention; returns how many.
/// `cells`   a multiple of 16
template <std::size_t n>
std::size_t find_worth_looking(const std::array<std::uint16_t, cells_at_once>& sums, std::uint32_t* places,
                               std::uint32_t cells = cells_at_once) {
    std::size_t found = 0;
#if defined(__SSE2__)
    const __m128i one = _mm_set1_epi8(1), most = _mm_set1_epi8(n - 2), attention = _mm_set1_epi8(16);
    for (std::uint32_t i = 0; i < cells; i += 16) {
        const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(&sums[i]));
        const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(&sums[i + 8]));
        const __m128i sum = _mm_packus_epi16(low, high); // 255 where it is more
        const __m128i less_one = _mm_sub_epi8(sum, one);
        const __m128i both_sides = _mm_cmpeq_epi8(_mm_min_epu8(less_one, most), less_one); // 1 to n - 1
        const __m128i worth = _mm_or_si128(both_sides, _mm_cmpeq_epi8(_mm_max_epu8(sum, attention), sum));
        for (auto bits = static_cast<unsigned>(_mm_movemask_epi8(worth)); bits; bits &= bits - 1)
            places[found++] = i + static_cast<std::uint32_t>(std::countr_zero(bits));
    }
#else
    for (std::uint32_t i = 0; i < cells; ++i) {
        places[found] = i;
        found += has_both_sides<n>(sums[i]) || sums[i] >= 16;
    }
#endif
    return found;
}

} // namespace isotet::cpu::direct
