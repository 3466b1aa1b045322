// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// 32 characters at once where the machine has AVX2 (Mula and Lemire, "Faster Base64 Encoding and Decoding using AVX2
// Instructions", 2018), else four by tables.
#include "io/vtk_xml/base64.hpp"

#include <array>
#include <cstdint>
#include <cstring>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace isotet::io::vtk_xml {
namespace {

constexpr std::uint32_t no_digit = 0xFF000000U;

/// For each of the four places of a group what a character stands for in the 24 bits, last byte first.
constexpr auto make_tables() {
    std::array<std::array<std::uint32_t, 256>, 4> tables{};
    for (auto& table : tables) table.fill(no_digit);
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::uint32_t digit = 0; digit < 64; ++digit)
        for (std::uint32_t place = 0; place < 4; ++place)
            tables[place][static_cast<unsigned char>(alphabet[digit])] = digit << (18 - 6 * place);
    return tables;
}
constexpr auto tables = make_tables();

/// 24 bits, or no_digit set among them.
std::uint32_t group(const char* text) {
    const auto at = [&](std::size_t place) { return tables[place][static_cast<unsigned char>(text[place])]; };
    return at(0) | at(1) | at(2) | at(3);
}

void put(std::uint32_t bits, std::byte* to, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) to[i] = static_cast<std::byte>(bits >> (16 - 8 * i));
}

#if defined(__x86_64__)
/// Decodes 32 characters after another as long as there are 32 and all are digits; returns how many characters.
__attribute__((target("avx2"))) std::size_t decode_wide(const char* text, std::size_t size, std::byte* to) {
    const __m256i high_rules = _mm256_setr_epi8(0x10, 0x10, 0x01, 0x02, 0x04, 0x08, 0x04, 0x08, 0x10, 0x10, 0x10, 0x10,
                                                0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x01, 0x02, 0x04, 0x08, 0x04, 0x08,
                                                0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x10);
    const __m256i low_rules = _mm256_setr_epi8(0x15, 0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x13, 0x1A,
                                               0x1B, 0x1B, 0x1B, 0x1A, 0x15, 0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x11,
                                               0x11, 0x11, 0x13, 0x1A, 0x1B, 0x1B, 0x1B, 0x1A);
    const __m256i shifts = _mm256_setr_epi8(0, 16, 19, 4, -65, -65, -71, -71, 0, 0, 0, 0, 0, 0, 0, 0, 0, 16, 19, 4, -65,
                                            -65, -71, -71, 0, 0, 0, 0, 0, 0, 0, 0);
    const __m256i order = _mm256_setr_epi8(2, 1, 0, 6, 5, 4, 10, 9, 8, 14, 13, 12, -1, -1, -1, -1, 2, 1, 0, 6, 5, 4, 10,
                                           9, 8, 14, 13, 12, -1, -1, -1, -1);
    const __m256i slash = _mm256_set1_epi8(0x2F);
    std::size_t at = 0;
    for (; size - at >= 32; at += 32, to += 24) {
        const __m256i in = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(text + at));
        const __m256i high = _mm256_and_si256(_mm256_srli_epi32(in, 4), slash);
        const __m256i low = _mm256_and_si256(in, slash);
        if (!_mm256_testz_si256(_mm256_shuffle_epi8(low_rules, low), _mm256_shuffle_epi8(high_rules, high))) break;
        const __m256i shift = _mm256_shuffle_epi8(shifts, _mm256_add_epi8(_mm256_cmpeq_epi8(in, slash), high));
        const __m256i digits = _mm256_add_epi8(in, shift);
        const __m256i pairs = _mm256_maddubs_epi16(digits, _mm256_set1_epi32(0x01400140));
        const __m256i groups = _mm256_madd_epi16(pairs, _mm256_set1_epi32(0x00011000));
        const __m256i packed = _mm256_permutevar8x32_epi32(_mm256_shuffle_epi8(groups, order),
                                                           _mm256_setr_epi32(0, 1, 2, 4, 5, 6, -1, -1));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), packed);
    }
    return at;
}
#endif

} // namespace

std::optional<std::size_t> decode_base64(std::string_view text, std::byte* to) {
    if (text.size() % 4 != 0) return std::nullopt;
    std::size_t padding = 0;
    if (text.ends_with("==")) padding = 2;
    else if (text.ends_with('=')) padding = 1;
    const std::size_t whole = padding > 0 ? text.size() - 4 : text.size();
    std::size_t at = 0;
#if defined(__x86_64__)
    static const bool wide = __builtin_cpu_supports("avx2");
    if (wide) at = decode_wide(text.data(), whole, to);
#endif
    std::uint32_t seen = 0;
    for (; at < whole; at += 4) {
        const std::uint32_t bits = group(text.data() + at);
        seen |= bits;
        put(bits, to + at / 4 * 3, 3);
    }
    if (padding > 0) {
        std::array<char, 4> last{'A', 'A', 'A', 'A'};
        std::memcpy(last.data(), text.data() + whole, 4 - padding);
        const std::uint32_t bits = group(last.data());
        seen |= bits;
        put(bits, to + whole / 4 * 3, 3 - padding);
    }
    if ((seen & no_digit) != 0) return std::nullopt;
    return text.size() / 4 * 3 - padding;
}

} // namespace isotet::io::vtk_xml
