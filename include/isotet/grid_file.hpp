// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces straight from a grid file: no more of it is read than they need.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet {

struct FileContourOptions {
    std::size_t step = 0;
    std::vector<std::string> with =
        {}; ///< fields that surfaces carry: point fields and their components, cell fields, expressions
    bool close_hanging_points = true; ///< where cells of several sizes meet (linear_cells.hpp)
    ContourOptions contour = {}; ///< contour() sets its expected isovalues, and as many surfaces where none are named
};

struct FileSession {
    Contour contour;
    std::vector<std::string> notes; ///< of reading and closing: sentences for the user
};

/// What to read of a file where those cells do that the expected isovalues meet; nothing: all are needed.
ISOTET_API std::optional<ReadActiveCells> active_cells_for(const std::string& field, const ContourOptions& options);

/// ContourInput::part of a grid that was read; nothing where that is the whole.
///
/// `has_cells_around`   the active cells were chosen for gradient normals
/// `read_all`           the same with all cells; is called when something needs them, where active ones were read
/// `cell_fields`        gives those that surfaces carry, of that grid; empty: none
ISOTET_API std::optional<GridPart>
part_of(const ReadResult& read, bool has_cells_around, std::function<Result<ReadResult>(const Run& run)> read_all,
        std::function<Result<std::vector<Field>>(const Grid& grid, const Run& run)> cell_fields = {});

/// A grid file that was looked into.
///
/// Threads   safe from many threads
class ISOTET_API GridFile {
public:
    /// `options`   of all that is read; fields, the step and active cells aside
    /// Errors      as inspect()
    static Result<GridFile> open(const std::string& path, ReadOptions options = {}, const Run& run = {});

    const FileInfo& info() const noexcept;

    /// One step.
    ///
    /// `fields`   names of point and cell fields, components of them, and expressions, of which what they need is read;
    ///            nothing: all fields
    /// Errors     as read()
    Result<ReadResult> read(std::size_t step = 0, const std::optional<std::vector<std::string>>& fields = {},
                            const Run& run = {}) const;

    /// The surfaces of a field. Of formats that let it (ReadOptions::active_cells) only the cells that the isovalues meet are
    /// kept, where nothing needs the others. The notes begin with those of reading.
    ///
    /// `field`      as find_field() takes it
    /// Guarantees   the bytes of a session on the grid that read() gives, closed at hanging points; of a packed file those of
    ///              extract() from it, where it has all that is asked for
    /// Cost         one surface of a raw VTU: reading it, and memory for points, the field and the surface
    /// Errors       as read(), find_field() and Contour::extract()
    Result<ContourResult> contour(const std::string& field, std::span<const double> isovalues,
                                  const FileContourOptions& options = {}, const Run& run = {}) const;

    /// A session of one step, for isovalues that follow one another. With ContourOptions::surfaces and expected_isovalues it may
    /// begin with the cells that these meet, and reads the others when something needs them.
    ///
    /// Errors   as read(), find_field() and Contour::create()
    Result<FileSession> session(const std::string& field, const FileContourOptions& options = {},
                                const Run& run = {}) const;

private:
    struct Data;
    explicit GridFile(std::shared_ptr<const Data> data);
    std::shared_ptr<const Data> data_;
};

} // namespace isotet
