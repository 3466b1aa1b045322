// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

// Isovalues within a range, for whoever has a field but no isovalue in mind.

/// Whether levels are computed exactly or moved to short decimals.
enum class LevelRounding : std::uint8_t {
    none,           ///< lower + k (upper - lower) / (count + 1)
    short_decimals, ///< the same, rounded to a tenth of the distance between two levels or better: 0.3, not 0.29873
};

/// `count` isovalues that divide a range into equal parts; neither end is one of them, unless both are the same value.
///
/// `lower`, `upper`   in the unit of the field; finite. Nothing is returned where lower > upper or one is not finite
/// Returns            the levels, ascending; with `short_decimals` without repetitions, so perhaps fewer
/// Guarantees         finite, also where upper - lower is too large for a double
ISOTET_API std::vector<double> evenly_spaced_levels(double lower, double upper, std::uint64_t count,
                                                    LevelRounding rounding = LevelRounding::none);

// Isovalues by what lies below them: a part of the grid's volume, or of the point values.

/// "90 % of the volume is below", or "the 95th percentile of the point values".
struct IsovalueShare {
    enum class Of : std::uint8_t {
        volume, ///< ContourSpectrum::volume_below over ContourSpectrum::volume
        points  ///< finite values of all points of the grid, each counted once
    };
    Of of = Of::volume;
    double percent = 50; ///< 0 to 100
};

/// The isovalue of each share, in their order.
///
/// Of volume: the least isovalue with at least the share of the volume below it, where the field is linear in each tet
/// (contour_spectrum() says which tets those are); 0 % is the smallest, 100 % the largest value. Where tets of one value
/// make the volume jump over the share: that value.
/// Of points: the least of the n values so that at least percent * n / 100 of them are not above it (nearest rank;
/// NumPy's method "inverted_cdf").
///
/// Guarantees   the volume below the isovalue is the share up to 1e-12 of the volume, jumps aside; the same for any thread
///              count
/// Cost         of volume: four to seven contour_spectrum(); of points: a copy of the values, partly sorted
/// Errors       invalid_argument: a percent that is not from 0 to 100, a field that does not fit; invalid_data: no finite
///              value, no volume, and as contour_spectrum(); out_of_memory; cancelled
ISOTET_API Result<std::vector<double>> isovalues_at(const Grid& grid, const PointField& field,
                                                    std::span<const IsovalueShare> shares, const Run& run = {});

/// Cells that go by. `each` hands over all of them in their order, some at a time: the number of the first, and a grid of
/// these and of all points.
struct CellsInTurn {
    std::uint64_t count = 0;
    std::function<Result<void>(const std::function<void(std::uint64_t first, const Grid& some)>& take)> each;
};

/// The same numbers of linear cells that go by as often as needed: five to eight times.
/// Errors   those of `each`, too
ISOTET_API Result<std::vector<double>> isovalues_at(const Array& points, const CellsInTurn& cells,
                                                    const PointField& field, std::span<const IsovalueShare> shares,
                                                    const Run& run = {});

// Area and volume against the isovalue, without a surface of any.

/// Areas in the square of the unit of the points, volumes in its cube.
///
/// `isovalues`      as they were given, N
/// `area`           N, of the isosurface at each: what its triangles add up to
/// `volume_below`   N, where the field is below; it never falls from one isovalue to the next. What is enclosed by
///                  surfaces around low values; around high ones it is `volume` less this
/// `volume`         of all tets that count
/// `tets`           that count
/// `no_data_tets`   that do not: a corner is NaN or infinite
struct ContourSpectrum {
    std::vector<double> isovalues, area, volume_below;
    double volume = 0;
    std::uint64_t tets = 0, no_data_tets = 0;
};

/// Area of the isosurface and volume below it at many isovalues, in one pass over the tets. Within a tet area is a
/// quadratic and volume a cubic polynomial between two values of its corners: at the isovalues they are exact up to
/// rounding.
///
/// Cells are taken as their tets, as with PackOptions::split_cells: the surface of whole hexahedra, wedges and pyramids,
/// which has fewer triangles, has another area by the error of both. Polyhedra and quadratic cells are taken as
/// linearize() makes them. Repeated tets count each time, tets of any orientation with their volume above 0.
/// A point whose value equals the isovalue counts as above.
///
/// `field`       one value a point
/// `isovalues`   1 to 65,536, finite, ascending
///
/// Guarantees   the same bytes for any thread count
/// Cost         O(T log N + E), E how often an isovalue is within a tet: 60 ns a tet and 4 ns for each of E on one core;
///              8 bytes a point, up to 25 MB beside
/// Errors       invalid_argument when field or isovalues are not as above; invalid_data as survey(); out_of_memory;
///              cancelled
/// Threads      safe from many threads on one grid
/// Method       Bajaj, Pascucci, Schikore: The contour spectrum (1997)
ISOTET_API Result<ContourSpectrum> contour_spectrum(const Grid& grid, const PointField& field,
                                                    std::span<const double> isovalues, const Run& run = {});

/// The same at `steps` + 1 isovalues that divide the range of the field's finite values equally, both ends among them;
/// at one where all values are the same, at none where none is finite.
///
/// `steps`   1 to 65,535
ISOTET_API Result<ContourSpectrum> contour_spectrum_over_range(const Grid& grid, const PointField& field,
                                                               std::uint64_t steps, const Run& run = {});
/// Of a range that is known.
ISOTET_API Result<ContourSpectrum> contour_spectrum_over_range(const Grid& grid, const PointField& field,
                                                               std::uint64_t steps, const ValueRange& range,
                                                               const Run& run = {});

/// Isovalues that follow from the values of a field: levels in the range that they mostly lie in (typical_range()), or in
/// that of all finite ones. As ReadActiveCells::choose it goes to the reader processes, too; of any other function these
/// read all cells.
struct RangeLevels {
    std::uint64_t count = 1;
    LevelRounding rounding = LevelRounding::none;
    bool whole_range = false;

    /// Errors   invalid_data: the field has no finite value
    ISOTET_API Result<std::vector<double>> operator()(const PointField& field) const;
    /// Of a range that is known.
    ISOTET_API Result<std::vector<double>> within(const ValueRange& range, const PointField& field) const;
};

} // namespace isotet
