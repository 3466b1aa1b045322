// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Workers of JavaScript (js/isotet_threads.js) that help the thread that JavaScript calls. They wait in
// wait_for_work(), come in through a door where there is a job, and go out when all of its pieces are taken; the first
// thread takes pieces as well, closes the door, and waits until all are out. It spins: that of a page must not sleep.
// What is waited for may have trapped, so every loop that waits looks at `failed`.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace web_workers {

constexpr unsigned max_threads = 16; ///< with the first one

inline constinit thread_local unsigned here = 0;   ///< number of the thread; 0: the first
inline constinit std::atomic<unsigned> threads{1}; ///< that there are
inline constinit std::atomic<bool> failed{false};  ///< a worker has trapped
inline constinit bool is_sharing = false;          ///< the first thread's: it is within share()
inline constinit std::atomic<int> calls{0};        ///< changes when there is a job
inline constinit std::atomic<unsigned> door{0};    ///< workers that are in; with `open` there is a job
constexpr unsigned open = 1U << 31U;

inline constinit std::atomic<std::size_t> next_piece{0};
inline constinit std::size_t pieces = 0; ///< these are set while the door is closed and no worker is in
inline constinit const void* job = nullptr;
inline constinit void (*do_piece)(const void* job, std::size_t piece) = nullptr;

inline bool in_job() { return here != 0 || is_sharing; }

inline void take_pieces() {
    for (std::size_t i = next_piece.fetch_add(1); i < pieces; i = next_piece.fetch_add(1)) do_piece(job, i);
}

/// Ends the call if a worker has trapped.
inline void stop_if_failed() {
    if (failed.load()) __builtin_trap();
}

/// Returns when no worker is in, and traps where that takes too long: a worker may have been ended from outside.
void wait_for_workers();

/// Of a worker, for ever.
[[noreturn]] void wait_for_work(unsigned number);

/// Calls one(piece) for all pieces.
template <class One>
void share(std::size_t count, const One& one) {
    if (count <= 1 || in_job() || threads.load() <= 1) {
        for (std::size_t i = 0; i < count; ++i) one(i);
        return;
    }
    stop_if_failed();
    do_piece = [](const void* what, std::size_t i) { (*static_cast<const One*>(what))(i); };
    job = &one;
    pieces = count;
    next_piece.store(0);
    is_sharing = true;
    door.fetch_or(open);
    calls.fetch_add(1);
    __builtin_wasm_memory_atomic_notify(reinterpret_cast<int*>(&calls), max_threads);
    take_pieces();
    door.fetch_and(~open);
    wait_for_workers();
    is_sharing = false;
}

/// How many pieces of at least `grain`: several of each thread, for they take different times.
inline std::size_t piece_count(std::size_t count, std::size_t grain) {
    constexpr std::size_t pieces_per_thread = 8;
    return std::clamp<std::size_t>(count / std::max<std::size_t>(1, grain), 1, pieces_per_thread * threads.load());
}

/// Where a piece begins.
inline std::size_t piece_begin(std::size_t count, std::size_t piece, std::size_t of) {
    return static_cast<std::size_t>(std::uint64_t{count} * piece / of);
}

/// Calls body(begin, end) for pieces of [0, count).
template <class Body>
void for_ranges(std::size_t count, std::size_t grain, const Body& body) {
    if (count == 0) return;
    const std::size_t all = piece_count(count, grain);
    share(all, [&](std::size_t i) { body(piece_begin(count, i, all), piece_begin(count, i + 1, all)); });
}

} // namespace web_workers
