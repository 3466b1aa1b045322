// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A pair of a method and a search index on one grid, measured by `isotet bench`.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <isotet/device.hpp>
#include <isotet/grid.hpp>
#include <isotet/pack.hpp>
#include <isotet/render.hpp>

#include "bench_options.hpp"
#include "console.hpp"

namespace isotet::cli {

/// What all contestants share: the grid, packed once for those that need it, and what draws.
struct BenchBed {
    const Grid& grid;
    const PointField& field;
    const Run& run;
    std::optional<Device> device;     ///< nothing: surfaces are made, and not drawn
    std::optional<Renderer> renderer; ///< if there is a device
    std::optional<PackedGrid> packed;
    double pack_seconds = 0;

    /// Packs the grid if that has not been done.
    Result<void> pack();
};

/// What happens once.
struct BenchCosts {
    double prepare_seconds = 0; ///< packing, building the index, uploading
    std::uint64_t host_bytes = 0, device_bytes = 0; ///< that stay: packed grid, tables, index; on the device
    std::uint64_t crossing_bytes = 0; ///< of the store: found no room on the device, and cross the bus for every
                                      ///< picture
};

/// From an isovalue to its picture, or without a device to its surface.
struct BenchTimes {
    double search = 0, extract = 0, draw = 0; ///< seconds

    double total() const noexcept { return search + extract + draw; }
};

/// What an isovalue makes.
struct BenchOutcome {
    std::optional<std::uint64_t> tets_looked_at; ///< by a vertex-shader method
    std::optional<std::uint64_t> triangles;      ///< of a surface that was made
    std::uint64_t sent_bytes = 0;     ///< over the bus to the device
};

class Contestant {
public:
    virtual ~Contestant() = default;

    /// Does what is done once, and tells what it costs.
    virtual Result<BenchCosts> prepare(BenchBed& bed) = 0;

    /// Makes the surface of an isovalue ready to be drawn: `times` has the parts search and extract then. The surface
    /// lasts until the next call.
    virtual Result<DrawnSurface> make(BenchBed& bed, double isovalue, BenchTimes& times, BenchOutcome& outcome) = 0;
};

/// Errors   of the calls: as the functions of the library that they stand for
std::unique_ptr<Contestant> make_contestant(const BenchPair& pair);

} // namespace isotet::cli
