// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/extract.hpp>
#include <isotet/grid.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/slice.hpp>
#include <isotet/surface.hpp>

namespace isotet {

struct StreamedBoundary; // boundary.hpp

/// A file format that isotet reads or writes.
struct Format {
    std::string name;                    ///< "vtu", "gmsh", as --format takes it
    std::string title;                   ///< "VTK XML unstructured grid"
    std::vector<std::string> extensions; ///< ".vtu"; lower case
    bool reads_grid = false, writes_grid = false, reads_surface = false, writes_surface = false;
    bool reader_process = false; ///< read by the program isotet-reader, in a child process
};
ISOTET_API std::vector<Format> formats();

/// A field as a file announces it, before its values are read.
struct FieldInfo {
    std::string name;
    Association association = Association::point;
    ScalarType type = ScalarType::float32;
    std::size_t components = 1;
    bool active = false; ///< the file marks it as the scalars, or else the vectors, to show first
};

/// A part of a file that can be read without the others: an element block of Exodus, a zone of CGNS, a part of EnSight,
/// a block of a VTM, a region of Gmsh, Medit, TetGen
/// or OpenFOAM.
struct BlockInfo {
    std::int64_t number = 0; ///< of the file where it numbers blocks, else from 1 in its order
    std::string name;        ///< empty where the file has none; "Base/Zone" where blocks are in others
    std::string kind;        ///< "element block", "zone", "part", "block", "region"
    std::uint64_t cells = 0; ///< of all types and dimensions; 0 where only reading the block would tell (OpenFOAM)
};

/// What a number of a cell field stands for.
struct RegionName {
    std::string field;
    std::int64_t number = 0;
    std::string name;
};

/// Something of a file that is not read, though the rest is.
struct LeftOut {
    std::string what;   ///< its kind: "point field", "cell field", "section", "block"
    std::string name;   ///< in the file
    std::string reason; ///< completes "is left out: ", such as "its type is 'Foo', which is not known"
};

/// How many numbers a grid has in memory that is read whole: at least these, as far as the head of its file tells; else 0.
struct LeastCounts {
    std::uint64_t points = 0, cells = 0;
    std::uint64_t corners = 0; ///< of all cells
    ScalarType coordinates = ScalarType::float32;
    bool all_cells = false; ///< `active_cells` reads all of this format, too
};

/// What a file holds.
struct FileInfo {
    std::string format;
    std::uint64_t cells = 0; ///< of all types, pieces and blocks; 0 where only reading the grid would tell
    std::vector<FieldInfo> fields;
    std::vector<double> times; ///< empty where the file knows no time; ascending as stored
    std::vector<std::string>
        files;                     ///< those that were opened to find this out, or to read: the file and its companions
    std::vector<BlockInfo> blocks; ///< empty where the format has none that can be chosen; regions are listed when
                                   ///< some were chosen and read
    std::vector<RegionName> regions; ///< names of volumes that Gmsh and Gocad have; not always all numbers have one
    std::vector<LeftOut> left_out;   ///< ReadResult::notes tell it, too
    LeastCounts least; ///< of the step that was asked for, all blocks; zeros where blocks or regions are chosen
};

/// Cells with a value of a cell field in some ranges, both ends in them; or all other cells.
struct CellCondition {
    std::string field;
    std::vector<std::array<double, 2>> ranges;
    bool others = false;
};

/// Only the cells that direct extraction of some isovalues needs (active_cells.hpp).
struct ReadActiveCells {
    std::string field; ///< as find_field() takes it; empty, without a shape: none is extracted, and one cell is kept
    std::vector<double> isovalues;
    DirectOptions options;                ///< of the extraction; the point fields that are read count as carried ones
    std::optional<SliceShape> shape = {}; ///< slice_field() in place of `field`
    bool bounds = false;                  ///< ReadResult::bounds are wanted
    /// Gets the boundary, if it is wanted.
    std::shared_ptr<StreamedBoundary> boundary = {};
    /// Active cells of these isovalues, too: ReadResult::share_isovalues. Of the volume only of a file that is one piece.
    std::vector<IsovalueShare> shares = {};
    /// Where there are no isovalues: gives them once the values of all points are known. VTKHDF and Exodus read all cells
    /// unless it is a RangeLevels (isovalues.hpp).
    std::function<Result<std::vector<double>>(const PointField& field)> choose = {};
    /// Of these only those for which all conditions hold, by fields that are read; points of no such cell have no value, of
    /// integers they keep it. All cells are read where some have no volume, or a range has no value; not with `bounds`,
    /// `boundary`, `shares` and `choose`.
    std::vector<CellCondition> conditions = {};
    bool averages = false; ///< `field` is one of cells, or an expression of some: ReadResult::field
    bool digests = false;  ///< ReadResult::digests are wanted; all cells are read where some have no volume
};

/// Where inspect() leaves a file that it had to read whole, so that read() need not read it again. Nothing of it is left
/// when read() has taken it; a file that was changed meanwhile is read again.
class KeptFiles;
ISOTET_API std::shared_ptr<KeptFiles> keep_files();

struct ReadOptions {
    std::string format;                                                ///< empty: by content, then by name
    std::optional<std::vector<std::string>> point_fields, cell_fields; ///< names to read; nothing: all
    bool skip_missing_fields = false; ///< names the step lacks are passed over, else errors; of other blocks always
    std::optional<std::size_t> step;  ///< index into FileInfo::times; nothing: the first, and of a case of OpenFOAM
                                      ///< inspect() tells the fields of all steps
    bool merge_pieces_by_coordinates = true; ///< join points of different pieces that are one (docs/pieces.md),
                                             ///< so that surfaces have no seams there
    bool allow_outside = false;              ///< index files may name files outside their own folder
    std::string displace;                    ///< a point vector field to add to the coordinates, or the name of three
                                             ///< scalars (component_groups())
    std::string reader_program;              ///< the program isotet-reader; empty: the one beside the library or this
                                             ///< program, in PATH, or where isotet was to be installed
    std::uint64_t memory_limit = 0;          ///< bytes of address space of a reader process; 0: by free memory
    std::chrono::seconds time_limit{3600};
    std::vector<std::string> blocks; ///< names or numbers of FileInfo::blocks to read; empty: all, of CGNS those of the
                                     ///< first base. A name is any whole parts of a path: "x" and "g/x" are "g/x/m"
    std::vector<std::string> more_files; ///< of the steps behind that of the path; times are then numbers of the files
    bool patches = false;                ///< Grid::patches: of Gmsh, MED, OpenFOAM, Exodus and CGNS
    std::optional<ReadActiveCells> active_cells = {}; ///< where that can be done while reading (VTU, PVTU, VTM, PVD,
                                                      ///< VTKHDF, Exodus, binary legacy VTK; linear cells, points that
                                                      ///< do not coincide); else all are read. Cell fields have
                                                      ///< values of the cells that were kept
    std::uint64_t some_cells =
        0; ///< not 0: about so many cells will do, spread evenly; packed files then read no more than
           ///< these, all other formats all
    std::shared_ptr<KeptFiles> kept = {}; ///< keep_files(); the same for inspect() and the read() behind it
};

struct ReadResult {
    Grid grid;
    FileInfo info;
    std::size_t step = 0;                            ///< the step that was read
    std::optional<std::uint64_t> cells_in_file = {}; ///< where only active cells or some were read
    std::optional<std::array<double, 6>> bounds =
        {};                         ///< then, if they were asked for: least x, y and z of the points that any
                                    ///< cell has, then the greatest
    std::vector<std::string> notes; ///< sentences for the user: ghost cells left out, blocks joined and so on
    Array cell_numbers =
        {}; ///< uint64, where cells have other numbers than in the file that has them: of a piece, of which
            ///< some are left out, and of a packed file with source cells; of active cells, where
            ///< their options ask for source cells. Empty: they are the same
    std::optional<std::uint64_t> chosen_cells =
        {}; ///< of active cells: for how many of all the conditions hold; nothing: they were not looked at
    std::optional<PointField> field = {}; ///< of active cells, with `averages`: as find_field() has it for all cells
    std::vector<double> share_isovalues = {}; ///< of active cells, in the order of `shares`
    std::vector<Field> digests = {}; ///< of active cells, where they are wanted: a few values of each cell field of one
        ///< component, as float64, by which colours are those of all (ColorOptions::all_values)
};

/// Tells what a file holds without reading more of it than the format makes necessary.
ISOTET_API Result<FileInfo> inspect(const std::string& path, const ReadOptions& options = {}, const Run& run = {});

/// Reads a grid. Fields have the names of the file; coordinates are those of the file.
///
/// Every grid that comes back has passed the checks of array lengths and index ranges; a file that is cut short or
/// broken is an error that says what was seen. What HDF5 or CGNS's library parses is read in a child process: if it crashes,
/// that is an error, too.
///
/// Errors   file: not there, not readable, format not recognized; invalid_data: broken content; invalid_argument: an
///          unknown field, step, block or format; out_of_memory; system; cancelled
ISOTET_API Result<ReadResult> read(const std::string& path, const ReadOptions& options = {}, const Run& run = {});

/// How far the system confines isotet-reader, which reads what C libraries parse (docs/security.md).
struct ReaderConfinement {
    bool files =
        false; ///< Landlock: it opens nothing but files below the folder of the grid, and those for reading only
    bool calls = false; ///< seccomp: no network, no other programs, no file made, changed or removed
};
ISOTET_API ReaderConfinement reader_confinement();

struct ReadSurfaceOptions {
    std::string format; ///< empty: by content, then by name
};

/// A surface from a file.
struct SurfaceFile {
    Surface surface;
    std::string format;
    std::vector<std::string> notes = {}; ///< what of it is left out (arrays of a VTP)
    std::vector<Field> field_data = {};  ///< WriteOptions::field_data
};

/// Reads a surface (VTP, PLY, STL, 3MF, OBJ, legacy VTK, Gocad TSurf), polygons split into triangles. STL has no shared
/// vertices: weld it.
ISOTET_API Result<SurfaceFile> read_surface(const std::string& path, const ReadSurfaceOptions& options = {},
                                            const Run& run = {});

/// A grid that was read to be counted.
struct SurveyedGrid {
    ReadResult read; ///< where there is a report, with a sample of the cells, and cell fields of all of them
    std::optional<GridReport> report = {};   ///< survey() of all cells, without faces; nothing: the grid has all cells
    std::vector<std::uint64_t> sampled = {}; ///< numbers of the cells of the sample
};

/// read(), but cells are counted as they go by, and only a sample of them is kept, where that can be done: linear cells in
/// VTK's XML formats, VTKHDF, Exodus or a binary legacy VTK file, of which no piece repeats some of another but as ghost cells,
/// and points that do not coincide.
///
/// Cost     of such a file memory for points and fields, a byte a point, and one pass over the cells
/// Errors   as read()
ISOTET_API Result<SurveyedGrid> read_surveyed(const std::string& path, const ReadOptions& options = {},
                                              const Run& run = {});

} // namespace isotet
