// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What to show of a grid when nobody says it: the field that varies most, and isovalues where its values are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <isotet/grid.hpp>

namespace isotet::cli {

/// The field whose values are spread most evenly over its range (largest entropy of a histogram), named for
/// find_field(): vectors by their magnitude. Whole numbers count half, for they are numbers of something more often
/// than measured; holes count against a field. Empty: no field has two different values.
/// Cost   one pass over all fields
std::string most_varied_field(const Grid& grid);

/// `count` values evenly between the ends of the range; the fiftieth part of the values at either end does not count,
/// where that leaves a range; rounded to a tenth of their distance or better. Ascending; empty when no value is finite.
std::vector<double> levels_within(const PointField& field, std::uint64_t count);

} // namespace isotet::cli
