// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Errors of parallel work: of several the one of the lowest place is kept, whichever thread was first.
#pragma once

#include <atomic>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include <isotet/result.hpp>

namespace isotet::io {

class FirstError {
public:
    void add(std::size_t place, Error error) {
        const std::scoped_lock lock(mutex_);
        if (error_ && place >= place_) return;
        place_ = place;
        error_ = std::move(error);
        any_ = true;
    }

    /// Work behind the first error may be left out.
    explicit operator bool() const noexcept { return any_.load(std::memory_order_relaxed); }

    /// When all work is done.
    Result<void> result() const {
        if (error_) return *error_;
        return {};
    }

private:
    std::mutex mutex_;
    std::optional<Error> error_;
    std::size_t place_ = std::numeric_limits<std::size_t>::max();
    std::atomic<bool> any_ = false;
};

} // namespace isotet::io
