// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A field that colours a surface or a grid: its values, and the scale that fits them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/field_statistics.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/scene.hpp>
#include <isotet/surface.hpp>

namespace isotet {

/// A field that colours surfaces.
struct ColorField {
    std::string name;
    Array values; ///< a scalar for each point or cell of the grid; of a surface for each vertex or triangle
    Association association = Association::point;
    ColorScale scale;
    bool has_no_data = false;              ///< some values are NaN: a legend shows their colour
    std::vector<std::string> classes = {}; ///< names of scale.classes; `values` are then numbers of classes
};

/// The scale that is wanted.
struct ColorOptions {
    ColorScale scale;                         ///< without its ends and classes
    std::optional<ValueRange> range = {};     ///< its ends; nothing: those of the values
    std::map<double, std::string> names = {}; ///< of whole numbers that are classes; without one it is the number
};

/// A field that colours, and what a reader of the picture should know of it.
struct FoundColors {
    ColorField field;
    std::vector<std::string> notes;
};

/// The smallest and the largest value that has a place on a scale: finite, and on a logarithmic one above 0.
///
/// Returns   lower > upper where there is none
/// Cost      one parallel pass
/// Errors    cancelled; out_of_memory
ISOTET_API Result<ValueRange> colored_range(const Array& values, bool logarithmic, const Run& run = {});

/// The scale of `options` with its ends: the range that is asked for, or that of all `values` together. Values that are
/// all the same, or none, have a scale around them.
///
/// Errors   invalid_argument: a range whose ends are not ascending and finite, or not above 0 on a logarithmic scale;
///          those of colored_range()
ISOTET_API Result<ColorScale> color_scale(std::span<const Array> values, const ColorOptions& options,
                                          const Run& run = {});

/// The name of a cell field of one component that colours cells as they are: no point field has that name.
///
/// Returns   null where there is no such field
ISOTET_API const Field* cell_colors(const Grid& grid, const std::string& name);

/// A field of a grid that colours: cell_colors() as they are, otherwise what find_field() makes of the name. Cells of
/// at most twelve whole numbers have a colour for each number, unless a range or a logarithmic scale is asked for.
///
/// Errors   invalid_argument: no such field, or several components; those of color_scale()
ISOTET_API Result<FoundColors> find_colors(const Grid& grid, const std::string& name, const ColorOptions& options = {},
                                           const Run& run = {});

/// A field of a surface that colours: point fields first, with their components as find_field() names them.
///
/// Errors   as for a grid
ISOTET_API Result<FoundColors> find_colors(const Surface& surface, const std::string& name,
                                           const ColorOptions& options = {}, const Run& run = {});

/// Gives a boundary_of() a grid the values of a field of that grid, as its first field of points or cells.
///
/// Cost     of points one pass over the boundary; of cells boundary_cells()
/// Errors   invalid_argument: the field does not fit the grid; as boundary_cells()
ISOTET_API Result<void> color_boundary(Surface& boundary, const Grid& grid, const ColorField& field,
                                       const Run& run = {});

/// Fields of the grid's points at the vertices of a boundary_of() that grid, of any components, in the order of `fields`. The grid's
/// cells are needed only where the boundary has points that linearize() has made: the fields are then continued there by
/// LinearGrid::extend(), integers as float64.
///
/// `fields`   one tuple a point of the grid
///
/// Cost     a pass over the boundary a field; with points of linearize() that, once, and a copy of each field
/// Errors   invalid_argument: a field does not fit the grid, or the boundary is of another one; as linearize()
ISOTET_API Result<std::vector<Field>> fields_at_boundary(const Surface& boundary, const Grid& grid,
                                                         std::span<const Field> fields, const Run& run = {});

/// The same as color_boundary() of a field of points that fits, by fields_at_boundary().
ISOTET_API Result<void> color_boundary_by_points(Surface& boundary, const Grid& grid, const ColorField& field,
                                                 const Run& run = {});

/// The same of a field of cells that fits, with boundary_cells().
ISOTET_API void color_boundary_by_cells(Surface& boundary, const std::vector<std::uint64_t>& cells,
                                        const ColorField& field);

/// Of each triangle of a boundary_of() a grid the lowest cell that has it; UINT64_MAX where none has.
///
/// Cost     a pass over all cells, one thread; 40 bytes a triangle
/// Errors   as linearize() and split()
ISOTET_API Result<std::vector<std::uint64_t>> boundary_cells(const Surface& boundary, const Grid& grid,
                                                             const Run& run = {});

} // namespace isotet
