// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces of grids whose cells are never in memory as a whole.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/extract.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet {

/// Keeps the cells that some isovalues cut, of cells that come by in pieces: all that extract_direct() needs of them.
///
///     auto filter = ActiveCellFilter::create(points, field, isovalues, CellType::tetrahedron, options);
///     do {
///         for (each piece of the connectivity) filter->add(place of its first corner, corners);
///     } while (filter->next_round());
///     grid.cells = *filter->finish();
///     options.active_cells_only = true;
///     extract_direct(grid, field, isovalues, options);
///
/// For tetrahedra, voxels, hexahedra, wedges and pyramids, without point numbers.
///
/// Memory    a byte a point, three where there are several isovalues, and twice the cells that are kept: of smooth fields
///           a few of a hundred for each isovalue
/// Threads   add() is safe from many threads
class ISOTET_API ActiveCellFilter {
public:
    /// `points`      of the whole grid, as Grid::points
    /// `field`       one scalar a point
    /// `isovalues`   at least one, at most max_isovalues; those that will be extracted
    /// `type`        of all cells, for add(); nothing where cells have types of their own, for add_cells()
    /// `options`     those of the extraction. For gradient normals cells that share a point with one that is cut are kept,
    ///               too. Frames need all cells
    ///
    /// Cost     two passes over points and values for each isovalue
    /// Errors   invalid_argument: no isovalue, one that is not finite, options that need all cells, arrays that do not fit
    static Result<ActiveCellFilter> create(const Array& points, const PointField& field,
                                           std::span<const double> isovalues, std::optional<CellType> type,
                                           const DirectOptions& options = {});

    /// Point numbers of corners, of 32 or 64 bits; `first`: how many corners of the grid's connectivity come before.
    /// Pieces may begin and end within a cell. All calls together have each corner once, in any order. The array is not
    /// kept.
    /// Cost   at the speed of memory
    void add(std::uint64_t first, const Array& corners);

    /// Whole cells, of VTK's types, and their corners one after another; `first_cell`: how many cells come before.
    /// Vertices, lines, triangles, pixels and quadrilaterals are kept, all of them; other types are an error of
    /// finish(). Else as add().
    void add_cells(std::uint64_t first_cell, std::span<const std::uint8_t> types, const Array& corners);

    /// When all cells were added. True where all must be added once more: for gradient normals, once.
    bool next_round();

    /// The cells that were kept, in their order, and the first cell of all, so that there is one.
    /// Errors   invalid_data: a cell has a type that is not taken, a point that is not there, or one whose coordinates
    ///          are not finite or 2^91 or more; survey() tells which; invalid_argument before the last round
    Result<Cells> finish();

    /// After finish(), where `options` have source cells or cell fields: of the cells that were kept the numbers in the
    /// whole grid, uint64. Surfaces of these cells have the places of theirs in it as source cells, and cell fields of these
    /// cells alone are what they carry.
    Array numbers() const;

    static constexpr std::size_t max_isovalues = 255;

    ActiveCellFilter(ActiveCellFilter&&) noexcept;
    ActiveCellFilter& operator=(ActiveCellFilter&&) noexcept;
    ~ActiveCellFilter();

private:
    struct Data;
    explicit ActiveCellFilter(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

/// Whether surfaces end or go on at hanging points, of a grid of which only the cells that isovalues cut were kept: by the
/// faces that they cut and that one cell has, and by the cells near these, for which all go by once more.
///
///     auto around = CellsAround::of(active, field, isovalues);
///     if (around->are_needed()) for (each piece of the cells) around->add(types, corners);
///     if (*around->may_have_hanging_points()) ... // extraction needs the whole grid, closed
///
/// Memory    some hundred bytes for each such face
/// Threads   add() is safe from many threads
class ISOTET_API CellsAround {
public:
    /// `active`   all points, and the cells that were kept
    /// `field`    one scalar a point
    ///
    /// Cost     two passes over these cells, 9 to 17 bytes each; where surfaces end, up to a pass over the points
    /// Errors   invalid_argument when the field does not fit; else as close_hanging_points() (linear_cells.hpp)
    static Result<CellsAround> of(const Grid& active, const PointField& field, std::span<const double> isovalues,
                                  const Run& run = {});

    /// False where surfaces end nowhere, or at few planes that no point is beyond: those of boxes, turned ones too.
    bool are_needed() const;

    /// Whole linear cells, of VTK's types, and their corners one after another. All calls together have each cell, in any
    /// order; those with points that the grid does not have are passed over.
    void add(std::span<const std::uint8_t> types, const Array& corners);

    /// When all were added. True where a cut face lies on a larger one that no further cell has, so also where smaller
    /// faces do not cover the larger one.
    /// Errors   out_of_memory; cancelled
    Result<bool> may_have_hanging_points(const Run& run = {});

    CellsAround(CellsAround&&) noexcept;
    CellsAround& operator=(CellsAround&&) noexcept;
    ~CellsAround();

private:
    struct Data;
    explicit CellsAround(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

/// Whether points hang on cells at the boundary of a grid, or faces there lie on smaller ones that do not cover them
/// (HangingReport): the grid that is drawn is another one then.
///
/// `around`     all points, and at least the cells with a point that a triangle of the boundary has as its lowest one
/// `boundary`   boundary_of() the whole grid
///
/// Cost     a pass over the cells, 9 bytes a point, 150 for each face of the boundary
/// Errors   invalid_argument: the boundary is not one of these points; invalid_data as survey(); out_of_memory; cancelled
ISOTET_API Result<bool> has_hanging_points(const Grid& around, const Surface& boundary, const Run& run = {});

} // namespace isotet
