// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the kinds of grids of VTKHDF share: their time steps, types of coordinates, and words of messages.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <isotet/read.hpp>

namespace isotet::io::confined {

/// As LeftOut has it.
inline const char* kind_of_field(Association association) {
    return association == Association::point ? "point field" : "cell field";
}

constexpr const char* no_table_of_numbers = "it is no table of numbers of 1, 2, 4 or 8 bytes";

/// Coordinates as integers become float64.
Array as_coordinates(Array points);

struct HdfSteps {
    std::vector<double> times;      ///< empty: the grid has no steps
    std::optional<LeftOut> missing; ///< what of them is not read
};

/// The times of group Steps; where they cannot be read, the numbers of the steps that it announces.
///
/// `root`   the group of the grid: "/VTKHDF"
HdfSteps steps_of(const std::string& path, const std::string& root);

} // namespace isotet::io::confined
