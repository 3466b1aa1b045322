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

/// Ends a walk through a file. Stays within the check of a case.
class EnsightError : public std::exception {
public:
    explicit EnsightError(Error error) : error_(std::move(error)) {}
    const Error& error() const noexcept { return error_; }
    const char* what() const noexcept override { return error_.message.c_str(); }

private:
    Error error_;
};

enum class EnsightForm : std::uint8_t { ascii, c, fortran };
enum class EnsightOrder : std::uint8_t { unknown, little, big };

/// True when a file has the record marks of Fortran around its first line of 80 bytes, as VTK's reader tests them.
bool is_fortran(std::string_view bytes);

/// A cursor that never leaves the file. `what` names what should come next, for errors. Borrows path and bytes.
///
/// Lines of text are read as VTK's readers do: a data line is not empty, does not begin with #, and has at most 255
/// characters. Functions with `what`, and wrong(), throw EnsightError.
class EnsightFile {
public:
    /// `order`   of integers in C binary files, where another file has told it; Fortran's record marks tell it, too
    EnsightFile(const std::string& path, std::string_view bytes, EnsightForm form,
                EnsightOrder order = EnsightOrder::unknown);

    bool is_binary() const noexcept { return form_ != EnsightForm::ascii; }
    bool is_fortran() const noexcept { return form_ == EnsightForm::fortran; }
    const std::string& path() const noexcept { return path_; }
    EnsightOrder order() const noexcept { return order_; }
    std::size_t position() const noexcept { return at_; }
    std::size_t left() const noexcept { return bytes_.size() - at_; }
    std::string_view bytes() const noexcept { return bytes_; }
    void seek(std::size_t position) noexcept { at_ = position; }

    /// True when text has no more data lines, or a binary file no more bytes.
    bool at_end() noexcept;

    /// From here on the end of the data is END TIME STEP, no longer that of the file.
    void expect_end_of_step() noexcept { in_step_ = true; }

    /// True when data is left. In a step the end of the file is an error.
    bool has_more();

    /// A data line, of 80 bytes in binary files, without space and zeros at its end.
    std::string_view line(const char* what);

    /// The same, but in text also a line that is empty or a comment: descriptions may be.
    std::string_view raw_line(const char* what);

    /// The line that comes next, which stays there.
    std::string_view peek(const char* what);

    /// The first one tells the byte order of C binary files of EnSight Gold: parts have small numbers.
    std::uint64_t part_number();

    /// An integer, on a line of its own in text.
    std::uint64_t count(const char* what);

    /// The same, in C binary files of EnSight 6: the first one that is not zero tells the byte order, in which it is the
    /// larger number that fits into the file.
    std::uint64_t count_of_unknown_order(const char* what);

    /// So many integers that are not negative; in text one on a line, or all on one line.
    enum class Lines : std::uint8_t { one_each, all_on_one };
    std::vector<std::uint32_t> counts(std::uint64_t n, const char* what, Lines lines = Lines::one_each);

    /// Floats, on a line each in text; `visit(value)` gets them one by one.
    void skip_floats(std::uint64_t n, const char* what);
    template <class Visit>
    void floats(std::uint64_t n, const char* what, Visit visit) {
        if (is_binary() || n > left()) return skip_floats(n, what);
        for (std::uint64_t i = 0; i < n; ++i) visit(float_line(what));
    }

    /// Integers, `row` on a line in text.
    void skip_integers(std::uint64_t rows, std::uint64_t row, const char* what);

    /// Integers in text, on lines of so many each.
    void skip_lines(const std::vector<std::uint32_t>& sizes, const char* what);

    [[noreturn]] void wrong(const std::string& what) const;
    [[noreturn]] void missing(const char* what, std::uint64_t n) const;

private:
    std::string_view text_line();
    double float_line(const char* what);
    std::string_view data_line(const char* what, std::size_t longest);
    void record_mark(std::uint64_t bytes);
    void skip_bytes(std::uint64_t n, const char* what, std::uint64_t items);
    std::int32_t plain_integer(const char* what);
    std::int64_t integer(const char* what);

    const std::string& path_;
    std::string_view bytes_;
    std::size_t at_ = 0;
    EnsightForm form_;
    EnsightOrder order_;
    bool in_step_ = false;
    std::vector<std::int64_t> row_; ///< of the last line of integers
};

/// The words of a line.
std::vector<std::string_view> words_of(std::string_view line);

/// Integers that text has room for, in a line; false where a word is none, or does not fit into 32 bits.
bool integers_of(std::string_view line, std::vector<std::int64_t>& values);

} // namespace isotet::io::confined
