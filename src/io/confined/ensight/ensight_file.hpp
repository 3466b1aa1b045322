// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Lines, integers and floats of an EnSight file, ascii, C binary or Fortran binary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/result.hpp>

namespace isotet::io::confined {

/// Ends the reading of a file. Stays within load_ensight().
class EnsightError : public std::exception {
public:
    explicit EnsightError(Error error) : error_(std::move(error)) {}
    const Error& error() const noexcept { return error_; }
    const char* what() const noexcept override { return error_.message.c_str(); }

private:
    Error error_;
};

enum class EnsightForm : std::uint8_t { ascii, c, fortran };

/// The form of a geometry, which its first line states; of the other files that of their first record.
EnsightForm ensight_form(std::string_view bytes);
bool has_fortran_records(std::string_view bytes);

/// A cursor that never leaves the file. `what` names what should come next, for errors. Borrows path and bytes.
///
/// A line of text that is empty or begins with # is skipped, unless said otherwise. Numbers in text stand between
/// spaces, or in columns: floats in 12 characters, integers in `integer_width`. Functions with `what`, and wrong(),
/// throw EnsightError.
class EnsightFile {
public:
    /// `big_endian`   of C binary files; Fortran's record marks tell it themselves
    EnsightFile(const std::string& path, std::string_view bytes, EnsightForm form, bool big_endian,
                std::size_t integer_width);

    const std::string& path() const noexcept { return path_; }
    bool is_binary() const noexcept { return form_ != EnsightForm::ascii; }
    std::size_t position() const noexcept { return at_; }
    void seek(std::size_t position) noexcept { at_ = position; }
    std::size_t left() const noexcept { return bytes_.size() - at_; }

    /// False: integers() and floats() give nothing, but go on as far and find the same errors.
    void keep(bool values) noexcept { keeps_ = values; }

    /// True when the next line begins so.
    bool is_at(std::string_view begin) noexcept;

    /// Goes to the next line that begins so; the end of the data is then END TIME STEP, no longer that of the file.
    bool find_step(std::string_view begin);

    /// True when data is left. In a step the end of the file is an error.
    bool has_more();

    /// A line, of 80 bytes in binary files, without space around it. The raw one may be empty in text, as descriptions
    /// may be.
    std::string_view line(const char* what);
    std::string_view raw_line(const char* what);

    /// An integer, on a line of its own in text; counts are not negative.
    std::int32_t integer(const char* what);
    std::uint64_t count(const char* what);

    /// Integers that are not negative, kept in any case. `on_line`: so many in each line of text, 0: any number.
    std::vector<std::int32_t> counts(std::uint64_t n, std::size_t on_line, const char* what);
    std::vector<std::int32_t> integers(std::uint64_t n, std::size_t on_line, const char* what);
    std::vector<float> floats(std::uint64_t n, std::size_t on_line, const char* what);

    /// Columns of n floats each, one after another in the file, interleaved.
    std::vector<float> columns(std::uint64_t n, std::size_t count, std::size_t on_line, const char* what);

    /// Integers in rows of different lengths, each on a line of text; how many these are.
    std::uint64_t sum_of(const std::vector<std::int32_t>& sizes) const;
    std::vector<std::int32_t> rows(const std::vector<std::int32_t>& sizes, const char* what);

    /// Nodes of EnSight 6 in text: x, y and z of each, behind its number where they are `numbered`.
    std::vector<float> text_nodes(std::uint64_t n, bool numbered, std::vector<std::int32_t>& numbers);

    /// A last line of text that is not ended may have lost digits, unless its numbers fill their columns.
    void expect_whole_last_line(std::size_t integer_width) const;

    [[noreturn]] void wrong(const std::string& what) const;
    [[noreturn]] void missing(const char* what, std::uint64_t n) const;

private:
    std::string_view text_line();
    void skip_empty_lines() noexcept;
    /// Fortran may write a record for arrays without values, too.
    void skip_empty_records() noexcept;
    std::size_t marks() const noexcept { return form_ == EnsightForm::fortran ? 4 : 0; }
    std::uint32_t word_at(std::size_t at) const noexcept;
    std::string_view record(std::uint64_t n, const char* what, std::uint64_t items);
    template <class Number>
    std::vector<Number> numbers(std::uint64_t n, std::size_t on_line, bool keep, const char* what);
    template <class Number>
    void text_row(std::size_t n, std::uint64_t all, std::vector<Number>& values, const char* what);

    const std::string& path_;
    std::string_view bytes_;
    std::size_t at_ = 0, integer_width_;
    EnsightForm form_;
    bool big_endian_, keeps_ = true, in_step_ = false;
};

/// The words of a line.
std::vector<std::string_view> words_of(std::string_view line);

} // namespace isotet::io::confined
