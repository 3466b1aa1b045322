// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Isovalues by what lies below them: a part of the grid's volume, or of the point values.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

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

} // namespace isotet
