// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Position along a Hilbert curve through a cube of 2^21 steps a side.
// Hamilton, Compact Hilbert Indices (2006), as a table of 24 states.
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

inline constexpr auto hilbert_table = make_hilbert_table();

} // namespace detail

/// The position of a cell of the cube; x, y, z below 2^21.
inline std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    std::uint64_t index = 0;
    unsigned state = 0;
    for (int bit = 20; bit >= 0; --bit) {
        const unsigned octant = (x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2;
        const detail::HilbertStep step = detail::hilbert_table[state][octant];
        index = index << 3 | step.digit;
        state = step.next;
    }
    return index;
}

} // namespace isotet::core
