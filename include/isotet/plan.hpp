// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How surfaces are made: the rule that chooses a method, and what it is expected to take.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// From a grid to its surfaces. Both give the same surfaces; the order of vertices and triangles differs.
enum class Method : std::uint8_t {
    direct,   ///< goes through all cells for each surface (extract_direct.hpp)
    clusters, ///< packs the grid once (pack.hpp), then extracts from the clusters that an isovalue can cut
};

/// "direct", "clusters".
ISOTET_API std::string_view name_of(Method method) noexcept;

/// Packing pays from so many surfaces of one grid on, isovalues times fields: direct extraction takes longer than
/// packing and extracting from clusters (docs/inside/choice.md). With gradient normals, for which direct
/// extraction goes through all cells twice more, much earlier.
inline constexpr std::uint64_t surfaces_that_pay_for_packing = 32;
inline constexpr std::uint64_t surfaces_with_gradients_that_pay_for_packing = 4;

/// The rule: what is taken where nothing else is asked for. Always the same for the same arguments.
constexpr Method method_for(std::uint64_t surfaces, bool gradient_normals) noexcept {
    const std::uint64_t pays =
        gradient_normals ? surfaces_with_gradients_that_pay_for_packing : surfaces_that_pay_for_packing;
    return surfaces < pays ? Method::direct : Method::clusters;
}

/// A few of a grid's cells, to tell beforehand how large surfaces will be.
class ISOTET_API FieldSample {
public:
    static constexpr std::uint64_t max_cells = std::uint64_t{1} << 14;

    /// Looks at up to `max_cells` cells, spread evenly over their numbers: at all cells of a grid that has no more.
    /// Broken cells are passed over: reading and packing report them.
    ///
    /// `split_cells`   as PackOptions::split_cells
    /// Cost     a few milliseconds
    /// Errors   invalid_argument when the field does not fit the grid; invalid_data when the arrays of the grid do not
    ///          fit together; out_of_memory
    static Result<FieldSample> create(const Grid& grid, const PointField& field, bool split_cells = false);

    std::uint64_t points() const noexcept { return points_; } ///< of the grid
    /// Of the grid; exact where all cells are tets. Elsewhere as many as take the time and memory that its cells take.
    std::uint64_t tets() const noexcept { return tets_; }
    double lower() const noexcept { return lower_; } ///< of the values seen; lower > upper: none is finite
    double upper() const noexcept { return upper_; }

    /// Triangles of an isovalue's surface, estimated. Of a surface that cuts few cells the estimate is rough: from t
    /// active tets in the sample it is wrong by about a part of 1 / sqrt(t).
    double triangles(double isovalue) const noexcept;

private:
    struct Range {
        double lower, upper, triangles;
    };
    class Looker;
    std::vector<Range> cells_seen_; ///< with data at all corners and different values
    double cells_each_ = 0;         ///< of the grid, for each one looked at
    std::uint64_t points_ = 0, tets_ = 0;
    double lower_ = 0, upper_ = -1;
};

/// What is to be made of one grid.
struct Workload {
    std::uint64_t points = 0, tets = 0;
    double surfaces = 1;           ///< isovalues times fields
    bool gradients = false;        ///< gradient normals are asked for
    bool find_range = false;       ///< isovalues follow the range of the field, which direct extraction looks for first
    double triangles = 0;          ///< of a surface, on the average
    double triangles_together = 0; ///< of the surfaces that are in memory at the same time, at most
};

/// What a method is expected to take, without reading and writing files.
struct Estimate {
    double seconds = 0;      ///< on two threads of an ordinary machine: tells minutes from seconds
    std::uint64_t bytes = 0; ///< needed beyond the grid, at the peak; rather too many than too few. Memory that is free
                             ///< is used beyond that, to keep blocks for later: up to 1/64 of the machine's
};

/// `workload`   numbers that are finite and not negative
ISOTET_API Estimate estimate(Method method, const Workload& workload) noexcept;

} // namespace isotet
