// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The frame of Medit files: keywords of text files, the chain of sections of binary ones.
#include <algorithm>
#include <iterator>

#include <fmt/core.h>

#include "io/medit/read_medit_parts.hpp"

namespace isotet::io::medit {

namespace {

constexpr CellKind cell_kinds[] = {
    {"Edges", 5, 3, 2},           {"Triangles", 6, 5, 3},
    {"Quadrilaterals", 7, 9, 4},  {"Tetrahedra", 8, 10, 4},
    {"Prisms", 9, 13, 6},         {"Hexahedra", 10, 12, 8},
    {"Pyramids", 49, 14, 5},      {"TrianglesP2", 24, 22, 6},
    {"EdgesP2", 25, 21, 3},       {"QuadrilateralsQ2", 27, 28, 9},
    {"TetrahedraP2", 30, 24, 10}, {"HexahedraQ2", 33, 29, 27},
    {"PrismsP2", 86, 32, 18},     {"PyramidsP2", 87, 74, 14},
    {"Hexaedra", 10, 12, 8},      {"Pentahedra", 9, 13, 6}, // as older programs write them
};

struct Name {
    std::string_view name;
    std::int32_t keyword;
};
constexpr Name names[] = {{"Dimension", dimension}, {"Vertices", vertices}, {"End", end}};

constexpr SolutionKind solution_kinds[] = {
    {"SolAtVertices", sol_at_vertices, 0, 0},      {"SolAtEdges", sol_at_edges, 0, 0},
    {"SolAtTriangles", sol_at_triangles, 0, 0},    {"SolAtQuadrilaterals", sol_at_quadrilaterals, 0, 0},
    {"SolAtTetrahedra", sol_at_tetrahedra, 8, 30}, {"SolAtPrisms", sol_at_prisms, 9, 86},
    {"SolAtHexahedra", sol_at_hexahedra, 10, 33},  {"SolAtPyramids", sol_at_pyramids, 49, 87},
    {"SolAtPentahedra", sol_at_prisms, 9, 86}, // as older programs write them
    {"SolAtHexaedra", sol_at_hexahedra, 10, 33},
};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Moves to the next word that starts with a letter and is no number.
void skip_numbers(TextScanner& scanner) {
    while (!scanner.at_end()) {
        const std::size_t start = scanner.position();
        const std::string_view word = scanner.word();
        double value = 0;
        if (is_letter(word.front()) && !parse_number(word, value)) return scanner.seek(start);
    }
}

Result<bool> visit_text(std::string_view bytes, const SectionVisitor& visitor) {
    TextScanner scanner(bytes, '#');
    std::int64_t version = 0;
    scanner.word(); // MeshVersionFormatted or MeshVersionUnformatted, which made this a text file
    if (!scanner.number(version)) {
        return Error{ErrorCode::invalid_data, "MeshVersionFormatted: no version follows, at " + scanner.where()};
    }
    while (!scanner.at_end()) {
        if (!is_letter(scanner.rest().front())) {
            return Error{ErrorCode::invalid_data,
                         "a keyword should stand at " + scanner.where() + ": a section holds more than it states"};
        }
        const std::string_view name = scanner.word();
        const std::int32_t keyword = keyword_of(name);
        if (keyword == end) return true;
        if (keyword == other && visitor.unknown) visitor.unknown(name);
        if (keyword == other || visitor.skips(keyword)) {
            skip_numbers(scanner);
            continue;
        }
        TextSource source(scanner);
        if (const auto read = visitor.text(keyword, source); !read) return read.error();
        if (visitor.headers_only) skip_numbers(scanner);
    }
    return false;
}

Result<bool> visit_binary(std::string_view bytes, bool swapped, const SectionVisitor& visitor) {
    const auto cut_short = [](std::size_t at) {
        return Error{ErrorCode::invalid_data,
                     fmt::format("ends at byte {} without the keyword End: the file is cut short", at)};
    };
    ByteReader reader(bytes, swapped);
    std::int32_t one = 0, version = 0;
    if (!reader.read(one) || !reader.read(version)) return cut_short(bytes.size());
    if (version < 1 || version > 4) {
        return Error{ErrorCode::invalid_data, fmt::format("says version {}, but isotet reads 1 to 4", version)};
    }
    for (;;) {
        const std::size_t start = reader.position();
        std::int32_t keyword = 0, narrow = 0;
        std::int64_t next = 0;
        if (!reader.read(keyword)) return cut_short(bytes.size());
        if (keyword == end) return true;
        if (version >= 3 ? !reader.read(next) : !reader.read(narrow)) return cut_short(bytes.size());
        if (version < 3) next = static_cast<std::uint32_t>(narrow); // files between 2 and 4 GB
        const std::size_t stop = next == 0 ? bytes.size() : static_cast<std::size_t>(next);
        if (next < 0 || stop > bytes.size() || stop < reader.position()) {
            return Error{
                ErrorCode::invalid_data,
                fmt::format("keyword {} at byte {} says that the next one is at byte {}, but the file has {} bytes",
                            keyword, start, next, bytes.size())};
        }
        if ((cell_kind(keyword) || !name_of_keyword(keyword).empty()) && !visitor.skips(keyword)) {
            ByteReader section(bytes.substr(0, stop), swapped);
            section.seek(reader.position());
            BinarySource source(section, version);
            if (const auto read = visitor.binary(keyword, source); !read) return read.error();
            if (next != 0 && section.left() != 0 && !visitor.headers_only) {
                return broken(keyword, fmt::format("holds {} bytes more than it states", section.left()));
            }
        }
        if (next == 0) return cut_short(bytes.size());
        reader.seek(stop);
    }
}

} // namespace

const CellKind* cell_kind(std::int32_t keyword) {
    const auto found = std::find_if(std::begin(cell_kinds), std::end(cell_kinds),
                                    [&](const CellKind& kind) { return kind.keyword == keyword; });
    return found == std::end(cell_kinds) ? nullptr : found;
}

const SolutionKind* solution_kind(std::int32_t keyword) {
    const auto found = std::find_if(std::begin(solution_kinds), std::end(solution_kinds),
                                    [&](const SolutionKind& kind) { return kind.keyword == keyword; });
    return found == std::end(solution_kinds) ? nullptr : found;
}

std::int32_t keyword_of(std::string_view name) {
    for (const Name& known : names) {
        if (known.name == name) return known.keyword;
    }
    for (const SolutionKind& kind : solution_kinds) {
        if (kind.name == name) return kind.keyword;
    }
    for (const CellKind& kind : cell_kinds) {
        if (kind.name == name) return kind.keyword;
    }
    return other;
}

std::string_view name_of_keyword(std::int32_t keyword) {
    for (const Name& known : names) {
        if (known.keyword == keyword) return known.name;
    }
    if (const SolutionKind* solution = solution_kind(keyword)) return solution->name;
    const CellKind* kind = cell_kind(keyword);
    return kind ? kind->name : std::string_view();
}

Error not_medit(std::string_view bytes) {
    return {ErrorCode::invalid_data,
            fmt::format("begins with {}, but a Medit file begins with MeshVersionFormatted, a binary one "
                        "with the number 1",
                        in_quotes(bytes.substr(0, 20)))};
}

Error broken(std::int32_t keyword, const std::string& message) {
    return {ErrorCode::invalid_data, fmt::format("{}: {}", name_of_keyword(keyword), message)};
}

std::string BinarySource::where() const { return fmt::format("byte {}", reader_.position()); }

Form form_of(std::string_view bytes) {
    std::int32_t one = 0;
    if (ByteReader(bytes).read(one)) {
        if (one == 1) return Form::binary;
        if (one == 0x01000000) return Form::swapped_binary;
    }
    return TextScanner(bytes, '#').word().starts_with("MeshVersion") ? Form::text : Form::none;
}

bool looks_like_medit(std::string_view head) {
    const Form form = form_of(head);
    if (form == Form::none || form == Form::text) return form == Form::text;
    ByteReader reader(head, form == Form::swapped_binary);
    std::int32_t one = 0, version = 0, keyword = 0;
    return reader.read(one) && reader.read(version) && reader.read(keyword) && version >= 1 && version <= 4 &&
           keyword == dimension;
}

Result<bool> visit_sections(std::string_view bytes, const SectionVisitor& visitor) {
    switch (form_of(bytes)) {
    case Form::text: return visit_text(bytes, visitor);
    case Form::binary: return visit_binary(bytes, false, visitor);
    case Form::swapped_binary: return visit_binary(bytes, true, visitor);
    case Form::none: break;
    }
    return not_medit(bytes);
}

} // namespace isotet::io::medit
