// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Elements of EnSight as cells.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <isotet/grid.hpp>

namespace isotet::io::confined {

struct EnsightElement {
    std::string_view name;
    std::uint8_t vtk_type = 0;
    std::uint32_t nodes = 0;                  ///< 0: each element has its own number of them
    std::span<const std::uint8_t> order = {}; ///< of VTK's nodes among EnSight's, where it differs
};

inline constexpr std::uint8_t ensight_polygon = 7, ensight_polyhedron = 42;

/// Null for a name that is none.
const EnsightElement* ensight_element(std::string_view name);

/// Cells that grow at their end. Nodes of the file count from 1; that they are there is not looked at.
class EnsightCells {
public:
    std::uint64_t count() const noexcept { return types_.size(); }

    void add(const EnsightElement& element, std::vector<std::int32_t> nodes);
    void add_polygons(std::span<const std::int32_t> sizes, std::vector<std::int32_t> nodes);

    /// `faces`   of each cell;  `sizes`, `nodes`   of each face;  `points`   that the part has
    void add_polyhedra(std::span<const std::int32_t> faces, std::span<const std::int32_t> sizes,
                       std::span<const std::int32_t> nodes, std::uint64_t points);

    Cells take() &&;

private:
    void append(std::vector<std::int32_t> nodes);
    void end_cell(std::uint8_t type, std::int64_t end);

    std::vector<std::int32_t> connectivity_, faces_;
    std::vector<std::int64_t> offsets_{0}, face_offsets_;
    std::vector<std::uint8_t> types_;
};

} // namespace isotet::io::confined
