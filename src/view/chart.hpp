// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What stands above the slider: how a field's values are spread, and how large surfaces will be.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::view {

/// `lower`, `upper`   of the finite values; lower > upper where there is none
/// `points`           values in each of `bins` equal parts of the range, of about a million of them
/// `triangles`        expected of isovalues at the middles of the parts
/// `first`            an isovalue to begin with: half of all triangles of the chart are below it; a short decimal
struct Chart {
    static constexpr std::size_t bins = 128;
    double lower = 1, upper = 0;
    std::vector<std::uint64_t> points;
    std::vector<double> triangles;
    double first = 0;
    std::uint64_t no_data = 0; ///< values that are NaN
};

/// `triangles`   how many an isosurface is expected to have
/// Cost          one parallel pass over the values, and up to a million of them again
/// Errors        as statistics_of()
Result<Chart> chart_of(const Array& values, const std::function<double(double isovalue)>& triangles, const Run& run);
/// Expected by a sample of the cells, which are linear. Errors   as above, and FieldSample::create()
Result<Chart> chart_of(const Grid& grid, const PointField& field, const Run& run = {});

} // namespace isotet::view
