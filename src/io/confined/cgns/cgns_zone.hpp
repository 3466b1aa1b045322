// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A zone of a CGNS file: its size, points, cells and fields.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

#include "io/confined/cgns/cgns_tree.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {

/// A zone as its node tells of it.
struct CgnsZone {
    CgnsNode node;
    std::vector<CgnsNode> parts; ///< its children
    std::string name;            ///< "Base/Zone"
    std::size_t base = 0;        ///< among the bases of the file
    int cell_dimension = 3;
    std::size_t dimension = 3;   ///< of space
    bool is_structured = false;
    std::vector<std::uint64_t> points, cells; ///< along each axis; of unstructured zones one number

    std::uint64_t point_count() const;
    bool has_points() const { return child_labelled(parts, "GridCoordinates_t").has_value(); }
};

/// All zones of all bases.
///
/// Errors   invalid_data: a zone without a size
Result<std::vector<CgnsZone>> cgns_zones(const CgnsTree& tree, const std::string& path);

/// The values inside the rind planes, which files may add around those of a grid.
///
/// `size`     the values that are wanted along each axis
/// `parts`    the children of the node that the array is in: one of them may tell of rind planes
/// Errors     invalid_data: another number of values
Result<Array> without_rind(const CgnsTree& tree, const std::vector<CgnsNode>& parts, const Array& values,
                           const std::vector<std::uint64_t>& size);

/// How many values the arrays of a node have, rind planes included.
std::uint64_t count_with_rind(const CgnsTree& tree, const std::vector<CgnsNode>& parts,
                              const std::vector<std::uint64_t>& size);

/// Coordinates x, y and z as float64.
///
/// `name`     of the GridCoordinates_t that holds at this time; empty, or not there: the first
Result<Array> cgns_points(const CgnsTree& tree, const CgnsZone& zone, const std::string& name);

struct CgnsCounts {
    std::uint64_t cells = 0;
    std::uint64_t elements = 0; ///< of all dimensions
    std::uint64_t corners = 0;  ///< at least, of the cells
};

struct CgnsCells {
    /// Cells whose numbers follow each other, as the zone numbers its elements.
    struct Numbers {
        std::int64_t first = 0;
        std::uint64_t count = 0;
    };
    Cells cells;
    std::vector<Numbers> numbers; ///< empty: not known
    std::uint64_t elements = 0;   ///< of all dimensions

    void add_number(std::int64_t number) {
        if (numbers.empty() || numbers.back().first + static_cast<std::int64_t>(numbers.back().count) != number)
            numbers.push_back({number, 0});
        ++numbers.back().count;
    }
};

/// The elements of an unstructured zone that have the dimension of its base (or where there are none, the largest dimension
/// that there is), in the order of their numbers, whatever the order of sections.
///
/// Errors   invalid_data: sections that do not hold what their range promises, points that are not there, faces as
///          write_out_faces()
Result<CgnsCells> cgns_cells(const CgnsTree& tree, const CgnsZone& zone, std::vector<std::string>& notes);

/// Their number, without reading more than sections of mixed elements.
Result<CgnsCounts> count_cgns_cells(const CgnsTree& tree, const CgnsZone& zone);

} // namespace isotet::io::confined
