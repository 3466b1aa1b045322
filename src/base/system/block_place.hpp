// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Another place for large blocks (base/block.hpp) than the machine's memory.
#pragma once

#include <cstddef>

#include "base/system/block.hpp"

namespace isotet::core {

/// Threads   all functions are called from many threads at once
class BlockPlace {
public:
    virtual ~BlockPlace() = default;

    /// A block of `bytes`, at least large_block, or more; without data where it shall come from memory.
    /// `in_memory`  bytes of the large blocks that are in memory now
    /// Errors       throws std::bad_alloc
    virtual Block take(std::size_t bytes, std::size_t in_memory) = 0;

    /// False where the block is not from here.
    virtual bool give_back(Block block) noexcept = 0;

    /// Whether blocks of memory that are given back may be kept for later.
    virtual bool lets_keep() const noexcept = 0;
};

/// From now on large blocks are asked for there first. The place must live as long as the process.
void use_block_place(BlockPlace& place) noexcept;

} // namespace isotet::core
