// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/points/duplicate_points.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <span>

#include "base/dealt.hpp"
#include "base/parallel.hpp"
#include "base/radix_sort.hpp"
#include "numbers/point_hash.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t points_per_bucket = 1 << 14, max_point_buckets = 4096;
constexpr std::size_t points_per_chunk = 1 << 16, max_point_chunks = 256;

/// Among points of one hash, nearly always the same point again and again.
std::uint64_t duplicates_in_run(const PointReader& points, std::span<Keyed> run) {
    const auto at = [&](const Keyed& item) { return points[item.number]; };
    const Point first = at(run[0]);
    if (std::ranges::all_of(run, [&](const Keyed& item) { return at(item) == first; })) return run.size() - 1;
    std::ranges::sort(run, {}, at);
    std::uint64_t count = 0;
    for (std::size_t i = 1; i < run.size(); ++i) count += at(run[i - 1]) == at(run[i]);
    return count;
}

std::uint64_t duplicates_in(const PointReader& points, std::span<Keyed> bucket) {
    Buffer<Keyed> scratch(bucket.size());
    radix_sort(bucket, {scratch.data(), scratch.size()});
    std::uint64_t count = 0;
    for (std::size_t begin = 0, end = 0; begin < bucket.size(); begin = end) {
        for (end = begin + 1; end < bucket.size() && bucket[end].key == bucket[begin].key; ++end) {}
        if (end - begin > 1) count += duplicates_in_run(points, bucket.subspan(begin, end - begin));
    }
    return count;
}

} // namespace

std::uint64_t count_duplicates(const PointReader& points, const Buffer<std::uint8_t>& used, const Progress& progress) {
    const int bits =
        static_cast<int>(std::bit_width(std::clamp<std::size_t>(used.size() / points_per_bucket, 1, max_point_buckets)));
    const std::size_t chunks = std::clamp<std::size_t>(used.size() / points_per_chunk, 1, max_point_chunks);
    auto dealt = Dealt<Keyed>::deal(
        chunks, std::size_t{1} << bits,
        [&](std::size_t chunk, auto& dealer) {
            const std::size_t end = chunk + 1 == chunks ? used.size() : used.size() / chunks * (chunk + 1);
            for (std::size_t i = used.size() / chunks * chunk; i < end; ++i) {
                if (!used[i]) continue;
                const std::uint64_t hash = hash_of(points[i]);
                dealer.put(hash >> (64 - bits), [&] { return Keyed{hash, i}; });
            }
        },
        progress);
    std::atomic<std::uint64_t> duplicates{0};
    parallel_each(dealt.buckets(), 1, [&](std::size_t bucket) {
        if (!progress.cancelled()) duplicates += duplicates_in(points, dealt.bucket(bucket));
    });
    return duplicates;
}

} // namespace isotet::core
