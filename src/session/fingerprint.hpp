// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tells whether an array is the same as one before, without keeping the one before.
#pragma once

#include <cstdint>

#include <isotet/grid.hpp>

namespace isotet::session {

/// 128 bits that depend on every byte and on the shape. Not against forgery: equal by chance once in 2^128.
struct Fingerprint {
    std::uint64_t low = 0, high = 0;
    friend bool operator==(const Fingerprint&, const Fingerprint&) = default;
};

/// In parallel, at the speed of memory; the same for any number of threads.
Fingerprint fingerprint(const Array& array);
Fingerprint fingerprint(const Cells& cells);

} // namespace isotet::session
