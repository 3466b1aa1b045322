// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From isovalues to a Scene that a Renderer draws: a session that extracts, colours, the grid's boundary, a box around.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/draw_tets.hpp>
#include <isotet/export.hpp>
#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/progress.hpp>
#include <isotet/render.hpp>
#include <isotet/result.hpp>
#include <isotet/scene.hpp>
#include <isotet/paper/search.hpp>
#include <isotet/slice.hpp>
#include <isotet/solid.hpp>
#include <isotet/surface.hpp>

namespace isotet {

class KnownBoundary; // boundary.hpp

/// Where the normals come from that smooth surfaces are shaded by.
enum class ShadeBy : std::uint8_t {
    vertices, ///< vertex_normals()
    gradient, ///< of the field
    faces     ///< every triangle is flat
};

/// The side of an isosurface that is shown as a solid.
enum class SolidSide : std::uint8_t { above, below };

/// How the field is drawn as a volume.
///
/// `opacity`          without points: nothing but the isosurfaces that rays meet
/// `opacity_length`   that the opacity is of; nothing: a tenth of the diagonal of the box around the grid
/// `isosurfaces`      isovalues of surfaces that rays meet, opaque, with the colours of isosurfaces
/// `shaded`           as DrawnVolume::shaded
struct VolumeLook {
    ColorScale scale;
    OpacityCurve opacity;
    std::optional<double> opacity_length = {};
    std::vector<double> isosurfaces = {};
    bool shaded = false;
};

/// How a scene looks.
struct SceneLook {
    std::optional<ColorField> colors; ///< of isosurfaces and slices; nothing: each isovalue has its own colour of `map`
    std::optional<ColorField> boundary_colors; ///< of the grid's boundary
    std::optional<ValueRange> isovalue_range;  ///< in which isovalues have their colours; nothing: that of those shown
    ShadeBy shade_by = ShadeBy::vertices;
    ColorMap map = ColorMap::viridis;
    std::optional<double> opacity; ///< nothing: that of looks_of()
    double boundary_opacity = 0.1; ///< of the grid's boundary; 0: it is not looked for
    bool outline = false;          ///< the edges of the box around
    double line_width = 1;         ///< pixels
    bool edges = false;            ///< those of the triangles of boundary and slices; of the surfaces where neither is
                                   ///< drawn
    std::vector<Plane> clips;      ///< of isosurfaces and boundary only normal . p <= offset is shown
    std::vector<Plane> slices;     ///< through the grid; not clipped
    std::optional<VolumeLook> volume = {}; ///< of the field; curved cells are then split at their nodes
    std::optional<SolidSide> solid = {};   ///< in place of isosurfaces: the closed part of the grid on one side of
                                           ///< each; the CPU makes them, and no volume goes with them
    std::optional<PartChoice> keep = {};   ///< of each isosurface or solid only these parts, as keep_parts(); the CPU
                                           ///< extracts
    std::vector<Color> map_colors = {};    ///< not empty: in place of `map`, as ColorScale::colors
};

/// Colour and opacity of one of several isosurfaces.
struct SurfaceLook {
    Color color;
    double opacity = 1;
};

/// Vertices of a surface, up to 2048 finite ones, spread evenly over their order.
using SurfacePoints = std::vector<std::array<double, 3>>;
ISOTET_API SurfacePoints some_points_of(const Surface& surface);

/// By surface: which others it hides more than two thirds of, in the mean over 14 directions.
ISOTET_API std::vector<std::vector<std::size_t>> hidden_by(std::span<const SurfacePoints> points);

/// What IsosurfaceScene gives isosurfaces that are shown together: colours in the order of their values, and an opacity of
/// 0.35 to those that hide others (hidden_by()).
///
/// `points`   of the surfaces, one an isovalue
/// `look`     its map, range of isovalues and opacity count
/// Returns    a look an isovalue
ISOTET_API std::vector<SurfaceLook> looks_of(std::span<const double> isovalues, std::span<const SurfacePoints> points,
                                             const SceneLook& look);

/// The cut through a grid along a plane, as IsosurfaceScene draws it; with `field`, if it is not null, as its first field of
/// points or cells.
///
/// Cost     a direct extraction
/// Errors   as slice_field(), linearize() and extract_direct()
ISOTET_API Result<Surface> slice_of(const Grid& grid, const Plane& plane, const ColorField* field, const Run& run = {});

/// What exaggerates heights: points, and a plane through them, with their axes stretched by factors above 0. The points keep
/// their type.
/// Cost   one pass over the points
ISOTET_API Array stretched(const Array& points, std::span<const double, 3> factors);
ISOTET_API Plane stretched(const Plane& plane, std::span<const double, 3> factors);

/// Formats of corner-point grids: reservoirs of kilometres, some metres high.
ISOTET_API bool is_of_reservoirs(std::string_view format) noexcept;

/// Where points reach 50 times as wide as high or more, factors that make it 4 to 10 times: 1, 2 or 5 times a power of
/// ten for z. Else nothing.
/// Cost   one pass over the points
ISOTET_API std::optional<std::array<double, 3>> default_stretch(const Array& points);

/// A solid as IsosurfaceScene draws it: triangles of its boundary share no vertex, so that each is flat.
///
/// `keep`   its connected parts that are drawn; nothing: all
/// Errors   as keep_parts()
ISOTET_API Result<Surface> drawn_solid(const Solid& solid, const std::optional<PartChoice>& keep = {},
                                       const Run& run = {});

/// Where surfaces of a grid are extracted.
enum class ExtractOn : std::uint8_t {
    best, ///< on the device that draws if it is a graphics card and clusters pay or are asked for, else on the CPU
    cpu,
    device, ///< or an error
};

/// A packed grid to contour, of a PackedFile say: no grid is needed, and surfaces come from the clusters that they meet.
struct PackedScene {
    PackedGrid grid; ///< with the field to contour
    std::optional<PackedGrid>
        colors;           ///< with the field of SceneLook::colors or boundary_colors, if it is one of points
    bool contours = true; ///< else only boundary and slices are drawn
    /// Gives the same grid with the field of a plane, as PackedFile::sliced() does, for SceneLook::slices.
    std::function<Result<PackedGrid>(const Plane& plane, const Run& run)> sliced = {};
};

/// A grid to contour, and how.
struct IsosurfaceOptions {
    Grid grid;        ///< its own fields are not looked at
    PointField field; ///< without values: nothing is contoured, show() takes no isovalues
    /// Of these method, surfaces, split cells, expected isovalues and refinement are taken; a device takes curved cells split at
    /// their nodes.
    ContourOptions contour{.surfaces = 1};
    ExtractOn where = ExtractOn::best;
    std::optional<DrawMethod> draw;                  ///< tets are drawn by this method instead, and no surface is made
    SearchIndex index = SearchIndex::cluster_ranges; ///< that finds the tets to draw
    PictureOptions picture; ///< of the pictures to come: `draw` leaves device memory free for them
    /// As ContourInput::part; where cells colour, `whole` gives the values of all of them. Where cells are missing, no slices
    /// are drawn, of boundaries only `boundary`, with its colours, and all is as large as it or the bounds.
    std::optional<GridPart> part = {};
    Box bounds = {};                      ///< of the points that any cell has; with `packed`, too
    std::optional<Surface> boundary = {}; ///< of all cells, where it is known
    /// In place of `grid` and `field`. The CPU extracts; there are no solids, and cells colour isosurfaces and slices
    /// only, of a grid that was packed with source cells.
    std::optional<PackedScene> packed = {};
    std::shared_ptr<KnownBoundary> known_boundary =
        {}; ///< of scenes before, whose grids may have the same cells; or null
};

/// A surface that is shown, or the tets that stand for it.
struct ShownSurface {
    std::optional<double> isovalue; ///< nothing for a surface that was given
    std::uint64_t vertices = 0, triangles = 0;
    std::uint64_t tets = 0, sent_bytes = 0; ///< with IsosurfaceOptions::draw: how many, and bytes over the bus for this
                                            ///< isovalue

    std::uint64_t size() const noexcept { return triangles + tets; }
};

/// What making a scene took; seconds of all calls so far.
struct SceneReport {
    FieldReport field; ///< of a grid, from the first show() on
    double pack_seconds = 0, boundary_seconds = 0, upload_seconds = 0, extract_seconds = 0;
    std::uint64_t boundary_faces = 0, slice_triangles = 0;
    std::vector<std::size_t> empty_slices; ///< SceneLook::slices that do not meet the grid
    bool on_device = false;                ///< the last surfaces were extracted there
    Method method = Method::direct;        ///< of the last surfaces
    DeviceWork extract_work;               ///< of the last ones on the device
    std::optional<TetStoreReport> store;   ///< with IsosurfaceOptions::draw
    double opacity_length = 0;             ///< with SceneLook::volume
};

/// A scene of isosurfaces of one grid, or of one surface. Moving is cheap; it keeps the device open, if it has one.
///
/// Guarantees   the surfaces of Contour; on a device they stay there, and a field colours them where they are
/// Threads      one call at a time
class ISOTET_API IsosurfaceScene {
public:
    /// Finds the boundary, starts the session, and packs and uploads what all isovalues share.
    ///
    /// `look`     with a volume the grid is packed, and the scene is one for draw()
    /// `device`   that will draw the scene; nothing: surfaces stay in the machine's memory, for draw()
    /// Errors   as Contour::create(), Contour::prepare(), Solids::create(), boundary_of(), TetStore::upload() and
    ///          TetIndex::create(); invalid_argument when options need a device and there is none, or a volume is to be
    ///          drawn by one, or has no field, or solids go with either, or a packed grid with what it does not take
    static Result<IsosurfaceScene> create(const std::optional<Device>& device, IsosurfaceOptions options,
                                          SceneLook look, const Run& run = {});

    /// Of a surface that is there already: show() without isovalues shows it.
    static Result<IsosurfaceScene> create(const std::optional<Device>& device, Surface surface, SceneLook look);

    IsosurfaceScene(IsosurfaceScene&&) noexcept;
    IsosurfaceScene& operator=(IsosurfaceScene&&) noexcept;
    ~IsosurfaceScene();

    /// Makes the scene that of these isovalues; what was shown before goes.
    /// Errors   as Contour::extract(), DeviceMesh::upload() and DeviceColors; the CPU replaces a
    ///          device that fails, with a note, unless it is required
    Result<void> show(std::span<const double> isovalues, const Run& run = {});

    /// Changes how the volume looks, from the next show() on. Nothing where the scene was made without one.
    void set_volume(const VolumeLook& look);

    /// Points a camera at the whole grid or surface: the same for all isovalues, and with `orbit` from all sides at one
    /// distance.
    enum class Fit : std::uint8_t { once, orbit };
    void fit(Camera& camera, double aspect, Fit fit = Fit::once) const;

    /// The box around the grid or surface.
    const Box& bounds() const noexcept;

    /// Points a camera at the isosurfaces and slices that are shown now; at the grid where there are none in memory.
    void fit_surfaces(Camera& camera, double aspect) const;

    const Scene& scene() const noexcept;
    const std::vector<ShownSurface>& surfaces() const noexcept;
    const SceneReport& report() const noexcept;

    /// Sentences for the user since the last call.
    std::vector<std::string> take_notes();

private:
    struct Data;
    explicit IsosurfaceScene(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

} // namespace isotet
