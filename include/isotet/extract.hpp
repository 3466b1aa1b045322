// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet {

class SurfaceSink;

enum class Ties : std::uint8_t {
    merge, ///< default mode: vertices on edges that meet in a tied point are one vertex; no zero-area triangles at ties
    keep,  ///< kept mode (`keep_degenerate`): every active edge gives a vertex, every active tet one or two triangles
};

struct ExtractOptions {
    Ties ties = Ties::merge;
    Normals normals = Normals::none; ///< gradient needs PackOptions::gradients
    bool edge_ends = false;          ///< edge_ends and edge_weights
    bool source_cells = false;       ///< needs PackOptions::source_cells
    std::vector<Field> point_fields; ///< carried onto the surface: one tuple a point of the user's grid, any components
    std::vector<PackedGrid>
        packed_fields;                 ///< carried after `point_fields`: the fields of grids with the same cells and
                                       ///< points, made by with_field() or of the same PackedFile. On the CPU only
    std::vector<Field> cell_fields;    ///< copied to the triangles: one tuple a user's cell; needs
                                       ///< PackOptions::source_cells
    std::shared_ptr<SurfaceSink> sink; ///< gives the memory of surfaces: the CPU engine makes them
                                       ///< there, and what comes from a device is copied; null: isotet's own
};

struct ExtractReport {
    std::uint64_t selected_clusters = 0;
    std::uint64_t tied_points = 0;           ///< points whose value, as stored, equals the isovalue, as stored
    std::optional<std::uint64_t> false_ties; ///< of these, made equal only by rounding: none where values are stored
                                             ///< unchanged; nothing when the input is no longer at hand
    bool near_tie = false; ///< no point is tied, but points hold the value of the field's type nearest to the isovalue
                           ///< (0.7 on float32)
    double isovalue_stored = 0;        ///< the isovalue of the surface, in the unit of the field: rounded as
                                       ///< values are; not at all where these are stored unchanged
    std::uint64_t surface_bytes = 0;   ///< all arrays of the surface
    std::uint64_t transient_bytes = 0; ///< beyond the surfaces themselves, at the peak of the call
    std::uint64_t predicted_bytes = 0; ///< what the call was expected to need at most, surfaces included, before
                                       ///< it began
};

struct Extraction {
    Surface surface;
    ExtractReport report;
};

/// Extracts the surface on which the packed field, linear in each tetrahedron, equals `isovalue`.
///
/// A point whose value equals the isovalue counts as above it; edges that meet in such a point share one vertex there
/// (Ties::merge) or have one each (Ties::keep). Tets with a corner of no data give nothing.
///
/// `packed`     C clusters; borrowed, must outlive the call
/// `isovalue`   in the unit of the field; finite
///
/// Guarantees   every active edge gives one vertex; the surface is closed except on boundary faces of the valid tets;
///              the same bytes for any thread count and on every engine
/// Cost         O(C + V + F); transient memory at most 48 bytes a triangle, 100 a selected cluster, 16 a cluster, 1 MB
///              a thread
/// Errors       invalid_argument when the isovalue is not finite, a field does not fit, or something was not packed;
///              out_of_memory; cancelled
/// Threads      safe from many threads on one packed grid
/// Method       marching tetrahedra over clusters; docs/inside/clusters.md
ISOTET_API Result<Extraction> extract(const PackedGrid& packed, double isovalue, const ExtractOptions& options = {},
                                      const Run& run = {});

/// Extracts the surfaces of several isovalues in one pass: the ranges of all clusters are looked at once, and a cluster
/// that several isovalues cut is read once. The more clusters they have in common, the more this saves.
///
/// `isovalues`  finite; in any order, with repetitions or none at all
///
/// Guarantees   the surfaces stand in the order of `isovalues`, each the same bytes as when extracted alone
/// Cost         O(C + V + F) of all surfaces; they are in memory together, and so is the transient memory of each:
///              limits as above, a cluster counted once for every isovalue that selects it
/// Errors       as above; all or nothing
ISOTET_API Result<std::vector<Extraction>> extract(const PackedGrid& packed, std::span<const double> isovalues,
                                                   const ExtractOptions& options = {}, const Run& run = {});

/// The nearest value that the type of the field can hold: 0.7 becomes 0.699999988 on a float32 field, 3.2 becomes 3 on
/// integers.
ISOTET_API double snap(const Array& values, double isovalue);

struct DirectOptions {
    ExtractOptions extract = {};              ///< whatever it asks for can be had: nothing need have been kept for it
    Precision precision = Precision::float32; ///< of positions, values and weights
    bool split_cells = false;                 ///< as PackOptions::split_cells
    std::optional<Frame> frame = {};          ///< as PackOptions::frame
    bool active_cells_only = false;           ///< the grid has only what an ActiveCellFilter kept (active_cells.hpp)
};

/// Surfaces from arrays, and what was seen on the way.
struct DirectExtraction {
    std::vector<Extraction> surfaces; ///< in the order of the isovalues; no clusters are selected
    FieldReport field;
    std::uint64_t cells_left_out = 0; ///< cells of types that are not contoured
    std::uint64_t coarse_tets =
        0; ///< active tets and other cells (of all isovalues) where rounding to float32 moves a corner by over
           ///< a thousandth of the shortest edge
    bool needs_all_cells = false; ///< with DirectOptions::active_cells_only: cells that were not kept decide how values
                                  ///< are stored, or which side of a flat tet is which; there are no surfaces
};

/// Extracts surfaces straight from the arrays of a grid; nothing is kept. For one isovalue or a few: many are faster
/// from a packed grid (extract.hpp), whose surfaces these are, in another order.
///
/// `grid`, `field`  as for pack()
/// `isovalues`      in the unit of the field; finite; in any order, with repetitions; none at all: only the report is
///                  made
///
/// Guarantees   the vertices and triangles of extract() on the packed grid, except that a repeated cell gives its
///              triangles again; triangles by the user's cells ascending, tets of a split cell in the order of split();
///              vertices by the lower, then the higher point number of their edge, a vertex at a tied point before
///              those on edges from it; gradient normals may differ in the last place, being summed in the user's order
///              of the tets; the same bytes for any thread count and on every engine
/// Cost         one pass over cells and points for each isovalue, and what its surface takes; gradient normals another
///              two. Transient memory: a byte a point; about 50 bytes a triangle where cells that are neighbours are
///              near each other in the arrays, 110 where they are shuffled
/// Errors       invalid_argument when an isovalue is not finite or a field does not fit grid or frame; invalid_data
///              as survey();
///              out_of_memory, before memory is taken, with the amount needed and the amount free; cancelled
/// Threads      safe from many threads on one grid
/// Method       marching cells over all cells, welded by sorted edges; docs/inside/direct.md
ISOTET_API Result<DirectExtraction> extract_direct(const Grid& grid, const PointField& field,
                                                   std::span<const double> isovalues, const DirectOptions& options = {},
                                                   const Run& run = {});

} // namespace isotet
