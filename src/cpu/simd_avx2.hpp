// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The small loops of the plain path with AVX2. A table of 128 bits (one a point) is looked up by shuffling its 16 bytes
// and testing one bit of the byte found.
// Functions carry their instruction set as an attribute, so that nothing else in the program is compiled for it.
#pragma once

#if defined(__x86_64__)

#include <immintrin.h>

#include "cpu/simd_portable.hpp"

#define ISOTET_AVX2 [[gnu::target("avx2,bmi,bmi2,popcnt")]]

namespace isotet::cpu {

struct Avx2 {
    ISOTET_AVX2 static bool classify(const float* values, std::size_t n, const core::StoredIsovalue<float>& isovalue,
                                     std::uint8_t* above) {
        const __m256 level = _mm256_set1_ps(isovalue.value), tied = _mm256_set1_ps(isovalue.tied);
        bool special = false;
        std::size_t k = 0;
        for (; k + 8 <= n; k += 8) {
            const __m256 x = _mm256_loadu_ps(values + k);
            const __m128i is_above = halves(_mm256_castps_si256(_mm256_cmp_ps(x, level, _CMP_GE_OQ)));
            special |= _mm256_movemask_ps(_mm256_cmp_ps(x, tied, _CMP_EQ_UQ)) != 0; // tied, or not a number
            _mm_storel_epi64(reinterpret_cast<__m128i*>(above + k),
                             _mm_and_si128(_mm_packs_epi16(is_above, is_above), _mm_set1_epi8(1)));
        }
        return special | Portable::classify(values + k, n - k, isovalue, above + k);
    }

    ISOTET_AVX2 static void cut(const std::uint8_t* above, const core::StoredTet* tets, std::size_t n,
                                std::size_t first, CutTets& out) {
        const __m256i table = table_of(above);
        const __m256i weights = _mm256_set1_epi32(0x08040201);
        for (std::size_t i = 0; i < n; i += 8) {
            const __m256i corners =
                _mm256_loadu_si256(reinterpret_cast<const __m256i*>(tets + i)); // what stands behind may be read
            const __m256i sides = look_up(table, corners);
            const __m256i index = _mm256_madd_epi16(_mm256_maddubs_epi16(sides, weights), _mm256_set1_epi16(1));
            // 1 to 14 are cut: neither 0 nor 15.
            const __m256i uncut = _mm256_or_si256(_mm256_cmpeq_epi32(index, _mm256_setzero_si256()),
                                                  _mm256_cmpeq_epi32(index, _mm256_set1_epi32(15)));
            unsigned is_cut = ~static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(uncut))) & 0xff;
            if (n - i < 8) is_cut &= (1u << (n - i)) - 1;
            if (!is_cut) continue;
            const __m128i lanes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(lanes_of[is_cut].data()));
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.corners.data() + out.count),
                                _mm256_permutevar8x32_epi32(corners, _mm256_cvtepu8_epi32(lanes)));
            const __m128i indices = _mm_packus_epi16(halves(index), halves(index));
            _mm_storel_epi64(reinterpret_cast<__m128i*>(out.cases.data() + out.count),
                             _mm_shuffle_epi8(indices, lanes));
            const __m128i place =
                _mm_add_epi16(_mm_cvtepu8_epi16(lanes), _mm_set1_epi16(static_cast<short>(first + i)));
            _mm_storeu_si128(reinterpret_cast<__m128i*>(out.places.data() + out.count), place);
            out.count += static_cast<std::size_t>(_mm_popcnt_u32(is_cut));
        }
    }

    ISOTET_AVX2 static std::size_t cross_seams(const std::uint8_t* above, std::span<const core::SeamEdge> seams,
                                               std::uint64_t* mask, VertexKey* out) {
        const __m256i table = table_of(above);
        std::fill_n(mask, core::words_of_bits(seams.size()), std::uint64_t{0});
        std::size_t count = 0, k = 0;
        for (; k + 16 <= seams.size(); k += 16) {
            const __m256i edges = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(seams.data() + k));
            const __m256i sides = look_up(table, edges);
            const __m256i differ =
                _mm256_and_si256(_mm256_xor_si256(sides, _mm256_srli_epi16(sides, 8)), _mm256_set1_epi16(1));
            const __m128i bytes = _mm_packus_epi16(_mm256_castsi256_si128(differ), _mm256_extracti128_si256(differ, 1));
            const auto bits = static_cast<unsigned>(_mm_movemask_epi8(_mm_slli_epi16(bytes, 7)));
            mask[k / 64] |= std::uint64_t{bits} << k % 64;
            const __m256i lower = _mm256_and_si256(edges, _mm256_set1_epi16(0xff));
            const __m256i keys = _mm256_or_si256(_mm256_slli_epi16(lower, 7), _mm256_srli_epi16(edges, 8));
            count += compress(_mm256_castsi256_si128(keys), bits & 0xff, out + count);
            count += compress(_mm256_extracti128_si256(keys, 1), bits >> 8, out + count);
        }
        for (; k < seams.size(); ++k) {
            const std::uint64_t crossed = above[seams[k].lower] ^ above[seams[k].higher];
            mask[k / 64] |= crossed << k % 64;
            out[count] = edge_key(seams[k]);
            count += crossed;
        }
        return count;
    }

    ISOTET_AVX2 static void find_owners(const core::ClusterLinks& links, const std::uint64_t* crossed,
                                        const std::uint32_t* base, std::uint32_t isovalue, SharedVertex* out) {
        Portable::find_owners(links, crossed, base, isovalue, out);
    }

    ISOTET_AVX2 static std::size_t list_keys(KeyTable& used, VertexKey* out) {
        return Portable::list_keys<Avx2>(used, out);
    }
    ISOTET_AVX2 static std::uint64_t ones(const std::uint8_t* bytes) {
        const __m256i low = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(bytes));
        const __m256i high = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(bytes + 32));
        return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_slli_epi16(low, 7))) |
               std::uint64_t{static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_slli_epi16(high, 7)))} << 32;
    }

    ISOTET_AVX2 static void keys(CutTets& cut, VertexKey* out) {
        for (std::size_t i = 0; i < cut.count; ++i, out += 4) {
            cut.triangles[i] = core::case_table[cut.cases[i]].triangles;
            write_keys(_mm_cvtsi32_si128(static_cast<int>(cut.corners[i])), polygon_bytes[cut.cases[i]].data(), out);
        }
    }

    template <core::CellKind kind>
    ISOTET_AVX2 static void cut_cells(const std::uint8_t* above, const core::StoredTet* words, std::size_t n,
                                      std::size_t first, CutCells& out) {
        constexpr char all = static_cast<char>((1u << core::corner_count(kind)) - 1);
        const __m256i table = table_of(above);
        for (std::size_t i = 0; i < n; i += 4) {
            const __m256i corners =
                _mm256_loadu_si256(reinterpret_cast<const __m256i*>(words + 2 * i)); // what stands behind may be read
            // A bit for each of four times eight corners: the cases.
            const __m128i cases =
                _mm_and_si128(_mm_cvtsi32_si128(_mm256_movemask_epi8(_mm256_slli_epi16(look_up(table, corners), 7))),
                              _mm_set1_epi8(all));
            const __m128i uncut =
                _mm_or_si128(_mm_cmpeq_epi8(cases, _mm_setzero_si128()), _mm_cmpeq_epi8(cases, _mm_set1_epi8(all)));
            unsigned is_cut = ~static_cast<unsigned>(_mm_movemask_epi8(uncut)) & 0xf;
            if (n - i < 4) is_cut &= (1u << (n - i)) - 1;
            const __m128i lanes = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(lanes_of[is_cut].data()));
            const __m128i halves_of_lanes =
                _mm_loadl_epi64(reinterpret_cast<const __m128i*>(lane_pairs_of[is_cut].data()));
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(out.corners.data() + out.count),
                                _mm256_permutevar8x32_epi32(corners, _mm256_cvtepu8_epi32(halves_of_lanes)));
            const int of_lanes = _mm_cvtsi128_si32(_mm_shuffle_epi8(cases, lanes));
            std::memcpy(out.cases.data() + out.count, &of_lanes, sizeof of_lanes);
            const __m128i place = _mm_add_epi16(_mm_slli_epi16(_mm_cvtepu8_epi16(lanes), 1),
                                                _mm_set1_epi16(static_cast<short>(first + 2 * i)));
            _mm_storel_epi64(reinterpret_cast<__m128i*>(out.places.data() + out.count), place);
            out.count += static_cast<std::size_t>(_mm_popcnt_u32(is_cut));
        }
    }

    template <core::CellKind kind>
    ISOTET_AVX2 static void polygons(const CutCells& cells, CutTets& out, VertexKey* keys) {
        constexpr auto& cases = core::cases_of<kind>().cases;
        std::size_t count = out.count;
        for (std::size_t i = 0; i < cells.count; ++i) {
            const core::CellCase c = cases[cells.cases[i]];
            const __m128i v = _mm_cvtsi64_si128(static_cast<long long>(cells.corners[i]));
            // Nearly all have one or two: both are written, and as many counted as there are.
            for (std::size_t k = 0; k < 2; ++k) {
                write_keys(v, polygon_shuffles<kind>[c.first + k].data(), keys + 4 * (count + k));
                out.triangles[count + k] = polygon_triangles<kind>[c.first + k];
                out.places[count + k] = cells.places[i];
            }
            for (std::size_t k = 2; k < c.polygons; ++k) {
                write_keys(v, polygon_shuffles<kind>[c.first + k].data(), keys + 4 * (count + k));
                out.triangles[count + k] = polygon_triangles<kind>[c.first + k];
                out.places[count + k] = cells.places[i];
            }
            count += c.polygons;
        }
        out.count = count;
    }

    ISOTET_AVX2 static void cross(const VertexKey* edges, std::size_t n, const std::uint8_t* above, const float* values,
                                  const core::StoredIsovalue<float>& isovalue, EndPair* ends, float* weights) {
        const __m256 level = _mm256_set1_ps(isovalue.value), rest = _mm256_set1_ps(isovalue.rest);
        const __m256i table = table_of(above);
        for (std::size_t i = 0; i < n; i += 8) {
            const __m256i key = _mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(edges + i)));
            // Behind the last edge stand numbers that are none: they must not be looked up outside of the table.
            const __m256i a = _mm256_and_si256(_mm256_srli_epi32(key, 7), _mm256_set1_epi32(127));
            const __m256i b = _mm256_and_si256(key, _mm256_set1_epi32(127));
            const __m256i a_is_above =
                _mm256_cmpeq_epi32(_mm256_and_si256(look_up(table, a), _mm256_set1_epi32(1)), _mm256_set1_epi32(1));
            const __m256i below = _mm256_blendv_epi8(a, b, a_is_above),
                          end_above = _mm256_blendv_epi8(b, a, a_is_above);
            const __m256i pairs = _mm256_or_si256(below, _mm256_slli_epi32(end_above, 8));
            _mm_storeu_si128(reinterpret_cast<__m128i*>(ends + i), halves(pairs));
            const __m256 value_below = _mm256_i32gather_ps(values, below, 4),
                         value_above = _mm256_i32gather_ps(values, end_above, 4);
            const __m256 part = _mm256_add_ps(_mm256_sub_ps(level, value_below), rest);
            const __m256 t = _mm256_div_ps(part, _mm256_sub_ps(value_above, value_below));
            const __m256 large = _mm256_cmp_ps(t, _mm256_set1_ps(0x1p-32f), _CMP_NLT_UQ);
            _mm256_storeu_ps(weights + i, _mm256_and_ps(t, large));
        }
    }

    ISOTET_AVX2 static void place(const EndPositions<float>* ends, const float* weights, std::size_t n, float* out) {
        // The last position of all has nothing behind it: three numbers are loaded, not four.
        const __m128i three = _mm_setr_epi32(-1, -1, -1, 0);
        for (std::size_t i = 0; i < n; ++i, out += 3) {
            const __m128 a = _mm_maskload_ps(ends[i].below, three);
            const __m128 b = _mm_maskload_ps(ends[i].above, three);
            const __m128 t = _mm_set1_ps(weights[i]);
            const __m128 between = _mm_add_ps(a, _mm_mul_ps(t, _mm_sub_ps(b, a)));
            _mm_storeu_ps(out, _mm_blendv_ps(between, b, _mm_cmpeq_ps(t, _mm_set1_ps(1))));
        }
    }

    ISOTET_AVX2 static void copy(const float* from, std::size_t n, float* to) {
        std::size_t i = 0;
        for (; i + 8 <= n; i += 8) _mm256_storeu_ps(to + i, _mm256_loadu_ps(from + i));
        for (; i < n; ++i) to[i] = from[i];
    }
    ISOTET_AVX2 static void copy(const double* from, std::size_t n, double* to) { Portable::copy(from, n, to); }

    template <class Local, class Index>
    ISOTET_AVX2 static void number(const Local* local, std::size_t n, std::size_t listed, std::uint64_t first,
                                   Index* numbers, Index* out) {
        Portable::number(local, n, listed, first, numbers, out);
    }

private:
    /// The keys of four edges, by a shuffle of a cell's corners that gives the corners above, then those below.
    ISOTET_AVX2 static void write_keys(__m128i corners, const std::uint8_t* shuffle, VertexKey* out) {
        const __m128i ends = _mm_shuffle_epi8(corners, _mm_loadl_epi64(reinterpret_cast<const __m128i*>(shuffle)));
        const __m128i others = _mm_srli_epi64(ends, 32);
        const __m128i lower = _mm_cvtepu8_epi16(_mm_min_epu8(ends, others)),
                      higher = _mm_cvtepu8_epi16(_mm_max_epu8(ends, others));
        _mm_storel_epi64(reinterpret_cast<__m128i*>(out), _mm_or_si128(_mm_slli_epi16(lower, 7), higher));
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
    /// For each mask of eight lanes, those that it has.
    static constexpr auto lanes_of = [] {
        std::array<std::array<std::uint8_t, 8>, 256> lanes{};
        for (std::size_t mask = 0; mask < 256; ++mask)
            for (std::uint8_t lane = 0, n = 0; lane < 8; ++lane)
                if (mask >> lane & 1) lanes[mask][n++] = lane;
        return lanes;
    }();

    /// For each mask of four lanes of eight bytes, those that it has, as lanes of four.
    static constexpr auto lane_pairs_of = [] {
        std::array<std::array<std::uint8_t, 8>, 16> lanes{};
        for (std::size_t mask = 0; mask < 16; ++mask)
            for (std::uint8_t lane = 0, n = 0; lane < 4; ++lane)
                if (mask >> lane & 1) {
                    lanes[mask][n++] = 2 * lane;
                    lanes[mask][n++] = 2 * lane + 1;
                }
        return lanes;
    }();

    /// Writes those of eight keys that the mask has, and more behind them; returns how many it has.
    ISOTET_AVX2 static std::size_t compress(__m128i keys, unsigned mask, VertexKey* out) {
        const __m128i lanes =
            _mm_cvtepu8_epi16(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(lanes_of[mask].data())));
        // From lanes of two bytes to bytes: 2 * lane, then 2 * lane + 1.
        const __m128i bytes = _mm_add_epi16(_mm_mullo_epi16(lanes, _mm_set1_epi16(0x0202)), _mm_set1_epi16(0x0100));
        _mm_storeu_si128(reinterpret_cast<__m128i*>(out), _mm_shuffle_epi8(keys, bytes));
        return static_cast<std::size_t>(_mm_popcnt_u32(mask));
    }
    /// The lower halves of eight numbers below 2^15.
    ISOTET_AVX2 static __m128i halves(__m256i x) {
        return _mm_packs_epi32(_mm256_castsi256_si128(x), _mm256_extracti128_si256(x, 1));
    }
    /// Bits of the 128 sides in 16 bytes, twice.
    ISOTET_AVX2 static __m256i table_of(const std::uint8_t* above) {
        // In registers: what was stored in parts would have to be waited for.
        return _mm256_broadcastsi128_si256(_mm_setr_epi32(sides_of_32(above), sides_of_32(above + 32),
                                                          sides_of_32(above + 64), sides_of_32(above + 96)));
    }
    ISOTET_AVX2 static int sides_of_32(const std::uint8_t* above) {
        const __m256i sides = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(above));
        return _mm256_movemask_epi8(_mm256_slli_epi16(sides, 7));
    }
    /// Each byte of the result is 1 or 0, the table's bit for that byte of `indices`.
    ISOTET_AVX2 static __m256i look_up(__m256i table, __m256i indices) {
        const __m256i seven = _mm256_set1_epi8(7);
        const __m256i byte =
            _mm256_shuffle_epi8(table, _mm256_and_si256(_mm256_srli_epi16(indices, 3), _mm256_set1_epi8(15)));
        const __m256i bit = _mm256_shuffle_epi8(_mm256_set1_epi64x(static_cast<long long>(0x8040201008040201u)),
                                                _mm256_and_si256(indices, seven));
        return _mm256_min_epu8(_mm256_and_si256(byte, bit), _mm256_set1_epi8(1));
    }
};

} // namespace isotet::cpu

#endif
