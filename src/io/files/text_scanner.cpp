// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The slow paths of the scanner: unusual numbers, quoted words, messages.
#include "io/files/text_scanner.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include <fmt/core.h>

#include "io/files/escape.hpp"

namespace isotet::io {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// True when a decimal number that a double cannot hold is too large, false when it is too small.
bool is_large(std::string_view number) {
    // The power of ten of the first digit that is not zero decides: only its sign matters.
    std::int64_t power = 0;
    bool after_point = false, counting = false;
    std::size_t i = 0;
    for (; i < number.size() && number[i] != 'e'; ++i) {
        if (number[i] == '.') after_point = true;
        else if (is_digit(number[i])) {
            if (number[i] != '0') counting = true;
            if (counting && !after_point) ++power;
            if (!counting && after_point) --power;
        }
    }
    if (i < number.size()) {
        std::string_view exponent = number.substr(i + 1);
        if (!exponent.empty() && exponent[0] == '+') exponent.remove_prefix(1);
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(exponent.data(), exponent.data() + exponent.size(), value);
        if (error == std::errc::result_out_of_range) return exponent[0] != '-';
        if (std::numeric_limits<std::int64_t>::max() / 2 < std::max(value, -(value + 1))) return value > 0;
        power += value;
    }
    return power > 0;
}

} // namespace

bool TextScanner::unusual_number(std::string_view word, double& value) {
    if (!word.empty() && word[0] == '+') {
        word.remove_prefix(1);
        if (!word.empty() && (word[0] == '+' || word[0] == '-')) return false;
    }
    std::string usual(word);
    for (std::size_t i = 1; i < usual.size(); ++i) {
        const bool follows_digit = is_digit(usual[i - 1]) || usual[i - 1] == '.';
        if (!follows_digit) continue;
        if (usual[i] == 'd' || usual[i] == 'D' || usual[i] == 'E') usual[i] = 'e';
        else if (usual[i] == '+' || usual[i] == '-') usual.insert(i, 1, 'e');
    }
    const auto [end, error] = std::from_chars(usual.data(), usual.data() + usual.size(), value);
    if (end != usual.data() + usual.size()) return false;
    if (error == std::errc{}) return true;
    if (error != std::errc::result_out_of_range) return false;
    const double magnitude = is_large(usual) ? std::numeric_limits<double>::infinity() : 0.0;
    value = usual[0] == '-' ? -magnitude : magnitude;
    return true;
}

std::string_view TextScanner::quoted_of_line() noexcept {
    skip_blanks();
    if (cursor_ == end_ || *cursor_ != '"') return take_word();
    const char* first = ++cursor_;
    while (cursor_ != end_ && *cursor_ != '"' && *cursor_ != '\n') ++cursor_;
    const std::string_view result(first, static_cast<std::size_t>(cursor_ - first));
    if (cursor_ != end_ && *cursor_ == '"') ++cursor_;
    return result;
}

std::string_view TextScanner::line() noexcept {
    skip_space();
    std::string_view result = rest().substr(0, rest().find('\n'));
    cursor_ += result.size();
    while (!result.empty() && is_space(result.back())) result.remove_suffix(1);
    return result;
}

void TextScanner::next_line() noexcept {
    const std::size_t end_of_line = rest().find('\n');
    cursor_ = end_of_line == std::string_view::npos ? end_ : cursor_ + end_of_line + 1;
}

std::string TextScanner::where() const {
    const auto line = 1 + std::count(begin_, cursor_, '\n');
    const char* last = cursor_;
    while (!ends_word(last)) ++last;
    if (cursor_ == end_) return fmt::format("line {} (the end)", line);
    if (last == cursor_) return fmt::format("line {} (its end)", line);
    return fmt::format("line {} ({})", line, in_quotes({cursor_, static_cast<std::size_t>(last - cursor_)}));
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t most = 40;
    std::string result = "'";
    for (std::size_t i = 0; i < most && !text.empty(); ++i) {
        const std::size_t length = printable_length(text);
        if (length > 0) result += text.substr(0, length);
        else result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    result += text.empty() ? "'" : "...'";
    return result;
}

} // namespace isotet::io
