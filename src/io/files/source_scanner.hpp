// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A TextScanner over bytes that are not all in memory: for the few words between large arrays.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>

#include "io/files/byte_source.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io {

/// Words are at most 4,096 characters. Where reading failed everything looks like the end of the file, and error() says
/// why.
class SourceScanner {
private:
    static constexpr std::size_t window_bytes = std::size_t{1} << 16, longest_word = 4096;
    static constexpr std::size_t first_bytes = 2 * longest_word; ///< behind an array, where another one may follow soon

    /// Calls use(scanner) with the cursor in a window of the text, and follows it.
    template <class Use>
    auto scan(const Use& use) {
        const std::size_t ahead = std::min(longest_word, left());
        if (position_ < begin_ || position_ + ahead > begin_ + window_.size()) {
            const bool goes_on = position_ >= begin_ && position_ <= begin_ + window_.size() && !window_.empty();
            begin_ = position_;
            const auto view = source_.view(begin_, std::min(goes_on ? window_bytes : first_bytes, left()), scratch_);
            if (!view) error_ = view.error();
            window_ = view ? *view : std::string_view();
        }
        TextScanner scanner(window_);
        scanner.seek(std::min(position_ - begin_, window_.size()));
        auto result = use(scanner);
        position_ = begin_ + scanner.position();
        return result;
    }

public:
    explicit SourceScanner(const ByteSource& source) : source_(source) {}

    std::size_t position() const noexcept { return position_; }
    std::size_t left() const noexcept { return error_ ? 0 : source_.size() - position_; }
    void seek(std::size_t position) noexcept { position_ = position; }
    const std::optional<Error>& error() const noexcept { return error_; }

    /// True when only space is left.
    bool at_end() {
        while (left() > 0)
            if (scan([](TextScanner& text) { return !text.at_end(); })) return false;
        return true;
    }
    bool at_line_end() {
        return scan([](TextScanner& text) { return text.at_line_end(); });
    }
    /// The next word, on this or a later line; empty at the end.
    std::string word() {
        if (at_end()) return {};
        return scan([](TextScanner& text) { return std::string(text.word()); });
    }
    /// The next word of this line, empty at its end.
    std::string word_of_line() {
        return scan([](TextScanner& text) { return std::string(text.word_of_line()); });
    }
    template <class Number>
    bool number(Number& value) {
        return !at_end() && scan([&](TextScanner& text) { return text.number(value); });
    }
    template <class Number>
    bool number_of_line(Number& value) {
        return scan([&](TextScanner& text) { return text.number_of_line(value); });
    }
    /// Moves to the first character of the next line.
    void next_line() {
        while (left() > 0) {
            const bool found = scan([](TextScanner& text) {
                const auto end = text.rest().find('\n');
                text.seek(text.position() + (end == std::string_view::npos ? text.left() : end + 1));
                return end != std::string_view::npos;
            });
            if (found) return;
        }
    }
    /// The line of the cursor, without moving it; at most 40 characters.
    std::string here() {
        const std::size_t before = position_;
        auto text = scan([](TextScanner& scanner) { return std::string(scanner.rest().substr(0, 40)); });
        position_ = before;
        return text.substr(0, text.find('\n'));
    }

private:
    ByteSource source_;
    Scratch scratch_;
    std::string_view window_;
    std::size_t begin_ = 0, position_ = 0;
    std::optional<Error> error_;
};

} // namespace isotet::io
