// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Lines, integers and floats of an EnSight Gold file, ascii, C binary or Fortran binary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/result.hpp>

#include "io/own/byte_reader.hpp"
#include "io/own/text_scanner.hpp"
#include "io/vtk/mapped_file.hpp"

namespace isotet::io::vtk {

/// Ends a walk through a file. Stays within the check of a case.
class GoldError : public std::exception {
public:
    explicit GoldError(Error error) : error_(std::move(error)) {}
    const Error& error() const noexcept { return error_; }
    const char* what() const noexcept override { return error_.message.c_str(); }

private:
    Error error_;
};

/// A cursor that never leaves the file. `what` names what should come next, for errors. Borrows path and file.
///
/// All functions but is_binary(), at_end() and left() throw GoldError.
class GoldFile {
public:
    GoldFile(const std::string& path, const MappedFile& file);

    bool is_binary() const noexcept { return form_ != Form::ascii; }
    bool at_end() noexcept { return is_binary() ? bytes_.left() == 0 : scanner_.at_end(); }
    std::size_t left() const noexcept { return is_binary() ? bytes_.left() : scanner_.left(); } ///< bytes

    /// A line, of 80 bytes in binary files, without space and zeros at its end.
    std::string_view line(const char* what);

    /// The line that comes next, which stays there.
    std::string_view peek(const char* what);

    /// The first integer tells which byte order a C binary file has: parts have small numbers.
    std::uint64_t part_number();

    std::uint64_t count(const char* what);
    std::vector<std::uint64_t> counts(std::uint64_t n, const char* what);

    /// Integers or floats, 4 bytes each.
    void skip_numbers(std::uint64_t n, const char* what);

    [[noreturn]] void wrong(const std::string& what) const;

private:
    enum class Form : std::uint8_t { ascii, c, fortran };

    [[noreturn]] void missing(const char* what, std::uint64_t n) const;
    void record_mark();
    void skip_bytes(std::uint64_t n, const char* what, std::uint64_t items);
    std::int64_t plain_integer(const char* what);
    std::int64_t integer(const char* what);

    const std::string& path_;
    ByteReader bytes_;
    TextScanner scanner_;
    Form form_ = Form::ascii;
    bool swapped_ = false;
};

} // namespace isotet::io::vtk
