// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A grid as pages look at it: frames and charts, by the session of the library.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/isosurface_scene.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/read.hpp>
#include <isotet/scene.hpp>
#include <isotet/solid.hpp>

#include "view/messages.hpp"
#include "view/packed_source.hpp"
#include "view/pick.hpp"
#include "view/steps.hpp"

namespace isotet::view {

/// A name that find_field() takes, as pages offer it.
struct OfferedField {
    std::string name;
    Association association = Association::point;
};

/// Scalar fields, components and magnitudes of vectors; the coordinates where there is no field.
std::vector<OfferedField> offered_fields(const Grid& grid);

struct GridViewOptions {
    std::size_t preview_triangles = 150'000; ///< of a surface while a hand moves
    std::size_t max_triangles = 8'000'000; ///< of a surface that a page is sent; larger ones are previews of that size
    int threads = 0;                       ///< at most; 0: all
    std::shared_ptr<const Engine> engine = cpu_engine();   ///< for isosurfaces; one that keeps no grid
    std::size_t step = 0;                                  ///< that the grid is
    std::size_t steps = 1;                                 ///< of the file
    std::optional<RefineOptions> refine = RefineOptions{}; ///< of curved cells, as ShowMessage::refined asks
    ReadStep read_step;               ///< of any step. Nothing: there is one step, and cells stay in memory
    std::optional<PackedFile> packed; ///< where the grid lies, packed: then read_step need not give all cells
    std::uint64_t cells = 0;          ///< of it, of which the grid has some
    ReadStep read_cells;              ///< with `packed`: of any step with all cells
    std::vector<RegionName> regions;  ///< names of numbers of regions
    std::function<Result<Grid>(Grid grid, const std::vector<std::string>& cells)>
        only_cells; ///< empties other cells, for ViewState::cells; nothing: all are shown
};

/// A frame in bytes. `known` of GridView::frame() are then the surfaces that the page has.
struct Frame {
    std::string bytes;
    bool preview = false;
};

/// A frame before it is bytes.
struct FrameParts {
    FrameFacts facts;
    std::vector<FrameSurface> surfaces;
    std::vector<std::shared_ptr<const Mesh>> meshes; ///< that `surfaces` points to
    std::vector<std::string> keys;
    std::uint64_t most = 0; ///< triangles of a surface above which it is a preview
};

/// The parts of a surface, largest area first, and which of them are shown.
struct ShownParts {
    std::vector<SurfacePart> parts;
    std::vector<std::uint64_t> kept; ///< their numbers, ascending
};

/// Threads   pack() and find_boundary() by one thread beside one other call; all else one call at a time
class GridView {
public:
    /// Errors   as statistics_of()
    static Result<std::unique_ptr<GridView>> create(Grid grid, const GridViewOptions& options = {});

    const std::vector<OfferedField>& fields() const noexcept { return fields_; }
    const Box& bounds() const noexcept { return bounds_; }
    std::uint64_t points() const noexcept { return grid_.points.tuples(); }
    std::uint64_t cells() const noexcept { return cell_count_; }
    /// Whether ShowMessage::refined makes a difference.
    bool refines() const { return options_.refine && has_curved_cells(grid_.cells); }

    /// Packs the grid, for the field that frame() was asked for last, else `field`. frame() extracts directly until then, and
    /// from the packed grid afterwards.
    /// `isovalues`   that are shown first
    /// Errors   as find_field() and Contour::prepare(); frame() then goes on directly
    Result<void> pack(const std::string& field, const Run& run, const std::vector<double>& isovalues = {});

    /// Whether the grid lies in a packed file: pack() does nothing then.
    bool is_of_file() const noexcept { return options_.packed.has_value(); }

    /// Takes a packed grid of the same cells and points, as a packed file holds it, in place of pack().
    /// Errors   as find_field()
    Result<void> take_packed(const PackedGrid& packed, const std::string& field, const Run& run);

    /// The grid's boundary; frame() leaves it out until then.
    /// Errors   as boundary_of()
    Result<void> find_boundary(const Run& run);

    /// The surfaces of a state. Those whose keys are in `known` are not sent again; `known` becomes those of this frame.
    ///
    /// Errors   as find_field() and Contour::extract(); cancelled. `known` is then as before
    Result<Frame> frame(const ShowMessage& message, double wait_seconds, std::vector<std::string>& known,
                        const Run& run);

    /// The same of meshes, before they are bytes. Errors   as above
    Result<FrameParts> frame_parts(const ShowMessage& message, const std::vector<std::string>& known, const Run& run);

    /// Gives memory back that the next frame of the same kind does not need: the cells of a packed grid of one step, which
    /// are read again when something needs them, and what the library keeps for later.
    void rest();
    bool has_cells() const noexcept { return has_cells_; }

    /// Of a step, which is read where it is not the one at hand; nothing: that one.
    /// Errors   as find_field(), statistics_of() and of reading
    Result<Chart> chart(const std::string& field, std::optional<std::uint64_t> step, const Run& run = {},
                        const std::vector<std::string>& cells = {});

    /// Area and volume over the range of a field. The last answer is kept.
    /// `step`   as above
    /// Errors   as find_field(), contour_spectrum() and of reading
    Result<ContourSpectrum> spectrum(const std::string& field, std::optional<std::uint64_t> step, const Run& run = {},
                                     const std::vector<std::string>& cells = {});
    std::size_t step() const noexcept { return step_; } ///< that was asked for last

    /// All fields, and the cell, at the point of the isosurface or slice that is nearest.
    /// Errors   as Contour::extract(); invalid_data where there is no triangle
    Result<Picked> pick(const PickMessage& message, const Run& run);

    /// The connected parts of the first isosurface or solid of a state.
    /// Errors   as Contour::extract(), Solids and find_parts()
    Result<ShownParts> parts(const PartsMessage& message, const Run& run);

    /// Errors   as isovalues_at()
    Result<double> isovalue_at(const ShareMessage& message, const Run& run);

private:
    /// A mesh of a surface, in full.
    struct Kept {
        std::string key;
        std::shared_ptr<const Mesh> mesh;
        bool used = false;      ///< by the frame that is made
        double field_bound = 0; ///< where cells were refined
    };
    /// An isosurface of a frame.
    struct Shown {
        std::string key;
        std::shared_ptr<const Mesh> mesh;
        std::optional<double> field_bound; ///< where cells were refined
    };
    /// A session that surfaces come from, and what it was set to.
    struct Source {
        std::shared_ptr<Contour> contour;
        std::string field, color_by;
        std::size_t step = 0;
        std::vector<double> isovalues = {}; ///< that `contour` is for, where it has only polyhedra that these meet
    };
    /// A cell field of few whole numbers, each of which has a colour.
    struct Classes {
        std::string key;                ///< of the field and its step
        std::map<double, float> places; ///< of numbers among the classes
        ColorField field;               ///< without classes: the field has none
    };
    GridView() = default;
    Result<const ColorField*> classes_of(const ViewState& state, const Run& run);
    Array places_in_classes(const Array& numbers) const;
    Result<Surface> colored_boundary(Surface boundary, std::uint64_t number, const ColorField& colors, const Run& run);
    void open_packed();
    std::vector<Field> cell_fields_of_file(std::size_t step) const;
    Result<const Field*> cell_colors_at(const std::string& name, const Run& run);
    bool draws_from_file(const ViewState& state) const;
    Result<void> draw_from_file(const ViewState& state, IsosurfaceOptions& options, const Run& run);
    Result<void> need_cells(const Run& run);
    bool may_release_cells(const Grid& grid) const;
    Result<ExtractOptions> carried_fields(const std::string& color_by, const Run& run);
    Result<std::shared_ptr<const Mesh>> packed_mesh_at(const ViewState& state, double isovalue, const std::string& key,
                                                       FrameParts& making, const Run& run);
    Result<std::shared_ptr<const Mesh>> solid_mesh_at(const ViewState& state, double isovalue, const std::string& key,
                                                      FrameParts& making, const Run& run);
    Result<Solid> solid_at(const ViewState& state, double isovalue, const Run& run);
    Result<Surface> whole_isosurface(const PartsMessage& message, double isovalue, const Run& run);
    Result<Surface> shown_surface(const PickMessage& message, const Run& run);
    Result<Surface> boundary_of_pick(const Run& run);
    Result<void> find_boundary_cells(const Surface& boundary, std::uint64_t number, const Run& run);
    Result<Surface> solid_of_pick(const PickMessage& message, const Run& run);
    Result<Picked> pick_along(const PickMessage& message, const Run& run);
    Result<Surface> surface_of_pick(const PickMessage& message, const Run& run);
    Result<PointField> field_of(const std::string& name, const Run& run);
    Result<ContourInput> input_of(const std::string& field, const std::string& color_by, const Run& run);
    Result<std::optional<ColorScale>> scale_of(const ViewState& state, const Run& run);
    Result<Source*> source_for(const ViewState& state, const Run& run);
    Result<void> set_source(Source& source, ContourInput input, const std::vector<double>& isovalues, const Run& run);
    Result<std::shared_ptr<Contour>> session_to_pack(const Grid& grid, const std::string& field, std::size_t step,
                                                     const std::vector<double>& isovalues, const Run& run);
    Result<Frame> picture_frame(const ShowMessage& message, double wait_seconds, std::vector<std::string>& known,
                                const Run& run);
    Result<void> make_scene(const ShowMessage& message, const std::optional<ColorScale>& scale, const Run& run);
    Result<void> show_volume(const ViewState& state, const ColorScale& scale, const Run& run);
    Result<OpacityCurve> opacity_of_volume(const ViewState& state, const Run& run);
    std::optional<ColorField> color_field(const ViewState& state, const ColorScale& scale, const Run& run);
    Result<void> show_grid(std::optional<std::uint64_t> wanted, const std::vector<std::string>& cells, const Run& run);
    bool leaves_no_cell(std::optional<std::uint64_t> wanted, const std::vector<std::string>& cells, const Run& run);
    Result<FrameParts> frame_begun(const ShowMessage& message, const Run& run);
    Result<Grid> grid_of_step(std::optional<std::uint64_t> wanted, const Run& run);
    bool uses_packed() const { return is_packed_.load(std::memory_order_acquire) && cells_.empty(); }
    void read_ahead(const ShowMessage& message);
    Result<void> tell_field(const std::string& field, FrameFacts& facts, const Run& run);
    Result<Shown> refined_at(const ViewState& state, double isovalue, const std::string& key, FrameParts& making,
                             const Run& run);
    Result<Shown> surface_at(const ShowMessage& message, double isovalue, Source* source, FrameParts& making,
                             const Run& run);
    std::shared_ptr<const Mesh> kept_mesh(const std::string& key);
    Result<std::shared_ptr<const Mesh>> keep(const std::string& key, const Surface& surface,
                                             const std::optional<ColorScale>& scale, FrameFacts& facts, const Run& run);
    Result<std::shared_ptr<const Mesh>> keep(const std::string& key, const ViewState& state, const Surface& surface,
                                             FrameFacts& facts, const Run& run);
    Result<std::shared_ptr<const Mesh>> mesh_at(Source& source, const ViewState& state, double isovalue,
                                                const std::string& key, FrameFacts& facts, const Run& run);
    Result<std::shared_ptr<const Mesh>> slice_at(const ViewState& state, const Plane& plane, const std::string& key,
                                                 const std::optional<ColorScale>& scale, FrameFacts& facts,
                                                 const Run& run);
    Result<void> add_isosurfaces(const ShowMessage& message, const std::vector<std::string>& known, FrameParts& making,
                                 const Run& run);
    Result<void> add_slices(const ViewState& state, const std::vector<std::string>& known, FrameParts& making,
                            const Run& run);
    Result<void> add_boundary(const ViewState& state, const std::vector<std::string>& known, FrameParts& making,
                              const Run& run);
    static void add(FrameSurface surface, const std::shared_ptr<const Mesh>& mesh,
                    const std::vector<std::string>& known, FrameParts& making);

    mutable std::mutex grid_mutex_;  ///< of grid_, grid_number_ and step_, while another thread may copy them
    Grid grid_;                      ///< without cells where has_cells_ is false; of `cells_` where these are chosen
    std::vector<std::string> cells_; ///< as ViewState::cells
    std::optional<Cells> all_cells_; ///< of grid_ where cells are chosen
    std::uint64_t grid_number_ = 0;  ///< another one when cells or points are others
    bool has_cells_ = true;          ///< of a packed file: and grid_ has values of its cell fields, by these cells
    std::map<std::string, Field> file_cells_; ///< of a packed file at this step, by the user's cells: those that colour
    std::uint64_t cell_count_ = 0;
    std::optional<Solids> solids_; ///< of solids_key_, while solids are shown
    std::string solids_key_;
    std::optional<PackedSource> lean_;       ///< instead of session_, where cells may be released
    std::optional<CellSample> sample_;       ///< of the cells that were released
    std::optional<std::uint64_t> cells_sum_; ///< of these, to know them again
    GridViewOptions options_;
    std::vector<OfferedField> fields_;
    Box bounds_;
    std::map<std::string, PointField> found_; ///< fields that were asked for
    std::vector<Kept> kept_;                  ///< of the last frame
    std::mutex session_mutex_;
    Source session_; ///< of all cells: pack() packs it beside frame(); session_mutex_ guards it until then
    Source chosen_;  ///< of `cells_`
    std::atomic<bool> is_packed_{false};
    std::size_t step_ = 0; ///< that grid_ is
    std::unique_ptr<StepReader> steps_;
    std::optional<IsosurfaceScene> scene_; ///< of pictures, while they are asked for
    std::string scene_key_;
    std::optional<ContourSpectrum> spectrum_; ///< of spectrum_key_
    std::string spectrum_key_;
    std::optional<ValueRange> range_; ///< of range_key_
    std::string range_key_;
    std::optional<std::vector<double>> scene_isovalues_; ///< that scene_ draws; nothing: it draws nothing yet
    std::optional<VolumeState> scene_volume_;            ///< the same
    OpacityCurve scene_opacity_;                         ///< that scene_volume_ became
    std::uint32_t volume_part_ = 3; ///< pictures of a moving volume have this part of the width and height
    ValueRange volume_range_;       ///< that presets of opacity are over, of volume_field_: that of the step
    std::string volume_field_;      ///< which was shown first, so that steps can be compared
    std::mutex boundary_mutex_;
    std::shared_ptr<const Mesh> boundary_;            ///< of the cells and points of grid_; null: not there yet
    std::shared_ptr<const Surface> boundary_surface_; ///< the same
    std::uint64_t boundary_grid_ = 0;                 ///< grid_number_ that it is of
    std::uint64_t boundary_number_ = 0;               ///< another one for each boundary, in its key
    std::vector<std::uint64_t> boundary_cells_;       ///< of the triangles of the boundary with boundary_cells_of_
    std::uint64_t boundary_cells_of_ = 0;
    std::optional<Classes> classes_;
};

} // namespace isotet::view
