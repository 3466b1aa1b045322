// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A grid of two tets as an MSH file: small enough to know every number, with names and times as a test wants them.
#pragma once

#include <string>
#include <vector>

namespace isotet::test {

struct SmallField {
    std::string name;
    std::vector<double> values; ///< one for each of the points (5) or tets (2)
    double time = 0;
    bool on_cells = false;
};

/// Points (0,0,0), (1,0,0), (0,1,0), (0,0,1), (1,1,1); tets 1 2 3 4 and 2 3 4 5.
std::string small_grid(const std::vector<SmallField>& fields);

} // namespace isotet::test
