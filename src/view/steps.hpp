// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Time steps of a file, the next one read ahead.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <future>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::view {

/// Reads a time step with all fields. One call at a time, by any thread.
using ReadStep = std::function<Result<Grid>(std::size_t step, const Run& run)>;

/// Threads   one call at a time
class StepReader {
public:
    StepReader(ReadStep read, int threads) : read_(std::move(read)), threads_(threads) {}
    StepReader(const StepReader&) = delete;
    StepReader& operator=(const StepReader&) = delete;
    ~StepReader();

    /// The grid of a step: at once where it was read ahead.
    /// Errors   of reading; cancelled
    Result<Grid> take(std::size_t step, const Run& run);

    /// Begins to read a step, unless one is being read ahead already.
    void read_ahead(std::size_t step);

private:
    void stop();

    ReadStep read_;
    int threads_;
    std::future<Result<Grid>> ahead_;
    std::size_t ahead_step_ = 0;
    std::atomic<bool> cancel_{false};
};

} // namespace isotet::view
