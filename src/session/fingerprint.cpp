// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "session/fingerprint.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <vector>

#include "core/parallel.hpp"

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

Fingerprint of_block(const std::byte* data, std::size_t bytes) noexcept {
    Fingerprint print{bytes, ~std::uint64_t{bytes}};
    while (bytes > 0) {
        std::uint64_t word = 0;
        const std::size_t count = std::min(bytes, sizeof word);
        std::memcpy(&word, data, count);
        stir(print, word);
        data += count;
        bytes -= count;
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
