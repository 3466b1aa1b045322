// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The small loops of the plain path with AVX2. A table of 128 bits (one a point) is looked up by shuffling its 16 bytes and
// testing one bit of the byte found.
// Functions carry their instruction set as an attribute, so that nothing else in the program is compiled for it.
#pragma once

#if defined(__x86_64__)

#include <immintrin.h>

#include "cpu/simd_portable.hpp"

#define ISOTET_AVX2 [[gnu::target("avx2,bmi,bmi2,popcnt")]]

namespace isotet::cpu {

struct Avx2 {
    ISOTET_AVX2 static bool classify(const float* values, std::size_t n, float isovalue, std::uint8_t* above) {
        return Portable::classify(values, n, isovalue, above);
    }

    ISOTET_AVX2 static void cut(const std::uint8_t* above, const core::StoredTet* tets, std::size_t n, std::size_t first,
                                CutTets& out) {
        const __m256i table = table_of(above);
        const __m256i weights = _mm256_set1_epi32(0x08040201);
        for (std::size_t i = 0; i < n; i += 8) {
            const __m256i corners = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(tets + i)); // groups are padded
            const __m256i sides = _mm256_and_si256(look_up(table, corners), _mm256_set1_epi8(1));
            const __m256i index = _mm256_madd_epi16(_mm256_maddubs_epi16(sides, weights), _mm256_set1_epi16(1));
            // 1 to 14 are cut: neither 0 nor 15.
            const __m256i uncut = _mm256_or_si256(_mm256_cmpeq_epi32(index, _mm256_setzero_si256()),
                                                  _mm256_cmpeq_epi32(index, _mm256_set1_epi32(15)));
            unsigned is_cut = ~static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(uncut))) & 0xff;
            if (n - i < 8) is_cut &= (1u << (n - i)) - 1;
            if (!is_cut) continue;
            alignas(32) std::uint32_t indices[8];
            _mm256_store_si256(reinterpret_cast<__m256i*>(indices), index);
            for (; is_cut; is_cut &= is_cut - 1) {
                const auto k = static_cast<std::size_t>(std::countr_zero(is_cut));
                std::memcpy(&out.corners[out.count], tets + i + k, 4);
                out.cases[out.count] = static_cast<std::uint8_t>(indices[k]);
                out.places[out.count++] = static_cast<std::uint16_t>(first + i + k);
            }
        }
    }

    template <std::size_t stride>
    ISOTET_AVX2 static void crossed(const std::uint8_t* above, const std::uint8_t* edges, std::size_t n, std::uint64_t* bits) {
        constexpr std::size_t at_once = 32 / stride;
        const __m256i table = table_of(above);
        std::fill_n(bits, core::words_of_bits(n), std::uint64_t{0});
        std::size_t k = 0;
        for (; k + at_once <= n; k += at_once) {
            const __m256i e = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(edges + stride * k));
            const __m256i sides = _mm256_and_si256(look_up(table, e), _mm256_set1_epi8(1));
            std::uint64_t mask;
            if constexpr (stride == 2) {
                // Bit 0 of each 16-bit lane to the lane's top, then one bit a lane.
                const __m256i differ = _mm256_slli_epi16(_mm256_xor_si256(sides, _mm256_srli_epi16(sides, 8)), 15);
                mask = _pext_u32(static_cast<unsigned>(_mm256_movemask_epi8(differ)), 0xaaaaaaaau);
            } else {
                const __m256i differ = _mm256_slli_epi32(_mm256_xor_si256(sides, _mm256_srli_epi32(sides, 8)), 31);
                mask = static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(differ)));
            }
            bits[k / 64] |= mask << k % 64;
        }
        for (; k < n; ++k) bits[k / 64] |= std::uint64_t(above[edges[stride * k]] ^ above[edges[stride * k + 1]]) << k % 64;
    }

    ISOTET_AVX2 static void nonzero(const std::uint64_t* words, std::size_t n, std::uint64_t* out) {
        for (std::size_t k = 0; k < n; k += 64) {
            std::uint64_t bits = 0;
            for (std::size_t i = 0; i < 64; i += 4) {
                const __m256i x = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(words + k + i));
                const __m256i is_zero = _mm256_cmpeq_epi64(x, _mm256_setzero_si256());
                bits |= std::uint64_t(~static_cast<unsigned>(_mm256_movemask_pd(_mm256_castsi256_pd(is_zero))) & 15) << i;
            }
            out[k / 64] = bits;
        }
    }

    ISOTET_AVX2 static void keys(const CutTets& cut, VertexKey* out) { Portable::keys(cut, out); }

private:
    /// Bits of the 128 sides in 16 bytes, twice.
    ISOTET_AVX2 static __m256i table_of(const std::uint8_t* above) {
        std::uint32_t bits[4];
        for (std::size_t k = 0; k < 4; ++k) {
            const __m256i sides = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(above + 32 * k));
            bits[k] = static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_slli_epi16(sides, 7)));
        }
        return _mm256_broadcastsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(bits)));
    }
    /// Bit 0 of each byte of the result is the table's bit for that byte of `indices`; other bits are leftovers.
    ISOTET_AVX2 static __m256i look_up(__m256i table, __m256i indices) {
        const __m256i seven = _mm256_set1_epi8(7);
        const __m256i byte = _mm256_shuffle_epi8(table, _mm256_and_si256(_mm256_srli_epi16(indices, 3), _mm256_set1_epi8(15)));
        const __m256i bit = _mm256_shuffle_epi8(_mm256_set1_epi64x(static_cast<long long>(0x8040201008040201u)), _mm256_and_si256(indices, seven));
        return _mm256_min_epu8(_mm256_and_si256(byte, bit), _mm256_set1_epi8(1));
    }
};

} // namespace isotet::cpu

#endif
