// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/radix_sort.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/workers.hpp"

namespace isotet::core {

namespace {

constexpr int max_digit_bits = 11; // 2,048 parts: as many lines as the first cache holds twice over
constexpr std::size_t insertion_limit = 24;
constexpr std::size_t parallel_limit = std::size_t{1} << 18;

/// The digit by which a part is split: the highest bits in which its keys differ.
struct Digit {
    int shift;
    std::size_t mask;
    std::size_t of(const Keyed& item) const { return item.key >> shift & mask; }
};

Digit digit_for(std::uint64_t differing, int bits) {
    const int shift = std::max(static_cast<int>(std::bit_width(differing)) - bits, 0);
    return {shift, (std::size_t{1} << bits) - 1};
}

/// The two places of a part: where it is now, and the other one. In the end it is to be in `home`, which is one of
/// them.
struct Part {
    Keyed* here;
    Keyed* there;
    Keyed* home;
    std::size_t size;

    Part moved(std::size_t from, std::size_t count) const { return {there + from, here + from, home + from, count}; }
};

void bring_home(const Part& part) {
    if (part.here != part.home) std::copy(part.here, part.here + part.size, part.home);
}

void insertion_sort(const Part& part) {
    for (std::size_t i = 1; i < part.size; ++i) {
        const Keyed item = part.here[i];
        std::size_t at = i;
        for (; at > 0 && part.here[at - 1].key > item.key; --at) part.here[at] = part.here[at - 1];
        part.here[at] = item;
    }
}

void sort_serial(const Part& part) {
    if (part.size <= insertion_limit) {
        insertion_sort(part);
        bring_home(part);
        return;
    }
    std::uint64_t differing = 0;
    for (std::size_t i = 1; i < part.size; ++i) differing |= part.here[i].key ^ part.here[0].key;
    if (differing == 0) {
        bring_home(part);
        return;
    }
    const Digit digit =
        digit_for(differing, std::min<int>(max_digit_bits, static_cast<int>(std::bit_width(part.size)) - 2));
    std::array<std::uint32_t, (std::size_t{1} << max_digit_bits) + 1> next;
    std::fill_n(next.begin(), digit.mask + 2, 0);
    for (std::size_t i = 0; i < part.size; ++i) ++next[digit.of(part.here[i]) + 1];
    for (std::size_t d = 0; d < digit.mask; ++d) next[d + 1] += next[d];
    for (std::size_t i = 0; i < part.size; ++i) part.there[next[digit.of(part.here[i])]++] = part.here[i];
    std::size_t begin = 0;
    for (std::size_t d = 0; d <= digit.mask; ++d) { // next[d] is now where part d ends
        if (next[d] > begin) sort_serial(part.moved(begin, next[d] - begin));
        begin = next[d];
    }
}

std::uint64_t differing_bits(const Part& part) {
    std::atomic<std::uint64_t> differing{0};
    worker_ranges(part.size, 1 << 16, [&](std::size_t begin, std::size_t end) {
        std::uint64_t bits = 0;
        for (std::size_t i = begin; i < end; ++i) bits |= part.here[i].key ^ part.here[0].key;
        differing.fetch_or(bits, std::memory_order_relaxed);
    });
    return differing;
}

/// Splits the part by its highest digit, chunks of it at the same time. Returns where each digit's items end up, and
/// the whole size behind them.
std::vector<std::size_t> split_parallel(const Part& part, Digit digit) {
    const std::size_t digits = digit.mask + 1;
    const std::size_t chunks = std::clamp<std::size_t>(part.size >> 16, 1, 64);
    const auto chunk_begin = [&](std::size_t chunk) {
        return part.size / chunks * chunk + std::min(chunk, part.size % chunks);
    };
    std::vector<std::size_t> next(chunks * digits, 0);
    worker_each(chunks, 1, [&](std::size_t chunk) {
        std::size_t* const count = next.data() + chunk * digits;
        for (std::size_t i = chunk_begin(chunk); i < chunk_begin(chunk + 1); ++i) ++count[digit.of(part.here[i])];
    });
    std::vector<std::size_t> begin(digits + 1);
    std::size_t sum = 0;
    for (std::size_t d = 0; d < digits; ++d) {
        begin[d] = sum;
        for (std::size_t chunk = 0; chunk < chunks; ++chunk) sum += std::exchange(next[chunk * digits + d], sum);
    }
    begin[digits] = sum;
    worker_each(chunks, 1, [&](std::size_t chunk) {
        std::size_t* const to = next.data() + chunk * digits;
        for (std::size_t i = chunk_begin(chunk); i < chunk_begin(chunk + 1); ++i)
            part.there[to[digit.of(part.here[i])]++] = part.here[i];
    });
    return begin;
}

void sort_parallel(const Part& part) {
    if (part.size <= parallel_limit) return sort_serial(part);
    const std::uint64_t differing = differing_bits(part);
    if (differing == 0) {
        bring_home(part);
        return;
    }
    const std::vector<std::size_t> begin = split_parallel(part, digit_for(differing, max_digit_bits));
    const auto part_of = [&](std::size_t d) { return part.moved(begin[d], begin[d + 1] - begin[d]); };
    worker_each(begin.size() - 1, 1, [&](std::size_t d) {
        if (part_of(d).size <= parallel_limit) sort_serial(part_of(d));
    });
    for (std::size_t d = 0; d + 1 < begin.size(); ++d)
        if (part_of(d).size > parallel_limit) sort_parallel(part_of(d));
}

} // namespace

void radix_sort(std::span<Keyed> items, std::span<Keyed> scratch) {
    if (!items.empty()) sort_parallel({items.data(), scratch.data(), items.data(), items.size()});
}

} // namespace isotet::core
