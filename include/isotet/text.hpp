// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Text as isotet's messages and pictures have it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <isotet/export.hpp>

namespace isotet {

/// "512 B", "1.2 MB", "2500.0 TB": a MB is 10^6 bytes.
ISOTET_API std::string format_bytes(std::uint64_t bytes);

/// The order of names by the numbers in them: "run2" comes before "run10".
ISOTET_API bool comes_before(std::string_view a, std::string_view b) noexcept;

/// A character of UTF-8 text.
struct Utf8Character {
    char32_t code = 0xFFFD; ///< U+FFFD where the text is not UTF-8
    std::size_t bytes = 1;
    bool valid = false;
};

/// The character at the start of a text that is not empty. A byte that begins no character (of an overlong form, a
/// surrogate, a number above U+10FFFF or a sequence cut short) is one by itself, and not valid.
ISOTET_API Utf8Character first_utf8_character(std::string_view text) noexcept;

/// Valid UTF-8 as it is, every other byte as \xNN, so that different texts stay different.
ISOTET_API std::string valid_utf8(std::string_view text);

} // namespace isotet
