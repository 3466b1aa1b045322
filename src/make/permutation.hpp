// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A random order of 0 .. n - 1 that needs no memory: a Feistel network, repeated until it lands below n.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "make/random.hpp"

namespace isotet::make {

/// A bijection of [0, count) and its inverse.
///
/// Method   Luby and Rackoff 1988 for the network; cycle walking as Black and Rogaway 2002: the network permutes a
///          power of four, at most four times count, and a result outside is permuted again (four times on average at
///          worst)
class Permutation {
public:
    Permutation(std::uint64_t count, std::uint64_t seed, Stream stream) noexcept : count_(count) {
        half_bits_ = count > 1 ? (static_cast<unsigned>(std::bit_width(count - 1)) + 1) / 2 : 1;
        half_mask_ = (std::uint64_t{1} << half_bits_) - 1;
        for (std::size_t round = 0; round < keys_.size(); ++round) keys_[round] = draw(seed, stream, round);
    }

    std::uint64_t operator()(std::uint64_t index) const noexcept {
        do {
            std::uint64_t left = index >> half_bits_, right = index & half_mask_;
            for (std::size_t round = 0; round < keys_.size(); ++round) {
                const std::uint64_t next = left ^ (mix(keys_[round] ^ right) & half_mask_);
                left = right;
                right = next;
            }
            index = left << half_bits_ | right;
        } while (index >= count_);
        return index;
    }

    std::uint64_t inverse(std::uint64_t index) const noexcept {
        do {
            std::uint64_t left = index >> half_bits_, right = index & half_mask_;
            for (std::size_t round = keys_.size(); round-- > 0;) {
                const std::uint64_t previous = right ^ (mix(keys_[round] ^ left) & half_mask_);
                right = left;
                left = previous;
            }
            index = left << half_bits_ | right;
        } while (index >= count_);
        return index;
    }

private:
    std::uint64_t count_;
    unsigned half_bits_;
    std::uint64_t half_mask_;
    std::array<std::uint64_t, 5> keys_{};
};

} // namespace isotet::make
