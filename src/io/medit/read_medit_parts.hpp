// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the parts of the Medit reader share: sections, and sources of numbers, text and binary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include <isotet/result.hpp>

#include "io/files/byte_reader.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io::medit {

/// libMeshb's keyword numbers of what is not a kind of cell.
enum Keyword : std::int32_t {
    other = 0,
    dimension = 3,
    vertices = 4,
    sol_at_pyramids = 26,
    end = 54,
    sol_at_vertices = 62,
    sol_at_edges = 63,
    sol_at_triangles = 64,
    sol_at_quadrilaterals = 65,
    sol_at_tetrahedra = 66,
    sol_at_prisms = 67,
    sol_at_hexahedra = 68
};

/// A section of values.
struct SolutionKind {
    std::string_view name; ///< "SolAtTetrahedra"
    std::int32_t keyword;
    std::int32_t of, of_higher_order; ///< keywords of what has the values, cells with a volume; 0: vertices, or no such
};
/// The kind behind a keyword; null if it is none.
const SolutionKind* solution_kind(std::int32_t keyword);

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

/// A section's count, checked against what the rest of the file can hold.
template <class Source>
Result<std::uint64_t> read_count(std::int32_t keyword, Source& source, std::size_t integers, std::size_t reals) {
    std::int64_t count = 0;
    if (!source.count(count)) return broken(keyword, "has no count, at " + source.where());
    const std::uint64_t most = source.records_left(integers, reals);
    if (count < 0 || static_cast<std::uint64_t>(count) > most) {
        return broken(keyword, fmt::format("states {} entries, but there is room for {} at most", count, most));
    }
    return static_cast<std::uint64_t>(count);
}

template <class Source>
Error missing(std::int32_t keyword, std::uint64_t count, std::uint64_t index, const Source& source) {
    return broken(keyword, fmt::format("states {} entries, but entry {} is broken or missing at {}", count, index + 1,
                                       source.where()));
}

template <class Source>
Result<int> read_dimension(Source& source) {
    std::int64_t value = 0;
    if (!source.small(value) || (value != 2 && value != 3)) {
        return broken(dimension, fmt::format("is {}, but 2 or 3 is the rule, at {}", value, source.where()));
    }
    return static_cast<int>(value);
}

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
    std::function<void(std::string_view name)> unknown = {}; ///< told of keywords of a text file that are skipped
    bool headers_only = false;                               ///< the visitor does not read sections up to their end
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
