// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A method and a search index on one grid, measured by GridBench.
#pragma once

#include <memory>
#include <optional>

#include <isotet/paper/grid_bench.hpp>
#include <isotet/pack.hpp>
#include <isotet/render.hpp>

#include "base/stopwatch.hpp"

namespace isotet::measure {

using core::Stopwatch;

/// What all contestants share: the grid, packed once for those that need it, and what draws.
struct Bed {
    Grid grid;
    PointField field;
    std::optional<Device> device;     ///< nothing: surfaces are made, and not drawn
    std::optional<Renderer> renderer; ///< if there is a device
    std::uint64_t estimated_tets = 0;
    Run run; ///< of the call
    std::optional<PackedGrid> packed = {};
    double pack_seconds = 0;

    /// Packs the grid if that has not been done.
    Result<void> pack();
};

class Contestant {
public:
    virtual ~Contestant() = default;

    /// Does what is done once, and returns what it costs.
    virtual Result<BenchCosts> prepare(Bed& bed) = 0;

    /// Makes the surface of an isovalue ready to be drawn, and measures `search` and `extract`. The surface lasts until
    /// the next call.
    virtual Result<DrawnSurface> make(Bed& bed, double isovalue, BenchTimes& times, BenchOutcome& outcome) = 0;
};

/// Errors   of the calls: as the functions of the library that they stand for
std::unique_ptr<Contestant> make_contestant(const BenchPair& pair);

} // namespace isotet::measure
