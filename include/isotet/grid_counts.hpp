// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cheap looks at a grid that has been read: what survey() counts exactly, and more, takes longer.
#pragma once

#include <cstdint>
#include <map>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// Cells by type (CellType, or VTK's number of a type that is not contoured), contoured or not.
///
/// Guarantees   the same for any thread count; an empty map when Cells::types is no array of uint8
/// Cost         one parallel pass over the types; none where all cells have the same type
ISOTET_API std::map<std::uint8_t, std::uint64_t> count_cells_by_type(const Cells& cells);

/// True for the types of which isotet makes tets: tetrahedron, voxel, hexahedron, wedge and pyramid.
ISOTET_API bool is_contoured(std::uint8_t cell_type) noexcept;

/// Whether there are triangles, polygons or quadrilaterals, and no cells with a volume: a shell, a surface, a result in two
/// dimensions. It has no isosurface; its cells are what boundary_of() gives. Cost: one pass over the types
ISOTET_API bool has_only_flat_cells(const Cells& cells);

/// Points that have the coordinates of another point. Topology goes by point numbers, so surfaces are open there, until
/// merge_points() joins them.
struct CoincidentPoints {
    std::uint64_t points = 0; ///< but the first at each place
    bool estimated = false;   ///< from a sample: exact up to 65,536 points
};

/// Estimates how many points that cells use coincide with others. The grid need not have been checked.
///
/// The sample is chosen by coordinates, so of the points at one place all are in it or none is.
///
/// Guarantees   the same for any thread count; 0 where fewer than a thousandth of the points coincide
/// Cost         one parallel pass over the points, about 65,000 of which are sorted; another over the connectivity only
///              where points coincide
ISOTET_API CoincidentPoints estimate_coincident_points(const Grid& grid);

/// Places in a face or edge of a larger cell that does not have them, as between levels of refinement: the surface is open
/// there. Points of the same place count once.
///
/// Guarantees   the same for any thread count; 0 where more than 4 million faces, and more than there are tets, are boundary
/// Cost         as survey() with faces; a sort of the boundary's faces
/// Errors       as survey()
ISOTET_API Result<std::uint64_t> count_hanging_points(const Grid& grid, const Run& run = {});

/// A power of ten within which points lie that a program has computed twice: they may differ by roundings of the grid's size.
/// 0 where no coordinate but 0 is finite. Cost: one pass over the points
ISOTET_API double rounding_of(const Array& points);

/// False where estimate_coincident_points() finds none, whatever the cells are. Cost: the first of its passes
ISOTET_API bool may_have_coincident_points(const Array& points);

} // namespace isotet
