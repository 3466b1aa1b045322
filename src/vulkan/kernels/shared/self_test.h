// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A case of the arithmetic self-test, and what a device makes of it. All members are 4 bytes wide, so that C++ and
// GLSL's scalar layout place them alike.
#ifndef ISOTET_SELF_TEST_H
#define ISOTET_SELF_TEST_H

#ifdef __cplusplus
#include <cstdint>
namespace isotet::vulkan::layout {
using uint = std::uint32_t;
#endif

struct SelfTestCase {
    float isovalue, rest, below, above; ///< for edge_weight
    float a, b;                    ///< for interpolate, by that weight
    uint code_below, code_above;   ///< for vertex_normal, by that weight
    float corners[9];              ///< for face_normal
};

/// Bits of floats.
struct SelfTestAnswer {
    uint weight;
    uint interpolated;
    uint vertex_normal[3];
    uint face_normal[3];
};

#ifdef __cplusplus
static_assert(sizeof(SelfTestCase) == 68 && sizeof(SelfTestAnswer) == 32);
} // namespace isotet::vulkan::layout
#endif

#endif
