// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Measuring pairs of methods and search indexes on one grid.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench_contestant.hpp"

namespace isotet::cli {

/// What was measured of one pair on one grid.
struct BenchRow {
    std::string grid;
    std::uint64_t tets = 0, points = 0;
    std::uint64_t dropped_tets = 0; ///< repeated and collapsed ones, where the grid was packed; 0 else
    BenchPair pair;
    BenchCosts costs;
    BenchTimes median, best; ///< of an isovalue, the mean over all of them: the round in the middle, and the shortest
    BenchOutcome outcome;    ///< of an isovalue, the mean
    std::string missing;     ///< why nothing was measured; empty: it was

    double tets_per_second() const noexcept { return static_cast<double>(tets) / median.total(); }
};

/// Pictures are small, of one sample a pixel: what is measured is the way to them.
PictureOptions bench_picture();

/// Measures one pair. What the machine cannot (memory, device) is a row that says why.
/// Errors   all others, and cancelled
Result<BenchRow> measure(const BenchPair& pair, BenchBed& bed, const std::vector<double>& isovalues,
                         std::uint64_t rounds);

} // namespace isotet::cli
