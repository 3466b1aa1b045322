// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <string_view>

namespace isotet {

/// How a long operation tells how far it is, and how it is told to stop. Every operation that can last over a second
/// takes one; a default-made Progress reports nothing and is never cancelled.
struct Progress {
    /// Called with the step ("read", "pack", "extract", "write") and the fraction done, 0 to 1.
    /// It may be called from any thread of the operation, one call at a time, and within a step the fraction never
    /// falls; keep it short. May be empty.
    std::function<void(std::string_view step, double fraction)> report;

    /// When not null and set to true (by any thread, or a signal handler), the operation ends within a fraction of a
    /// second with ErrorCode::cancelled and leaves no file behind. Borrowed: must outlive the operation.
    const std::atomic<bool>* cancel = nullptr;

    bool cancelled() const noexcept { return cancel && cancel->load(std::memory_order_relaxed); }
    void operator()(std::string_view step, double fraction) const {
        if (report) report(step, fraction);
    }
};

/// How a call is carried out.
struct Run {
    int threads = 0; ///< at most; 0: those of the caller's oneTBB arena, outside of one all
    Progress progress = {};
};

} // namespace isotet
