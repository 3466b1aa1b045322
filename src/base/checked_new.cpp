// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The heap of programs of isotet's own: large objects are asked for as blocks are (fresh_memory.hpp), so that a control
// group with too little memory is an error. A library replaces no operator of its users' programs.
#include <cstddef>
#include <cstdlib>
#include <new>

#include "base/system/block.hpp"
#include "base/system/fresh_memory.hpp"

namespace {

bool is_there(std::size_t bytes) {
    using namespace isotet::core;
    constexpr std::size_t many = std::size_t{32} << 10; // of 64 pieces each array is below a large block
    return bytes < many || fresh_memory().take(bytes) || (drop_kept_blocks() > 0 && fresh_memory().take(bytes));
}

} // namespace

// The forms for arrays and those that return null call it.
void* operator new(std::size_t bytes) {
    while (is_there(bytes)) {
        if (void* const memory = std::malloc(bytes > 0 ? bytes : 1)) return memory;
        const std::new_handler handler = std::get_new_handler();
        if (!handler) break;
        handler();
    }
    throw std::bad_alloc();
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
