// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "memory/counted_memory.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

#include <malloc.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

std::atomic<std::size_t> held{0}, peak{0};

void add(std::size_t bytes) {
    const std::size_t now = held.fetch_add(bytes) + bytes;
    std::size_t seen = peak.load();
    while (now > seen && !peak.compare_exchange_weak(seen, now)) {}
}

void* take(std::size_t bytes, std::size_t alignment) {
    void* const data = alignment > alignof(std::max_align_t)
                           ? std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment)
                           : std::malloc(bytes ? bytes : 1);
    if (!data) throw std::bad_alloc();
    add(malloc_usable_size(data));
    return data;
}

void* take_or_null(std::size_t bytes, std::size_t alignment) noexcept {
    try {
        return take(bytes, alignment);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

void give(void* data) noexcept {
    if (data) held -= malloc_usable_size(data);
    std::free(data);
}

} // namespace

void* operator new(std::size_t bytes) { return take(bytes, 0); }
void* operator new[](std::size_t bytes) { return take(bytes, 0); }
void* operator new(std::size_t bytes, std::align_val_t a) { return take(bytes, static_cast<std::size_t>(a)); }
void* operator new[](std::size_t bytes, std::align_val_t a) { return take(bytes, static_cast<std::size_t>(a)); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return take_or_null(bytes, 0); }
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept { return take_or_null(bytes, 0); }
void operator delete(void* data) noexcept { give(data); }
void operator delete[](void* data) noexcept { give(data); }
void operator delete(void* data, std::size_t) noexcept { give(data); }
void operator delete[](void* data, std::size_t) noexcept { give(data); }
void operator delete(void* data, std::align_val_t) noexcept { give(data); }
void operator delete[](void* data, std::align_val_t) noexcept { give(data); }
void operator delete(void* data, std::size_t, std::align_val_t) noexcept { give(data); }
void operator delete[](void* data, std::size_t, std::align_val_t) noexcept { give(data); }

#if !defined(__SANITIZE_ADDRESS__)
// Large blocks of the library are mapped (base/block.hpp); the heap's own mappings do not come along here.
extern "C" void* mmap(void* address, size_t bytes, int protection, int flags, int file, off_t offset) noexcept {
    const long result = syscall(SYS_mmap, address, bytes, protection, flags, file, offset);
    if (result != -1) add(bytes);
    return reinterpret_cast<void*>(result);
}
extern "C" int munmap(void* address, size_t bytes) noexcept {
    const long result = syscall(SYS_munmap, address, bytes);
    if (result == 0) held -= bytes;
    return static_cast<int>(result);
}
#endif

namespace isotet::test {

std::size_t peak_bytes(const std::function<void()>& work) {
    const std::size_t before = held;
    peak = before;
    work();
    return peak - before;
}

} // namespace isotet::test
