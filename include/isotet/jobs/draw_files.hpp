// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From a grid or surface file to pictures: what `isotet render` does.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/isosurface_scene.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/render.hpp>
#include <isotet/scene.hpp>
#include <isotet/jobs/device_choice.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/range_shares.hpp>
#include <isotet/paper/search.hpp>

namespace isotet::jobs {

/// The opacity of the grid's boundary where none is given.
constexpr double default_boundary_opacity = 0.1;

/// What finds tets for a method that draws tets, where no search index is given.
constexpr SearchIndex default_index = SearchIndex::cluster_ranges;

/// Isovalues where none is given.
constexpr std::uint64_t default_levels = 3;

/// How a picture comes about: surfaces are extracted (by the rule where nothing is set), or tets are drawn.
struct DrawHow {
    std::optional<Method> extract;
    std::optional<DrawMethod> draw; ///< draws tets, and no surface is made
};

struct DrawJob {
    GridOptions grid;                       ///< `file` may be a surface
    std::string out;                        ///< with {frame} for numbered pictures; empty: called as the file is
    std::vector<std::string> other_outputs; ///< of the caller: no picture may overwrite them
    FieldChoice field;
    std::vector<double> isovalues;
    std::vector<IsovalueShare> shares;   ///< more isovalues, after the others: of each time step its own
    std::uint64_t levels = 0;            ///< 0: `isovalues` and `shares` say it, or three
    std::optional<double> decimal_comma; ///< as of ExtractJob
    bool allow_empty = false;        ///< also where all isovalues are outside the field's range, which else is an error
    PictureOptions picture;          ///< camera and occlusion aside
    std::optional<double> occlusion; ///< of the picture; nothing: default_occlusion where the CPU draws
    std::optional<View> view;        ///< nothing: best_view_of() the grid where no isosurface is drawn, else iso
    std::vector<double> angles;      ///< azimuth and elevation, instead of `view`; or none
    std::optional<UpAxis> up;
    std::optional<Camera> camera; ///< all of it: neither view nor fit counts
    double zoom = 1;
    bool fit_surface = false; ///< else the grid
    bool parallel = false;
    std::string unit; ///< of coordinates, beside a scale bar; empty: none
    bool scale_bar = false;
    std::vector<double> stretch; ///< of x, y and z; none: that of z where a reservoir is flat (default_stretch())
    std::vector<Plane> clips, slices;
    std::optional<SolidSide> solid; ///< in place of isosurfaces: solids on this side of them
    std::optional<PartChoice> keep; ///< of each isosurface or solid only these parts; nothing: all
    bool edges = false;
    ShadeBy shade_by = ShadeBy::vertices;
    std::string boundary_color_by; ///< a field; empty: none
    bool all_steps = false;
    std::uint64_t interpolate = 0; ///< pictures between two steps of a packed file: PackedFile::interpolated()
    bool outline = false;          ///< the box around
    bool volume = false;           ///< the field as a volume; isosurfaces only where isovalues are given
    std::optional<OpacityText> volume_opacity; ///< nothing: a ramp, and with `dirac` none
    std::optional<double> opacity_length;      ///< that it is of; nothing: a tenth of the diagonal of the grid's box
    bool volume_shading = false;               ///< VolumeLook::shaded
    std::vector<double> dirac;                 ///< isovalues of surfaces that rays meet; asks for a volume, too
    std::vector<IsovalueShare> dirac_shares;   ///< more of these: of each time step its own
    bool plain = false;                        ///< no text
    std::string color_by;                      ///< a field; empty: each isovalue has its colour
    ColorScale scale;                          ///< the map, the logarithm and the colour for no data
    std::vector<double> range;                 ///< both ends of the scale, or none
    std::optional<double> boundary, opacity;   ///< of the grid's boundary, of the surfaces
    EngineChoice engine = EngineChoice::automatic;
    DrawHow method;
    std::optional<SearchIndex> index; ///< nothing: none was given
    std::vector<double> sweep;        ///< first and last isovalue, and how many; or none
    RangeShares sweep_shares = {};    ///< of the first step: in place of both isovalues
    std::uint64_t orbit = 0;          ///< pictures around; 0: one
    double frames_per_second = 12;
    std::string reference;    ///< a picture to compare with; empty: none
    double threshold = 0.001; ///< share of its pixels that may differ
    DeviceChoice device;
    ContourOptions contour{.refine = RefineOptions{}}; ///< of these split cells and refinement are taken
    bool refine_averaged = false;                      ///< as of ExtractJob
    std::optional<std::uint64_t>
        memory; ///< of a packed file, as PackedFileOptions::memory; nothing: half of what is free
};

/// What is drawn, of the last step.
struct DrawInput {
    std::string format;
    bool is_surface = false;
    std::string field;               ///< that is contoured; empty for a surface file, and where nothing is
    std::optional<double> time;      ///< of the step
    std::optional<std::size_t> step; ///< where there are several
    std::vector<double> isovalues;
    std::vector<double> sweep = {};   ///< DrawJob::sweep, with its shares
    std::optional<ColorField> colors; ///< of whatever is coloured
    std::optional<VolumeLook> volume;
    std::vector<double> stretch = {}; ///< of x, y and z; or none
    std::uint64_t cells = 0;          ///< of the grid
    double read_seconds = 0;
    std::optional<IsosurfaceScene> scene; ///< always there
};

/// Whether rays meet isosurfaces.
inline bool draws_dirac(const DrawJob& job) { return !job.dirac.empty() || !job.dirac_shares.empty(); }

/// Whether the field is drawn as a volume.
inline bool draws_volume(const DrawJob& job) { return job.volume || draws_dirac(job); }

/// Pictures that were drawn and written.
struct PictureNumbers {
    std::string file; ///< OUT
    std::size_t pictures = 1;
    std::uint64_t bytes = 0;                    ///< of all
    double draw_seconds = 0, write_seconds = 0; ///< for all
    VolumeWork volume;                          ///< of the last one
    std::optional<std::uint64_t> peak_memory;   ///< of the process
    DeviceWork drawing;                         ///< of the last one
    std::string camera;                         ///< of the last one, as parse_camera() takes it
    std::optional<double> differs;              ///< share of the pixels, with a reference
};

struct DrawReport {
    DrawInput input;
    std::optional<DeviceInfo> device; ///< that drew; nothing: the CPU
    PictureNumbers pictures;
};

/// One picture, or one for each isovalue of `sweep` (of a volume a peak of opacity there, or with `dirac` its surface),
/// each direction of `orbit` or each step: read and extracted one after another, each written while the next one is drawn.
///
/// Memory   one step, with `all_steps` two
/// Errors   invalid_argument: what is asked for does not fit together or with the file, told before anything large is
///          read where that can be known; as of reading, packing, drawing and writing
Result<DrawReport> draw_files(const DrawJob& job, Caller& caller);

/// Isovalues of the surfaces that are shown, each different.
std::vector<std::string> isovalue_texts(const IsosurfaceScene& scene);

/// "0.25 %".
std::string percent_text(double share);

} // namespace isotet::jobs
