// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Words, entries and lists of OpenFOAM's files, ASCII and binary.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

#include "io/files/text_scanner.hpp"
#include "io/foam/case_files.hpp"

namespace isotet::io::foam {

/// What FoamFile { ... } says. `single`: the file states that its numbers are float32.
struct Header {
    std::string type; ///< "volScalarField"
    bool binary = false, single = false;
    std::size_t label_bytes = 4, scalar_bytes = 8;
};

/// Lists of point numbers, one after another.
struct Faces {
    std::vector<std::uint64_t> begins{0}; ///< one more than there are faces; empty where all have `each` points
    std::vector<std::int32_t> points;
    std::uint64_t each = 0;

    std::size_t count() const noexcept {
        return each > 0 ? static_cast<std::size_t>(points.size() / each) : begins.size() - 1;
    }
    std::uint64_t begin(std::size_t face) const noexcept { return each > 0 ? face * each : begins[face]; }
    std::span<const std::int32_t> of(std::size_t face) const noexcept {
        return {points.data() + begin(face), points.data() + begin(face + 1)};
    }

    /// Frees `begins` where all have as many points.
    void drop_regular_begins();
};

/// A cursor over a file. Every error says which file, what was read, and where.
///
/// Guarantees   no memory is taken for a count before the bytes behind it are known to be there
class ISOTET_API Scanner {
public:
    explicit Scanner(CaseText file) : file_(std::move(file)), text_(without_byte_order_mark(file_.text)) {}

    /// Reads FoamFile { ... } and applies it to what follows.
    Result<Header> header();
    /// The same of a collated file, too, whose type is decomposedBlockData.
    Result<Header> any_header();
    const Header& format() const noexcept { return header_; }
    /// For a file without a header of its own, which another one includes.
    void use(const Header& header) { header_ = header; }
    /// True when the first word is FoamFile.
    bool is_foam() const;

    bool at_end();
    /// The next character that is neither space nor comment; '\0' at the end.
    char peek();
    /// Takes it, if it is `c`.
    bool take(char c);
    Result<void> expect(char c, std::string_view what);
    /// A word, a string with its quotes, or one of ( ) { } [ ] ; alone. Empty at the end.
    std::string_view token();
    /// Behind a keyword: goes behind the ';' of its entry, or its whole { }.
    Result<void> skip_entry();

    /// A list of whole numbers below 2^31, or -1.
    ///
    /// `repeated`   as many as N{x} may stand for
    Result<std::vector<std::int32_t>> labels(std::string_view what, std::size_t repeated);
    /// Goes behind such a list, and says how many it has. Numbers are not looked at.
    Result<std::uint64_t> skip_labels(std::string_view what);
    /// A list of tuples. `repeated` as above, in tuples.
    Result<std::vector<double>> tuples(std::size_t components, std::string_view what, std::size_t repeated);
    /// One tuple: a number, or numbers in parentheses.
    Result<std::vector<double>> tuple(std::size_t components, std::string_view what);
    Result<Faces> faces();
    Result<std::uint64_t> count(std::string_view what);
    /// A list of bytes, as they are: N(...).
    Result<std::string_view> bytes(std::string_view what);
    /// What there is of such a list, in a file of which only the beginning was opened.
    std::string_view bytes_begun();
    /// Up to the cursor.
    std::string_view text_so_far() const noexcept { return text_.substr(0, at_); }

    const CaseText& file() const noexcept { return file_; }
    Error fail(std::string_view what) const;

private:
    template <class Read, class ReadParts>
    Result<void> list(std::string_view what, std::size_t item_bytes, std::size_t repeated, const Read& read,
                      const ReadParts& read_parts);
    template <class Part, class ReadOne>
    std::optional<std::vector<Part>> parts_of_list(std::uint64_t items, char end_of_item, const ReadOne& read_one);
    bool number(double& value);
    bool number(std::int64_t& value);
    bool tuple_here(std::size_t components, std::vector<double>& to);
    Result<void> face_here(Faces& faces);
    Result<Faces> compact_faces();
    bool skip_binary_list(std::string_view type);
    void skip_space();

    CaseText file_;
    std::string_view text_;
    std::size_t at_ = 0;
    Header header_;
};

/// Tuples of a field class or a list type ("volVectorField", "vector"): how many numbers; 0 where it is none of both.
std::size_t components_of(std::string_view type);

} // namespace isotet::io::foam
