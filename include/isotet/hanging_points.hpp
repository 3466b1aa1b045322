// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Hanging points: points on faces and edges of larger cells, which do not have them, as where adaptive solvers refine
// some cells and not their neighbours. The surface is open there, unless the larger cells list these points.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// What was found.
struct HangingReport {
    std::uint64_t points = 0;     ///< that hang on a face or an edge of a larger cell
    std::uint64_t faces = 0;      ///< of larger cells, which smaller faces of other cells cover
    std::uint64_t near_faces = 0; ///< of these: some points are beside the face, as on curved shapes
    double largest_distance = 0;  ///< of these from the face, in the unit of the points
    std::uint64_t levels = 0;     ///< n: an edge meets up to 2^n smaller ones
    std::uint64_t cells = 0;      ///< that list hanging points now
    std::uint64_t open_faces = 0; ///< on smaller ones that do not cover them: the surface stays open there
    /// That hang in a grid with cells above degree 1, which cannot list them: the surface stays open there.
    std::uint64_t curved_points = 0;

    /// Sentences for the user.
    ISOTET_API std::vector<std::string> notes() const;
};

/// A grid whose cells list the points on their faces.
struct ISOTET_API ClosedGrid {
    Grid grid; ///< the same points, cells in the same order, and fields
    HangingReport report;
    Array points;          ///< uint64, H: those that hang; of one that hangs between others, these come before
    DerivedPoints parents; ///< H rows: the larger cell's own value there, as weights of the corners of its face or edge

    /// A point field that has the larger cells' values at hanging points. float32 and float64 keep their type; integers
    /// become float64.
    ///
    /// Cost     a copy, and the hanging points
    /// Errors   invalid_argument when it has not one tuple a point; out_of_memory; cancelled
    Result<Array> interpolated(const Array& values, const Run& run = {}) const;

    /// The largest difference between these and the field's own values, of all components; NaN aside.
    /// Errors   as interpolated()
    Result<double> largest_difference(const Array& values, const Run& run = {}) const;
};

/// Finds hanging points by their places, and gives the cells that have them on a face or an edge as polyhedra that list
/// them: a face that smaller ones cover becomes these, and an edge becomes as many. linearize() splits them as any
/// others, by rules that depend on each face alone, so the surface is closed. All other cells stay as they are; so does
/// a grid without hanging points, whose arrays are shared.
///
/// A face is covered by faces of other cells that share points with it, face the other way, lie on it, and together
/// have its outline, whatever their number and sizes; faces of one size that only differ in their diagonals do not
/// count. Faces may be warped, cells of any kinds, and several levels meet in one face. Points that coincide must be
/// one (merge_points()).
///
/// Grids with curved cells are returned as they are; only curved_points of the report is set.
///
/// Guarantees   the same bytes for any thread count; a face that has a neighbour of its own is never looked at, but for
///              hashes that are equal by chance: 2^-64 a face
/// Cost         two passes over the cells, 8 bytes a point; sorting of the faces without a neighbour, about 200 bytes
///              each; where points hang, another pass and new cells
/// Errors       invalid_data as survey(); out_of_memory; cancelled
/// Threads      safe from many threads on one grid
/// Method       docs/inside/hanging.md
ISOTET_API Result<ClosedGrid> close_hanging_points(const Grid& grid, const Run& run = {});

/// Closes grids, and gives the last cells again for a grid with the same cells and points, as time steps mostly have.
///
/// Threads   safe from many: one call waits for another
class ISOTET_API KnownClosing {
public:
    KnownClosing();
    ~KnownClosing();

    /// close_hanging_points(grid). Where cells and points are those of the last call, in the same memory or by a fingerprint of
    /// 128 bits, the cells, if some list points, are in the memory that that call gave.
    ///
    /// Cost   a pass over cells and points, and close_hanging_points() where they are others
    Result<ClosedGrid> of(const Grid& grid, const Run& run = {});

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// Whether the surfaces of isovalues may end at hanging points, by places: a face that they cut, and that no other cell
/// has, lies on a larger one. For grids of which only the cells that the isovalues cut are there (active_cells.hpp):
/// their other faces have lost their neighbours. True of thin grids, too; false where only the smaller cells are cut.
///
/// `field`  one scalar a point
/// Cost     two passes over the cells, and the places of faces at which the surfaces end
/// Errors   invalid_argument when the field does not fit; else as close_hanging_points()
ISOTET_API Result<bool> may_have_hanging_points(const Grid& active, const PointField& field,
                                                std::span<const double> isovalues, const Run& run = {});

} // namespace isotet
