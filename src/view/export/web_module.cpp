// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/export/web_module.hpp"

#include <cstddef>

#ifdef ISOTET_WEB_MODULE

#ifdef ISOTET_WEB_READERS
#define ISOTET_READERS_IN_PROGRAM ".incbin \"" ISOTET_WEB_READERS "\"\n"
#else
#define ISOTET_READERS_IN_PROGRAM "\n"
#endif

// The assembler puts the files into the program: as numbers in C++ it would take minutes to compile.
asm(".section .rodata\n"
    ".global isotet_web_module_begin, isotet_web_module_end, isotet_web_readers_end\n"
    "isotet_web_module_begin: .incbin \"" ISOTET_WEB_MODULE "\"\n"
    "isotet_web_module_end: " ISOTET_READERS_IN_PROGRAM "isotet_web_readers_end: .byte 0\n"
    ".text\n");
extern "C" const char isotet_web_module_begin[], isotet_web_module_end[], isotet_web_readers_end[];

namespace isotet::view {

std::string_view web_module() {
    return {isotet_web_module_begin, static_cast<std::size_t>(isotet_web_module_end - isotet_web_module_begin)};
}

std::string_view web_reader_module() {
    return {isotet_web_module_end, static_cast<std::size_t>(isotet_web_readers_end - isotet_web_module_end)};
}

} // namespace isotet::view

#else

namespace isotet::view {

std::string_view web_module() { return {}; }
std::string_view web_reader_module() { return {}; }

} // namespace isotet::view

#endif
