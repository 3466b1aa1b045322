// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packed grids in files (.isotet): opened at once, and read where an isovalue needs them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/slice.hpp>

namespace isotet {

/// How a packed grid is saved.
struct SavePackedOptions {
    std::vector<PackedGrid> more_fields; ///< other fields of the same cells and points, made by with_field()
    std::optional<double> time;          ///< of the step
    std::uint32_t chunk_bytes = 65'536;  ///< topology of a chunk, the least that is read at once; 1 to 2^24
};

/// Saves a packed grid. The bytes depend on the grid and the options alone.
///
/// The file is written beside `path` and renamed when it is whole, as write_grid() does.
///
/// Cost     one pass over the packed arrays; of a grid that lies in a file itself, all of it is read first
/// Errors   invalid_argument when a further field is of other cells, or two have one name; as write_grid(); cancelled
ISOTET_API Result<void> save_packed(const PackedGrid& packed, const std::string& path,
                                    const SavePackedOptions& options = {}, const Run& run = {});

/// Saves the steps of a series that have the same cells, one after another. Points may move: PackedGrid::with_points().
class ISOTET_API PackedWriter {
public:
    /// Writes cells, points and the field of `packed` as step 0.
    /// Errors   as save_packed()
    static Result<PackedWriter> create(const PackedGrid& packed, const std::string& path,
                                       const SavePackedOptions& options = {}, const Run& run = {});

    /// Adds to a file that is there: the field of `packed` becomes the next step. The grid must be the one that was saved, of
    /// the file (PackedFile::load(), with_field() and with_points()) or packed again in the same way. What is there stays where it is, and who
    /// has the file open sees the old steps. At every moment the file is whole: with all of the new steps after commit(), without
    /// any of them before.
    ///
    /// Cost     a pass over cells and points, which are compared by checksums
    /// Errors   invalid_argument: other cells, with the first chunk that differs; as PackedFile::open();
    ///          cannot_write: another writer has the file, or it cannot be written
    static Result<PackedWriter> append(const PackedGrid& packed, const std::string& path, std::optional<double> time,
                                       const Run& run = {});

    PackedWriter(PackedWriter&&) noexcept;
    PackedWriter& operator=(PackedWriter&&) noexcept;
    ~PackedWriter();

    /// Another field of the same step, with the same points, or the first of the next one.
    /// `time`   of the step; the same for all fields of it
    /// Errors   as save_packed(); after an error of writing the file is given up
    Result<void> add_field(const PackedGrid& packed);
    Result<void> add_step(const PackedGrid& packed, std::optional<double> time);

    /// A cell field of the same step, as it is: surfaces can carry it. Nothing is written where it is that of the step before.
    /// Errors   as save_packed(); invalid_argument: the grid was packed without source cells, or has another number of cells
    Result<void> add_cell_field(const Field& field);

    /// The file appears under its name. Nothing else can be done afterwards.
    Result<std::uint64_t> commit(); ///< bytes of the file

private:
    struct Data;
    explicit PackedWriter(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

/// A field of a packed file at a step.
struct PackedFieldInfo {
    std::size_t step = 0;
    ScalarType type = ScalarType::float32; ///< of the user's values
    FieldReport report;                    ///< with its name
    bool gradients = false;
};

/// A cell field of a packed file, from this step on until there is another of the same name.
struct PackedCellFieldInfo {
    std::size_t step = 0;
    std::string name;
    ScalarType type = ScalarType::float32;
    std::size_t components = 1;
};

/// Other points, from this step on until there are others.
struct PackedPointsInfo {
    std::size_t step = 0;
    std::array<double, 3> lower{}, upper{}; ///< bounds of the points that cells use
};

/// What a packed file holds: all that opening it tells.
struct PackedFileInfo {
    std::uint32_t major = 1, minor = 0; ///< version of the format
    std::uint64_t file_bytes = 0;
    Precision precision = Precision::float32;
    ScalarType point_type = ScalarType::float32;
    std::uint64_t user_points = 0, user_cells = 0; ///< of the grid that was packed
    std::uint64_t unpacked_bytes = 0; ///< memory that read() takes for a step with one field: packed arrays, and those of a grid
    PackReport report;
    std::uint64_t chunks = 0;
    bool source_cells = false;
    std::array<double, 3> lower{}, upper{}; ///< bounds of the points that cells use, at step 0
    std::size_t steps = 1;
    std::vector<double> times;           ///< one a step; empty where they are not known
    std::vector<PackedFieldInfo> fields; ///< by step, then in the order of saving
    std::vector<PackedCellFieldInfo> cell_fields; ///< likewise
    std::vector<PackedPointsInfo> moved_points;   ///< by step
};

struct PackedFileOptions {
    /// Bytes of the file's arrays that are kept in memory when nothing works on them; more only while that is worked on.
    /// 0: half of the memory that is free when the file is opened.
    std::uint64_t memory = 0;
};

/// What was read so far, and what of it is in memory.
struct ResidencyReport {
    std::uint64_t limit = 0;      ///< PackedFileOptions::memory
    std::uint64_t bytes_read = 0; ///< directory and tables included
    std::uint64_t reads = 0;      ///< calls to the system
    std::uint64_t pieces_read = 0; ///< parts of chunks: points, topology, values
    std::uint64_t pieces_dropped = 0;
    std::uint64_t bytes = 0, peak_bytes = 0; ///< of pieces in memory: now, at most
};

/// An open packed file. A handle: copies share it, and grids that it gave keep it open.
///
/// Nothing of the file is trusted: checksums are compared and numbers checked where they are read, so that a broken file is an
/// error of the call that meets it.
///
/// Threads   safe from many threads
class ISOTET_API PackedFile {
public:
    /// Reads the header and the directory: 32 bytes for each 64 kB of cells, 8 for each field and step.
    /// Errors   file: not there, not readable; invalid_data: no packed file, broken, cut short, a newer major version;
    ///          out_of_memory
    static Result<PackedFile> open(const std::string& path, const PackedFileOptions& options = {},
                                   const Run& run = {});

    /// Whether the file begins as packed files do.
    static bool is_one(const std::string& path);

    const PackedFileInfo& info() const noexcept;

    /// The packed grid with one of the fields. It is a PackedGrid as any other: extract() reads the chunks that isovalues
    /// meet, all else reads all of it. What a file cannot tell is not told: false ties of values that were rounded.
    ///
    /// `field`      empty: the only one
    /// Guarantees   surfaces are the same bytes as those of the grid that was saved, for any limit of memory
    /// Cost         a table is read: 29 bytes a cluster (37 in double)
    /// Errors       invalid_argument: there is no such field or step; file, invalid_data; out_of_memory
    Result<PackedGrid> grid(std::string_view field = {}, std::size_t step = 0, const Run& run = {}) const;

    /// The grid of a field between a step and the next: values (1 - fraction) a + fraction b, each product and the sum rounded
    /// once as values are stored; points likewise where they move. A point without data in either step has none. Cell fields
    /// are those of the steps. Gradients are there where both steps have them: directions between these, as how steep they are is
    /// not known. The range in its report is that of both steps.
    ///
    /// Cells may turn over between two steps that move far, as in half a turn: they are not looked at. Where values of a step
    /// are stored with a larger factor, since they are tiny, the smaller one counts.
    ///
    /// `fraction`   0 to 1; at the ends grid() of that step
    /// Guarantees   surfaces are the same bytes as those of the grid in memory with such values
    /// Cost         two tables; surfaces read values of both steps
    /// Errors       as grid(); invalid_argument: the fraction is outside, or the next step lacks the field
    Result<PackedGrid> interpolated(std::string_view field, std::size_t step, double fraction,
                                    const Run& run = {}) const;

    /// The grid with slice_field() of its points as the field: extract() at slice_isovalue() is the cut.
    ///
    /// Guarantees   surfaces are the same bytes as those of the grid in memory with_field(slice_field()), for any limit
    /// Cost         all of the file but values is read once, and points once or twice before: within the limit of memory;
    ///              9 bytes a cluster and 4 kB a chunk stay beside it. Then surfaces need what they meet
    /// Errors       as slice_field() and grid()
    Result<PackedGrid> sliced(const SliceShape& shape, std::size_t step = 0, const Run& run = {}) const;

    /// The same as grid() with all of its arrays in memory, everything checked.
    Result<PackedGrid> load(std::string_view field = {}, std::size_t step = 0, const Run& run = {}) const;

    /// A cell field at a step, by the user's cells, for ExtractOptions::cell_fields. All of it is read.
    /// Errors       as grid()
    Result<Field> cell_field(std::string_view name, std::size_t step = 0, const Run& run = {}) const;

    /// Reads all fields of all steps, and checks what load() does; the boundary against that of the cells.
    Result<void> check(const Run& run = {}) const;

    /// Asks the system to read meanwhile what surfaces like those before need of another step: ranges, and the values of the
    /// chunks that are in memory. Returns at once.
    /// Returns   the bytes that were asked for; 0 where there is no such field or step
    std::uint64_t read_ahead(std::string_view field, std::size_t step) const;

    ResidencyReport residency() const;

private:
    struct Data;
    explicit PackedFile(std::shared_ptr<const Data> data);
    std::shared_ptr<const Data> data_;
};

} // namespace isotet
