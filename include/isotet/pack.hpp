// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <isotet/export.hpp>
#include <isotet/frame.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

namespace core {
struct Packed;
}

enum class Precision : std::uint8_t { float32, float64 };

struct PackOptions {
    Precision precision = Precision::float32;
    bool source_cells = false; ///< keep the user's cell number of every packed tet (4 bytes a tet)
    bool split_cells = false;  ///< store pyramids, wedges and hexahedra as tets: the surface has 2 to 3 times
                               ///< the triangles
    bool gradients = false;    ///< keep a gradient direction at every point (4 bytes a point), for gradient normals
    std::optional<Frame> frame = {}; ///< the grid is a piece of one that is stored so, perhaps without a cell; kept for
                                     ///< with_field() and with_points(). It must know the field, and hold its values
};

/// What packing found and what it costs.
struct PackReport {
    std::uint64_t points = 0;                              ///< points that tets use
    std::uint64_t tets = 0;                                ///< stored tets: collapsed and repeated ones dropped
    std::uint64_t pyramids = 0, wedges = 0, hexahedra = 0; ///< stored as they are
    std::uint64_t split_cells = 0; ///< cells with repeated corners, stored as tets beside native cells: the surface may
                                   ///< be open at their quadrilateral faces
    std::uint64_t clusters = 0;
    std::uint64_t cells_left_out = 0; ///< cells of types that are not contoured
    std::uint64_t collapsed_tets = 0, repeated_tets = 0, negative_tets = 0, inverted_tets = 0, flat_tets = 0;
    std::uint64_t flushed_coordinates = 0; ///< non-zero coordinates below 2^-70, stored as 0
    std::uint64_t coarse_clusters = 0; ///< clusters where rounding to float32 moves a point by over a thousandth of the
                                       ///< shortest edge
    std::uint64_t bytes = 0;           ///< packed grid, point map included
    std::uint64_t source_bytes = 0;    ///< of the map to user's cells
    std::uint64_t gradient_bytes = 0;
};

/// How a field's values are stored; see docs/inside/precision.md.
struct FieldReport {
    std::string name;
    double lower = 0, upper = 0; ///< smallest and largest finite value at the points that tets use, as the user
                                 ///< gave them; lower > upper: there is none
    std::uint64_t no_data = 0;   ///< points with NaN
    std::uint64_t infinite = 0;
    std::uint64_t flushed = 0; ///< non-zero values that are stored as 0
    double offset = 0;         ///< stored = (value - offset) * scale, rounded
    double scale = 1;          ///< a power of two
    bool unchanged = false;    ///< no rounding: float32 or integers below 2^24 (2^53 in double packing)
};

/// The grid in clusters: what every engine works on. A handle: copying shares everything, and what it refers to never
/// changes. The grid that was packed is not needed any more. A default-made handle is an empty grid.
///
/// Where values were changed as they were stored (FieldReport), the array of the contoured field stays shared, to tell
/// false ties; not a borrowed one, without which nothing is told of them.
///
/// Threads   safe from many threads
class ISOTET_API PackedGrid {
public:
    PackedGrid();
    explicit PackedGrid(std::shared_ptr<const core::Packed> data);
    PackedGrid(const PackedGrid&) = default; // no move: a handle that was moved from stays what it was
    PackedGrid& operator=(const PackedGrid&) = default;
    ~PackedGrid() = default;

    const PackReport& report() const noexcept;
    const FieldReport& field() const noexcept;
    Precision precision() const noexcept;
    std::uint64_t user_point_count() const noexcept; ///< points of the user's grid, unused ones too
    std::uint64_t user_cell_count() const noexcept;

    /// The frame of PackOptions or with_frame(); null: there is none.
    const Frame* frame() const noexcept;

    /// The same grid with another frame (or none), for the with_field() and with_points() that follow; nothing that is
    /// stored changes.
    PackedGrid with_frame(const std::optional<Frame>& frame) const;

    /// The packed arrays, for engines; src/packed/packed.hpp draws them.
    const core::Packed& data() const noexcept { return *data_; }
    const std::shared_ptr<const core::Packed>& shared_data() const noexcept { return data_; }

    /// The same grid with another field (or the next time step on the same cells); cells and points are shared.
    ///
    /// `field`   one scalar for each point of the user's grid
    /// Cost      one pass over values and tets; 4 bytes a point (8 in double) and 0.1 bytes a tet are allocated
    /// Errors    invalid_argument when the length or the number of components is wrong, or the frame does not know the
    ///           field or hold its values; out_of_memory; cancelled
    Result<PackedGrid> with_field(const PointField& field, const Run& run = {}) const;

    /// The same grid with other coordinates (a mesh that moves); cells and field are shared.
    ///
    /// `points`  float32 or float64, 3 components, as many as the user's grid has, in the same order
    /// Cost      one pass over points and tets; 12 bytes a point (24 in double) are allocated
    /// Errors    invalid_argument when the shape or type is wrong, or points are outside the frame; invalid_data when a coordinate is not finite or 2^91
    ///           or more, or when a tet changes its orientation (pack again); out_of_memory; cancelled
    Result<PackedGrid> with_points(const Array& points, const Run& run = {}) const;

private:
    std::shared_ptr<const core::Packed> data_;
};

/// Packs a grid: cells are checked and split into tets, tets are oriented, sorted along a Hilbert curve, and gathered
/// into clusters of at most 128 points by growth.
///
/// `field`      the field to contour; its length must be the number of points
/// Guarantees   the packed grid is the same bytes for any thread count
/// Cost         O(T log T); about 10 to 11 bytes a tet stay, at most 40 bytes a tet beyond the input at the peak
/// Errors       invalid_data as survey(); invalid_argument when the field does not fit the grid, or either does not fit
///              the frame; out_of_memory, before memory is taken, with the amount needed and the amount free; cancelled
/// Threads      safe from many threads
/// Method       docs/inside/packing.md
ISOTET_API Result<PackedGrid> pack(const Grid& grid, const PointField& field, const PackOptions& options = {},
                                   const Run& run = {});

/// A packed grid as arrays again: points with the user's numbers, cells cluster after cluster, the packed field. What packing
/// changed stays so (values and coordinates as they are stored, dropped and split cells). Points that no cell uses have the
/// coordinates of one that is used, and NaN (integers: 0).
///
/// Guarantees   the same bytes for any thread count
/// Cost         one pass; of a grid in a file, all of it is read
/// Errors       out_of_memory; of a grid in a file: as PackedFile; cancelled
ISOTET_API Result<Grid> unpack(const PackedGrid& packed, const Run& run = {});

/// What unpack() gives, with some of the cells.
struct UnpackedSample {
    Grid grid;
    std::uint64_t cells = 0; ///< of all of the packed grid
};

/// All points and values, and about `cells` of the cells (at most so many), from 256 places spread evenly over the grid.
///
/// Guarantees   as unpack()
/// Cost         of a grid in a file points and values are read, and the chunks at these places
/// Errors       as unpack()
ISOTET_API Result<UnpackedSample> unpack_sample(const PackedGrid& packed, std::uint64_t cells, const Run& run = {});

/// The packed field alone, by the user's point numbers, as unpack() gives it.
ISOTET_API Result<Field> unpack_field(const PackedGrid& packed, const Run& run = {});

} // namespace isotet
