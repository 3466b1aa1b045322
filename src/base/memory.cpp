// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/memory.hpp"

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

#include "base/block.hpp"
#include "base/scratch_memory.hpp"

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

/// A line "name 123" of a file of counters; 0 where there is none.
std::uint64_t counter_in(const std::string& path, std::string_view name) {
    std::ifstream file(path);
    std::uint64_t value = 0;
    for (std::string word; file >> word >> value;)
        if (word == name) return value;
    return 0;
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

} // namespace

std::uint64_t control_group_free(const std::string& membership, const std::string& mount) {
    std::uint64_t least = unlimited;
    const auto consider = [&](const std::string& limit, const std::string& used, const std::string& statistics) {
        const auto most = number_in(limit), all = number_in(used);
        if (!most || !all) return;
        const std::uint64_t cached = counter_in(statistics, "inactive_file") + counter_in(statistics, "active_file");
        const std::uint64_t now = *all - std::min(cached, *all);
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

std::uint64_t free_memory() {
    std::uint64_t least = proc_bytes("/proc/meminfo", "MemAvailable:").value_or(unlimited);
    least = std::min(least, control_group_free("/proc/self/cgroup", "/sys/fs/cgroup"));
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
        const std::uint64_t used = proc_bytes("/proc/self/status", "VmSize:").value_or(0);
        least = std::min<std::uint64_t>(least, limit.rlim_cur > used ? limit.rlim_cur - used : 0);
    }
    return least;
}

Result<void> require_memory(std::string_view what, std::uint64_t bytes) {
    if (auto there = require_scratch(what, bytes)) return *std::move(there);
    std::uint64_t free = free_memory();
    if (bytes > free && drop_kept_blocks() > 0) free = free_memory();
    if (bytes <= free) return {};
    return Error{ErrorCode::out_of_memory,
                 fmt::format("{} needs {}, but {} are free", what, format_bytes(bytes), format_bytes(free))};
}

void trim_heap() noexcept {
#ifdef __GLIBC__
    // Where another allocator has replaced malloc(), the first call makes glibc's heap, which no other call may read then.
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
