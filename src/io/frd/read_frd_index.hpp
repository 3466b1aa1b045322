// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where the blocks of an .frd file lie.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/result.hpp>

#include "io/files/text_scanner.hpp"
#include "io/pieces/named_components.hpp"

namespace isotet::io::frd {

/// How records are stored, by the digit at the end of a block's first line.
enum class Form : std::uint8_t { short_text, long_text, binary_float, binary_double };

inline bool is_binary(Form form) { return form == Form::binary_float || form == Form::binary_double; }

/// Records: lines up to "-3", or bytes.
struct Block {
    Form form = Form::long_text;
    std::uint64_t count = 0; ///< that the block announces
    std::size_t begin = 0, end = 0;
};

/// An array at a step.
struct Values {
    Block block;
    std::string name;
    std::vector<std::string> components; ///< names of those that are stored
    std::vector<NamedComponents> fields; ///< that it is
    std::string problem;                 ///< why it cannot be read; empty: it can
};

struct Step {
    std::int64_t number = 0;
    double value = 0;
    std::vector<Values> values;
};

struct Index {
    Block nodes, elements;
    bool has_nodes = false, has_elements = false;
    std::size_t more_meshes = 0; ///< further blocks of nodes or elements
    std::size_t unknown_lines = 0, first_unknown = 0; ///< between blocks; the byte of the first
    std::optional<std::size_t> cut_at;                ///< where a binary block begins that is longer than the file
    std::vector<Step> steps;
};

/// Errors   invalid_data: a block of nodes or elements that does not end
Result<Index> index_of(std::string_view file);

struct ElementType {
    std::uint32_t nodes = 0;
    std::uint8_t vtk_type = 0;
};

/// No nodes: there is no such type.
ElementType element_type(std::int64_t number);

/// The next line, without its end; moves `at` behind it.
std::string_view take_line(std::string_view file, std::size_t& at);

/// A number in columns from 0, with spaces around it; false where there is none.
template <class Number>
bool number_at(std::string_view line, std::size_t column, std::size_t width, Number& value) {
    if (column >= line.size()) return false;
    std::string_view word = line.substr(column, width);
    while (!word.empty() && is_space(word.front())) word.remove_prefix(1);
    while (!word.empty() && is_space(word.back())) word.remove_suffix(1);
    return parse_number(word, value);
}


} // namespace isotet::io::frd
