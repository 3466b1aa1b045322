// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "session/fingerprint.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

#include "base/parallel.hpp"

namespace isotet::session {

namespace {

constexpr std::size_t block = std::size_t{1} << 20;

void stir(Fingerprint& print, std::uint64_t word) noexcept {
    // Two multiplicative hashes with different odd factors; each step is a bijection of the state.
    print.low = (print.low ^ word) * 0x9E3779B97F4A7C15U;
    print.low ^= print.low >> 32;
    print.high = (print.high + word) * 0xC2B2AE3D27D4EB4FU;
    print.high ^= print.high >> 29;
}

std::uint64_t load(const std::byte* data, std::size_t bytes) noexcept {
    std::uint64_t word = 0;
    std::memcpy(&word, data, bytes);
    return word;
}

/// Several states, each of every so many words: one alone would wait for its own multiplications.
Fingerprint of_block(const std::byte* data, std::size_t bytes) noexcept {
    constexpr std::size_t lanes = 4, word = sizeof(std::uint64_t);
    std::array<Fingerprint, lanes> prints;
    for (std::size_t lane = 0; lane < lanes; ++lane) prints[lane] = {bytes + lane, ~std::uint64_t{bytes}};
    for (; bytes >= lanes * word; data += lanes * word, bytes -= lanes * word)
        for (std::size_t lane = 0; lane < lanes; ++lane) stir(prints[lane], load(data + lane * word, word));
    for (; bytes > 0; data += std::min(bytes, word), bytes -= std::min(bytes, word))
        stir(prints[0], load(data, std::min(bytes, word)));
    Fingerprint print = prints[0];
    for (std::size_t lane = 1; lane < lanes; ++lane) {
        stir(print, prints[lane].low);
        stir(print, prints[lane].high);
    }
    return print;
}

} // namespace

Fingerprint fingerprint(const Array& array) {
    const std::size_t blocks = (array.bytes() + block - 1) / block;
    std::vector<Fingerprint> prints(blocks);
    core::parallel_each(blocks, 1, [&](std::size_t i) {
        const std::size_t begin = i * block;
        prints[i] =
            of_block(static_cast<const std::byte*>(array.data()) + begin, std::min(block, array.bytes() - begin));
    });
    Fingerprint print{array.tuples(), array.components()};
    stir(print, static_cast<std::uint64_t>(array.type()));
    for (const Fingerprint& part : prints) {
        stir(print, part.low);
        stir(print, part.high);
    }
    return print;
}

Fingerprint fingerprint(const Cells& cells) {
    Fingerprint print{static_cast<std::uint64_t>(cells.uniform_type), 0};
    for (const Array* array : {&cells.connectivity, &cells.offsets, &cells.types, &cells.faces, &cells.face_offsets}) {
        const Fingerprint part = fingerprint(*array);
        stir(print, part.low);
        stir(print, part.high);
    }
    return print;
}

} // namespace isotet::session
