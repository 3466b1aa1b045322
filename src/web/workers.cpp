// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a module with workers has beside the others (portable/web_workers.h). The C and C++ libraries were built without
// threads: their memory is behind a lock (the linker gives calls of malloc() to __wrap_malloc()), and so is what static
// variables begin with.
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include <web_workers.h>

namespace web_workers {

void wait_for_workers() {
    using Clock = std::chrono::steady_clock;
    constexpr std::uint64_t turns_per_look = 1U << 20U;
    constexpr std::chrono::seconds most{30}; // they are at their last pieces, which take milliseconds
    Clock::time_point begin;
    for (std::uint64_t turn = 1; door.load() != 0; ++turn) {
        stop_if_failed();
        if (turn % turns_per_look != 0) continue;
        const Clock::time_point now = Clock::now();
        if (turn == turns_per_look) begin = now;
        else if (now - begin > most) failed.store(true);
    }
    stop_if_failed();
}

void wait_for_work(unsigned number) {
    here = number;
    for (int seen = 0;;) {
        __builtin_wasm_memory_atomic_wait32(reinterpret_cast<int*>(&calls), seen, -1);
        seen = calls.load();
        if (door.fetch_add(1) & open) take_pieces();
        door.fetch_sub(1);
    }
}

} // namespace web_workers

namespace {

std::atomic<bool> memory_is_locked{false};

class MemoryLock {
public:
    MemoryLock() {
        while (memory_is_locked.exchange(true)) web_workers::stop_if_failed();
    }
    ~MemoryLock() { memory_is_locked.store(false); }
    MemoryLock(const MemoryLock&) = delete;
    MemoryLock& operator=(const MemoryLock&) = delete;
};

/// Of the guard of a static variable: 0 is set when the variable is made, 1 while a thread makes it.
std::atomic<std::uint8_t>& part(std::uint8_t* guard, std::size_t which) {
    return *reinterpret_cast<std::atomic<std::uint8_t>*>(guard + which);
}

} // namespace

extern "C" {

void* __real_malloc(std::size_t bytes);
void* __real_calloc(std::size_t count, std::size_t bytes);
void* __real_realloc(void* old, std::size_t bytes);
void* __real_aligned_alloc(std::size_t alignment, std::size_t bytes);
int __real_posix_memalign(void** to, std::size_t alignment, std::size_t bytes);
void __real_free(void* memory);

void* __wrap_malloc(std::size_t bytes) {
    const MemoryLock lock;
    return __real_malloc(bytes);
}
void* __wrap_calloc(std::size_t count, std::size_t bytes) {
    const MemoryLock lock;
    return __real_calloc(count, bytes);
}
void* __wrap_realloc(void* old, std::size_t bytes) {
    const MemoryLock lock;
    return __real_realloc(old, bytes);
}
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t bytes) {
    const MemoryLock lock;
    return __real_aligned_alloc(alignment, bytes);
}
int __wrap_posix_memalign(void** to, std::size_t alignment, std::size_t bytes) {
    const MemoryLock lock;
    return __real_posix_memalign(to, alignment, bytes);
}
void __wrap_free(void* memory) {
    const MemoryLock lock;
    __real_free(memory);
}

int __cxa_guard_acquire(std::uint8_t* guard) {
    while (part(guard, 1).exchange(1) != 0) web_workers::stop_if_failed();
    if (part(guard, 0).load() == 0) return 1;
    part(guard, 1).store(0);
    return 0;
}
void __cxa_guard_release(std::uint8_t* guard) {
    part(guard, 0).store(1);
    part(guard, 1).store(0);
}
void __cxa_guard_abort(std::uint8_t* guard) { part(guard, 1).store(0); }

/// For the stack and the variables of a worker; null where there is none.
__attribute__((export_name("worker_memory"))) void* isotet_worker_memory(std::size_t bytes) {
    void* memory = nullptr;
    return posix_memalign(&memory, 16, bytes) == 0 ? memory : nullptr;
}

/// How many threads there are, with the first.
__attribute__((export_name("set_threads"))) void isotet_set_threads(unsigned count) {
    web_workers::threads.store(count);
}

/// What a worker calls, once.
__attribute__((export_name("wait_for_work"))) void isotet_wait_for_work(unsigned number) {
    web_workers::wait_for_work(number);
}

/// Of a worker that has trapped.
__attribute__((export_name("worker_failed"))) void isotet_worker_failed() { web_workers::failed.store(true); }

/// Whether a worker has.
__attribute__((export_name("has_failed"))) bool isotet_has_failed() { return web_workers::failed.load(); }
}
