// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/pack.hpp>
#include <isotet/picture.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/slice.hpp>
#include <isotet/surface.hpp>

namespace isotet {

// How opaque a volume is, by the values of its field: as points, as text, and by presets.

struct OpacityPoint {
    double value = 0;   ///< of the field
    double opacity = 0; ///< 0 to 1: what a given length of this value hides

    friend bool operator==(const OpacityPoint&, const OpacityPoint&) = default;
};

/// Opacity over the values of a field: linear between points, and that of the first and the last point beyond them.
/// Two points with one value are a step. Without points everything is transparent.
struct ISOTET_API OpacityCurve {
    std::vector<OpacityPoint> points;

    double at(double value) const noexcept;
    bool is_transparent() const noexcept; ///< everywhere

    /// Errors   invalid_argument, with the number of the point: values that descend or are not finite, an opacity that
    ///          is not from 0 to 1
    Result<void> check() const;
};

enum class OpacityPreset : std::uint8_t {
    ramp,  ///< from transparent at the lower end of a range to 0.6 at the upper
    peaks, ///< narrow peaks at isovalues, transparent elsewhere
    shell  ///< transparent near both ends of a range, 0.35 between
};

/// What a text says: points, or a preset.
struct OpacityText {
    OpacityCurve curve; ///< of points
    std::optional<OpacityPreset> preset;
    std::uint64_t peaks = 0; ///< how many; 0: not said
};

/// "0:0,300:0.02,400:0.5" (value:opacity, values ascending), "ramp", "peaks", "peaks:5" or "shell".
///
/// Errors   invalid_argument: what is wrong, at which point, and the rule
ISOTET_API Result<OpacityText> parse_opacity(std::string_view text);

/// The curve of a preset. A range of one value is 0.35 opaque everywhere.
///
/// `range`    of the field, finite, lower <= upper
/// `levels`   of peaks, ascending; others take none
ISOTET_API OpacityCurve opacity_of(OpacityPreset preset, const ValueRange& range, std::span<const double> levels = {});

/// The curve that a text says; peaks are at as many levels, three where it is not said, evenly inside the range.
///
/// `range`    of the field; of presets finite, lower <= upper
ISOTET_API OpacityCurve opacity_of(const OpacityText& text, const ValueRange& range);

/// A box along the axes; empty while lower > upper.
struct ISOTET_API Box {
    std::array<double, 3> lower{1, 1, 1}, upper{-1, -1, -1};

    bool empty() const noexcept { return !(lower[0] <= upper[0]); }
    void add(const std::array<double, 3>& point) noexcept;
    void add(const Box& other) noexcept;
};

/// The box of all points that packed tets use, or of all vertices of a surface that are finite.
/// Cost   one pass
ISOTET_API Box bounds_of(const PackedGrid& packed);
ISOTET_API Box bounds_of(const Surface& surface);

/// From where one looks: obliquely from the front, the right and above; or from the end of an axis. z is up, except
/// that from +z and -z y is.
enum class View : std::uint8_t { iso, plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };

/// "iso", "+x", "-x" and so on, and back.
ISOTET_API std::string_view name_of(View view) noexcept;
ISOTET_API std::optional<View> parse_view(std::string_view name) noexcept;

enum class Projection : std::uint8_t { perspective, parallel };

/// A camera: what is in the middle of the picture, from which direction it is seen, and how much of it.
///
/// `direction`   from the target to the eye, unit
/// `up`          unit, at right angles to `direction`
/// `distance`    of the eye from the target
/// `angle`       of view, in degrees, from the lower to the upper edge of a perspective picture
/// `height`      of what a parallel picture shows
struct ISOTET_API Camera {
    Projection projection = Projection::perspective;
    std::array<double, 3> target{};
    std::array<double, 3> direction{0, 0, 1};
    std::array<double, 3> up{0, 1, 0};
    double distance = 1;
    double angle = 25;
    double height = 1;

    /// Sees all of a box as large as possible.
    ///
    /// `aspect`   width of the picture / its height
    /// `margin`   part of the picture that is left free on each side, below 0.5
    void fit(const Box& box, double aspect, double margin = 0.04);

    /// The same of all vertices of a surface that are finite: closer than their box, which has corners where nothing
    /// is.
    /// Cost   one pass
    void fit(const Surface& surface, double aspect, double margin = 0.04);

    /// The same for all cameras that orbit(azimuth, 0) leads to: at one distance, as small as lets each of them see
    /// all. A camera that has gone around and fits again keeps its distance, as long as it looks up or down by less
    /// than 45 degrees; the axis that it goes around is in the middle of the picture.
    /// Cost   as fit()
    void fit_orbit(const Box& box, double aspect, double margin = 0.04);
    void fit_orbit(const Surface& surface, double aspect, double margin = 0.04);

    /// Goes around the target: `azimuth` degrees to the right about the axis of the world that is nearest to `up`, then
    /// `elevation` degrees upwards, as far as just below the pole.
    void orbit(double azimuth, double elevation);

    /// Shows things `factor` times as large.
    void zoom(double factor);
};

/// An axis of the world that points upwards in a picture.
enum class UpAxis : std::uint8_t { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };

/// A camera with the direction of a view; fit() does the rest.
ISOTET_API Camera camera_of(View view, Projection projection = Projection::perspective);

/// The same with another axis upwards; along that axis itself the view keeps its own.
ISOTET_API Camera camera_of(View view, UpAxis up, Projection projection = Projection::perspective);

/// The view that shows most of what lies in a box: along the axis that is under a twentieth of both others, iso where none
/// is. `box` is not empty.
ISOTET_API View best_view_of(const Box& box) noexcept;

/// A camera that looks from the front (-y where z is up, +z where y is, -y where x is), `azimuth` degrees to the right
/// of it and `elevation` degrees above, -90 to 90.
ISOTET_API Camera camera_of(double azimuth, double elevation, UpAxis up = UpAxis::plus_z,
                            Projection projection = Projection::perspective);

/// All of a camera in one word, "perspective:TARGET:DIRECTION:UP:DISTANCE:ANGLE" or "parallel:TARGET:DIRECTION:UP:HEIGHT",
/// vectors as three numbers separated by commas; and back. Numbers are the shortest that are read back as they were.
ISOTET_API std::string to_text(const Camera& camera);
ISOTET_API std::optional<Camera> parse_camera(std::string_view text);

// What is drawn, and how: the same for every renderer.

class DeviceMesh;
class DeviceSurface;
class DeviceColors;
class TetSurface;

/// A colour map, from 0 to 1. All but turbo and cool_warm are perceptually uniform.
enum class ColorMap : std::uint8_t { viridis, cividis, plasma, turbo, cool_warm };

/// "viridis", "cool-warm" and so on, and back.
ISOTET_API std::string_view name_of(ColorMap map) noexcept;
ISOTET_API std::optional<ColorMap> parse_color_map(std::string_view name) noexcept;

/// The colour at a place of the map; places outside 0 to 1 have those of its ends.
ISOTET_API Color color_at(ColorMap map, double place) noexcept;

/// The same of some colours, evenly from 0 to 1; of none those of `map`.
ISOTET_API Color color_at(const std::vector<Color>& colors, ColorMap map, double place) noexcept;

/// Which value has which colour.
///
/// `lower`, `upper`   values at the ends of the map, lower < upper, both finite; on a logarithmic scale lower > 0
/// `classes`          not empty: the range is as many equal parts, each of one colour; `map` does not count
/// `no_data`          where a value is NaN. Values beyond the ends have the colours of the ends
/// `colors`           not empty: in place of `map`, evenly from 0 to 1, with mixed ones between (parse_color_map_file())
struct ISOTET_API ColorScale {
    ColorMap map = ColorMap::viridis;
    double lower = 0, upper = 1;
    bool logarithmic = false;
    std::vector<Color> classes = {};
    Color no_data{0.72F, 0.72F, 0.72F, 1};
    std::vector<Color> colors = {};

    /// The place of a value in the map, not limited to 0 to 1; NaN for what is no number.
    double place_of(double value) const noexcept;
    double value_of(double place) const noexcept; ///< the value at a place of the map
    Color color_at(double place) const noexcept;  ///< without `classes`, at a place of the map
};

/// A colour map of a file.
struct ColorMapFile {
    std::string name;
    std::vector<Color> colors;    ///< 1024, evenly from its first value to its last, for ColorScale::colors; or none
    ValueRange range;             ///< these values
    std::optional<Color> no_data; ///< its NanColor
    OpacityCurve opacity;         ///< over values as the file has them; without points where it has none
};

/// A colour map from the text of a JSON file that ParaView exports: RGBPoints in the spaces RGB, HSV, Lab, Diverging and Step,
/// and Points, with their midpoints and sharpness, for the opacity. LabCIEDE2000 is taken as Lab.
///
/// `name`   of one of several maps; empty: the file has one only
/// Errors   invalid_data: no JSON, no such map, several but no name, neither colours nor opacity, lists that are not of
///          four numbers a point, values that descend or are not finite, colours and opacities that are not from 0 to 1
ISOTET_API Result<ColorMapFile> parse_color_map_file(std::string_view text, std::string_view name = {});

/// Opacity from the text of a file: such a colour map, or what parse_opacity() takes, where points may also be separated
/// by blanks and line ends, and # begins a comment.
///
/// Errors   as these two; invalid_data: a colour map without opacity
ISOTET_API Result<OpacityText> parse_opacity_file(std::string_view text, std::string_view name = {});

/// Values that colour a surface in memory.
///
/// `values`   a scalar a vertex (Association::point) or a triangle (Association::cell); NaN: no data
struct SurfaceColors {
    Array values;
    Association association = Association::point;
    ColorScale scale;
};

/// Something with triangles that is drawn. Exactly one of `triangles`, `mesh`, `surface` and `tets` is set; all are
/// borrowed. The CPU draws `triangles` only, a device all of them.
struct DrawnSurface {
    const Surface* triangles = nullptr;     ///< in memory; a device uploads it for each picture
    const SurfaceColors* values = nullptr;  ///< of `triangles`; null: `color` everywhere
    const DeviceMesh* mesh = nullptr;       ///< uploaded (render.hpp)
    const DeviceSurface* surface = nullptr; ///< where the Vulkan engine left it (device.hpp)
    const DeviceColors* colors = nullptr;   ///< of `mesh` and `surface`; null: `color` everywhere. Tets have none
    Color color{0.70F, 0.75F, 0.80F, 1};    ///< its opacity does not count
    double opacity = 1;                     ///< of the sheet seen at a right angle; at a slant it is denser. 0: not
                                            ///< drawn
    const TetSurface* tets = nullptr;       ///< that give their triangles while they are drawn (draw_tets.hpp)
};

/// Straight lines of one colour, drawn as opaque.
struct DrawnLines {
    std::vector<std::array<std::array<double, 3>, 2>> lines; ///< both ends of each
    Color color{0.25F, 0.25F, 0.25F, 1};
    double width = 1; ///< pixels
    double lift = 0;  ///< nearer by this part of the depth of the picture: edges of a surface are then before it
};

/// An isosurface that is met by rays through a volume, opaque, and not extracted.
struct DrawnIsosurface {
    double isovalue = 0; ///< in the unit of the field; finite
    Color color{0.70F, 0.75F, 0.80F, 1};
};

/// The field of a packed grid as a medium that absorbs and emits light, linear in each tet. Other cells are seen as the
/// tets of PackOptions::split_cells. Cells with a corner whose value is NaN or infinite are empty; where cells overlap
/// each is seen. On a logarithmic scale the logarithm is linear in each tet, and values below 0 are far below the scale.
struct DrawnVolume {
    const PackedGrid* grid = nullptr; ///< borrowed; with its field. Of a packed file what is not transparent is read
    ColorScale scale;
    OpacityCurve opacity;                     ///< without points: only `isosurfaces` are seen
    double opacity_length = 1;                ///< that `opacity` is of, in the unit of coordinates; above 0
    std::vector<DrawnIsosurface> isosurfaces; ///< shaded by the gradient of the field in each tet
    std::vector<Plane> clips;                 ///< only normal . p <= offset is seen; rays are cut, not cells
    bool shaded = false; ///< colours are lit as those of isosurfaces are, by the gradient of the field in each tet
};

/// The length that opacity is of where none is given: a tenth of the diagonal.
ISOTET_API double default_opacity_length(const Box& box);

/// The twelve edges of a box.
ISOTET_API DrawnLines outline_of(const Box& box);

/// What is drawn; nothing at all is fine, and gives the background.
///
/// `bounds`   everything lies within
struct Scene {
    std::vector<DrawnSurface> surfaces;
    std::vector<DrawnLines> lines;
    Box bounds;
    std::vector<DrawnVolume> volumes = {}; ///< that do not overlap
};

/// PictureOptions::occlusion of isotet's own pictures.
inline constexpr double default_occlusion = 0.8;

struct PictureOptions {
    std::uint32_t width = 1200, height = 900; ///< pixels, 1 to 32768 each
    std::uint32_t samples = 3;                ///< an axis and pixel, 1 to 8: their mean is the pixel
    Color background{1, 1, 1, 1};
    Camera camera;
    double occlusion = 0; ///< how dark folds of opaque surfaces become, 0 to 1; devices draw 0
};

// A field that colours a surface or a grid: its values, and the scale that fits them.

/// A field that colours surfaces.
struct ColorField {
    std::string name;
    Array values; ///< a scalar for each point or cell of the grid; of a surface for each vertex or triangle
    Association association = Association::point;
    ColorScale scale;
    bool has_no_data = false;              ///< some values are NaN: a legend shows their colour
    std::vector<std::string> classes = {}; ///< names of scale.classes; `values` are then numbers of classes
};

/// The scale that is wanted.
struct ColorOptions {
    ColorScale scale;                         ///< without its ends and classes
    std::optional<ValueRange> range = {};     ///< its ends; nothing: those of the values
    std::map<double, std::string> names = {}; ///< of whole numbers that are classes; without one it is the number
    Array all_values = {}; ///< of a cell field of a grid that has some of its cells: of all, or ReadResult::digests
};

/// A field that colours, and what a reader of the picture should know of it.
struct FoundColors {
    ColorField field;
    std::vector<std::string> notes;
};

/// The smallest and the largest value that has a place on a scale: finite, and on a logarithmic one above 0.
///
/// Returns   lower > upper where there is none
/// Cost      one parallel pass
/// Errors    cancelled; out_of_memory
ISOTET_API Result<ValueRange> colored_range(const Array& values, bool logarithmic, const Run& run = {});

/// The scale of `options` with its ends: the range that is asked for, or that of all `values` together. Values that are
/// all the same, or none, have a scale around them.
///
/// Errors   invalid_argument: a range whose ends are not ascending and finite, or not above 0 on a logarithmic scale;
///          those of colored_range()
ISOTET_API Result<ColorScale> color_scale(std::span<const Array> values, const ColorOptions& options,
                                          const Run& run = {});

/// The name of a cell field of one component that colours cells as they are: no point field has that name.
///
/// Returns   null where there is no such field
ISOTET_API const Field* cell_colors(const Grid& grid, const std::string& name);

/// A field of a grid that colours: cell_colors() as they are, otherwise what find_field() makes of the name. Cells of
/// at most twelve whole numbers have a colour for each number, unless a range or a logarithmic scale is asked for.
///
/// Errors   invalid_argument: no such field, or several components; those of color_scale()
ISOTET_API Result<FoundColors> find_colors(const Grid& grid, const std::string& name, const ColorOptions& options = {},
                                           const Run& run = {});

/// A field of a surface that colours: point fields first, with their components as find_field() names them.
///
/// Errors   as for a grid
ISOTET_API Result<FoundColors> find_colors(const Surface& surface, const std::string& name,
                                           const ColorOptions& options = {}, const Run& run = {});

/// Gives a boundary_of() a grid the values of a field of that grid, as its first field of points or cells.
///
/// Cost     of points one pass over the boundary; of cells boundary_cells()
/// Errors   invalid_argument: the field does not fit the grid; as boundary_cells()
ISOTET_API Result<void> color_boundary(Surface& boundary, const Grid& grid, const ColorField& field,
                                       const Run& run = {});

/// Fields of the grid's points at the vertices of a boundary_of() that grid, of any components, in the order of `fields`. The grid's
/// cells are needed only where the boundary has points that linearize() has made: the fields are then continued there by
/// LinearGrid::extend(), integers as float64.
///
/// `fields`   one tuple a point of the grid
///
/// Cost     a pass over the boundary a field; with points of linearize() that, once, and a copy of each field
/// Errors   invalid_argument: a field does not fit the grid, or the boundary is of another one; as linearize()
ISOTET_API Result<std::vector<Field>> fields_at_boundary(const Surface& boundary, const Grid& grid,
                                                         std::span<const Field> fields, const Run& run = {});

/// The same as color_boundary() of a field of points that fits, by fields_at_boundary().
ISOTET_API Result<void> color_boundary_by_points(Surface& boundary, const Grid& grid, const ColorField& field,
                                                 const Run& run = {});

/// The same of a field of cells that fits, with boundary_cells().
ISOTET_API void color_boundary_by_cells(Surface& boundary, const std::vector<std::uint64_t>& cells,
                                        const ColorField& field);

/// Of each triangle of a boundary_of() a grid the lowest cell that has it; UINT64_MAX where none has.
///
/// Cost     a pass over all cells, one thread; 40 bytes a triangle
/// Errors   as linearize() and split()
ISOTET_API Result<std::vector<std::uint64_t>> boundary_cells(const Surface& boundary, const Grid& grid,
                                                             const Run& run = {});

} // namespace isotet
