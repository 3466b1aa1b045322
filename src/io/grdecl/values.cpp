// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/grdecl/values.hpp"

#include <algorithm>
#include <charconv>
#include <vector>

#include <fmt/core.h>

#include "base/parallel.hpp"
#include "io/files/first_error.hpp"
#include "io/files/pace.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io::grdecl {

namespace {

constexpr std::uint64_t max_values = std::uint64_t{1} << 48U;
constexpr std::size_t piece_bytes = std::size_t{1} << 19U;

/// One word of a list.
struct Word {
    std::uint64_t repeat = 1;
    std::string_view number; ///< empty: a default
};

/// Calls use(word) for each word of a text until it returns false; comments are gone over.
///
/// Returns   false, with `at` at the word, where a repeat count is none, or use() said no
template <class Use>
bool each_word(std::string_view text, std::string_view& at, const Use& use) {
    const char* cursor = text.data();
    const char* const end = cursor + text.size();
    while (true) {
        while (cursor != end && is_space(*cursor)) ++cursor;
        if (cursor == end) return true;
        if (*cursor == '-' && end - cursor > 1 && cursor[1] == '-') {
            while (cursor != end && *cursor != '\n') ++cursor;
            continue;
        }
        const char* const begin = cursor;
        const char* star = nullptr;
        const bool quoted = *begin == '\'' || *begin == '"';
        for (; cursor != end && !is_space(*cursor); ++cursor)
            if (*cursor == '*' && !quoted) star = cursor;
        Word word{1, {begin, static_cast<std::size_t>(cursor - begin)}};
        if (star) {
            const auto [stop, error] = std::from_chars(begin, star, word.repeat);
            word.number = {star + 1, static_cast<std::size_t>(cursor - star - 1)};
            if (error != std::errc{} || stop != star || word.repeat == 0 || word.repeat > max_values) word.repeat = 0;
        }
        if (word.repeat == 0 || !use(word)) {
            at = {begin, static_cast<std::size_t>(cursor - begin)};
            return false;
        }
    }
}

/// A text in pieces that end at line ends, and so never in a word or a comment.
std::vector<std::string_view> pieces_of(std::string_view text) {
    std::vector<std::string_view> pieces;
    while (!text.empty()) {
        const std::size_t line = text.find('\n', std::min(piece_bytes, text.size()));
        const std::size_t size = line == std::string_view::npos ? text.size() : line + 1;
        pieces.push_back(text.substr(0, size));
        text.remove_prefix(size);
    }
    return pieces;
}

/// The error of a word, with the line where it stands.
Error fail_at(const Record& record, std::string_view word) {
    Record here = record;
    here.body = word;
    return here.fail(fmt::format("has {}, which is no number", in_quotes(word)));
}

Result<std::vector<std::uint64_t>> count_pieces(const Record& record, const std::vector<std::string_view>& pieces,
                                                const Progress& progress) {
    std::vector<std::uint64_t> counts(pieces.size());
    FirstError failed;
    core::parallel_pieces(pieces.size(), 1, progress, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            std::string_view at;
            const bool read = each_word(pieces[i], at, [&](const Word& word) {
                counts[i] += word.repeat;
                return counts[i] <= max_values;
            });
            if (!read) failed.add(i, fail_at(record, at));
        }
    });
    if (auto counted = failed.result(); !counted) return counted.error();
    if (progress.cancelled()) return Pace::cancelled();
    return counts;
}

bool read_number(std::string_view text, double& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return (error == std::errc{} && end == text.data() + text.size()) || parse_number(text, value);
}

} // namespace

Result<std::uint64_t> count_values(const Record& record, const Progress& progress) {
    const auto counts = count_pieces(record, pieces_of(record.body), progress);
    if (!counts) return counts.error();
    std::uint64_t count = 0;
    for (const std::uint64_t part : *counts) {
        count += part;
        if (count > max_values) return record.fail("has more than 2^48 numbers");
    }
    return count;
}

Result<void> read_values(const Record& record, double unset, std::span<double> to, const Progress& progress) {
    const auto pieces = pieces_of(record.body);
    const auto counts = count_pieces(record, pieces, progress);
    if (!counts) return counts.error();
    std::vector<std::size_t> begins(pieces.size());
    for (std::size_t i = 1; i < pieces.size(); ++i) begins[i] = begins[i - 1] + (*counts)[i - 1];
    FirstError failed;
    core::parallel_pieces(pieces.size(), 1, progress, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            auto next = to.begin() + static_cast<std::ptrdiff_t>(begins[i]);
            std::string_view at;
            const bool read = each_word(pieces[i], at, [&](const Word& word) {
                double value = unset;
                if (!word.number.empty() && !read_number(word.number, value)) return false;
                next = std::fill_n(next, word.repeat, value);
                return true;
            });
            if (!read) failed.add(i, fail_at(record, at));
        }
    });
    if (progress.cancelled()) return Pace::cancelled();
    return failed.result();
}

} // namespace isotet::io::grdecl
