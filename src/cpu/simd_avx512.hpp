// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The small loops of the plain path with AVX-512: a table of 128 bytes is looked up 64 bytes at a time (VBMI),
// and of many numbers those wanted are moved together (VBMI2).
// Functions carry their instruction set as an attribute, so that nothing else in the program is compiled for it.
#pragma once

#if defined(__x86_64__)

#include <immintrin.h>

#include "cpu/simd_avx2.hpp"

#define ISOTET_AVX512 [[gnu::target("avx512f,avx512bw,avx512vl,avx512vbmi,avx512vbmi2,bmi,bmi2,popcnt")]]

namespace isotet::cpu {

struct Avx512 {
    ISOTET_AVX512 static bool classify(const float* values, std::size_t n, const core::StoredIsovalue<float>& isovalue,
                                       std::uint8_t* above) {
        const __m512 level = _mm512_set1_ps(isovalue.value), tied = _mm512_set1_ps(isovalue.tied);
        unsigned special = 0;
        std::array<std::uint64_t, 2> sides{};
        for (std::size_t k = 0; k < n; k += 16) {
            const __mmask16 there = n - k >= 16 ? 0xffff : static_cast<__mmask16>((1u << (n - k)) - 1);
            const __m512 x = _mm512_maskz_loadu_ps(there, values + k);
            const __mmask16 is_above = _mm512_cmp_ps_mask(x, level, _CMP_GE_OQ);
            special |= _mm512_mask_cmp_ps_mask(there, x, tied, _CMP_EQ_UQ); // tied, or not a number
            sides[k / 64] |= std::uint64_t{is_above} << k % 64;
        }
        // Whole registers, as they are loaded soon: what was stored in parts would have to be waited for.
        for (std::size_t k = 0; k < 2; ++k) _mm512_storeu_si512(above + 64 * k, _mm512_maskz_set1_epi8(sides[k], 1));
        return special;
    }

    ISOTET_AVX512 static void cut(const std::uint8_t* above, const core::StoredTet* tets, std::size_t n,
                                  std::size_t first, CutTets& out) {
        const __m512i low = _mm512_loadu_si512(above), high = _mm512_loadu_si512(above + 64);
        const __m512i weights = _mm512_set1_epi32(0x08040201);
        const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
        for (std::size_t i = 0; i < n; i += 16) {
            // Behind the last ones stand others, or slack: a whole register can always be read.
            const __m512i corners = _mm512_loadu_si512(tets + i);
            const __m512i sides = _mm512_permutex2var_epi8(low, corners, high);
            const __m512i index = _mm512_madd_epi16(_mm512_maddubs_epi16(sides, weights), _mm512_set1_epi16(1));
            const __mmask16 there = n - i >= 16 ? 0xffff : static_cast<__mmask16>((1u << (n - i)) - 1);
            const __mmask16 is_cut = _mm512_mask_cmplt_epu32_mask(there, _mm512_sub_epi32(index, _mm512_set1_epi32(1)),
                                                                  _mm512_set1_epi32(14));
            _mm512_storeu_si512(out.corners.data() + out.count, _mm512_maskz_compress_epi32(is_cut, corners));
            _mm_storeu_si128(reinterpret_cast<__m128i*>(out.cases.data() + out.count),
                             _mm512_cvtepi32_epi8(_mm512_maskz_compress_epi32(is_cut, index)));
            const __m512i place = _mm512_add_epi32(lanes, _mm512_set1_epi32(static_cast<int>(first + i)));
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.places.data() + out.count),
                                _mm512_cvtepi32_epi16(_mm512_maskz_compress_epi32(is_cut, place)));
            out.count += static_cast<std::size_t>(_mm_popcnt_u32(is_cut));
        }
    }

    ISOTET_AVX512 static std::size_t cross_seams(const std::uint8_t* above, std::span<const core::SeamEdge> seams,
                                                 std::uint64_t* mask, VertexKey* out) {
        const __m512i low = _mm512_loadu_si512(above), high = _mm512_loadu_si512(above + 64);
        const VertexKey* const begin = out;
        for (std::size_t k = 0; k < seams.size(); k += 32) {
            const __mmask32 there = seams.size() - k >= 32 ? ~__mmask32{0} : (__mmask32{1} << (seams.size() - k)) - 1;
            const __m512i edges = _mm512_maskz_loadu_epi16(there, seams.data() + k);
            const __m512i sides = _mm512_permutex2var_epi8(low, edges, high);
            const __mmask32 crossed = _mm512_mask_test_epi16_mask(
                there, _mm512_xor_si512(sides, _mm512_srli_epi16(sides, 8)), _mm512_set1_epi16(1));
            const __m512i lower = _mm512_and_si512(edges, _mm512_set1_epi16(0xff));
            const __m512i keys = _mm512_or_si512(_mm512_slli_epi16(lower, 7), _mm512_srli_epi16(edges, 8));
            _mm512_storeu_si512(out, _mm512_maskz_compress_epi16(crossed, keys));
            out += _mm_popcnt_u32(crossed);
            if (k % 64 == 0) mask[k / 64] = crossed;
            else mask[k / 64] |= std::uint64_t{crossed} << 32;
        }
        return static_cast<std::size_t>(out - begin);
    }

    ISOTET_AVX512 static void find_owners(const core::ClusterLinks& links, const std::uint64_t* crossed,
                                          const std::uint32_t* base, std::uint32_t isovalue, SharedVertex* out) {
        if (links.wide) return Portable::find_owners(links, crossed, base, isovalue, out);
        std::array<std::uint8_t, CrossedBefore::most + 64> indices; // of crossed seams
        CrossedBefore crossed_before(crossed);
        for (std::size_t word = 0; 64 * word < links.ghost_seams.size(); ++word) {
            const __m512i all = _mm512_maskz_loadu_epi8(crossed[word], links.seam_indices + 64 * word);
            _mm512_storeu_si512(&indices[crossed_before.add_word()], _mm512_maskz_compress_epi8(crossed[word], all));
        }
        // How many seams of a neighbour are crossed is as good as random, but rarely more than a register holds.
        std::size_t seam = 0, first = 0;
        for (const core::Neighbour& neighbour : links.neighbours) {
            const __m512i owner = _mm512_set1_epi64(base[neighbour.cluster] + isovalue);
            seam += neighbour.ghost_seams;
            const std::size_t last = crossed_before[seam];
            do {
                const __m512i index =
                    _mm512_cvtepu8_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(&indices[first])));
                _mm512_storeu_si512(out + first, _mm512_or_si512(owner, _mm512_slli_epi64(index, 32)));
                first += 8;
            } while (first < last);
            first = last;
        }
    }

    ISOTET_AVX512 static std::size_t list_keys(KeyTable& used, VertexKey* out) {
        const VertexKey* const begin = out;
        const __m512i lanes = _mm512_loadu_si512(first_numbers.data()), zero = _mm512_setzero_si512();
        for (std::size_t flags = 0; flags < KeyTable::part_count; flags += 64) {
            const __m512i some = _mm512_load_si512(&used.parts[flags]);
            _mm512_store_si512(&used.parts[flags], zero);
            for (std::uint64_t parts = _mm512_test_epi8_mask(some, some); parts; parts &= parts - 1) {
                const std::size_t first =
                    KeyTable::part_size * (flags + static_cast<std::size_t>(std::countr_zero(parts)));
                const __m512i x = _mm512_load_si512(&used.bytes[first]);
                const __mmask64 there = _mm512_test_epi8_mask(x, x);
                _mm512_store_si512(&used.bytes[first], zero);
                const __m512i found = _mm512_maskz_compress_epi8(there, lanes),
                              before = _mm512_set1_epi16(static_cast<short>(first));
                _mm512_storeu_si512(out, _mm512_add_epi16(before, _mm512_cvtepu8_epi16(_mm512_castsi512_si256(found))));
                const auto count = static_cast<std::size_t>(_mm_popcnt_u64(there));
                if (count > 32)
                    _mm512_storeu_si512(
                        out + 32, _mm512_add_epi16(before, _mm512_cvtepu8_epi16(_mm512_extracti64x4_epi64(found, 1))));
                out += count;
            }
        }
        return static_cast<std::size_t>(out - begin);
    }

    ISOTET_AVX512 static void keys(CutTets& cut, VertexKey* out) { Avx2::keys(cut, out); }

    template <core::CellKind kind>
    ISOTET_AVX512 static void cut_cells(const std::uint8_t* above, const core::StoredTet* words, std::size_t n,
                                        std::size_t first, CutCells& out) {
        constexpr char all = static_cast<char>((1u << core::corner_count(kind)) - 1);
        const __m512i low = _mm512_loadu_si512(above), high = _mm512_loadu_si512(above + 64);
        const __m128i lanes = _mm_setr_epi16(0, 2, 4, 6, 8, 10, 12, 14);
        for (std::size_t i = 0; i < n; i += 8) {
            const __m512i corners = _mm512_loadu_si512(words + 2 * i); // what stands behind may be read
            const __m512i sides = _mm512_permutex2var_epi8(low, corners, high);
            // A bit for each of eight times eight corners: the cases.
            const auto bits = static_cast<long long>(_mm512_test_epi8_mask(sides, sides));
            const __m128i cases = _mm_and_si128(_mm_cvtsi64_si128(bits), _mm_set1_epi8(all));
            const __mmask16 there = n - i >= 8 ? 0xff : static_cast<__mmask16>((1u << (n - i)) - 1);
            const __mmask16 is_cut = _mm_mask_cmplt_epu8_mask(there, _mm_sub_epi8(cases, _mm_set1_epi8(1)),
                                                              _mm_set1_epi8(static_cast<char>(all - 1)));
            const auto cut_lanes = static_cast<__mmask8>(is_cut);
            _mm512_storeu_si512(out.corners.data() + out.count, _mm512_maskz_compress_epi64(cut_lanes, corners));
            _mm_storel_epi64(reinterpret_cast<__m128i*>(out.cases.data() + out.count),
                             _mm_maskz_compress_epi8(is_cut, cases));
            const __m128i place = _mm_add_epi16(lanes, _mm_set1_epi16(static_cast<short>(first + 2 * i)));
            _mm_storeu_si128(reinterpret_cast<__m128i*>(out.places.data() + out.count),
                             _mm_maskz_compress_epi16(cut_lanes, place));
            out.count += static_cast<std::size_t>(_mm_popcnt_u32(is_cut));
        }
    }

    template <core::CellKind kind>
    ISOTET_AVX512 static void polygons(const CutCells& cells, CutTets& out, VertexKey* keys) {
        Avx2::polygons<kind>(cells, out, keys);
    }

    ISOTET_AVX512 static void cross(const VertexKey* edges, std::size_t n, const std::uint8_t* above,
                                    const float* values, const core::StoredIsovalue<float>& isovalue, EndPair* ends,
                                    float* weights) {
        const __m512i low = _mm512_loadu_si512(above), high = _mm512_loadu_si512(above + 64);
        const __m512 level = _mm512_set1_ps(isovalue.value), rest = _mm512_set1_ps(isovalue.rest);
        for (std::size_t i = 0; i < n; i += 16) {
            const __m256i key = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(edges + i));
            const __m256i a = _mm256_and_si256(_mm256_srli_epi16(key, 7), _mm256_set1_epi16(127));
            const __m256i b = _mm256_and_si256(key, _mm256_set1_epi16(127));
            const __m256i side = _mm512_castsi512_si256(_mm512_permutex2var_epi8(low, _mm512_castsi256_si512(a), high));
            const __mmask16 a_is_above = _mm256_test_epi16_mask(side, _mm256_set1_epi16(1));
            const __m256i end_below = _mm256_mask_mov_epi16(a, a_is_above, b),
                          end_above = _mm256_mask_mov_epi16(b, a_is_above, a);
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(ends + i),
                                _mm256_or_si256(end_below, _mm256_slli_epi16(end_above, 8)));
            const __m512 value_below = _mm512_i32gather_ps(_mm512_cvtepu16_epi32(end_below), values, 4);
            const __m512 value_above = _mm512_i32gather_ps(_mm512_cvtepu16_epi32(end_above), values, 4);
            const __m512 part = _mm512_add_ps(_mm512_sub_ps(level, value_below), rest);
            const __m512 t = _mm512_div_ps(part, _mm512_sub_ps(value_above, value_below));
            const __mmask16 large = _mm512_cmp_ps_mask(t, _mm512_set1_ps(0x1p-32f), _CMP_NLT_UQ);
            _mm512_storeu_ps(weights + i, _mm512_maskz_mov_ps(large, t));
        }
    }

    ISOTET_AVX512 static void place(const EndPositions<float>* ends, const float* weights, std::size_t n, float* out) {
        for (std::size_t i = 0; i < n; ++i, out += 3) {
            // The last position of all has nothing behind it: three numbers are loaded, not four.
            const __m128 a = _mm_maskz_loadu_ps(7, ends[i].below);
            const __m128 b = _mm_maskz_loadu_ps(7, ends[i].above);
            const __m128 t = _mm_set1_ps(weights[i]);
            const __m128 between = _mm_add_ps(a, _mm_mul_ps(t, _mm_sub_ps(b, a)));
            _mm_storeu_ps(out, _mm_mask_mov_ps(between, _mm_cmp_ps_mask(t, _mm_set1_ps(1), _CMP_EQ_OQ), b));
        }
    }

    ISOTET_AVX512 static void copy(const float* from, std::size_t n, float* to) {
        std::size_t i = 0;
        for (; i + 16 <= n; i += 16) _mm512_storeu_ps(to + i, _mm512_loadu_ps(from + i));
        const auto there = static_cast<__mmask16>((1u << (n - i)) - 1);
        _mm512_mask_storeu_ps(to + i, there, _mm512_maskz_loadu_ps(there, from + i));
    }
    ISOTET_AVX512 static void copy(const double* from, std::size_t n, double* to) { Portable::copy(from, n, to); }

    template <class Local>
    ISOTET_AVX512 static void number(const Local* local, std::size_t n, std::size_t listed, std::uint64_t first,
                                     const std::uint32_t* numbers, std::uint32_t* out) {
        const __m512i before = _mm512_set1_epi32(static_cast<int>(first)),
                      end = _mm512_set1_epi32(static_cast<int>(listed));
        // Mostly there are no more others than two registers hold. Behind them anything may stand, but it can be read.
        const __m512i low = _mm512_loadu_si512(numbers + listed), high = _mm512_loadu_si512(numbers + listed + 16);
        for (std::size_t i = 0; i < n; i += 16) {
            const __mmask16 there = n - i >= 16 ? 0xffff : static_cast<__mmask16>((1u << (n - i)) - 1);
            __m512i index;
            if constexpr (sizeof(Local) == 1) index = _mm512_cvtepu8_epi32(_mm_maskz_loadu_epi8(there, local + i));
            else index = _mm512_cvtepu16_epi32(_mm256_maskz_loadu_epi16(there, local + i));
            const __mmask16 others = _mm512_mask_cmpge_epu32_mask(there, index, end);
            const __m512i own = _mm512_add_epi32(index, before), other = _mm512_sub_epi32(index, end);
            __m512i number = _mm512_mask_mov_epi32(own, others, _mm512_permutex2var_epi32(low, other, high));
            const __mmask16 far = _mm512_mask_cmpge_epu32_mask(others, other, _mm512_set1_epi32(32));
            if (far) number = _mm512_mask_i32gather_epi32(number, far, index, numbers, 4);
            _mm512_mask_storeu_epi32(out + i, there, number);
        }
    }
    template <class Local>
    ISOTET_AVX512 static void number(const Local* local, std::size_t n, std::size_t listed, std::uint64_t first,
                                     std::uint64_t* numbers, std::uint64_t* out) {
        Portable::number(local, n, listed, first, numbers, out);
    }

    static constexpr auto first_numbers = [] {
        std::array<std::uint8_t, 64> numbers{};
        for (std::size_t i = 0; i < 64; ++i) numbers[i] = static_cast<std::uint8_t>(i);
        return numbers;
    }();
    static_assert(core::max_cluster_points == 128, "two registers of 64 bytes, keys of 7 + 7 bits");
};

} // namespace isotet::cpu

#endif
