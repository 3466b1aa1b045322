// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A file descriptor that closes itself, and what to call a thing that is not a plain file.
#pragma once

#include <sys/stat.h>
#include <unistd.h>

#include <string_view>
#include <utility>

namespace isotet::core {

/// Owns an open file descriptor.
class Descriptor {
public:
    explicit Descriptor(int number = -1) noexcept : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        if (this != &other) {
            reset();
            number_ = other.release();
        }
        return *this;
    }
    ~Descriptor() { reset(); }

    int number() const noexcept { return number_; }
    explicit operator bool() const noexcept { return number_ >= 0; }
    int release() noexcept { return std::exchange(number_, -1); }
    void reset() noexcept {
        if (number_ >= 0) ::close(release());
    }

private:
    int number_;
};

/// "a folder", "a pipe" and so on; empty for a plain file.
inline std::string_view what_else_than_a_file(mode_t mode) noexcept {
    if (S_ISREG(mode)) return {};
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISSOCK(mode)) return "a socket";
    return "a device";
}

} // namespace isotet::core
