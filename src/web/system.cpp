// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the system does elsewhere. WebAssembly has 4 GiB, and grows until it has them (base/system/memory.cpp asks the system);
// what would be thrown ends the module; pictures are drawn by the page.
#include <cstddef>
#include <cstdint>
#include <string>

#include <fmt/core.h>

#include "base/system/fresh_memory.hpp"
#include "base/system/memory.hpp"
#include "view/grid_view.hpp"

extern "C" {
void* __cxa_allocate_exception(std::size_t) { __builtin_trap(); }
void __cxa_throw(void*, void*, void (*)(void*)) { __builtin_trap(); }
int madvise(void*, std::size_t, int) { return 0; }
int mprotect(void*, std::size_t, int) { return 0; }                  // tests alone ask for it
int __cxa_thread_atexit(void (*)(void*), void*, void*) { return 0; } // the one thread does not end
}

namespace isotet {

struct IsosurfaceScene::Data {}; ///< none is made
IsosurfaceScene::~IsosurfaceScene() = default;

std::optional<std::uint64_t> resident_memory() {
    return static_cast<std::uint64_t>(__builtin_wasm_memory_size(0)) << 16U;
}
std::optional<std::uint64_t> peak_resident_memory() { return resident_memory(); }
bool reset_peak_memory() { return false; }

namespace core {

std::uint64_t free_memory() { return (std::uint64_t{1} << 32U) - *resident_memory(); }

std::uint64_t unclaimed_memory() { return free_memory(); }

std::uint64_t control_group_free(const std::string&, const std::string&) { return free_memory(); }

void trim_heap() noexcept {}

Error too_little_memory(std::string_view what, std::uint64_t bytes) {
    return {ErrorCode::out_of_memory,
            fmt::format("{} needs {}, but {} are free", what, format_bytes(bytes), format_bytes(free_memory()))};
}

Error ran_out_of_memory(std::string_view what) {
    return {ErrorCode::out_of_memory, fmt::format("{} ran out of memory", what)};
}

Result<void> require_memory(std::string_view what, std::uint64_t bytes) {
    if (bytes <= free_memory()) return {};
    return too_little_memory(what, bytes);
}

} // namespace core

namespace view {

Result<view::Frame> GridView::picture_frame(const ShowMessage&, double, std::vector<std::string>&, const Run&) {
    return Error{ErrorCode::invalid_argument, "pictures are not drawn here"};
}

std::optional<SaveKind> parse_save_kind(std::string_view) { return std::nullopt; } // the page writes its files

} // namespace view

} // namespace isotet
