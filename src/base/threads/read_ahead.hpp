// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is read step by step, the next step by a thread of its own.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <future>
#include <utility>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::core {

/// Threads   one call at a time
template <class T>
class ReadAhead {
public:
    /// Reads a step. One call at a time, by any thread.
    using Read = std::function<Result<T>(std::size_t step, const Run& run)>;

    ReadAhead(Read read, int threads) : read_(std::move(read)), threads_(threads) {}
    ReadAhead(const ReadAhead&) = delete;
    ReadAhead& operator=(const ReadAhead&) = delete;
    ~ReadAhead() { stop(); }

    /// A step: at once where it was read ahead.
    /// Errors   of reading; cancelled
    Result<T> take(std::size_t step, const Run& run) {
        if (!ahead_.valid() || ahead_step_ != step) {
            stop();
            return read_(step, run);
        }
        while (ahead_.wait_for(std::chrono::milliseconds(2)) != std::future_status::ready)
            if (run.progress.cancelled()) return Error{ErrorCode::cancelled, "cancelled"};
        return ahead_.get();
    }

    /// Begins to read a step, unless one is being read ahead already.
    void read_ahead(std::size_t step) {
        if (ahead_.valid()) {
            if (ahead_step_ == step || ahead_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
            ahead_ = {};
        }
        cancel_ = false;
        ahead_step_ = step;
        ahead_ = std::async(std::launch::async, [this, step] { return read_(step, Run{threads_, {{}, &cancel_}}); });
    }

private:
    void stop() {
        if (!ahead_.valid()) return;
        cancel_ = true;
        ahead_.wait();
        ahead_ = {};
    }

    Read read_;
    int threads_;
    std::future<Result<T>> ahead_;
    std::size_t ahead_step_ = 0;
    std::atomic<bool> cancel_{false};
};

} // namespace isotet::core
