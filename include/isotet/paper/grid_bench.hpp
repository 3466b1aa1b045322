// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How long each method takes on a grid, from an isovalue to its picture, and which is the fastest.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/device.hpp>
#include <isotet/draw_tets.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/render.hpp>
#include <isotet/result.hpp>
#include <isotet/paper/search.hpp>

namespace isotet {

/// What can be measured. `direct` and `clusters` extract on the CPU, `clusters_vulkan` on a device; the others are
/// DrawMethod, which draw tets and make no surface.
enum class BenchMethod : std::uint8_t {
    direct,
    clusters,
    clusters_vulkan,
    registers,
    registers_instanced,
    textures,
    mesh
};

inline constexpr std::array all_bench_methods{BenchMethod::direct,
                                              BenchMethod::clusters,
                                              BenchMethod::clusters_vulkan,
                                              BenchMethod::registers,
                                              BenchMethod::registers_instanced,
                                              BenchMethod::textures,
                                              BenchMethod::mesh};

/// The name as written here.
ISOTET_API std::string_view name_of(BenchMethod method) noexcept;

/// The method of drawing tets; nothing for methods that extract, which find active tets themselves.
ISOTET_API std::optional<DrawMethod> draw_method_of(BenchMethod method) noexcept;
ISOTET_API bool needs_device(BenchMethod method) noexcept;

/// A method, and for one that draws tets the search index that finds them.
struct ISOTET_API BenchPair {
    BenchMethod method = BenchMethod::direct;
    SearchIndex index = SearchIndex::none;

    ISOTET_API std::string name() const; ///< "textures + interval_tree", "clusters"
};

/// Each method that draws tets with each index, the others once.
ISOTET_API std::vector<BenchPair> pairs_of(const std::vector<BenchMethod>& methods,
                                           const std::vector<SearchIndex>& indexes);

/// What happens once.
struct BenchCosts {
    double prepare_seconds = 0;                     ///< packing, building the index, uploading
    std::uint64_t host_bytes = 0, device_bytes = 0; ///< that stay: packed grid, tables, index; on the device
    std::uint64_t crossing_bytes = 0; ///< of a store of tets: found no room on the device, and cross the bus for every
                                      ///< picture
};

/// From an isovalue to its picture, or without a device to its surface; seconds.
struct BenchTimes {
    double search = 0;  ///< of the index
    double extract = 0; ///< making triangles, and sending them or the list of tets to the device
    double draw = 0;    ///< the rest of the way to the picture

    double total() const noexcept { return search + extract + draw; }
};

/// What an isovalue makes.
struct BenchOutcome {
    std::optional<std::uint64_t> tets_looked_at; ///< of a method that draws tets
    std::optional<std::uint64_t> triangles;      ///< of a surface that was made
    std::uint64_t sent_bytes = 0;                ///< over the bus to the device
};

/// What was measured of one pair on one grid.
struct BenchRow {
    std::string grid; ///< its name, for the caller to set
    std::uint64_t tets = 0, points = 0;
    std::uint64_t dropped_tets = 0; ///< repeated and collapsed ones; 0 where nothing was packed
    BenchPair pair;
    BenchCosts costs;
    BenchTimes median, best; ///< of an isovalue, the mean over all of them: the round in the middle, and the shortest
    BenchOutcome outcome;    ///< of an isovalue, the mean
    std::string missing;     ///< why nothing was measured; empty: it was

    double tets_per_second() const noexcept { return static_cast<double>(tets) / median.total(); }
};

/// Pictures of measurements: 512 x 512 pixels of one sample, shaded by faces.
ISOTET_API PictureOptions bench_picture();

/// Measures methods on one grid, which is packed at most once.
///
/// Threads   one call at a time on one object
class ISOTET_API GridBench {
public:
    /// `device`   draws; nothing: surfaces are made, and not drawn
    /// Errors     as FieldSample::create() and Renderer::create()
    static Result<GridBench> create(Grid grid, PointField field, std::optional<Device> device);

    GridBench(GridBench&&) noexcept;
    GridBench& operator=(GridBench&&) noexcept;
    ~GridBench();

    /// Measures one pair: every isovalue in every round, after a round that does not count.
    ///
    /// `isovalues`   at least one; finite      `rounds`   at least one
    /// Returns       a row that says why where memory or the device do not suffice
    /// Errors        all others of the functions that are measured; invalid_argument; cancelled
    Result<BenchRow> measure(const BenchPair& pair, std::span<const double> isovalues, std::uint64_t rounds,
                             const Run& run = {});

private:
    struct Data;
    explicit GridBench(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

/// The fastest row for so many surfaces of one grid, up to `upto`.
struct BenchAdvice {
    std::size_t row = 0;
    double upto = 0; ///< infinite for the last
};

/// Which row is the fastest from one surface on, which from more, by the best rounds: preparing, and then so much for
/// each surface. Rows that are missing do not count.
ISOTET_API std::vector<BenchAdvice> advice_of(const std::vector<BenchRow>& rows);

/// How many times as fast a method is with the interval tree, the mean over the grids; nothing where it was not
/// measured.
ISOTET_API std::optional<double> gain_of_interval_tree(const std::vector<BenchRow>& rows, BenchMethod method);

} // namespace isotet
