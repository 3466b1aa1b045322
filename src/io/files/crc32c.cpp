// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/crc32c.hpp"

#include <array>
#include <bit>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace isotet::io {

namespace {

constexpr std::uint32_t castagnoli = 0x82f63b78; // reflected

/// tables[k][b]: the byte b followed by k zero bytes.
constexpr auto crc_tables = [] {
    std::array<std::array<std::uint32_t, 256>, 8> tables{};
    for (std::uint32_t b = 0; b < 256; ++b) {
        std::uint32_t crc = b;
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? castagnoli : 0);
        tables[0][b] = crc;
    }
    for (std::size_t k = 1; k < tables.size(); ++k)
        for (std::size_t b = 0; b < 256; ++b)
            tables[k][b] = tables[k - 1][b] >> 8 ^ tables[0][tables[k - 1][b] & 0xff];
    return tables;
}();

std::uint64_t eight_bytes(const std::byte* at) {
    std::uint64_t word;
    std::memcpy(&word, at, sizeof word);
    return word;
}

#if defined(__x86_64__)
__attribute__((target("sse4.2"))) std::uint32_t crc_by_instruction(std::span<const std::byte> bytes,
                                                                   std::uint32_t before) noexcept {
    std::uint64_t crc = ~before;
    const std::byte* at = bytes.data();
    std::size_t left = bytes.size();
    for (; left >= 8; at += 8, left -= 8) crc = _mm_crc32_u64(crc, eight_bytes(at));
    for (; left > 0; ++at, --left)
        crc = _mm_crc32_u8(static_cast<std::uint32_t>(crc), static_cast<std::uint8_t>(*at));
    return ~static_cast<std::uint32_t>(crc);
}
#endif

} // namespace

std::uint32_t portable_crc32c(std::span<const std::byte> bytes, std::uint32_t before) noexcept {
    std::uint32_t crc = ~before;
    const std::byte* at = bytes.data();
    std::size_t left = bytes.size();
    static_assert(std::endian::native == std::endian::little);
    for (; left >= 8; at += 8, left -= 8) { // slicing by 8 (Kounavis and Berry 2005)
        const std::uint64_t word = eight_bytes(at) ^ crc;
        crc = 0;
        for (std::size_t k = 0; k < 8; ++k) crc ^= crc_tables[7 - k][word >> 8 * k & 0xff];
    }
    for (; left > 0; ++at, --left)
        crc = crc >> 8 ^ crc_tables[0][(crc ^ static_cast<std::uint32_t>(*at)) & 0xff];
    return ~crc;
}

std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t before) noexcept {
#if defined(__x86_64__)
    static const bool has_instruction = __builtin_cpu_supports("sse4.2");
    if (has_instruction) return crc_by_instruction(bytes, before);
#endif
    return portable_crc32c(bytes, before);
}

} // namespace isotet::io
