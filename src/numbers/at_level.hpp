// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Plain loops, compiled for each set of instructions.
#pragma once

#include "numbers/level.hpp"

namespace isotet::core {

#if defined(__x86_64__)
// `work` is inlined into these with all that it calls, and so compiled for their instructions.
template <class Work>
[[gnu::target("avx512f,avx512bw,avx512vl,bmi,bmi2,popcnt"), gnu::flatten]] void with_avx512(const Work& work) {
    work();
}
template <class Work>
[[gnu::target("avx2,bmi,bmi2,popcnt"), gnu::flatten]] void with_avx2(const Work& work) {
    work();
}
#endif

/// Calls work(), which holds loops that compilers turn into vectors, compiled for the level of this processor.
template <class Work>
void at_level(const Work& work) {
    switch (level()) {
#if defined(__x86_64__)
    case Level::avx512: return with_avx512(work);
    case Level::avx2: return with_avx2(work);
#endif
    default: return work();
    }
}

} // namespace isotet::core
