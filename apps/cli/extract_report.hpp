// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The numbers of `isotet extract`, as a table and as JSON.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/contour.hpp>

#include "extract_plan.hpp"
#include "json_output.hpp"
#include "options.hpp"

namespace isotet::cli {

/// One isosurface.
struct SurfaceNumbers {
    double isovalue = 0;
    std::optional<double> time;
    ExtractReport report;
    std::uint64_t vertices = 0, triangles = 0;
    double area = 0;
    double extract_seconds = 0;
    std::optional<DeviceWork> device;
    double write_seconds = 0; ///< of several surfaces in one file the last has it all
    std::string file;         ///< empty without OUT
};

struct ExtractNumbers {
    std::string grid, format;
    std::size_t cells = 0;
    std::optional<PackReport> pack; ///< of the last packing; nothing where nothing is packed
    std::uint64_t cells_left_out = 0;
    FieldReport field;     ///< of the last time step
    std::size_t steps = 1; ///< time steps
    bool averaged = false;
    Precision precision = Precision::float32;
    Method method = Method::direct;          ///< of the last surface
    std::string why;                         ///< the method, in words
    std::optional<Estimate> predicted;       ///< nothing for devices and the reference engine
    std::optional<std::uint64_t> peak_bytes; ///< taken beyond the first grid, if the system tells
    std::string_view engine;                 ///< of the last surface
    std::string device;                      ///< its name
    unsigned threads = 1;
    double read_seconds = 0;
    double pack_seconds = 0;       ///< uploading included
    double look_seconds = 0;       ///< for the range of the field, where isovalues follow it
    double measure_seconds = 0;    ///< for the areas
    std::uint64_t peak_before = 0; ///< of the process, with the first grid
    std::vector<SurfaceNumbers> surfaces;
    std::string collection;           ///< of a series; empty: none
    RefinementReport refinement = {}; ///< of the last surface

    std::uint64_t transient_peak() const;
    double work_seconds() const; ///< packing, uploading, extracting: what is predicted
    bool on_device() const { return engine == "vulkan"; }
};

/// The surfaces, then the grid and the field; `verbose`: also how they were made.
std::string extract_table(const ExtractNumbers& numbers, bool verbose);
Json extract_json(const ExtractNumbers& numbers);

} // namespace isotet::cli
