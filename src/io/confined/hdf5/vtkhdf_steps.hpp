// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The time steps of a grid in a VTKHDF file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <isotet/read.hpp>

namespace isotet::io::confined {

struct HdfSteps {
    std::vector<double> times;      ///< empty: the grid has no steps
    std::optional<LeftOut> missing; ///< what of them is not read
};

/// The times of group Steps; where they cannot be read, the numbers of the steps that it announces.
///
/// `root`   the group of the grid: "/VTKHDF"
HdfSteps steps_of(const std::string& path, const std::string& root);

} // namespace isotet::io::confined
