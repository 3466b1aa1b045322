// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Computing that cannot be asked to stop, in a process of its own, which can be killed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>

namespace isotet::core {

/// Zeros that a process started by run_apart() shares with this one.
class ISOTET_API SharedMemory {
public:
    explicit SharedMemory(std::size_t bytes);
    ~SharedMemory();
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;

    void* data() const noexcept { return data_; } ///< null where there is no room, or nothing can be shared

private:
    void* data_ = nullptr;
    std::size_t bytes_;
};

enum class Apart : std::uint8_t {
    done,
    cancelled, ///< and the process is gone
    failed,    ///< it ended before the work did: for lack of memory
    refused    ///< no process could be started
};

/// Calls `work` in a copy of this process, and waits for its end or a cancel.
///
/// `work`   computes on memory that there is, and leaves its result in SharedMemory: other threads of this process do
///          not run in the copy, and may hold any lock, that of the heap too; take_pages() takes no lock
ISOTET_API Apart run_apart(const Progress& progress, const std::function<void()>& work);

/// Whether this thread is starting such a process: what is called around fork() then leaves all as it is.
ISOTET_API bool starts_apart() noexcept;

/// Memory for the work of run_apart(), which is given back at its end. Ends the process where there is none.
ISOTET_API void* take_pages(std::size_t bytes);

} // namespace isotet::core
