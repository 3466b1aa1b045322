// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The small loops of the plain path with AVX-512: a table of 128 bytes is looked up 64 bytes at a time (VBMI).
// Functions carry their instruction set as an attribute, so that nothing else in the program is compiled for it.
#pragma once

#if defined(__x86_64__)

#include <immintrin.h>

#include "cpu/simd_portable.hpp"

#define ISOTET_AVX512 [[gnu::target("avx512f,avx512bw,avx512vl,avx512vbmi,bmi,bmi2,popcnt")]]

namespace isotet::cpu {

struct Avx512 {
    ISOTET_AVX512 static bool classify(const float* values, std::size_t n, float isovalue, std::uint8_t* above) {
        const __m512 level = _mm512_set1_ps(isovalue);
        unsigned special = 0;
        for (std::size_t k = 0; k < n; k += 16) {
            const __mmask16 there = n - k >= 16 ? 0xffff : static_cast<__mmask16>((1u << (n - k)) - 1);
            const __m512 x = _mm512_maskz_loadu_ps(there, values + k);
            const __mmask16 is_above = _mm512_cmp_ps_mask(x, level, _CMP_GE_OQ);
            special |= _mm512_mask_cmp_ps_mask(there, x, level, _CMP_EQ_UQ); // equal, or not a number
            _mm_storeu_si128(reinterpret_cast<__m128i*>(above + k), _mm_maskz_set1_epi8(is_above, 1));
        }
        return special;
    }

    ISOTET_AVX512 static void cut(const std::uint8_t* above, const core::StoredTet* tets, std::size_t n, std::size_t first,
                                  CutTets& out) {
        const __m512i low = _mm512_loadu_si512(above), high = _mm512_loadu_si512(above + 64);
        const __m512i weights = _mm512_set1_epi32(0x08040201);
        const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
        for (std::size_t i = 0; i < n; i += 16) {
            // Groups are padded, so a whole register can always be read.
            const __m512i corners = _mm512_loadu_si512(tets + i);
            const __m512i sides = _mm512_permutex2var_epi8(low, corners, high);
            const __m512i index = _mm512_madd_epi16(_mm512_maddubs_epi16(sides, weights), _mm512_set1_epi16(1));
            const __mmask16 there = n - i >= 16 ? 0xffff : static_cast<__mmask16>((1u << (n - i)) - 1);
            const __mmask16 is_cut = _mm512_mask_cmplt_epu32_mask(there, _mm512_sub_epi32(index, _mm512_set1_epi32(1)), _mm512_set1_epi32(14));
            _mm512_storeu_si512(out.corners.data() + out.count, _mm512_maskz_compress_epi32(is_cut, corners));
            _mm_storeu_si128(reinterpret_cast<__m128i*>(out.cases.data() + out.count),
                             _mm512_cvtepi32_epi8(_mm512_maskz_compress_epi32(is_cut, index)));
            const __m512i place = _mm512_add_epi32(lanes, _mm512_set1_epi32(static_cast<int>(first + i)));
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.places.data() + out.count),
                                _mm512_cvtepi32_epi16(_mm512_maskz_compress_epi32(is_cut, place)));
            out.count += static_cast<std::size_t>(_mm_popcnt_u32(is_cut));
        }
    }

    template <std::size_t stride>
    ISOTET_AVX512 static void crossed(const std::uint8_t* above, const std::uint8_t* edges, std::size_t n, std::uint64_t* bits) {
        constexpr std::size_t at_once = 64 / stride;
        const __m512i low = _mm512_loadu_si512(above), high = _mm512_loadu_si512(above + 64);
        for (std::size_t k = 0; k < n; k += at_once) {
            const std::size_t bytes = std::min<std::size_t>(64, stride * (n - k));
            const __mmask64 there = bytes == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bytes) - 1;
            const __m512i e = _mm512_maskz_loadu_epi8(there, edges + stride * k);
            const __m512i sides = _mm512_permutex2var_epi8(low, e, high);
            std::uint64_t mask;
            if constexpr (stride == 2) {
                mask = _mm512_test_epi16_mask(_mm512_xor_si512(sides, _mm512_srli_epi16(sides, 8)), _mm512_set1_epi16(1));
            } else {
                mask = _mm512_test_epi32_mask(_mm512_xor_si512(sides, _mm512_srli_epi32(sides, 8)), _mm512_set1_epi32(1));
            }
            if (n - k < at_once) mask &= (std::uint64_t{1} << (n - k)) - 1;
            if (k % 64 == 0) bits[k / 64] = 0;
            bits[k / 64] |= mask << k % 64;
        }
    }

    ISOTET_AVX512 static void nonzero(const std::uint64_t* words, std::size_t n, std::uint64_t* out) {
        for (std::size_t k = 0; k < n; k += 64) {
            std::uint64_t bits = 0;
            for (std::size_t i = 0; i < 64; i += 8) {
                const __m512i x = _mm512_loadu_si512(words + k + i);
                bits |= std::uint64_t{_mm512_test_epi64_mask(x, x)} << i;
            }
            out[k / 64] = bits;
        }
    }

    ISOTET_AVX512 static void keys(const CutTets& cut, VertexKey* out) {
        for (std::size_t i = 0; i < cut.count; ++i, out += 4) {
            const __m128i v = _mm_cvtsi32_si128(static_cast<int>(cut.corners[i]));
            const __m128i ends = _mm_shuffle_epi8(v, _mm_loadl_epi64(reinterpret_cast<const __m128i*>(polygon_bytes[cut.cases[i]].data())));
            const __m128i others = _mm_srli_epi64(ends, 32);
            const __m128i lower = _mm_cvtepu8_epi16(_mm_min_epu8(ends, others)), higher = _mm_cvtepu8_epi16(_mm_max_epu8(ends, others));
            _mm_storel_epi64(reinterpret_cast<__m128i*>(out), _mm_or_si128(_mm_slli_epi16(lower, 7), higher));
        }
    }

    /// For each case, the corners above of the four edges, then the corners below: a shuffle.
    static constexpr auto polygon_bytes = [] {
        std::array<std::array<std::uint8_t, 8>, 16> bytes{};
        for (std::size_t index = 0; index < 16; ++index)
            for (std::size_t k = 0; k < 4; ++k) {
                bytes[index][k] = core::case_table[index].polygon[k].above;
                bytes[index][k + 4] = core::case_table[index].polygon[k].below;
            }
        return bytes;
    }();
    static_assert(core::max_cluster_points == 128, "two registers of 64 bytes, keys of 7 + 7 bits");
};

} // namespace isotet::cpu

#endif
