// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet {

/// A file format that isotet reads or writes.
struct Format {
    std::string name;                    ///< "vtu", "gmsh", as --format takes it
    std::string title;                   ///< "VTK XML unstructured grid"
    std::vector<std::string> extensions; ///< ".vtu"; lower case
    bool reads_grid = false, writes_grid = false, reads_surface = false, writes_surface = false;
    bool needs_vtk = false; ///< read by VTK's reader, in a child process
};
ISOTET_API std::vector<Format> formats();

/// A field as a file announces it, before its values are read.
struct FieldInfo {
    std::string name;
    Association association = Association::point;
    ScalarType type = ScalarType::float32;
    std::size_t components = 1;
};

/// What a file holds.
struct FileInfo {
    std::string format;
    std::vector<FieldInfo> fields;
    std::vector<double> times; ///< empty where the file knows no time; ascending as stored
};

struct ReadOptions {
    std::string format;                                                ///< empty: by content, then by name
    std::optional<std::vector<std::string>> point_fields, cell_fields; ///< names to read; nothing: all
    std::optional<std::size_t> step;          ///< index into FileInfo::times; nothing: the first
    bool merge_pieces_by_coordinates = false; ///< pieces without global ids: join points with exactly equal
                                              ///< coordinates
    bool allow_outside = false;               ///< index files may name files outside their own folder
    std::string displace;                     ///< a point vector field to add to the coordinates
    std::string reader_program;               ///< the program that runs VTK's readers ("isotet"); empty: this one
                                              ///< if it calls run_as_reader(), else the one beside the library or
                                              ///< this program, in PATH, or where isotet was to be installed
    std::uint64_t memory_limit = 0;           ///< bytes of address space of a reader process; 0: by free memory
    std::chrono::seconds time_limit{3600};
};

struct ReadResult {
    Grid grid;
    FileInfo info;
    std::size_t step = 0;           ///< the step that was read
    std::vector<std::string> notes; ///< sentences for the user: ghost cells left out, blocks joined and so on
};

/// Tells what a file holds without reading more of it than the format makes necessary.
ISOTET_API Result<FileInfo> inspect(const std::string& path, const ReadOptions& options = {}, const Run& run = {});

/// Reads a grid. Fields have the names of the file; coordinates are those of the file.
///
/// Every grid that comes back has passed the checks of array lengths and index ranges; a file that is cut short or
/// broken is an error that says what was seen. VTK's readers run in a child process: if one crashes, that is an error,
/// too.
///
/// Errors   file: not there, not readable, format not recognized; invalid_data: broken content; invalid_argument: an
///          unknown field, step or format; out_of_memory; system; cancelled
ISOTET_API Result<ReadResult> read(const std::string& path, const ReadOptions& options = {}, const Run& run = {});

struct ReadSurfaceOptions {
    std::string format; ///< empty: by content, then by name
};

/// A surface from a file.
struct SurfaceFile {
    Surface surface;
    std::string format;
};

/// Reads a surface (VTP, PLY, STL, OBJ, legacy VTK, Gocad TSurf), polygons split into triangles. STL has no shared
/// vertices: weld it.
ISOTET_API Result<SurfaceFile> read_surface(const std::string& path, const ReadSurfaceOptions& options = {},
                                            const Run& run = {});

/// What a program that serves as reader_program must call first in main(): does the reading and returns the exit status
/// when it was started as a reader process, nothing otherwise.
ISOTET_API std::optional<int> run_as_reader(int argc, char** argv);

} // namespace isotet
