// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/memory.hpp>

#include "base/system/block.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"

namespace isotet {

std::size_t release_memory() noexcept {
    core::drop_idle_arenas();
    const std::size_t kept = core::drop_kept_blocks();
    core::trim_heap();
    return kept;
}

} // namespace isotet
