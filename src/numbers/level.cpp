// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "numbers/level.hpp"

#include <atomic>

namespace isotet::core {

namespace {
std::atomic<int> forced{-1};
}

Level best_level() {
#if defined(__x86_64__)
    static const Level best = [] {
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
            __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512vbmi") &&
            __builtin_cpu_supports("avx512vbmi2") && __builtin_cpu_supports("bmi2"))
            return Level::avx512;
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2")) return Level::avx2;
        return Level::portable;
    }();
    return best;
#else
    return Level::portable;
#endif
}

Level level() {
    const int force = forced.load(std::memory_order_relaxed);
    return force < 0 ? best_level() : static_cast<Level>(force);
}

void force_level(std::optional<Level> level) { forced = level ? static_cast<int>(*level) : -1; }

std::string_view name_of(Level level) {
    switch (level) {
    case Level::avx2: return "AVX2";
    case Level::avx512: return "AVX-512";
    default: return "portable";
    }
}

} // namespace isotet::core
