// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/opened_files.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <dlfcn.h>
#include <fcntl.h>
#include <mutex>
#include <string_view>
#include <utility>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace isotet::io::confined {
namespace {

std::atomic<bool> watching = false;

struct Opened {
    std::mutex mutex;
    std::vector<std::string> paths;
};

Opened& opened() {
    static Opened& only = *new Opened;
    return only;
}

bool may_be_opened(const char* path) {
    struct stat status{};
    if (!watching || ::stat(path, &status) != 0) return true; // what is not there says so itself
    if (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)) return true;
    errno = ENXIO;
    return false;
}

void note_opened(const char* path) {
    struct stat status{};
    if (!watching || ::stat(path, &status) != 0 || !S_ISREG(status.st_mode)) return;
    std::string absolute = path;
    if (char folder[4096]; *path != '/' && ::getcwd(folder, sizeof folder)) absolute = std::string(folder) + "/" + path;
    if (absolute.starts_with("/proc/") || absolute.starts_with("/sys/")) return;
    const std::scoped_lock lock(opened().mutex);
    auto& paths = opened().paths;
    if (std::ranges::find(paths, absolute) == paths.end()) paths.push_back(std::move(absolute));
}

int open_watched(const char* path, int flags, mode_t mode) {
    if (!may_be_opened(path)) return -1;
    const int file = static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
    if (file >= 0) note_opened(path);
    return file;
}

template <class Open>
std::FILE* fopen_watched(const char* name, const char* path, const char* mode) {
    static const auto real = reinterpret_cast<Open*>(::dlsym(RTLD_NEXT, name));
    if (!real || !may_be_opened(path)) return nullptr;
    std::FILE* const file = real(path, mode);
    if (file) note_opened(path);
    return file;
}

using FileOpen = std::FILE*(const char*, const char*);

} // namespace

void watch_opened_files() { watching = true; }

std::vector<std::string> take_opened_files() {
    const std::scoped_lock lock(opened().mutex);
    return std::exchange(opened().paths, {});
}

} // namespace isotet::io::confined

// Declared under other names: the C library's headers may define these as inline functions.
#define ISOTET_STANDS_BEFORE(name) __asm__(name) __attribute__((visibility("default"), used))

extern "C" {

int isotet_open(const char* path, int flags, ...) ISOTET_STANDS_BEFORE("open");
int isotet_open64(const char* path, int flags, ...) ISOTET_STANDS_BEFORE("open64");
int isotet_open_2(const char* path, int flags) ISOTET_STANDS_BEFORE("__open_2");
int isotet_open64_2(const char* path, int flags) ISOTET_STANDS_BEFORE("__open64_2");
std::FILE* isotet_fopen(const char* path, const char* mode) ISOTET_STANDS_BEFORE("fopen");
std::FILE* isotet_fopen64(const char* path, const char* mode) ISOTET_STANDS_BEFORE("fopen64");

#define ISOTET_OPEN(name)                                                                                              \
    int name(const char* path, int flags, ...) {                                                                       \
        std::va_list rest;                                                                                             \
        va_start(rest, flags);                                                                                         \
        const auto mode = static_cast<mode_t>((flags & O_CREAT) ? va_arg(rest, int) : 0);                              \
        va_end(rest);                                                                                                  \
        return isotet::io::confined::open_watched(path, flags, mode);                                                       \
    }
ISOTET_OPEN(isotet_open)
ISOTET_OPEN(isotet_open64)

int isotet_open_2(const char* path, int flags) { return isotet::io::confined::open_watched(path, flags, 0); }
int isotet_open64_2(const char* path, int flags) { return isotet::io::confined::open_watched(path, flags, 0); }
std::FILE* isotet_fopen(const char* path, const char* mode) {
    return isotet::io::confined::fopen_watched<isotet::io::confined::FileOpen>("fopen", path, mode);
}
std::FILE* isotet_fopen64(const char* path, const char* mode) {
    return isotet::io::confined::fopen_watched<isotet::io::confined::FileOpen>("fopen64", path, mode);
}

} // extern "C"
