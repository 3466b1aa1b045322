// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What JavaScript gives the modules for pages (view/web/link/engine_worker.js): functions that copy what they are given.
#pragma once

#include <cstddef>
#include <string>

extern "C" {
__attribute__((import_module("page"), import_name("text"))) void page_takes_text(const char* bytes, std::size_t count);
__attribute__((import_module("page"), import_name("surface"))) void page_takes_surface(const void* positions,
                                                                                       std::size_t position_bytes,
                                                                                       const void* triangles,
                                                                                       std::size_t triangle_bytes);
__attribute__((import_module("page"), import_name("frame"))) void page_takes_frame(const char* bytes,
                                                                                   std::size_t count);
}

namespace isotet::web {

/// A message of view/messages.hpp.
inline void say_text(const std::string& text) { page_takes_text(text.data(), text.size()); }

} // namespace isotet::web
