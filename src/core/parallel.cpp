// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/parallel.hpp"

#include <algorithm>
#include <mutex>
#include <optional>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace isotet::core {

namespace {

/// An arena alone never gets more workers than there are cores. Of several controls the smallest rules, and calls that
/// run at the same time would slow each other down: so there is one, which only grows.
void allow_threads(int count) {
    static std::mutex mutex;
    static std::optional<tbb::global_control> control;
    static int allowed = tbb::info::default_concurrency();
    const std::lock_guard lock(mutex);
    if (count <= allowed) return;
    control.reset();
    control.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
    allowed = count;
}

} // namespace

void with_threads(int threads, const std::function<void()>& work) {
    constexpr int most = 1024; // an arena takes memory for each thread it may get
    const int count = threads > 0 ? std::min(threads, most) : tbb::info::default_concurrency();
    allow_threads(count);
    tbb::task_arena arena(count);
    arena.execute(work);
}

int threads_here() { return tbb::this_task_arena::max_concurrency(); }

void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
    if (count <= grain) {
        if (count) body(0, count);
        return;
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
}

} // namespace isotet::core
