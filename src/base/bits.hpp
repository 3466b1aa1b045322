// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sets of small numbers as words of 64 bits.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace isotet::core {

constexpr std::size_t words_of_bits(std::size_t bits) { return (bits + 63) / 64; }

inline void set_bit(std::uint64_t* words, std::size_t i) { words[i / 64] |= std::uint64_t{1} << i % 64; }
inline bool test_bit(const std::uint64_t* words, std::size_t i) { return words[i / 64] >> i % 64 & 1; }

/// Bits set among the first i.
inline std::size_t rank_of_bit(const std::uint64_t* words, std::size_t i) {
    std::size_t rank = 0;
    for (std::size_t w = 0; w < i / 64; ++w) rank += static_cast<std::size_t>(std::popcount(words[w]));
    const std::uint64_t below = (std::uint64_t{1} << i % 64) - 1;
    return below ? rank + static_cast<std::size_t>(std::popcount(words[i / 64] & below)) : rank;
}

inline std::size_t count_bits(const std::uint64_t* words, std::size_t n) {
    std::size_t count = 0;
    for (std::size_t w = 0; w < n; ++w) count += static_cast<std::size_t>(std::popcount(words[w]));
    return count;
}

/// Calls f(i) for every set bit, ascending.
template <class F>
void for_bits(const std::uint64_t* words, std::size_t n, F&& f) {
    for (std::size_t w = 0; w < n; ++w)
        for (std::uint64_t bits = words[w]; bits; bits &= bits - 1)
            f(64 * w + static_cast<std::size_t>(std::countr_zero(bits)));
}

} // namespace isotet::core
