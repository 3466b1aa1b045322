// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From a grid file to surface files: what `isotet extract` does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/jobs/device_choice.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/range_shares.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/pieces.hpp>
#include <isotet/scene.hpp>
#include <isotet/solid.hpp>
#include <isotet/surface.hpp>
#include <isotet/write.hpp>

namespace isotet::jobs {

/// Which solids are made in place of isosurfaces.
struct SolidChoice {
    enum class Kind : std::uint8_t {
        above,  ///< of each isovalue
        below,  ///< of each isovalue
        between ///< one, of `range`
    };
    Kind kind = Kind::above;
    SolidRange range;
    RangeShares shares = {}; ///< of `range`, each time step its own
};

/// Colours that go with each surface, as its point field "rgb".
struct ColorChoice {
    std::string by;            ///< a point field that is carried; empty: no colours
    ColorScale scale;          ///< the map, the logarithm and the colour for no data
    std::vector<double> range; ///< both ends of the scale, or none: those of each surface
};

struct ExtractJob {
    GridOptions grid;
    bool all_steps = false;
    std::uint64_t interpolate =
        0;           ///< surfaces between two steps of a packed file, with `all_steps`: PackedFile::interpolated()
    std::string out; ///< with {value}, {time} and {step}; empty: only numbers
    std::vector<std::string> other_outputs; ///< of the caller: no surface may overwrite them
    FieldChoice field;
    std::vector<double> isovalues;
    std::optional<double> decimal_comma; ///< what two isovalues mean if their comma is a decimal sign
    std::vector<IsovalueShare> shares;   ///< more isovalues, after the others: of each time step its own
    std::uint64_t levels = 0;            ///< 0: `isovalues` and `shares` say it
    bool volumes = false;                ///< the volume on both sides of each isovalue: SurfaceNumbers::volumes
    bool snap = false;
    /// Of these the job sets engine, ties, surfaces, expected isovalues and sink itself.
    ContourOptions contour{.refine = RefineOptions{}};
    bool refine_averaged = false; ///< also for a field averaged from cells, which else is taken at the nodes only
    std::optional<std::vector<std::string>> with; ///< nothing: all point fields that the format can hold
    bool keep_degenerate = false;
    bool fail_if_empty = false;
    bool allow_empty =
        false; ///< also where all isovalues are outside the field's range, or a solid has nothing, which else
               ///< is an error
    EngineChoice engine = EngineChoice::automatic;
    DeviceChoice device; ///< `name` is empty where none is asked for
    std::optional<PieceOf> piece;
    Compression compression = Compression::none;
    ColorChoice colors;
    std::optional<SolidChoice> solid; ///< nothing: isosurfaces
    std::optional<PartChoice>
        keep; ///< nothing: all parts; its region may be one that the file names, or "FIELD=VALUE" or
              ///< "FIELD=LOWER:UPPER" of cells
    std::optional<ReduceOptions> reduce; ///< nothing: all triangles
    std::string parts_table; ///< a CSV file with a row for each part; empty: none, and parts are not looked for
    std::optional<std::uint64_t> memory; ///< as PackedFileOptions::memory, where the grid is a packed file
};

/// What is told of a solid.
struct SolidNumbers {
    SolidRange range;
    double volume = 0, grid_volume = 0;
    double isosurface_area = 0, boundary_area = 0;
    std::uint64_t open_edges = 0, seam_edges = 0, unfit_edges = 0;
    std::vector<SolidPatch> patches; ///< Solid::patches
};

/// Where the field is below an isovalue, and where it is not, as contour_spectrum() measures it.
struct SideVolumes {
    double below = 0, above = 0;
};

/// One isosurface, or one solid.
struct SurfaceNumbers {
    double isovalue = 0;
    std::optional<double> time;
    ExtractReport report;
    std::uint64_t vertices = 0, triangles = 0;
    double area = 0; ///< of a solid with its boundary
    std::optional<SolidNumbers> solid;
    std::optional<SideVolumes> volumes;
    std::optional<SurfaceParts> parts; ///< of all parts that were found; without `numbers`
    std::uint64_t parts_kept = 0;
    double extract_seconds = 0;
    std::optional<DeviceWork> device;
    double write_seconds = 0; ///< of several surfaces in one file the last has it all
    std::string file;         ///< empty without OUT
};

/// What was done.
struct ExtractNumbers {
    std::string grid, format;
    std::size_t cells = 0;
    std::optional<PackReport> pack; ///< of the last packing; nothing where nothing is packed
    std::uint64_t cells_left_out = 0;
    FieldReport field;                    ///< of the last time step
    std::size_t steps = 1;                ///< time steps
    std::vector<BrokenStep> broken_steps; ///< of these
    bool averaged = false;
    Precision precision = Precision::float32;
    Method method = Method::direct;    ///< of the last surface
    std::string why;                   ///< the method, in words
    std::optional<Estimate> predicted; ///< nothing for devices, the reference engine and cells that are not linear
    std::optional<std::uint64_t> peak_bytes; ///< taken beyond the first grid, if the system tells
    std::string_view engine;                 ///< of the last surface
    std::string device;                      ///< its name
    unsigned threads = 1;
    double read_seconds = 0;
    double pack_seconds = 0;         ///< uploading included
    double look_seconds = 0;         ///< for the range of the field, where isovalues follow it
    double measure_seconds = 0;      ///< for the areas
    std::uint64_t process_bytes = 0; ///< most that the whole process had
    std::vector<SurfaceNumbers> surfaces;
    std::string collection;                     ///< of a series; empty: none
    std::string parts_table;                    ///< the file that was written; empty: none
    RefinementReport refinement = {};           ///< of the last surface
    std::optional<ResidencyReport> packed_file; ///< where the grid is one that was read in parts
    std::uint64_t packed_file_bytes = 0;        ///< of it, whole

    std::uint64_t transient_peak() const;
    double work_seconds() const; ///< packing, uploading, extracting: what is predicted
    bool on_device() const { return engine == "vulkan"; }
};

/// Reads the steps one after another, extracts, and writes each file as soon as it is complete. Files that were
/// complete before an error or a cancelled run stay. A step behind the
/// first that cannot be read does not end the others; what is read while extracting counts as extracting.
///
/// Memory   one step, and the surfaces that are extracted in one pass or go into one file
/// Errors   invalid_argument: what is asked for does not fit together or with the file, told before anything large is
///          read where that can be known; as of reading, Contour and writing
Result<ExtractNumbers> extract_files(const ExtractJob& job, Caller& caller);

} // namespace isotet::jobs
