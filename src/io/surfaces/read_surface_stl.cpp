// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// STL: ascii and binary. Every triangle has three vertices of its own.
#include <array>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/byte_reader.hpp"
#include "io/files/pace.hpp"
#include "io/files/scalars.hpp"
#include "io/surfaces/surface_parts.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t header_bytes = 80;
constexpr std::size_t facet_bytes = 50;

Surface soup(std::vector<float> positions, std::vector<float> normals) {
    Surface surface;
    const std::size_t corners = positions.size() / 3;
    if (corners <= std::numeric_limits<std::uint32_t>::max()) {
        std::vector<std::uint32_t> triangles(corners);
        std::iota(triangles.begin(), triangles.end(), 0U);
        surface.triangles = Array::own(std::move(triangles), 3);
    } else {
        std::vector<std::uint64_t> triangles(corners);
        std::iota(triangles.begin(), triangles.end(), std::uint64_t{0});
        surface.triangles = Array::own(std::move(triangles), 3);
    }
    surface.positions = Array::own(std::move(positions), 3);
    surface.normals = Array::own(std::move(normals), 3);
    surface.normals_kind = Normals::face;
    return surface;
}

std::uint32_t binary_count(std::string_view content) {
    ByteReader reader(content, std::endian::native != std::endian::little);
    std::uint32_t count = 0;
    if (!reader.skip(header_bytes) || !reader.read(count)) return 0;
    return count;
}

Result<Surface> parse_binary(std::string_view content, const Progress& progress) {
    const std::uint64_t count = binary_count(content);
    const std::uint64_t expected = header_bytes + sizeof(std::uint32_t) + count * facet_bytes;
    if (content.size() != expected) {
        return invalid_data(fmt::format("{} triangles make {} bytes of binary STL, but the file has {}", count,
                                        expected, content.size()));
    }
    std::vector<float> positions(static_cast<std::size_t>(count) * 9), normals(static_cast<std::size_t>(count) * 3);
    ByteReader reader(content, std::endian::native != std::endian::little);
    reader.skip(header_bytes + sizeof(std::uint32_t));
    Pace pace(progress, content.size());
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < 3; ++k) reader.read(normals[3 * i + k]);
        for (std::size_t k = 0; k < 9; ++k) reader.read(positions[9 * i + k]);
        reader.skip(2);
        if (!pace.goes_on(reader.position())) return Pace::cancelled();
    }
    return soup(std::move(positions), std::move(normals));
}

/// In lower case, for comparing; STL's keywords come in both.
bool is_word(std::string_view word, std::string_view keyword) {
    if (word.size() != keyword.size()) return false;
    for (std::size_t i = 0; i < word.size(); ++i) {
        const char lower = word[i] >= 'A' && word[i] <= 'Z' ? static_cast<char>(word[i] - 'A' + 'a') : word[i];
        if (lower != keyword[i]) return false;
    }
    return true;
}

class AsciiReader {
public:
    AsciiReader(std::string_view content, const Progress& progress)
        : scanner_(content), pace_(progress, content.size()) {}

    Result<Surface> read() {
        bool inside = false; // of solid ... endsolid
        for (;;) {
            const auto word = scanner_.word();
            if (word.empty()) break;
            if (is_word(word, "solid") && !inside) {
                inside = true;
                scanner_.next_line();
            } else if (is_word(word, "endsolid") && inside) {
                inside = false;
                scanner_.next_line();
            } else if (is_word(word, "facet") && inside) {
                if (auto facet = read_facet(); !facet) return facet.error();
            } else {
                return invalid_data(fmt::format("{} before {}: facet or {} was expected", in_quotes(word),
                                                scanner_.where(), inside ? "endsolid" : "solid"));
            }
            if (!pace_.goes_on(scanner_.position())) return Pace::cancelled();
        }
        if (inside) return invalid_data("the file ends before endsolid");
        return soup(std::move(positions_), std::move(normals_));
    }

private:
    Result<void> read_facet() {
        if (auto normal = expect({"normal"}, normals_); !normal) return normal;
        if (auto begin = expect_words({"outer", "loop"}); !begin) return begin;
        for (int i = 0; i < 3; ++i) {
            if (auto vertex = expect({"vertex"}, positions_); !vertex) return vertex;
        }
        return expect_words({"endloop", "endfacet"});
    }

    Result<void> expect_words(std::initializer_list<std::string_view> words) {
        for (const auto word : words) {
            if (!is_word(scanner_.word(), word))
                return invalid_data(fmt::format("before {}: \"{}\" was expected", scanner_.where(), word));
        }
        return {};
    }

    /// The word, and three numbers.
    Result<void> expect(std::initializer_list<std::string_view> words, std::vector<float>& numbers) {
        if (auto found = expect_words(words); !found) return found;
        for (int i = 0; i < 3; ++i) {
            float value = 0;
            if (!read_scalar(scanner_, value)) return invalid_data(fmt::format("{}: not a number", scanner_.where()));
            numbers.push_back(value);
        }
        return {};
    }

    TextScanner scanner_;
    Pace pace_;
    std::vector<float> positions_, normals_;
};

} // namespace

Result<Surface> parse_stl(std::string_view content, const Progress& progress) {
    // Binary files, too, may start with "solid": their length tells.
    const bool is_binary =
        content.size() == header_bytes + sizeof(std::uint32_t) + std::uint64_t{binary_count(content)} * facet_bytes;
    const std::string_view text = without_byte_order_mark(content);
    TextScanner scanner(text.substr(0, 256));
    if (!is_binary && is_word(scanner.word(), "solid")) return AsciiReader(text, progress).read();
    return parse_binary(content, progress);
}

} // namespace isotet::io
