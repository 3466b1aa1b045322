// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The engine that extracts: on the processor, or on a device.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <isotet/device_grid.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "console.hpp"
#include "options.hpp"

namespace isotet::cli {

/// What the device did for one surface.
struct DeviceNumbers {
    double seconds = 0; ///< on the device
    std::uint64_t uploaded_bytes = 0, downloaded_bytes = 0;
    std::uint64_t page_loads = 0;
};

/// --engine vulkan extracts on the device or not at all. Where the engine is left open but a device is named, what the
/// device cannot do the CPU engine does, with a note.
class Extractor {
public:
    Extractor(const ExtractCommand& command, Console& console) : command_(command), console_(console) {}

    /// Opens the device if one is meant.
    /// Errors   usage: a device beside an engine that uses none; what Device::open() says
    Result<void> open();

    /// Opens the best graphics card although none was asked for, before anything is loaded; false where there is none.
    bool open_unasked();

    /// Gives up the device, before anything is loaded.
    void close() { device_.reset(); }

    const std::optional<Device>& device() const noexcept { return device_; } ///< that is open

    /// The packed grid is about to go.
    void unload() { grid_.reset(); }

    /// Uploads the packed grid, which stays where it is until unload().
    Result<void> load(const PackedGrid& packed);

    /// Replaces the field or the points of the packed grid, here and on the device. Where the device fails and the CPU
    /// may stand in, they are replaced here.
    Result<void> set_field(PackedGrid& packed, const PointField& field, int threads);
    Result<void> set_points(PackedGrid& packed, const Array& points, int threads);

    /// Surfaces of isovalues, in their order: all in one pass by the CPU engine, one after another on a device.
    Result<std::vector<Extraction>> extract(std::span<const double> isovalues, const ExtractOptions& options);
    bool in_one_pass() const { return !grid_; }

    /// "cpu", "reference", or "vulkan" with the device's name.
    std::string engine_text() const;
    const char* engine_name() const;
    const std::optional<DeviceNumbers>& last() const noexcept { return last_; } ///< of the surface extracted last

    bool wants_device() const; ///< one is named, or asked for by --engine

private:
    /// The error, or nothing after a note where the CPU may stand in.
    Result<void> without_device(const Error& error);
    /// Whether the CPU must do what the device did not; the error where it may not, or where it could not either.
    Result<bool> left_to_cpu(const Result<void>& set);
    Result<Extraction> extract_on_device(double isovalue, const ExtractOptions& options);

    const ExtractCommand& command_;
    Console& console_;
    const PackedGrid* packed_ = nullptr;
    std::optional<Device> device_;
    std::optional<DeviceGrid> grid_;
    DeviceSurface surface_; ///< used again for the next isovalue
    std::optional<DeviceNumbers> last_;
};

} // namespace isotet::cli
