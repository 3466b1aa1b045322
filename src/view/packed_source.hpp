// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A packed grid without the arrays that it was made of: surfaces of any field, slices.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <isotet/engine.hpp>
#include <isotet/extract.hpp>
#include <isotet/isosurface_scene.hpp>
#include <isotet/pack.hpp>
#include <isotet/packed_file.hpp>

namespace isotet::view {

/// Whether the points of two steps of a file are the same.
bool same_points(const PackedFileInfo& file, std::size_t one, std::size_t other);

/// Threads   one call at a time
class PackedSource {
public:
    /// `packed`   of a grid of linear cells, for `field`
    /// `engine`   for isosurfaces
    PackedSource(const PackedGrid& packed, PointField field, std::shared_ptr<const Engine> engine)
        : engine_(std::move(engine)),
          packed_(packed),
          field_(std::move(field)),
          knows_cells_(packed.report().source_bytes > 0) {}

    /// Surfaces of the fields of the file, and slices, read what they meet; other fields bring all of it into memory once.
    explicit PackedSource(const PackedFile& file) : file_(file), knows_cells_(file.info().source_cells) {}

    /// Surfaces can have source cells.
    bool knows_cells() const noexcept { return knows_cells_; }

    /// `options`   fields that the surface carries
    /// `step`      of the field, where it is one of a file
    /// Cost     where `field` is not that of the call before, PackedFile::grid() or PackedGrid::with_field(), too
    /// Errors   as these and extract()
    Result<Surface> isosurface(const PointField& field, std::size_t step, double isovalue,
                               const ExtractOptions& options, const Run& run);

    /// What slice_of() gives, in another order, of a step. Cost and errors as above; of a file, as PackedFile::sliced() where the
    /// normal is not that of the call before
    Result<Surface> slice(const Array& points, const Plane& plane, std::size_t step, const ExtractOptions& options,
                          const Run& run);

    /// Of a file: heights over the plane. Cost and errors as above
    Result<PackedGrid> sliced(const Plane& plane, std::size_t step, const Run& run);

    /// Whether it is of a file that has a field at a step.
    bool has(const std::string& field, std::size_t step) const;

    /// As boundary_of(), of a step. Errors   as there, and as PackedFile::grid()
    Result<Surface> boundary(std::size_t step, const Run& run);

private:
    Result<PackedGrid> grid_of(const PointField& field, std::size_t step, const Run& run);
    Result<PackedGrid> whole(std::size_t step, const Run& run);
    Result<ExtractOptions> with_packed_fields(ExtractOptions options, std::size_t step, const Run& run) const;

    std::shared_ptr<const Engine> engine_ = cpu_engine();
    std::optional<PackedFile> file_;
    std::optional<PackedGrid> packed_; ///< of field_
    PointField field_;
    std::optional<PackedGrid> whole_; ///< of a file, once something needs all
    std::size_t whole_step_ = 0;      ///< that its points are of
    std::optional<PackedGrid> sliced_; ///< of a file
    Plane plane_;                      ///< whose normal made it
    std::size_t sliced_step_ = 0;
    bool knows_cells_;
};

/// A grid of a few cells of another, spread evenly over their numbers; the same points. All cells where there are no more.
struct CellSample {
    Grid grid;
    double cells_each = 1; ///< of the grid, for each one here
};
/// Cost     a few milliseconds
/// Errors   out_of_memory is thrown
CellSample sample_of_cells(const Grid& grid);

} // namespace isotet::view
