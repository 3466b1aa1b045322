// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/ensight/ensight_file.hpp"

#include <bit>
#include <charconv>
#include <cstring>
#include <type_traits>

#include <fmt/core.h>

#include "io/files/text_scanner.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t line_bytes = 80, float_width = 12;

std::string_view trimmed(std::string_view line) {
    while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
    while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
    return line;
}

/// Goes through the numbers of a line of text.
class LineScanner {
public:
    explicit LineScanner(std::string_view line) : line_(line) {}

    bool at_end() noexcept {
        while (at_ < line_.size() && is_space(line_[at_])) ++at_;
        return at_ == line_.size();
    }

    /// False where none stands here. `width`: of its column, which ends it where neither space nor sign does.
    template <class Number>
    bool next(std::size_t width, Number& value) {
        if (at_end()) return false;
        column_end_ += width;
        const char *const begin = line_.data() + at_, *const end = line_.data() + line_.size();
        const auto [stop, error] = std::from_chars(begin, end, value);
        const auto size = static_cast<std::size_t>(stop - begin);
        if (error == std::errc{} && (stop == end || is_space(*stop))) return take(size);
        const std::size_t in_column = column_end_ > at_ ? column_end_ - at_ : 0;
        const bool before_sign = error == std::errc{} && (*stop == '-' || *stop == '+');
        if (before_sign && size == in_column) return take(size); // "2.0000000000-3" could be read as 0.002
        const std::string_view word = TextScanner(line_.substr(at_)).word();
        if (parse_number(word, value)) return take(word.size());
        if (before_sign) return parse_number(word.substr(0, size), value) && take(size);
        return in_column < word.size() && parse_number(word.substr(0, in_column), value) && take(in_column);
    }

private:
    bool take(std::size_t characters) noexcept {
        at_ += characters;
        return true;
    }

    std::string_view line_;
    std::size_t at_ = 0, column_end_ = 0;
};

} // namespace

bool has_fortran_records(std::string_view bytes) {
    constexpr std::string_view little("\x50\0\0\0", 4), big("\0\0\0\x50", 4);
    if (bytes.size() < line_bytes + 8) return false;
    const std::string_view first = bytes.substr(0, 4), second = bytes.substr(line_bytes + 4, 4);
    return first == second && (first == little || first == big);
}

EnsightForm ensight_form(std::string_view bytes) {
    const bool fortran = has_fortran_records(bytes);
    const std::string_view line = bytes.substr(fortran ? 4 : 0, line_bytes);
    const auto words = words_of(line.substr(0, line.find('\n')));
    const bool binary = words.size() > 1 && (words[1].starts_with("Binary") || words[1].starts_with("binary"));
    return !binary ? EnsightForm::ascii : fortran ? EnsightForm::fortran : EnsightForm::c;
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    TextScanner scanner(line);
    for (auto word = scanner.quoted_of_line(); !word.empty(); word = scanner.quoted_of_line()) words.push_back(word);
    return words;
}

EnsightFile::EnsightFile(const std::string& path, std::string_view bytes, EnsightForm form, bool big_endian,
                         std::size_t integer_width)
    : path_(path),
      bytes_(form == EnsightForm::ascii ? without_byte_order_mark(bytes) : bytes),
      integer_width_(integer_width),
      form_(form),
      big_endian_(form == EnsightForm::fortran ? bytes[0] == 0 : big_endian) {}

void EnsightFile::skip_empty_records() noexcept {
    while (marks() > 0 && left() >= 2 * marks() && word_at(at_) == 0 && word_at(at_ + marks()) == 0) at_ += 2 * marks();
}

void EnsightFile::skip_empty_lines() noexcept {
    skip_empty_records();
    while (!is_binary() && at_ < bytes_.size()) {
        const std::size_t word = std::min(bytes_.find_first_not_of(" \t\r\v\f", at_), bytes_.size());
        if (word < bytes_.size() && bytes_[word] != '\n' && bytes_[at_] != '#') return;
        at_ = std::min(bytes_.find('\n', word), bytes_.size() - 1) + 1;
    }
}

bool EnsightFile::is_at(std::string_view begin) noexcept {
    skip_empty_lines();
    if (is_binary()) return left() > marks() && bytes_.substr(at_ + marks()).starts_with(begin);
    const std::size_t first = bytes_.find_first_not_of(" \t", at_);
    return first != std::string_view::npos && bytes_.substr(first).starts_with(begin);
}

bool EnsightFile::find_step(std::string_view begin) {
    for (std::size_t at = at_; (at = bytes_.find(begin, at)) != std::string_view::npos; ++at) {
        const bool begins_line = is_binary() ? at >= marks() : at == 0 || bytes_[at - 1] == '\n';
        if (!begins_line) continue;
        at_ = at - marks();
        line("BEGIN TIME STEP");
        in_step_ = true;
        return true;
    }
    return false;
}

bool EnsightFile::has_more() {
    skip_empty_lines();
    if (left() == 0) {
        if (in_step_) wrong("the file ends before END TIME STEP: it is cut short");
        return false;
    }
    return !in_step_ || !is_at("END TIME STEP");
}

std::string_view EnsightFile::line(const char* what) {
    skip_empty_lines();
    return raw_line(what);
}

std::string_view EnsightFile::raw_line(const char* what) {
    if (left() == 0) missing(what, 1);
    if (!is_binary()) return trimmed(text_line());
    const std::string_view all = record(line_bytes, what, 1);
    return trimmed(all.substr(0, all.find('\0')));
}

std::int32_t EnsightFile::integer(const char* what) { return numbers<std::int32_t>(1, 1, true, what).front(); }

std::uint64_t EnsightFile::count(const char* what) {
    const std::int32_t value = integer(what);
    if (value < 0) wrong(fmt::format("{} is {}", what, value));
    return static_cast<std::uint64_t>(value);
}

std::vector<std::int32_t> EnsightFile::counts(std::uint64_t n, std::size_t on_line, const char* what) {
    auto all = numbers<std::int32_t>(n, on_line, true, what);
    for (const std::int32_t value : all)
        if (value < 0) wrong(fmt::format("{} holds {}", what, value));
    return all;
}

std::vector<std::int32_t> EnsightFile::integers(std::uint64_t n, std::size_t on_line, const char* what) {
    return numbers<std::int32_t>(n, on_line, keeps_, what);
}

std::vector<float> EnsightFile::floats(std::uint64_t n, std::size_t on_line, const char* what) {
    return numbers<float>(n, on_line, keeps_, what);
}

std::uint64_t EnsightFile::sum_of(const std::vector<std::int32_t>& sizes) const {
    std::uint64_t sum = 0;
    for (const std::int32_t size : sizes) {
        if (static_cast<std::uint64_t>(size) > left()) wrong(fmt::format("an element has {} nodes or faces", size));
        sum += static_cast<std::uint64_t>(size);
    }
    return sum;
}

std::vector<std::int32_t> EnsightFile::rows(const std::vector<std::int32_t>& sizes, const char* what) {
    const std::uint64_t all = sum_of(sizes);
    if (is_binary()) return integers(all, 0, what);
    if (all > left()) missing(what, all);
    std::vector<std::int32_t> values;
    for (const std::int32_t size : sizes)
        if (size > 0) text_row(static_cast<std::size_t>(size), all, values, what);
    return values;
}

/// Fortran may have written the columns as one record.
std::vector<float> EnsightFile::columns(std::uint64_t n, std::size_t count, std::size_t on_line, const char* what) {
    if (count == 1) return floats(n, on_line, what);
    if (n > left()) missing(what, n);
    std::vector<float> values;
    const bool in_one = marks() > 0 && left() >= marks() && word_at(at_) == sizeof(float) * n * count;
    std::vector<float> column = in_one ? floats(n * count, 0, what) : std::vector<float>();
    for (std::size_t c = 0; c < count; ++c) {
        if (!in_one) column = floats(n, on_line, what);
        values.resize(column.empty() ? 0 : n * count);
        const float* const from = column.data() + (in_one ? c * n : 0);
        for (std::size_t i = 0; i * count + c < values.size(); ++i) values[i * count + c] = from[i];
    }
    return values;
}

std::vector<float> EnsightFile::text_nodes(std::uint64_t n, bool numbered, std::vector<std::int32_t>& numbers) {
    constexpr const char* what = "the coordinates";
    constexpr std::size_t axes = 3;
    if (n > left()) missing(what, n);
    std::vector<float> values;
    for (std::uint64_t i = 0; i < n; ++i) {
        skip_empty_lines();
        LineScanner line(text_line());
        std::int32_t number = 0;
        double value = 0;
        if (numbered && !line.next(integer_width_, number)) missing(what, n);
        if (numbered) numbers.push_back(number);
        for (std::size_t axis = 0; axis < axes; ++axis) {
            if (!line.next(float_width, value)) missing(what, n);
            values.push_back(static_cast<float>(value));
        }
        if (!line.at_end()) missing(what, n);
    }
    return values;
}

void EnsightFile::expect_whole_last_line(std::size_t integer_width) const {
    if (is_binary() || bytes_.empty() || is_space(bytes_.back())) return;
    const std::string_view line = bytes_.substr(bytes_.find_last_of('\n') + 1);
    const std::string_view word = line.substr(line.find_last_of(" \t") + 1);
    const std::size_t width = word.find_first_of(".eE") == std::string_view::npos ? integer_width : float_width;
    if (line.size() % width != 0)
        wrong(fmt::format("the last line, {}, is not ended: the file may be cut short", in_quotes(line)));
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

std::uint32_t EnsightFile::word_at(std::size_t at) const noexcept {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes_.data() + at, sizeof value);
    return big_endian_ ? __builtin_bswap32(value) : value;
}

/// So many bytes. Fortran writes the length of a record before and behind it.
std::string_view EnsightFile::record(std::uint64_t n, const char* what, std::uint64_t items) {
    skip_empty_records();
    if (n + 2 * marks() > left()) missing(what, items);
    const std::size_t begin = at_ + marks(), end = begin + static_cast<std::size_t>(n);
    if (marks() > 0)
        for (const std::size_t mark : {at_, end})
            if (word_at(mark) != n) wrong(fmt::format("a record of {} bytes should have {}", word_at(mark), n));
    at_ = end + marks();
    return bytes_.substr(begin, end - begin);
}

template <class Number>
std::vector<Number> EnsightFile::numbers(std::uint64_t n, std::size_t on_line, bool keep, const char* what) {
    if (n > left() / (is_binary() ? 4 : 1)) missing(what, n);
    std::vector<Number> values;
    if (n == 0) return values;
    if (!is_binary()) {
        values.reserve(n);
        while (values.size() < n) text_row(on_line, n, values, what);
        if (values.size() > n) missing(what, n);
        return keep ? std::move(values) : std::vector<Number>();
    }
    const std::string_view bytes = record(sizeof(Number) * n, what, n);
    if (!keep) return values;
    values.resize(n);
    std::memcpy(values.data(), bytes.data(), bytes.size());
    if (big_endian_)
        for (Number& value : values)
            value = std::bit_cast<Number>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value)));
    return values;
}

template <class Number>
void EnsightFile::text_row(std::size_t n, std::uint64_t all, std::vector<Number>& values, const char* what) {
    skip_empty_lines();
    const std::size_t before = at_, known = values.size();
    std::conditional_t<std::is_floating_point_v<Number>, double, Number> value{};
    LineScanner line(text_line());
    bool good = !line.at_end();
    while (good && !line.at_end()) {
        good = line.next(std::is_floating_point_v<Number> ? float_width : integer_width_, value);
        values.push_back(static_cast<Number>(value));
    }
    if (good && (n == 0 || values.size() - known == n)) return;
    at_ = before;
    missing(what, all);
}

} // namespace isotet::io::confined
