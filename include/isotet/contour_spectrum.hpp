// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Area and volume against the isovalue, without a surface of any.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

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

} // namespace isotet
