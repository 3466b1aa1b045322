// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/ensight/ensight_file.hpp"

#include <bit>
#include <charconv>
#include <cstring>
#include <limits>

#include <fmt/core.h>

#include "io/files/text_scanner.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t line_bytes = 80;
constexpr std::size_t most_characters = 255; // VTK's reader goes on in the middle of longer lines
constexpr std::uint32_t most_parts = 65'536;

std::string_view trimmed(std::string_view line) {
    while (!line.empty() && (is_space(line.back()) || line.back() == '\0')) line.remove_suffix(1);
    return line;
}

bool is_blank(std::string_view line) {
    for (const char c : line)
        if (!is_space(c)) return false;
    return true;
}

/// A number as C's atof() reads it, which knows no exponents with D. Too large and too small ones are numbers.
bool float_of(std::string_view word, double& value) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return !word.empty() && error != std::errc::invalid_argument && end == word.data() + word.size();
}

} // namespace

bool is_fortran(std::string_view bytes) {
    constexpr std::string_view little("\x50\0\0\0", 4), big("\0\0\0\x50", 4);
    if (bytes.size() < line_bytes + 8) return false;
    const std::string_view first = bytes.substr(0, 4), second = bytes.substr(line_bytes + 4, 4);
    return first == second && (first == little || first == big);
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    TextScanner scanner(line);
    for (auto word = scanner.quoted_of_line(); !word.empty(); word = scanner.quoted_of_line()) words.push_back(word);
    return words;
}

bool integers_of(std::string_view line, std::vector<std::int64_t>& values) {
    values.clear();
    TextScanner scanner(line);
    while (!scanner.at_line_end()) {
        std::int32_t value = 0;
        if (!scanner.number_of_line(value)) return false;
        values.push_back(value);
    }
    return true;
}

EnsightFile::EnsightFile(const std::string& path, std::string_view bytes, EnsightForm form, EnsightOrder order)
    : path_(path), bytes_(bytes), form_(form), order_(order) {
    if (form_ == EnsightForm::fortran) order_ = bytes[0] == 0 ? EnsightOrder::big : EnsightOrder::little;
}

bool EnsightFile::at_end() noexcept {
    if (is_binary()) return at_ == bytes_.size();
    while (at_ < bytes_.size()) {
        const std::size_t before = at_;
        if (const auto line = text_line(); !is_blank(line) && line[0] != '#') {
            at_ = before;
            return false;
        }
    }
    return true;
}

bool EnsightFile::has_more() {
    if (at_end()) {
        if (in_step_) wrong("the file ends before END TIME STEP: it is cut short");
        return false;
    }
    return !in_step_ || !peek("END TIME STEP").starts_with("END TIME STEP");
}

std::string_view EnsightFile::line(const char* what) {
    return is_binary() ? raw_line(what) : trimmed(data_line(what, most_characters));
}

std::string_view EnsightFile::raw_line(const char* what) {
    if (!is_binary()) {
        if (at_ == bytes_.size()) missing(what, 1);
        return trimmed(text_line());
    }
    const std::size_t begin = at_ + (is_fortran() ? 4 : 0);
    skip_bytes(line_bytes, what, 1);
    const std::string_view all = bytes_.substr(begin, line_bytes);
    return trimmed(all.substr(0, all.find('\0')));
}

std::string_view EnsightFile::peek(const char* what) {
    const std::size_t before = at_;
    const std::string_view found = line(what);
    at_ = before;
    return found;
}

std::uint64_t EnsightFile::part_number() {
    const std::size_t before = at_;
    const bool is_unknown = order_ == EnsightOrder::unknown;
    if (is_unknown) order_ = EnsightOrder::little;
    std::int64_t value = integer("the number of a part");
    if (is_unknown && is_binary() && (value < 0 || value >= most_parts)) {
        order_ = EnsightOrder::big;
        at_ = before;
        value = integer("the number of a part");
    }
    if (value < 0 || (is_binary() && value >= most_parts)) wrong(fmt::format("a part has the number {}", value));
    return static_cast<std::uint64_t>(value);
}

std::uint64_t EnsightFile::count(const char* what) {
    const std::int64_t value = integer(what);
    if (value < 0) wrong(fmt::format("{} is {}", what, value));
    return static_cast<std::uint64_t>(value);
}

std::uint64_t EnsightFile::count_of_unknown_order(const char* what) {
    if (is_binary() && order_ == EnsightOrder::unknown) {
        const std::size_t before = at_;
        const auto as = [&](EnsightOrder order) -> std::int64_t {
            order_ = order;
            at_ = before;
            const std::int64_t value = plain_integer(what);
            return value >= 0 && static_cast<std::uint64_t>(value) <= bytes_.size() / 4 ? value : -1;
        };
        const std::int64_t big = as(EnsightOrder::big), little = as(EnsightOrder::little);
        at_ = before;
        if (big > little) order_ = EnsightOrder::big;
        if (big == 0 && little == 0) {
            order_ = EnsightOrder::unknown;
            at_ += 4;
            return 0;
        }
        if (big < 0 && little < 0) wrong(fmt::format("{} is larger than the file in either byte order", what));
    }
    return count(what);
}

std::vector<std::uint32_t> EnsightFile::counts(std::uint64_t n, const char* what, Lines lines) {
    if (n > left() / (is_binary() ? 4 : 1)) missing(what, n);
    std::vector<std::uint32_t> all;
    const auto add = [&](std::int64_t value) {
        if (value < 0) wrong(fmt::format("{} holds {}", what, value));
        all.push_back(static_cast<std::uint32_t>(value));
    };
    if (!is_binary() && lines == Lines::all_on_one) {
        if (!integers_of(data_line(what, most_characters), row_) || row_.size() != n) missing(what, n);
        for (const std::int64_t value : row_) add(value);
        return all;
    }
    if (n == 0) return all;
    if (is_fortran()) record_mark(4 * n);
    for (std::uint64_t i = 0; i < n; ++i) add(is_binary() ? plain_integer(what) : integer(what));
    if (is_fortran()) record_mark(4 * n);
    return all;
}

void EnsightFile::skip_floats(std::uint64_t n, const char* what) {
    if (n > left() / (is_binary() ? 4 : 1)) missing(what, n);
    if (is_binary()) {
        if (n > 0) skip_bytes(4 * n, what, n);
        return;
    }
    for (std::uint64_t i = 0; i < n; ++i) float_line(what);
}

void EnsightFile::skip_integers(std::uint64_t rows, std::uint64_t row, const char* what) {
    if (rows > left() / (is_binary() ? 4 : 1)) missing(what, rows);
    if (is_binary()) {
        if (rows * row > left() / 4) missing(what, rows * row);
        if (rows * row > 0) skip_bytes(4 * rows * row, what, rows * row);
        return;
    }
    for (std::uint64_t i = 0; i < rows; ++i)
        if (!integers_of(data_line(what, most_characters), row_) || row_.size() != row) missing(what, rows * row);
}

void EnsightFile::skip_lines(const std::vector<std::uint32_t>& sizes, const char* what) {
    for (const std::uint32_t size : sizes)
        if (!integers_of(data_line(what, std::numeric_limits<std::size_t>::max()), row_) || row_.size() != size)
            missing(what, sizes.size());
}

void EnsightFile::wrong(const std::string& what) const {
    throw EnsightError(broken(path_, fmt::format("{}, before byte {}", what, at_)));
}

void EnsightFile::missing(const char* what, std::uint64_t n) const {
    wrong(fmt::format(
        "{} should have {} values or lines, but the file ends or has something else: it is cut short or broken", what,
        n));
}

std::string_view EnsightFile::text_line() {
    const std::size_t begin = at_, end = std::min(bytes_.find('\n', at_), bytes_.size());
    at_ = std::min(end + 1, bytes_.size());
    return bytes_.substr(begin, end - begin);
}

std::string_view EnsightFile::data_line(const char* what, std::size_t longest) {
    if (at_end()) missing(what, 1);
    const std::string_view line = text_line();
    if (line.size() > longest)
        wrong(fmt::format("a line has {} characters, of which VTK's reader takes {}", line.size(), longest));
    return line;
}

double EnsightFile::float_line(const char* what) {
    const std::size_t before = at_;
    TextScanner scanner(data_line(what, most_characters));
    double value = 0;
    if (float_of(scanner.word_of_line(), value) && scanner.at_line_end()) return value;
    at_ = before;
    missing(what, 1);
}

/// Fortran writes the length of a record before and behind it.
void EnsightFile::record_mark(std::uint64_t bytes) {
    const std::int64_t found = plain_integer("the length of a record");
    if (static_cast<std::uint32_t>(found) != bytes)
        wrong(fmt::format("a record of {} bytes should have {}", static_cast<std::uint32_t>(found), bytes));
}

void EnsightFile::skip_bytes(std::uint64_t n, const char* what, std::uint64_t items) {
    const std::uint64_t marks = is_fortran() ? 8 : 0;
    if (n + marks > left()) missing(what, items);
    if (is_fortran()) record_mark(n);
    at_ += static_cast<std::size_t>(n);
    if (is_fortran()) record_mark(n);
}

std::int32_t EnsightFile::plain_integer(const char* what) {
    if (left() < 4) missing(what, 1);
    std::uint32_t value = 0;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += 4;
    if (order_ == EnsightOrder::big) value = __builtin_bswap32(value);
    return std::bit_cast<std::int32_t>(value);
}

std::int64_t EnsightFile::integer(const char* what) {
    if (!is_binary()) {
        const std::size_t before = at_;
        if (integers_of(data_line(what, most_characters), row_) && row_.size() == 1) return row_[0];
        at_ = before;
        missing(what, 1);
    }
    if (is_fortran()) record_mark(4);
    const std::int64_t value = plain_integer(what);
    if (is_fortran()) record_mark(4);
    return value;
}

} // namespace isotet::io::confined
