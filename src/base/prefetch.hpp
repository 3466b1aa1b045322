// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Asking for memory before it is needed.
#pragma once

#include <cstddef>

namespace isotet::core {

inline void prefetch(const void* address) { __builtin_prefetch(address); }

inline void prefetch_bytes(const void* first, std::size_t bytes) {
    for (std::size_t at = 0; at < bytes; at += 64) prefetch(static_cast<const std::byte*>(first) + at);
}

} // namespace isotet::core
