// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Numbers as text: the shortest decimals that read back, the same in every locale.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <string>
#include <vector>

#include "io/write/write_stream.hpp"

namespace isotet::io {

template <class Number>
void append_number(std::string& out, Number value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    out.append(digits.data(), end);
}

/// Rows [begin, end) of a column of float32 or float64, as text with spaces between and before.
class FloatRows {
public:
    FloatRows(const Column& column, std::size_t begin, std::size_t end)
        : components_(column.components), is_float_(column.type == ScalarType::float32),
          bytes_((end - begin) * column.tuple_bytes()), begin_(begin) {
        column.fill(begin, end, bytes_.data());
    }

    void append(std::string& out, std::size_t row) const {
        for (std::size_t i = (row - begin_) * components_; i < (row - begin_ + 1) * components_; ++i) {
            out += ' ';
            if (is_float_) append_number(out, reinterpret_cast<const float*>(bytes_.data())[i]);
            else append_number(out, reinterpret_cast<const double*>(bytes_.data())[i]);
        }
    }

private:
    std::size_t components_;
    bool is_float_;
    std::vector<std::byte> bytes_;
    std::size_t begin_;
};

/// The corners of triangles [begin, end).
inline std::vector<std::int64_t> corners_of(const Array& triangles, std::size_t begin, std::size_t end) {
    std::vector<std::int64_t> corners(3 * (end - begin));
    triangles.visit([&](auto values) {
        for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<std::int64_t>(values[3 * begin + i]);
    });
    return corners;
}

} // namespace isotet::io
