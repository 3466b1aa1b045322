// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "bench/memory_use.hpp"

#include <malloc.h>

#include <fstream>
#include <stdexcept>
#include <string>

namespace isotet::bench {

namespace {

std::uint64_t kibibytes_of(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.compare(0, name.size(), name) == 0) return std::stoull(line.substr(name.size()));
    throw std::runtime_error("/proc/self/status has no line " + name);
}

} // namespace

std::uint64_t resident_bytes() { return 1024 * kibibytes_of("VmRSS:"); }

std::uint64_t peak_bytes() { return 1024 * kibibytes_of("VmHWM:"); }

void start_peak() {
    malloc_trim(0);
    std::ofstream clear("/proc/self/clear_refs");
    clear << "5\n" << std::flush; // proc(5): resets the peak resident set size
    if (!clear) throw std::runtime_error("/proc/self/clear_refs cannot be written, so peaks cannot be told apart");
}

} // namespace isotet::bench
