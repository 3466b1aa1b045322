// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Small files made in memory: text and numbers in either byte order, and what the tests look at in a grid.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/grid.hpp>
#include <isotet/read.hpp>

#include "grid/cells.hpp"

namespace isotet::test {

/// A file that grows at its end.
class SampleBytes {
public:
    explicit SampleBytes(bool swapped = false) : swapped_(swapped) {}

    SampleBytes& text(std::string_view text) {
        bytes_ += text;
        return *this;
    }
    template <class T>
    SampleBytes& number(T value) {
        char raw[sizeof(T)];
        std::memcpy(raw, &value, sizeof(T));
        if (swapped_) std::reverse(raw, raw + sizeof(T));
        bytes_.append(raw, sizeof(T));
        return *this;
    }
    /// Writes over what is there already.
    template <class T>
    void replace(std::size_t position, T value) {
        const SampleBytes one = SampleBytes(swapped_).number(value);
        bytes_.replace(position, sizeof(T), one.bytes_);
    }
    const std::string& str() const { return bytes_; }

private:
    std::string bytes_;
    bool swapped_;
};

/// `text` with the first `old` replaced, which must be there.
inline std::string replaced(std::string text, std::string_view old, std::string_view with) {
    const std::size_t at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return text.replace(at, old.size(), with);
}

/// All scalars of an array.
inline std::vector<double> values_of(const Array& array) {
    std::vector<double> values;
    for (std::size_t i = 0; i < array.tuples(); ++i) {
        for (std::size_t c = 0; c < array.components(); ++c) values.push_back(array.at(i, c));
    }
    return values;
}

inline const Field* find(const std::vector<Field>& fields, std::string_view name) {
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const Field& field) { return field.name == name; });
    return found == fields.end() ? nullptr : &*found;
}

/// The cells' types, one a cell.
inline std::vector<int> types_of(const Cells& cells) {
    if (cells.types.empty()) return std::vector<int>(cells.count(), static_cast<int>(cells.uniform_type));
    const auto types = cells.types.as<std::uint8_t>();
    return {types.begin(), types.end()};
}

/// The checks that isotet::read() makes of every grid.
inline Result<void> check(const Grid& grid) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    return core::check_cells(grid, *cells, {});
}

/// Eight corners of a cube and a point above it.
inline const std::vector<double> cube_points{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1,   0,    0,  0,
                                             1, 1, 0, 1, 1, 1, 1, 0, 1, 1, 0.5, 0.25, 1.5};

/// Cells of all kinds on the cube: a triangle, a tet, a hexahedron, a wedge, a pyramid; positions, VTK's types.
inline const std::vector<std::vector<int>> cube_cells{
    {0, 1, 2}, {0, 1, 3, 4}, {0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 3, 4, 5, 7}, {4, 5, 6, 7, 8}};
inline const std::vector<int> cube_types{5, 10, 12, 13, 14};

inline std::vector<double> cube_connectivity() {
    std::vector<double> all;
    for (const auto& cell : cube_cells) all.insert(all.end(), cell.begin(), cell.end());
    return all;
}

} // namespace isotet::test
