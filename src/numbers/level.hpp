// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which instructions the processor's hot loops use: chosen once at run time, the same bytes from each.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <isotet/export.hpp>

namespace isotet::core {

enum class Level : std::uint8_t {
    portable, ///< what the compiler may use anyway (SSE2 on x86-64)
    avx2,     ///< x86-64 with AVX2, BMI2
    avx512,   ///< x86-64 with AVX-512 F, BW, VL, VBMI, VBMI2; BMI2
};

/// The best level of this machine, or the forced one.
ISOTET_API Level level();

/// The best level of this machine.
ISOTET_API Level best_level();

/// For tests and benchmarks: uses this level from now on; nothing lifts it. Must not be above best_level().
ISOTET_API void force_level(std::optional<Level> level);

std::string_view name_of(Level level);

} // namespace isotet::core
