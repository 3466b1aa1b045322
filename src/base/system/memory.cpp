// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/system/memory.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <mutex>
#include <optional>

#include <fmt/core.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>
#include <unistd.h>

#include "base/system/block.hpp"
#include "base/system/fresh_memory.hpp"
#include "base/system/scratch_memory.hpp"

namespace isotet::core {

namespace {

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

std::optional<std::uint64_t> number_in(const std::string& path) {
    std::ifstream file(path);
    std::string word;
    std::uint64_t value = 0;
    if (!(file >> word) || std::from_chars(word.data(), word.data() + word.size(), value).ec != std::errc()) return {};
    return value;
}

/// Bytes of files that are only cached, by a file of counters. Of version 1, "total_..." has those of groups below,
/// too.
std::uint64_t cached_in(const std::string& path) {
    std::ifstream file(path);
    std::uint64_t value = 0, own = 0, total = 0;
    for (std::string name; file >> name >> value;) {
        if (name == "inactive_file" || name == "active_file") own += value;
        if (name == "total_inactive_file" || name == "total_active_file") total += value;
    }
    return std::max(own, total);
}

/// A line "Name:   123 kB" of a file in /proc, in bytes.
std::optional<std::uint64_t> proc_bytes(const char* path, std::string_view name) {
    std::ifstream file(path);
    for (std::string word; file >> word;) {
        std::uint64_t kib = 0;
        if (word == name && file >> kib) return kib * 1024;
    }
    return {};
}

struct Pages {
    std::uint64_t size = 0, resident = 0, shared = 0; ///< in bytes
};

/// Of this process. Readable in a reader process, too.
Pages pages_of_process() {
    std::ifstream file("/proc/self/statm");
    static const auto size = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    Pages pages;
    if (!(file >> pages.size >> pages.resident >> pages.shared)) return {};
    return {pages.size * size, pages.resident * size, pages.shared * size};
}

struct Heap {
    std::uint64_t used = 0, free = 0; ///< bytes
};

Heap heap_of_process() {
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
    const auto heap = mallinfo2();
    return {heap.uordblks + heap.hblkhd, heap.fordblks};
#else
    return {};
#endif
}

/// What blocks and `heap` bytes will take beside what they do, once they are written to.
std::uint64_t unwritten(std::uint64_t heap, const Pages& pages) {
    const std::uint64_t own = pages.resident - std::min(pages.shared, pages.resident);
    const std::uint64_t taken = mapped_blocks() + heap;
    return own == 0 ? 0 : taken - std::min(taken, own);
}

enum class Swap : std::uint8_t { counts, does_not };

std::uint64_t free_of_system(Swap swap) {
    std::uint64_t machine = proc_bytes("/proc/meminfo", "MemAvailable:").value_or(unlimited);
    if (swap == Swap::counts && machine != unlimited) machine += proc_bytes("/proc/meminfo", "SwapFree:").value_or(0);
    return std::min(machine, control_group_free("/proc/self/cgroup", "/sys/fs/cgroup"));
}

/// What there is, less what was taken and not written to yet.
std::uint64_t unclaimed(Swap swap) {
    const Heap heap = heap_of_process();
    std::uint64_t system = free_of_system(swap);
    const std::uint64_t least = system - std::min(system, unwritten(heap.used + heap.free, pages_of_process()));
    if (heap.free <= least / 4) return least;
    trim_heap(); // what was free of the heap may have been there, or not
    system = free_of_system(swap);
    return system - std::min(system, unwritten(heap.used, pages_of_process()));
}

/// What the limit on address space leaves.
std::uint64_t free_addresses() {
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
    return limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, pages_of_process().size);
}

} // namespace

std::uint64_t control_group_free(const std::string& membership, const std::string& mount) {
    std::uint64_t least = unlimited;
    const auto consider = [&](const std::string& limit, const std::string& used, const std::string& statistics) {
        const auto most = number_in(limit), all = number_in(used);
        if (!most || !all) return;
        const std::uint64_t now = *all - std::min(cached_in(statistics), *all);
        least = std::min(least, *most > now ? *most - now : 0);
    };
    std::ifstream file(membership);
    for (std::string line; std::getline(file, line);) {
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        std::string group = line.substr(second + 1);
        for (;; group.erase(group.find_last_of('/'))) {
            if (controllers.empty()) {
                const std::string folder = mount + group;
                consider(folder + "/memory.max", folder + "/memory.current", folder + "/memory.stat");
            } else if (controllers == "memory") {
                const std::string folder = mount + "/memory" + group;
                consider(folder + "/memory.limit_in_bytes", folder + "/memory.usage_in_bytes", folder + "/memory.stat");
            }
            if (group.find('/') == std::string::npos) break;
        }
    }
    return least;
}

std::uint64_t unclaimed_memory() { return unclaimed(Swap::counts); }

std::uint64_t free_memory() { return std::min(unclaimed(Swap::does_not), free_addresses()); }

std::uint64_t free_memory_and_swap() { return std::min(unclaimed(Swap::counts), free_addresses()); }

Error too_little_memory(std::string_view what, std::uint64_t bytes) {
    return {ErrorCode::out_of_memory,
            fmt::format("{} needs {}, but {} are free", what, format_bytes(bytes), format_bytes(free_memory()))};
}

Result<void> require_memory(std::string_view what, std::uint64_t bytes) {
    if (auto there = require_scratch(what, bytes)) return *std::move(there);
    if (bytes <= free_memory() || (drop_kept_blocks() > 0 && bytes <= free_memory())) return {};
    return too_little_memory(what, bytes);
}

Error ran_out_of_memory(std::string_view what) {
    const auto [bytes, left] = fresh_memory().take_refusal();
    std::string message = fmt::format("{} ran out of memory", what);
    if (bytes > 0)
        message += fmt::format(": beside {} that were taken, {} more are needed, but {} are free",
                               format_bytes(mapped_blocks()), format_bytes(bytes), format_bytes(left));
    return {ErrorCode::out_of_memory, std::move(message)};
}

void trim_heap() noexcept {
#ifdef __GLIBC__
    // Where another allocator has replaced malloc(), the first call makes glibc's heap, which no other call may read
    // then.
    static std::mutex one_at_a_time;
    const std::lock_guard lock(one_at_a_time);
    malloc_trim(0);
#endif
}

} // namespace isotet::core

namespace isotet {

std::optional<std::uint64_t> resident_memory() { return core::proc_bytes("/proc/self/status", "VmRSS:"); }

std::optional<std::uint64_t> peak_resident_memory() { return core::proc_bytes("/proc/self/status", "VmHWM:"); }

bool reset_peak_memory() {
    std::ofstream clear("/proc/self/clear_refs");
    clear << "5\n" << std::flush; // proc(5): resets the peak resident set size
    return static_cast<bool>(clear);
}

} // namespace isotet
