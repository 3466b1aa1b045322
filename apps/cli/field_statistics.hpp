// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Range and holes of a field, for `isotet info`.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/array.hpp>

namespace isotet::cli {

struct ComponentStatistics {
    double lower = 0, upper = 0; ///< of the finite values; lower > upper when there is none
    std::uint64_t not_a_number = 0;
    std::uint64_t infinite = 0;
};

/// One entry a component. One pass, in parallel.
std::vector<ComponentStatistics> statistics(const Array& values);

} // namespace isotet::cli
