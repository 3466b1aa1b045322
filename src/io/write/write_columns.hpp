// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces and grids as columns of scalars: checked, names unique.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <isotet/result.hpp>
#include <isotet/surface.hpp>

#include "io/write/write_stream.hpp"

namespace isotet::io {

using Names = std::set<std::string, std::less<>>;

/// What all surface formats choose from. `surface` must outlive it.
struct SurfaceColumns {
    Column positions;                ///< float32 or float64
    Column triangles;                ///< int32 while vertices and corners are fewer than 2^31, else int64
    std::optional<Column> point_normals, cell_normals;
    std::vector<Column> edges;       ///< edge_ends (int64, 2) and edge_weights, as far as there are any
    std::vector<Column> point_fields;
    std::vector<Column> cell_fields; ///< source_cell (int64) first, if there is one
    std::vector<Column> field_data;  ///< of the file as a whole

    std::uint64_t bytes() const;     ///< of all columns
};

/// Errors   invalid_argument: an array of the wrong length or type;
///          invalid_data: a triangle with a vertex that is not there
Result<SurfaceColumns> columns_of(const Surface& surface, std::vector<std::string>& notes);

/// An array as it is.
Column column_of(std::string name, const Array& array);

/// An array's scalars, each turned into a `To`.
template <class To>
Column converted(std::string name, const Array& array) {
    Column column{std::move(name), scalar_type_of<To>(), array.tuples(), array.components(), {}};
    column.fill = [array](std::size_t begin, std::size_t end, std::byte* out) {
        array.visit([&](auto values) {
            auto* target = reinterpret_cast<To*>(out);
            const std::size_t last = end * array.components();
            for (std::size_t i = begin * array.components(); i < last; ++i) *target++ = static_cast<To>(values[i]);
        });
    };
    return column;
}

/// Notes that a field got another name because its own was taken.
std::string take_field_name(const std::string& name, Names& taken, std::vector<std::string>& notes);

/// True if int32 holds every number up to `count`.
bool fits_int32(std::uint64_t count) noexcept;

/// `count` numbers: start, start + step, ... of type int32 or int64.
Column counting(std::string name, ScalarType type, std::size_t count, std::uint64_t start, std::uint64_t step);

/// True for the integer types that hold indices: 32 and 64 bits, signed or not.
bool holds_indices(ScalarType type) noexcept;

/// The position of the first index that is negative or not below `limit`. Parallel.
std::optional<std::size_t> first_bad_index(const Array& indices, std::uint64_t limit);

/// Position of a vertex in double.
std::array<double, 3> position_of(const Surface& surface, std::uint64_t vertex);

} // namespace isotet::io
