// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What draw_files() draws: a scene of a surface from a file, or of a grid.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/jobs/draw_files.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/packed_file.hpp>

#include "base/threads/read_ahead.hpp"
#include "jobs/streamed_steps.hpp"

namespace isotet::jobs {

/// The file, and the time steps that are drawn.
class PictureSource {
public:
    /// Errors   as of reading; invalid_argument where options are for grids, but the file is a surface
    static Result<PictureSource> open(const DrawJob& job, Caller& caller);

    /// With what is drawn between them.
    std::size_t steps() const noexcept {
        return steps_.empty() ? 1 : (steps_.size() - 1) * (static_cast<std::size_t>(job_.interpolate) + 1) + 1;
    }

    /// Reads a step, chooses field and isovalues, and starts the scene. All steps have the isovalues and the colour scale
    /// of the first that is read, whose range is that of all of them.
    ///
    /// The step behind is read while this one is drawn: then there are two in memory.
    ///
    /// `device`   draws, nothing: the CPU does; extracts too if it is a graphics card, or if `engine` vulkan asks for it
    /// Errors     as of reading and packing; invalid_argument where a field to colour by is none
    Result<DrawInput> read(std::size_t which, const std::optional<Device>& device, Caller& caller);

    /// How much of a packed file the pictures took.
    void tell_what_was_read(Caller& caller) const;

private:
    struct Contents; ///< of one step
    explicit PictureSource(const DrawJob& job) : job_(job) {}
    Result<DrawInput> take_surface(const std::optional<Device>& device, Caller& caller);
    bool wants_surfaces() const;
    bool may_stretch() const;
    std::string needed_field() const;
    Result<void> choose_steps_and_view(Caller& caller);
    Result<void> take_first_view(bool& contours, std::string& field, std::string& color, Contents& contents,
                                 Caller& caller) const;
    Result<void> keep_steps_with_fields(Caller& caller);
    Result<Contents> read_contents(std::size_t step, bool on_cpu, Caller& caller);
    bool draws_boundary_alone() const;
    std::optional<ReadActiveCells> active_cells(const Contents& contents, const FoundField& contoured,
                                                const FoundField& colored) const;
    Result<void> choose_isovalues_of_steps(std::size_t step, const FoundField& contoured, Caller& caller);
    Result<void> take_colors(const std::string& color, Contents& contents, Caller& caller);
    std::optional<ContourOptions> options_with_active_cells() const;
    Result<void> read_cells(const FieldsToRead& fields, std::size_t step, const std::optional<ReadActiveCells>& active,
                            Contents& contents, Caller& caller);
    bool has_cell_field(const FoundField& colored, std::size_t step) const;
    bool is_packed(std::size_t step, const FoundField& contoured, const FoundField& colored) const;
    Result<void> take_packed(const FoundField& contoured, const FoundField& colored, std::size_t step,
                             Contents& contents, Caller& caller);
    Result<void> check_interpolation() const;
    Result<PackedGrid> sliced(const Plane& plane, std::size_t step, const Run& run);
    Result<Grid> read_for(const FoundField& field, std::size_t step, Caller& caller);
    Result<ColorField> colors_at(std::size_t step, const std::string& name, Caller& caller);
    Result<PointField> field_at(std::size_t step, const std::string& name, Caller& caller);
    bool needs_range_of_volume() const;
    Result<ColorScale> scale_of_volume(std::size_t step, const Contents& contents, Caller& caller);
    Result<void> take_volume(std::size_t step, Contents& contents, Caller& caller);
    Result<void> find_sweep(const Contents& contents, Caller& caller);
    Result<void> choose_isovalues(const Contents& contents, DrawInput& input, Caller& caller);
    Result<void> widen_range(const std::string& color, Caller& caller);
    Result<ValueRange> typical_range_of_steps(const PointField& first, Caller& caller);
    core::ReadAhead<Grid>& grids(const FieldsToRead& fields, Caller& caller);
    void choose_stretch(const Array& points, Caller& caller);
    /// Takes the grid.
    IsosurfaceOptions scene_options(Contents& contents, const std::vector<double>& isovalues);
    SceneLook look_of(const Contents& contents) const;

    DrawJob job_; ///< with the isovalues and the range of all steps
    std::string surface_format_;
    std::optional<Surface> surface_;
    double surface_seconds_ = 0;
    std::optional<GridSource> source_;
    std::optional<PackedFile> packed_;                 ///< that is drawn without its grid
    bool told_of_cells_ = false;                       ///< that all of a packed file is needed
    std::vector<std::pair<Plane, PackedGrid>> sliced_; ///< of a packed file, for planes of each normal
    std::optional<std::size_t> sliced_step_;           ///< from which on the points are where they are there
    std::vector<std::size_t> steps_;
    double fraction_ = 0;                        ///< of the way to the next step
    FirstView first_;                            ///< where no field is named
    std::optional<OpacityCurve> volume_opacity_; ///< of the first step

    std::shared_ptr<KnownBoundary> boundary_;             ///< of the last of several steps
    std::shared_ptr<StreamedBoundary> streamed_boundary_; ///< where not all cells are read
    bool needs_all_cells_ = false;                        ///< a step that was to do with some needed all
    std::unique_ptr<core::ReadAhead<Grid>> grids_;        ///< of the steps, with these fields
    FieldsToRead last_read_;
    StreamedSteps streamed_; ///< where not all cells are read
};

} // namespace isotet::jobs
