// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Position along a Hilbert curve through a cube of 2^21 steps a side.
// Hamilton, Compact Hilbert Indices (2006), as a table of 24 states that takes two steps at a time.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace isotet::core {

namespace detail {

struct HilbertStep {
    std::uint8_t digit; ///< position of the octant along the curve
    std::uint8_t next;  ///< state inside the octant
};

constexpr std::array<std::array<HilbertStep, 8>, 24> make_hilbert_table() {
    const auto rotate_left = [](unsigned x, unsigned by) { return ((x << by) | (x >> (3 - by))) & 7u; };
    const auto gray = [](unsigned x) { return x ^ (x >> 1); };
    std::array<std::array<HilbertStep, 8>, 24> table{};
    for (unsigned entry = 0; entry < 8; ++entry)
        for (unsigned direction = 0; direction < 3; ++direction) {
            for (unsigned digit = 0; digit < 8; ++digit) {
                const unsigned turn = (direction + 1) % 3;
                const unsigned octant = rotate_left(gray(digit), turn) ^ entry;
                const unsigned sub_entry = digit == 0 ? 0 : gray(2 * ((digit - 1) / 2));
                const unsigned sub_direction =
                    digit == 0 ? 0 : static_cast<unsigned>(std::countr_one(digit % 2 == 0 ? digit - 1 : digit)) % 3;
                const unsigned next_entry = entry ^ rotate_left(sub_entry, turn);
                const unsigned next_direction = (direction + sub_direction + 1) % 3;
                table[entry * 3 + direction][octant] = {static_cast<std::uint8_t>(digit),
                                                        static_cast<std::uint8_t>(next_entry * 3 + next_direction)};
            }
        }
    return table;
}

/// Two steps in one: by state and two octants, the outer one first.
constexpr std::array<std::array<HilbertStep, 64>, 24> make_hilbert_pairs() {
    const auto single = make_hilbert_table();
    std::array<std::array<HilbertStep, 64>, 24> table{};
    for (unsigned state = 0; state < 24; ++state)
        for (unsigned octants = 0; octants < 64; ++octants) {
            const HilbertStep outer = single[state][octants >> 3], inner = single[outer.next][octants & 7];
            table[state][octants] = {static_cast<std::uint8_t>(outer.digit << 3 | inner.digit), inner.next};
        }
    return table;
}

inline constexpr auto hilbert_pairs = make_hilbert_pairs();

/// Moves bit k of a number below 2^21 to bit 3 k.
constexpr std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

} // namespace detail

/// The position of a cell of the cube; x, y, z below 2^21.
inline std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    const std::uint64_t octants = detail::spread(x) | detail::spread(y) << 1 | detail::spread(z) << 2;
    std::uint64_t index = 0;
    unsigned state = 2; // eleven pairs for 21 octants: state 2 leads through octant 0 to state 0, where the curve
                        // begins
    for (int bit = 60; bit >= 0; bit -= 6) {
        const detail::HilbertStep step = detail::hilbert_pairs[state][octants >> bit & 63];
        index = index << 6 | step.digit;
        state = step.next;
    }
    return index;
}

} // namespace isotet::core
