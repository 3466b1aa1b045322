// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Words and numbers out of text in memory, one after another: what the readers of text formats are made of.
#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>

#include <isotet/export.hpp>

namespace isotet::io {

constexpr std::string_view utf_8_mark = "\xef\xbb\xbf"; ///< the byte order mark that some programs write before text

inline std::string_view without_byte_order_mark(std::string_view text) noexcept {
    return text.starts_with(utf_8_mark) ? text.substr(utf_8_mark.size()) : text;
}

inline bool is_space(char c) noexcept { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// A cursor over text. Numbers are the same in every locale; "+5", "nan", "inf", "1.0D+05" and Fortran's "1.0-105" are
/// numbers too, too large ones become infinite, too small ones zero. Integers must be written as integers.
///
/// `comment`   a character that starts a comment up to the end of its line; '\0': there are none
///
/// Guarantees  after a function that returned false the cursor stands on the word that is no such number
class TextScanner {
public:
    explicit TextScanner(std::string_view text, char comment = '\0')
        : begin_(text.data()), cursor_(text.data()), end_(text.data() + text.size()), comment_(comment) {}

    std::size_t position() const noexcept { return static_cast<std::size_t>(cursor_ - begin_); }
    std::string_view rest() const noexcept { return {cursor_, static_cast<std::size_t>(end_ - cursor_)}; }
    std::size_t left() const noexcept { return static_cast<std::size_t>(end_ - cursor_); }
    void seek(std::size_t position) noexcept { cursor_ = begin_ + position; }

    /// True when only space and comments are left.
    bool at_end() noexcept {
        skip_space();
        return cursor_ == end_;
    }
    /// True when only space and a comment are left on this line.
    bool at_line_end() noexcept {
        skip_blanks();
        return cursor_ == end_ || *cursor_ == '\n';
    }

    /// The next word, on this or a later line; empty at the end.
    std::string_view word() noexcept {
        skip_space();
        return take_word();
    }
    /// The next word of this line, empty at its end.
    std::string_view word_of_line() noexcept {
        skip_blanks();
        return take_word();
    }
    /// As word_of_line(), but what stands between two quotation marks is one word, without them.
    std::string_view quoted_of_line() noexcept;

    /// The next line that is not empty, from its first word to its last. Knows no comments inside the line.
    ISOTET_API std::string_view line() noexcept;

    /// Moves to the first character of the next line.
    void next_line() noexcept;

    /// The next number, on this or a later line.
    template <class Number>
    bool number(Number& value) {
        skip_space();
        return number_here(value);
    }
    /// The next number of this line.
    template <class Number>
    bool number_of_line(Number& value) {
        skip_blanks();
        return number_here(value);
    }

    /// "line 12 ('abc')", for messages: where the cursor stands and the word there. Counts lines: slow.
    ISOTET_API std::string where() const;

private:
    bool ends_word(const char* at) const noexcept {
        return at == end_ || is_space(*at) || (comment_ && *at == comment_);
    }

    void skip_comment() noexcept {
        while (cursor_ != end_ && *cursor_ != '\n') ++cursor_;
    }
    void skip_space() noexcept {
        while (cursor_ != end_) {
            if (is_space(*cursor_)) ++cursor_;
            else if (comment_ && *cursor_ == comment_) skip_comment();
            else return;
        }
    }
    void skip_blanks() noexcept {
        while (cursor_ != end_ && *cursor_ != '\n') {
            if (is_space(*cursor_)) ++cursor_;
            else if (comment_ && *cursor_ == comment_) skip_comment();
            else return;
        }
    }
    std::string_view take_word() noexcept {
        const char* first = cursor_;
        while (!ends_word(cursor_)) ++cursor_;
        return {first, static_cast<std::size_t>(cursor_ - first)};
    }

    template <class Number>
    bool number_here(Number& value) {
        const auto [end, error] = std::from_chars(cursor_, end_, value);
        if (error == std::errc{} && ends_word(end)) {
            cursor_ = end;
            return true;
        }
        const char* first = cursor_;
        if (unusual_number(take_word(), value)) return true;
        cursor_ = first;
        return false;
    }

    const char* begin_;
    const char* cursor_;
    const char* end_;
    char comment_;

    ISOTET_API static bool unusual_number(std::string_view word, double& value);
    template <std::integral Integer>
    static bool unusual_number(std::string_view word, Integer& value) {
        if (word.size() < 2 || word[0] != '+' || word[1] == '-') return false;
        const auto [end, error] = std::from_chars(word.data() + 1, word.data() + word.size(), value);
        return error == std::errc{} && end == word.data() + word.size();
    }
};

/// Without space at its ends.
inline std::string_view without_blanks(std::string_view text) noexcept {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

/// The number that the whole word is, by the rules of TextScanner.
template <class Number>
bool parse_number(std::string_view word, Number& value) {
    TextScanner scanner(word);
    return !word.empty() && scanner.number(value) && scanner.left() == 0;
}

/// At most 40 characters of a file's own words, in quotes and with control characters and bytes that are not UTF-8 as
/// \x.., for messages.
ISOTET_API std::string in_quotes(std::string_view text);

} // namespace isotet::io
