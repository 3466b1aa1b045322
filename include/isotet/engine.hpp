// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/extract.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// How long a pass took on the device: "select", "count", "scan", "emit" and so on.
struct DevicePass {
    std::string name;
    double seconds = 0;
};

/// What a call cost on a device.
struct DeviceWork {
    std::vector<DevicePass> passes;   ///< in order; empty where the device has no timestamps
    double device_seconds = 0;        ///< from the beginning of the first pass to the end of the last, waits between
                                      ///< aside
    double waited_seconds = 0;        ///< for the device, as seen from here
    std::uint64_t uploaded_bytes = 0; ///< over the bus
    std::uint64_t downloaded_bytes = 0;
    std::uint64_t page_loads = 0;  ///< pages that had to be uploaded
    std::uint32_t submissions = 0; ///< one, unless arrays had to grow or pages to come
};

// What every engine does: the contract between a session and whatever extracts for it.

/// A packed grid where an engine wants it: in memory for the CPU, uploaded for a device.
class ISOTET_API EngineGrid {
public:
    virtual ~EngineGrid() = default;

    /// The grid as it is held: what set_field() and set_points() made of it.
    virtual const PackedGrid& packed() const noexcept = 0;

    /// Another field on the same cells, other points of the same cells. Guarantees and errors are those of
    /// PackedGrid::with_field() and with_points(); after an error of the device the grid must be created again.
    virtual Result<void> set_field(const PointField& field, const Run& run) = 0;
    virtual Result<void> set_points(const Array& points, const Run& run) = 0;

    /// Surfaces in the machine's memory, in the order of the isovalues: the bytes that extract() gives.
    virtual Result<std::vector<Extraction>> extract(std::span<const double> isovalues, const ExtractOptions& options,
                                                    const Run& run) = 0;

    /// What the last call cost on a device; nothing where there is none.
    virtual DeviceWork work() const { return {}; }

    /// Sentences for the user: that not all of the grid fits into the device's memory, say.
    virtual std::vector<std::string> notes() const { return {}; }
};

/// Extracts surfaces. Every engine gives the same bytes.
///
/// Threads   safe from many threads
class ISOTET_API Engine {
public:
    virtual ~Engine() = default;

    virtual std::string_view name() const noexcept = 0; ///< "cpu", "reference", "vulkan"

    /// Whether grids cost nothing to create and extract in any number of threads at once; else they are kept, and
    /// asked one call at a time.
    virtual bool is_stateless() const noexcept = 0;

    virtual Result<std::unique_ptr<EngineGrid>> create_grid(const PackedGrid& packed, const Run& run) const = 0;

    /// Whether extract_direct() can be asked for.
    virtual bool extracts_directly() const noexcept { return false; }

    /// As the function of this name; internal where extracts_directly() says no.
    virtual Result<DirectExtraction> extract_direct(const Grid& grid, const PointField& field,
                                                    std::span<const double> isovalues, const DirectOptions& options,
                                                    const Run& run) const;
};

/// The CPU engine: oneTBB and the processor's widest instructions.
ISOTET_API std::shared_ptr<const Engine> cpu_engine();

/// The slow reference (engine.hpp).
ISOTET_API std::shared_ptr<const Engine> reference_engine();

// The slow, short versions of extraction, which every engine is held against: for tests, and for those who doubt.

/// What extract() gives, byte for byte, worked out on one thread without any cleverness.
///
/// Cost     10 to 100 times the time of extract(); memory for a map of all edges of the surface
/// Errors   as extract()
ISOTET_API Result<std::vector<Extraction>> extract_by_reference(const PackedGrid& packed,
                                                                std::span<const double> isovalues,
                                                                const ExtractOptions& options = {},
                                                                const Run& run = {});

/// What extract_direct() gives, byte for byte. Cost and errors as above.
ISOTET_API Result<DirectExtraction> extract_direct_by_reference(const Grid& grid, const PointField& field,
                                                                std::span<const double> isovalues,
                                                                const DirectOptions& options = {}, const Run& run = {});

/// What contour_spectrum() gives within 1e-12 of its largest area and volume, by cutting every tet at every isovalue.
/// Errors   as contour_spectrum()
ISOTET_API Result<ContourSpectrum> contour_spectrum_by_reference(const Grid& grid, const PointField& field,
                                                                 std::span<const double> isovalues,
                                                                 const Run& run = {});

} // namespace isotet
