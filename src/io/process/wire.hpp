// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Plain bytes between isotet and its reader process: numbers and strings one after another, in the machine's own order
// (both ends are one machine). The decoder trusts nothing: after the first thing that does not fit it only fails.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace isotet::io::confined {

class Encoder {
public:
    template <class T>
    void number(T value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void text(std::string_view value) {
        number<std::uint64_t>(value.size());
        bytes_.append(value);
    }
    /// A count, then each element through `encode_one(element)`.
    template <class List, class EncodeOne>
    void list(List& elements, EncodeOne encode_one) {
        number<std::uint64_t>(elements.size());
        for (auto& element : elements) encode_one(element);
    }
    const std::string& bytes() const noexcept { return bytes_; }

private:
    std::string bytes_;
};

class Decoder {
public:
    explicit Decoder(std::string_view bytes) : rest_(bytes) {}

    template <class T>
    T number() {
        T value{};
        if (rest_.size() < sizeof value) return fail(), value;
        std::memcpy(&value, rest_.data(), sizeof value);
        rest_.remove_prefix(sizeof value);
        return value;
    }
    /// An enumerator of which `last` is the highest.
    template <class E>
    E enumerator(E last) {
        const auto value = number<std::underlying_type_t<E>>();
        if (value > static_cast<std::underlying_type_t<E>>(last)) return fail(), E{};
        return static_cast<E>(value);
    }
    std::string text() {
        const auto size = number<std::uint64_t>();
        if (size > rest_.size()) return fail(), std::string();
        std::string value(rest_.substr(0, size));
        rest_.remove_prefix(size);
        return value;
    }
    /// Calls `decode_one()` as often as the count says; stops at the first failure, so a wrong count costs nothing.
    template <class DecodeOne>
    void list(DecodeOne decode_one) {
        const auto count = number<std::uint64_t>();
        for (std::uint64_t i = 0; i < count && good_; ++i) decode_one();
    }
    void fail() noexcept {
        good_ = false;
        rest_ = {};
    }
    bool good() const noexcept { return good_; }
    /// Everything was there, and nothing more.
    bool finished() const noexcept { return good_ && rest_.empty(); }

private:
    std::string_view rest_;
    bool good_ = true;
};

} // namespace isotet::io::confined
