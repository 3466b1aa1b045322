// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/parallel.hpp"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace isotet::core {

void with_threads(int threads, const std::function<void()>& work) {
    const int count = threads > 0 ? threads : tbb::info::default_concurrency();
    // An arena alone never gets more workers than there are cores.
    tbb::global_control allow(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
    tbb::task_arena arena(count);
    arena.execute(work);
}

void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
    if (count <= grain) {
        if (count) body(0, count);
        return;
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
}

} // namespace isotet::core
