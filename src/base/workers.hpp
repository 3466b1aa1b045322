// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What WebAssembly's workers may do too (web/workers.cpp): the loops of extraction. Elsewhere they are loops as all
// others.
#pragma once

#include <cstddef>

#include "base/parallel.hpp"
#ifdef ISOTET_WEB_WORKERS
#include <web_workers.h>
#endif

namespace isotet::core {

/// Whether this is one of WebAssembly's workers.
inline bool is_worker() {
#ifdef ISOTET_WEB_WORKERS
    return web_workers::here != 0;
#else
    return false;
#endif
}

/// As parallel_ranges().
///
/// `body`   in a worker takes no lock, reads no file, reports no progress, throws nothing, and neither copies nor drops
///          a std::shared_ptr that others have: the libraries of WebAssembly are built without threads. It may take
///          memory.
template <class Body>
void worker_ranges(std::size_t count, std::size_t grain, const Body& body) {
#ifdef ISOTET_WEB_WORKERS
    web_workers::for_ranges(count, grain, body);
#else
    parallel_ranges(count, grain, body);
#endif
}

/// As parallel_each(); `body` as that of worker_ranges().
template <class Body>
void worker_each(std::size_t count, std::size_t grain, const Body& body) {
    worker_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

} // namespace isotet::core
