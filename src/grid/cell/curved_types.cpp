// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/cell/curved_types.hpp"

#include <algorithm>
#include <atomic>

#include "base/parallel.hpp"
#include "grid/cell/linear_names.hpp"
#include "grid/cell_faces.hpp"

namespace isotet {

namespace {

/// True when a cell is of a type for which `wanted` is true.
bool has_type(const Cells& cells, const auto& wanted) {
    if (cells.types.empty() || cells.types.type() != ScalarType::uint8) return false;
    const auto types = cells.types.as<std::uint8_t>();
    std::atomic<bool> found{false};
    core::parallel_ranges(types.size(), 1 << 18, [&](std::size_t begin, std::size_t end) {
        if (std::ranges::any_of(types.subspan(begin, end - begin), wanted))
            found.store(true, std::memory_order_relaxed);
    });
    return found;
}

/// True for the types of polyhedra that the grid has faces of.
auto is_split_by_faces(const Cells& cells) {
    return [listed = !cells.faces.empty()](std::uint8_t type) {
        return (listed && type == core::polyhedron_type) || core::prism_sides(type) > 0;
    };
}

} // namespace

bool is_curved(std::uint8_t vtk_type) noexcept {
    return (vtk_type >= 24 && vtk_type <= 27) || (vtk_type >= 29 && vtk_type <= 33 && vtk_type != 30) ||
           vtk_type == 37 || (vtk_type >= 64 && vtk_type <= 67) ||
           (vtk_type >= core::first_lagrange && vtk_type <= core::first_lagrange + 3) ||
           (vtk_type >= 78 && vtk_type <= 81);
}

bool has_curved_cells(const Cells& cells) { return has_type(cells, is_curved); }

bool has_polyhedra(const Cells& cells) { return has_type(cells, is_split_by_faces(cells)); }

bool has_cells_to_linearize(const Cells& cells) {
    return has_type(
        cells, [by_faces = is_split_by_faces(cells)](std::uint8_t type) { return by_faces(type) || is_curved(type); });
}

} // namespace isotet
