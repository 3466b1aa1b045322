// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <isotet/device.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// From a grid to its surfaces: an engine, a method and a filter that go together.
///
/// `brute`           the CPU goes through all cells for each surface (extract_once.hpp): no filter
/// `clusters`        the CPU packs the grid, and extracts from it (pack.hpp, extract.hpp): cluster ranges
/// `device_clusters` the CPU packs the grid, a device extracts (device_grid.hpp), surfaces come back: cluster ranges
enum class Way : std::uint8_t { brute, clusters, device_clusters };

inline constexpr std::array all_ways{Way::brute, Way::clusters, Way::device_clusters};

/// "brute on the CPU", "clusters on the CPU", "clusters on the device".
std::string_view name_of(Way way) noexcept;

/// A few of a grid's cells, to tell beforehand how large surfaces will be.
class FieldSample {
public:
    static constexpr std::uint64_t most_cells = std::uint64_t{1} << 14;

    /// Looks at up to `most_cells` cells, spread evenly over their numbers: at all cells of a grid that has no more.
    /// Cells that are not as they should be are passed over: reading and packing say what is wrong with them.
    ///
    /// Cost     a few milliseconds
    /// Errors   invalid_argument when the field does not fit the grid; invalid_data when the arrays of the grid do not
    ///          fit together; out_of_memory
    static Result<FieldSample> take(const Grid& grid, const PointField& field);

    std::uint64_t points() const noexcept { return points_; } ///< of the grid
    std::uint64_t tets() const noexcept { return tets_; }     ///< of the grid, estimated where cells are not tets;
                                                              ///< exact where they are
    double lower() const noexcept { return lower_; }          ///< of the values seen; lower > upper: none is finite
    double upper() const noexcept { return upper_; }

    /// Triangles of an isovalue's surface, estimated. Of a surface that cuts few cells the estimate is rough: from t
    /// cut tets in the sample it is wrong by about a part of 1 / sqrt(t).
    double triangles(double isovalue) const noexcept;

private:
    struct Range {
        double lower, upper;
    };
    std::vector<Range> tets_seen_; ///< with data at all corners and different values
    double tets_each_ = 0;         ///< of the grid, for each one seen
    std::uint64_t points_ = 0, tets_ = 0;
    double lower_ = 0, upper_ = -1;
};

/// What is to be made of one grid, and what there is to make it with.
struct Task {
    std::uint64_t points = 0, tets = 0;
    double surfaces = 1;              ///< expected: isovalues times time steps
    bool gradients = false;           ///< gradient normals are asked for
    bool find_range = false;          ///< isovalues follow the range of the field, which brute must look for first
    double triangles = 0;             ///< of a surface, on the average
    double triangles_together = 0;    ///< of the surfaces that are in memory at the same time, at most
    std::uint64_t memory_free = 0;    ///< of the machine, beside the grid
    std::optional<std::uint64_t> device_memory_free; ///< nothing: there is no device
};

/// Seconds that a machine takes, with a number of threads. Those of calls come once a grid or a surface, besides tets
/// and triangles.
struct Speeds {
    double pack_call = 0, pack_tet = 0, pack_gradient_tet = 0; ///< the last: with gradients, besides
    double brute_call = 0, brute_tet = 0, brute_triangle = 0, brute_gradient_tet = 0;
    double clusters_call = 0, clusters_tet = 0, clusters_triangle = 0;
};

/// Of a device; of a surface that is extracted and comes back.
struct DeviceSpeeds {
    double upload_tet = 0;
    double call = 0, tet = 0, triangle = 0;
};

/// Of two threads of an ordinary machine (docs/performance): good enough to tell minutes from seconds.
Speeds typical_speeds() noexcept;

/// Measures this machine: packs a made grid of three million tets, and extracts from it.
///
/// Cost     about two seconds, 200 MB
/// Errors   out_of_memory; cancelled
Result<Speeds> measure_speeds(int threads = 0, const Progress& progress = {});

/// Measures a device in the same way.
///
/// Errors   as Device and DeviceGrid
Result<DeviceSpeeds> measure_speeds(const Device& device, int threads = 0, const Progress& progress = {});

/// What a way is expected to take, without reading and writing files.
struct Forecast {
    Way way = Way::brute;
    double seconds = 0;
    std::uint64_t bytes = 0;        ///< needed beyond the grid, at the peak; rather too many than too few. Memory that
                                    ///< is free is used beyond that, to keep blocks for later: up to 1/64 of the
                                    ///< machine's
    std::uint64_t device_bytes = 0; ///< the packed grid and a surface; less will do, slower, but does not count as
                                    ///< fitting
    bool fits = false;              ///< into the memory that is free
};

/// All ways that there are: those that fit, the fastest first, then those that do not, the smallest first. Ways on a
/// device are there if the device is.
///
/// `task`    numbers that are finite and not negative
/// `device`  of the device; null: none is weighed
std::vector<Forecast> weigh(const Task& task, const Speeds& speeds, const DeviceSpeeds* device = nullptr);

} // namespace isotet
