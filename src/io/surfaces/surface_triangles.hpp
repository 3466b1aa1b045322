// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polygons and strips, as files have them, made into triangles.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// Collects triangles and remembers from which cell of the file each comes.
class TriangleList {
public:
    /// Adds a cell: a fan of triangles around its first corner; nothing if it has fewer than three corners.
    void add_polygon(std::span<const std::uint64_t> corners);
    /// Adds a cell: triangles of three consecutive corners each, every other one turned around.
    void add_strip(std::span<const std::uint64_t> corners);
    /// Adds cells without triangles (vertices, lines).
    void skip_cells(std::uint64_t count);

    std::uint64_t cells() const noexcept { return cells_; }
    std::size_t triangles() const noexcept { return (wide_.empty() ? narrow_.size() : wide_.size()) / 3; }

    /// Values of cells, given to the triangles that the cells became. Shared where every cell became one triangle.
    Array spread(const Array& of_cells) const;

    /// The triangles as uint32 (uint64 from 2^32 vertices on); the list is empty afterwards.
    ///
    /// Errors   invalid_data when a corner is not below `vertices`
    Result<Array> take(std::uint64_t vertices);

private:
    void add_triangle(std::uint64_t a, std::uint64_t b, std::uint64_t c);
    void remember_cells();
    std::uint64_t cell_of(std::size_t triangle) const { return one_to_one_ ? triangle : cell_of_triangle_[triangle]; }

    std::vector<std::uint32_t> narrow_;
    std::vector<std::uint64_t> wide_; ///< instead of narrow_, from the first corner on that needs it
    bool one_to_one_ = true;          ///< cell i is triangle i
    std::vector<std::uint64_t> cell_of_triangle_;
    std::uint64_t cells_ = 0;
};

} // namespace isotet::io
