// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What follows from rows of `isotet bench`.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "bench_run.hpp"

namespace isotet::cli {

/// What is fastest for so many surfaces of one grid, up to `upto`.
struct Advice {
    std::size_t row = 0;
    double upto = 0; ///< infinite for the last
};

/// Which row is fastest from one surface on, which from more: preparing, and then so much a surface.
std::vector<Advice> advice_of(const std::vector<BenchRow>& rows);

/// How many times as fast drawing with the interval tree is, the mean over the grids; nothing where it was not
/// measured.
std::optional<double> gain_of_interval_tree(const std::vector<BenchRow>& rows, BenchMethod method);

} // namespace isotet::cli
