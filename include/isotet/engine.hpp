// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What every engine does: the contract between a session and whatever extracts for it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/device_work.hpp>
#include <isotet/export.hpp>
#include <isotet/extract.hpp>
#include <isotet/extract_direct.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

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

/// The slow reference (reference.hpp).
ISOTET_API std::shared_ptr<const Engine> reference_engine();

} // namespace isotet
