// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Running work on a given number of threads. The one place that knows how many there are.
#pragma once

#include <cstddef>
#include <functional>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>

namespace isotet::core {

/// Runs `work` in an arena of `threads` threads (0 or less: as many as the caller's arena has; 1024 at most). Parallel
/// algorithms called inside use that many, even more than there are cores; oneTBB's limit for the process is raised as
/// long as the work lasts. The arena is kept for later calls. Work has the default floating-point environment, whatever
/// that of the caller.
ISOTET_API void with_threads(int threads, const std::function<void()>& work);

/// Gives the arenas that no call is in to oneTBB, which else does not end before the process.
ISOTET_API void drop_idle_arenas() noexcept;

/// How many threads parallel algorithms use where this is called.
ISOTET_API int threads_here();

/// Calls body(begin, end) for pieces of [0, count) of about `grain`, in parallel, in any order.
ISOTET_API void parallel_ranges(std::size_t count, std::size_t grain,
                                const std::function<void(std::size_t, std::size_t)>& body);

/// Calls body(begin, end) for pieces of [0, count) of at most `grain`, in parallel, in any order; after a cancel for no
/// further ones.
ISOTET_API void parallel_pieces(std::size_t count, std::size_t grain, const Progress& progress,
                                const std::function<void(std::size_t, std::size_t)>& body);

/// Calls body(index) for every index of [0, count), in parallel; for bodies that are worth a call each.
template <class Body>
void parallel_each(std::size_t count, std::size_t grain, const Body& body) {
    parallel_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

} // namespace isotet::core
