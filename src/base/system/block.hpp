// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where the memory of large arrays comes from. The first touch of fresh memory costs more than most of what is done
// with it: the system clears it page by page. So large blocks ask for huge pages, and a few of those given back are
// kept for the next surface, which is about as large as the last one.
#pragma once

#include <cstddef>

#include <isotet/export.hpp>

namespace isotet::core {

/// A piece of memory, aligned for every type. `bytes` may be more than was asked for.
struct Block {
    void* data = nullptr;
    std::size_t bytes = 0;
};

/// Guarantees   not cleared; aligned for every type; in memory to a huge page when it holds one and
///              where the address space has room
/// Errors       throws std::bad_alloc
/// Threads      safe from many threads
ISOTET_API Block take_block(std::size_t bytes);

/// Gives a block of take_block() back. Up to 1/64 of the machine's memory is kept for later.
ISOTET_API void give_back(Block block) noexcept;

/// Gives what is kept to the system; returns how many bytes that were.
ISOTET_API std::size_t drop_kept_blocks() noexcept;

/// Smaller blocks come from the ordinary heap. (The heap gives a megabyte that becomes free at its end back to the
/// system, and every small surface would touch its pages anew.)
constexpr std::size_t large_block = std::size_t{256} << 10;

/// Maps memory, in huge pages where there are some, from which the next large blocks are taken. A wish: nothing happens
/// where there is no room. What is not taken costs address space only.
ISOTET_API void prepare_blocks(std::size_t bytes) noexcept;

} // namespace isotet::core
