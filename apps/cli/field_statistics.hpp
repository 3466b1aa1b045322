// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Range and holes of a field, for `isotet info`.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>

namespace isotet::cli {

struct ComponentStatistics {
    double lower = 0, upper = 0; ///< of the finite values; lower > upper when there is none
    std::uint64_t not_a_number = 0;
    std::uint64_t infinite = 0;
};

/// One entry a component, for each array. One pass, in parallel over all arrays; incomplete when cancelled.
std::vector<std::vector<ComponentStatistics>> statistics(const std::vector<Array>& arrays, const Progress& progress);

} // namespace isotet::cli
