// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Numbers out of bytes in memory, in either byte order: what the readers of binary formats are made of.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace isotet::io {

/// A cursor over bytes that never leaves them.
///
/// `swapped`   true when the bytes stand in the order that is not this machine's
class ByteReader {
public:
    explicit ByteReader(std::string_view bytes, bool swapped = false) : bytes_(bytes), swapped_(swapped) {}

    std::size_t position() const noexcept { return position_; }
    std::size_t left() const noexcept { return bytes_.size() - position_; }
    std::string_view rest() const noexcept { return bytes_.substr(position_); }

    /// False, and the cursor unmoved, when the position lies outside.
    bool seek(std::size_t position) noexcept {
        if (position > bytes_.size()) return false;
        position_ = position;
        return true;
    }
    bool skip(std::size_t count) noexcept { return count <= left() && seek(position_ + count); }

    /// False, and nothing read, when fewer bytes are left.
    template <class T>
    bool read(T& value) noexcept {
        static_assert(std::is_arithmetic_v<T>);
        if (left() < sizeof(T)) return false;
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), bytes_.data() + position_, sizeof(T));
        if (swapped_) std::reverse(bytes.begin(), bytes.end());
        std::memcpy(&value, bytes.data(), sizeof(T));
        position_ += sizeof(T);
        return true;
    }

private:
    std::string_view bytes_;
    std::size_t position_ = 0;
    bool swapped_;
};

} // namespace isotet::io
