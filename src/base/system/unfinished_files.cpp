// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/system/unfinished_files.hpp"

#include <array>
#include <atomic>
#include <cstring>
#include <unistd.h>

namespace isotet::core {
namespace {

constexpr int nothing = -1, changing = -2;

/// A signal handler may look at them at any moment.
struct UnfinishedFile {
    std::atomic<int> folder{nothing};
    std::array<char, 64> name{};
};
static_assert(std::atomic<int>::is_always_lock_free);

std::array<UnfinishedFile, 64> unfinished_files;

} // namespace

void note_unfinished_file(int folder, const std::string& name) noexcept {
    for (UnfinishedFile& file : unfinished_files) {
        int free = nothing;
        if (name.size() >= file.name.size() || !file.folder.compare_exchange_strong(free, changing)) continue;
        std::memcpy(file.name.data(), name.c_str(), name.size() + 1);
        file.folder = folder;
        return;
    }
}

void forget_unfinished_file(int folder, const std::string& name) noexcept {
    for (UnfinishedFile& file : unfinished_files) {
        int own = folder;
        if (name != file.name.data()) continue;
        if (file.folder.compare_exchange_strong(own, nothing)) return;
    }
}

void remove_noted_files() noexcept {
    for (const UnfinishedFile& file : unfinished_files)
        if (const int folder = file.folder; folder >= 0) ::unlinkat(folder, file.name.data(), 0);
}

} // namespace isotet::core
