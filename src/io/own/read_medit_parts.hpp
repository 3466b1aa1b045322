// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the parts of the Medit reader share: sections, and sources of numbers, text and binary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include <isotet/result.hpp>

#include "io/own/byte_reader.hpp"
#include "io/own/text_scanner.hpp"

namespace isotet::io::medit {

/// libMeshb's keyword numbers of what is not a kind of cell.
enum Keyword : std::int32_t { other = 0, dimension = 3, vertices = 4, end = 54, sol_at_vertices = 62 };

/// A section that holds cells.
struct CellKind {
    std::string_view name;
    std::int32_t keyword;
    std::uint8_t vtk_type;
    std::uint32_t corners;
};
/// The kind of cells behind a keyword; null if it is none.
const CellKind* cell_kind(std::int32_t keyword);
/// The number of a keyword's name; `other` for those that are skipped.
std::int32_t keyword_of(std::string_view name);
std::string_view name_of_keyword(std::int32_t keyword);

/// What is wrong with a file of form none.
Error not_medit(std::string_view bytes);

/// "Vertices: message".
Error broken(std::int32_t keyword, const std::string& message);

/// Numbers of a text file.
class TextSource {
public:
    explicit TextSource(TextScanner& scanner) : scanner_(scanner) {}

    bool integer(std::int64_t& value) { return scanner_.number(value); }
    bool count(std::int64_t& value) { return scanner_.number(value); }
    bool small(std::int64_t& value) { return scanner_.number(value); }
    bool real(double& value) { return scanner_.number(value); }
    bool single() const { return false; }
    std::size_t position() const { return scanner_.position(); }
    std::string where() const { return scanner_.where(); }
    std::uint64_t records_left(std::size_t integers, std::size_t reals) const {
        return (scanner_.left() + 1) / (2 * (integers + reals));
    }

private:
    TextScanner& scanner_;
};

/// Numbers of a section of a binary file. Versions: 1 has 32-bit reals, 2 has 64-bit ones, 3 has 64-bit positions, too,
/// 4 has 64-bit integers, too.
class BinarySource {
public:
    BinarySource(ByteReader& reader, int version) : reader_(reader), version_(version) {}

    bool integer(std::int64_t& value) { return version_ >= 4 ? reader_.read(value) : small(value); }
    bool count(std::int64_t& value) { return integer(value); }
    /// 32 bits in every version.
    bool small(std::int64_t& value) {
        std::int32_t narrow = 0;
        if (!reader_.read(narrow)) return false;
        value = narrow;
        return true;
    }
    bool real(double& value) {
        if (version_ > 1) return reader_.read(value);
        float narrow = 0;
        if (!reader_.read(narrow)) return false;
        value = static_cast<double>(narrow);
        return true;
    }
    bool single() const { return version_ == 1; }
    std::size_t position() const { return reader_.position(); }
    std::string where() const;
    std::uint64_t records_left(std::size_t integers, std::size_t reals) const {
        return reader_.left() / ((version_ >= 4 ? 8 : 4) * integers + (version_ > 1 ? 8 : 4) * reals);
    }

private:
    ByteReader& reader_;
    int version_;
};

/// How the sections of a file are gone through, in the order of the file.
struct SectionVisitor {
    /// Reads a section up to its end. Not called for unknown keywords, nor for those that `skips` is true for.
    std::function<Result<void>(std::int32_t keyword, TextSource& source)> text;
    std::function<Result<void>(std::int32_t keyword, BinarySource& source)> binary;
    std::function<bool(std::int32_t keyword)> skips;
    bool headers_only = false; ///< the visitor does not read sections up to their end
};

/// How a file begins.
enum class Form { none, text, binary, swapped_binary };
Form form_of(std::string_view bytes);

/// As form_of(), but a binary file must also name a version and go on with Dimension: the number 1 begins many files.
bool looks_like_medit(std::string_view head);

/// Goes through a text or binary file, which its first bytes tell. Sections of unknown keywords are skipped.
///
/// Gives back whether the file ended with End: a binary file must.
Result<bool> visit_sections(std::string_view bytes, const SectionVisitor& visitor);

} // namespace isotet::io::medit
