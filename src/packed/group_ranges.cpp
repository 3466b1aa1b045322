// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/group_ranges.hpp"

#include <algorithm>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "numbers/level.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t group_corners = 4 * group_size;

/// Looks the steps up one by one, so that what is left of the work can be done sixteen bytes at a time.
void find_portable(const StoredTet* tets, std::size_t groups, const PointSteps& lower, const PointSteps& upper,
                   GroupRange* out) {
    for (std::size_t g = 0; g < groups; ++g, tets += group_size) {
        std::array<std::uint8_t, group_corners> low, high;
        for (std::size_t i = 0; i < group_corners; ++i) {
            const std::uint8_t corner = tets[i / 4].corners[i % 4];
            low[i] = lower[corner];
            high[i] = upper[corner];
        }
        for (std::size_t half = group_corners / 2; half > 0; half /= 2)
            for (std::size_t i = 0; i < half; ++i) {
                low[i] = std::min(low[i], low[i + half]);
                high[i] = std::max(high[i], high[i + half]);
            }
        out[g] = {low[0], high[0]};
    }
}

#if defined(__x86_64__)

#define ISOTET_AVX2 [[gnu::target("avx2")]]
#define ISOTET_AVX512 [[gnu::target("avx512f,avx512bw,avx512vl,avx512vbmi")]]

ISOTET_AVX2 std::uint8_t smallest(__m256i bytes) {
    __m128i x = _mm_min_epu8(_mm256_castsi256_si128(bytes), _mm256_extracti128_si256(bytes, 1));
    x = _mm_min_epu8(x, _mm_srli_epi16(x, 8)); // of two neighbours, in the lower; the upper becomes 0 or more
    return static_cast<std::uint8_t>(_mm_cvtsi128_si32(_mm_minpos_epu16(_mm_and_si128(x, _mm_set1_epi16(0xff)))));
}

ISOTET_AVX2 std::uint8_t largest(__m256i bytes) {
    return static_cast<std::uint8_t>(255 - smallest(_mm256_xor_si256(bytes, _mm256_set1_epi8(-1))));
}

/// A table of 128 bytes in eight registers, sixteen bytes twice in each.
struct Table {
    __m256i parts[8];

    ISOTET_AVX2 explicit Table(const PointSteps& steps) {
        for (std::size_t k = 0; k < 8; ++k)
            parts[k] =
                _mm256_broadcastsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(steps.data() + 16 * k)));
    }
    /// A shuffle gives 0 where the top bit of an index is set: so it is set for every part but the one that is meant.
    ISOTET_AVX2 __m256i look_up(__m256i indices) const {
        __m256i found = _mm256_setzero_si256();
        for (std::size_t k = 0; k < 8; ++k) {
            const __m256i inside =
                _mm256_xor_si256(indices, _mm256_set1_epi8(static_cast<char>(16 * k))); // below 16 in part k
            found =
                _mm256_or_si256(found, _mm256_shuffle_epi8(parts[k], _mm256_adds_epu8(inside, _mm256_set1_epi8(0x70))));
        }
        return found;
    }
};

ISOTET_AVX2 void find_avx2(const StoredTet* tets, std::size_t groups, const PointSteps& lower, const PointSteps& upper,
                           GroupRange* out) {
    const Table low(lower), high(upper);
    for (std::size_t g = 0; g < groups; ++g, tets += group_size) {
        __m256i least = _mm256_set1_epi8(-1), most = _mm256_setzero_si256();
        for (std::size_t i = 0; i < group_size; i += 8) {
            const __m256i corners = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(tets + i));
            least = _mm256_min_epu8(least, low.look_up(corners));
            most = _mm256_max_epu8(most, high.look_up(corners));
        }
        out[g] = {smallest(least), largest(most)};
    }
}

ISOTET_AVX512 void find_avx512(const StoredTet* tets, std::size_t groups, const PointSteps& lower,
                               const PointSteps& upper, GroupRange* out) {
    const __m512i low_0 = _mm512_loadu_si512(lower.data()), low_1 = _mm512_loadu_si512(lower.data() + 64);
    const __m512i high_0 = _mm512_loadu_si512(upper.data()), high_1 = _mm512_loadu_si512(upper.data() + 64);
    for (std::size_t g = 0; g < groups; ++g, tets += group_size) {
        const __m512i a = _mm512_loadu_si512(tets), b = _mm512_loadu_si512(tets + group_size / 2);
        const __m512i least =
            _mm512_min_epu8(_mm512_permutex2var_epi8(low_0, a, low_1), _mm512_permutex2var_epi8(low_0, b, low_1));
        const __m512i most =
            _mm512_max_epu8(_mm512_permutex2var_epi8(high_0, a, high_1), _mm512_permutex2var_epi8(high_0, b, high_1));
        out[g] = {smallest(_mm256_min_epu8(_mm512_castsi512_si256(least), _mm512_extracti64x4_epi64(least, 1))),
                  largest(_mm256_max_epu8(_mm512_castsi512_si256(most), _mm512_extracti64x4_epi64(most, 1)))};
    }
}

#undef ISOTET_AVX2
#undef ISOTET_AVX512

#endif

void find_whole(const StoredTet* words, std::size_t groups, const PointSteps& lower, const PointSteps& upper,
                GroupRange* out) {
    switch (level()) {
#if defined(__x86_64__)
    case Level::avx512: return find_avx512(words, groups, lower, upper, out);
    case Level::avx2: return find_avx2(words, groups, lower, upper, out);
#endif
    default: return find_portable(words, groups, lower, upper, out);
    }
}

} // namespace

void find_group_ranges(std::span<const StoredTet> words, const PointSteps& lower, const PointSteps& upper,
                       GroupRange* out) {
    const std::size_t whole = words.size() / group_size;
    find_whole(words.data(), whole, lower, upper, out);
    if (whole * group_size == words.size()) return;
    std::array<StoredTet, group_size> last;
    last.fill(words.back());
    std::ranges::copy(words.subspan(whole * group_size), last.begin());
    find_whole(last.data(), 1, lower, upper, out + whole);
}

static_assert(max_cluster_points == 128 && group_size == 32, "tables of 128 bytes, registers of 64");

} // namespace isotet::core
