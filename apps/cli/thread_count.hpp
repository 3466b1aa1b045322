// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <thread>

namespace isotet::cli {

/// How many threads --threads asks for; 0: all.
inline unsigned thread_count(int asked) {
    return asked > 0 ? static_cast<unsigned>(asked) : std::max(1U, std::thread::hardware_concurrency());
}

} // namespace isotet::cli
