// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "bench/copy_bandwidth.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "bench/protocol.hpp"

namespace isotet::bench {

namespace {

constexpr std::size_t array_bytes = std::size_t{256} << 20;
constexpr int passes = 5;

void on_each_thread(int threads, const auto& work) {
    std::vector<std::jthread> running;
    const std::size_t part = array_bytes / static_cast<std::size_t>(threads);
    for (int thread = 0; thread < threads; ++thread)
        running.emplace_back([&work, part, begin = part * static_cast<std::size_t>(thread)] { work(begin, part); });
}

} // namespace

double copy_bandwidth(int threads) {
    const auto from = std::make_unique_for_overwrite<std::byte[]>(array_bytes);
    const auto to = std::make_unique_for_overwrite<std::byte[]>(array_bytes);
    on_each_thread(threads, [&](std::size_t begin, std::size_t size) {
        std::memset(from.get() + begin, 1, size);
        std::memset(to.get() + begin, 0, size);
    });
    double best = 0;
    for (int pass = 0; pass < passes; ++pass) {
        const Stopwatch watch;
        on_each_thread(threads, [&](std::size_t begin, std::size_t size) {
            std::memcpy(to.get() + begin, from.get() + begin, size);
        });
        best = std::max(best, 2.0 * array_bytes / watch.seconds());
    }
    return best;
}

} // namespace isotet::bench
