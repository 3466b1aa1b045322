// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/gold_file.hpp"

#include <array>

#include <fmt/core.h>

#include "io/own/loaded.hpp"

namespace isotet::io::vtk {
namespace {

constexpr std::size_t line_bytes = 80;

} // namespace

GoldFile::GoldFile(const std::string& path, const MappedFile& file)
    : path_(path), bytes_(file.text()), scanner_(file.text()) {
    const std::string_view head = file.text().substr(0, 4096);
    // Geometry says its form. Variables do not; but a text has no zero bytes, and binary descriptions are padded with them or
    // followed by numbers.
    const bool fortran =
        head.size() > 4 && ((head[0] == line_bytes && head[1] == 0) || (head[3] == line_bytes && head[0] == 0));
    if (fortran) form_ = Form::fortran;
    else if (head.starts_with("C Binary") || head.find('\0') != std::string_view::npos) form_ = Form::c;
    swapped_ = fortran && head[3] == line_bytes;
}

std::string_view GoldFile::line(const char* what) {
    if (!is_binary()) {
        if (scanner_.at_end()) missing(what, 1);
        return scanner_.line();
    }
    const std::string_view all =
        bytes_.rest().substr(std::min<std::size_t>(form_ == Form::fortran ? 4 : 0, left()), line_bytes);
    skip_bytes(line_bytes, what, 1);
    const std::string_view text = all.substr(0, all.find('\0'));
    return text.substr(0, text.find_last_not_of(" \n\r\t") + 1);
}

std::string_view GoldFile::peek(const char* what) {
    const std::size_t binary = bytes_.position(), text = scanner_.position();
    const std::string_view found = line(what);
    bytes_.seek(binary);
    scanner_.seek(text);
    return found;
}

std::uint64_t GoldFile::part_number() {
    constexpr std::int64_t most = 65'535;
    const std::size_t before = bytes_.position();
    std::int64_t value = integer("the number of a part");
    if (form_ == Form::c && (value < 0 || value > most)) {
        swapped_ = !swapped_;
        bytes_.seek(before);
        value = integer("the number of a part");
    }
    if (value < 0) wrong(fmt::format("a part has the number {}", value));
    return static_cast<std::uint64_t>(value);
}

std::uint64_t GoldFile::count(const char* what) {
    const std::int64_t value = integer(what);
    if (value < 0) wrong(fmt::format("{} is {}", what, value));
    return static_cast<std::uint64_t>(value);
}

std::vector<std::uint64_t> GoldFile::counts(std::uint64_t n, const char* what) {
    if (n > left()) missing(what, n);
    std::vector<std::uint64_t> all;
    if (form_ == Form::fortran) record_mark();
    for (std::uint64_t i = 0; i < n; ++i) {
        const std::int64_t value = is_binary() ? plain_integer(what) : integer(what);
        if (value < 0) wrong(fmt::format("{} holds {}", what, value));
        all.push_back(static_cast<std::uint64_t>(value));
    }
    if (form_ == Form::fortran) record_mark();
    return all;
}

void GoldFile::skip_numbers(std::uint64_t n, const char* what) {
    if (is_binary()) {
        if (n > left() / 4) missing(what, n);
        if (n > 0) skip_bytes(4 * n, what, n);
        return;
    }
    double value = 0;
    for (std::uint64_t i = 0; i < n; ++i)
        if (!scanner_.number(value)) missing(what, n);
}

void GoldFile::wrong(const std::string& what) const {
    throw GoldError(
        broken(path_, fmt::format("{}, before byte {}", what, is_binary() ? bytes_.position() : scanner_.position())));
}

void GoldFile::missing(const char* what, std::uint64_t n) const {
    wrong(fmt::format(
        "{} should have {} values or lines, but the file ends or has something else: it is cut short or broken", what,
        n));
}

/// Fortran writes the length of a record before and behind it.
void GoldFile::record_mark() {
    if (!bytes_.skip(4)) missing("a record", 1);
}

void GoldFile::skip_bytes(std::uint64_t n, const char* what, std::uint64_t items) {
    const std::uint64_t marks = form_ == Form::fortran ? 8 : 0;
    if (n + marks > bytes_.left()) missing(what, items);
    bytes_.skip(static_cast<std::size_t>(n + marks));
}

std::int64_t GoldFile::plain_integer(const char* what) {
    std::array<char, 4> raw{};
    for (char& one : raw)
        if (!bytes_.read(one)) missing(what, 1);
    std::int32_t value = 0;
    ByteReader({raw.data(), raw.size()}, swapped_).read(value);
    return value;
}

std::int64_t GoldFile::integer(const char* what) {
    std::int64_t value = 0;
    if (!is_binary()) {
        if (!scanner_.number(value)) missing(what, 1);
        return value;
    }
    if (form_ == Form::fortran) record_mark();
    value = plain_integer(what);
    if (form_ == Form::fortran) record_mark();
    return value;
}

} // namespace isotet::io::vtk
