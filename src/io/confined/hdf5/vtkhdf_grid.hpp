// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// An unstructured grid of a VTKHDF file: partitions, time steps, polyhedra.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/confined/hdf5/hdf5_rows.hpp"
#include "io/confined/hdf5/vtkhdf_steps.hpp"
#include "io/pieces/cell_places.hpp"
#include "io/pieces/loaded.hpp"
#include "io/reader.hpp"

namespace isotet::io::confined {

/// What a partition has, and where it begins in the data sets.
struct HdfPartition {
    std::uint64_t points = 0, cells = 0, corners = 0;
    std::uint64_t first_point = 0, first_cell = 0, first_corner = 0;
    std::uint64_t first_offset = 0; ///< each partition has one more than cells

    /// Of polyhedra: faces, their points, and the faces of all cells.
    std::uint64_t faces = 0, face_points = 0, cell_faces = 0;
    std::uint64_t first_face = 0, first_face_point = 0, first_cell_face = 0;
    std::uint64_t first_face_offset = 0; ///< each partition has one more than faces
};

/// Where the tuples of fields begin that do not say so themselves.
struct HdfStepPlace {
    std::uint64_t first_part = 0, parts = 0;
    std::uint64_t first_point = 0, first_cell = 0, first_corner = 0;
};

/// The cells of a partition but for their corners.
struct HdfCells {
    Array types, offsets;                  ///< offsets: empty where there are places
    std::optional<CellPlaces> places = {}; ///< of linear cells one after another; borrow the types
};

/// An unstructured grid in an open file, which must outlive it.
class HdfGrid {
public:
    /// `group`   where it is, with a slash at the end: "/VTKHDF/"
    HdfGrid(std::string path, const Hdf5Rows& rows, std::string group)
        : path_(std::move(path)),
          rows_(rows),
          group_(std::move(group)),
          steps_(steps_of(path_, group_.substr(0, group_.size() - 1))) {}

    /// Adds fields and times.
    Result<void> announce_all(FileInfo& info) const;
    /// Of one step.
    Result<std::uint64_t> count_cells(std::size_t step) const;
    /// The same; zeros where they cannot be told.
    LeastCounts least(std::size_t step) const;
    /// Adds one piece a partition. `name` begins the names of the pieces. A field that cannot be read is left out.
    Result<void> load(const ReadOptions& options, std::size_t step, const std::string& name, Loaded& loaded) const;

private:
    Error wrong(const std::string& what) const { return broken(path_, what); }
    bool has(const std::string& name) const { return rows_.shape(group_ + name).has_value(); }
    bool has_steps() const { return !steps_.times.empty(); }

    Result<std::vector<std::uint64_t>> counts(const std::string& name, std::uint64_t first, std::uint64_t rows) const;
    Result<std::uint64_t> number_or(const std::string& name, std::uint64_t place, std::uint64_t otherwise) const;
    Result<HdfStepPlace> find_step(std::size_t step) const;
    Result<std::vector<HdfPartition>> find_partitions(const HdfStepPlace& place) const;
    void note_rows_left_over(const std::vector<HdfPartition>& parts, std::vector<std::string>& notes) const;
    Result<Array> read_points(const HdfPartition& part) const;
    Result<void> find_faces(const HdfStepPlace& place, std::size_t step, std::vector<HdfPartition>& parts) const;
    Result<void> load_types(const HdfPartition& part, HdfCells& cells) const;
    Result<bool> are_offsets_told(const HdfPartition& part, const CellPlaces& places) const;
    bool may_be_left(const HdfPartition& part, const ReadOptions& options, const HdfCells& cells) const;
    Result<void> load_corners(const HdfPartition& part, const ReadOptions& options, HdfCells cells, Piece& piece) const;
    Result<void> load_faces(const HdfPartition& part, Cells& cells) const;
    /// `later`   the values may stay in the file
    Result<void> load_fields(const HdfPartition& part, const HdfStepPlace& place, std::size_t step,
                             Association association, const ReadOptions& options, bool later, Piece& piece,
                             FileInfo& info) const;
    Result<std::uint64_t> first_row(const HdfPartition& part, const HdfStepPlace& place, std::size_t step,
                                    Association association, const std::string& name) const;

    std::string path_;
    const Hdf5Rows& rows_;
    std::string group_;
    HdfSteps steps_;
};

} // namespace isotet::io::confined
