// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is drawn, and how: the same for every renderer.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/camera.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/opacity.hpp>
#include <isotet/pack.hpp>
#include <isotet/picture.hpp>
#include <isotet/slice.hpp>
#include <isotet/surface.hpp>

namespace isotet {

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

/// Which value has which colour.
///
/// `lower`, `upper`   values at the ends of the map, lower < upper, both finite; on a logarithmic scale lower > 0
/// `classes`          not empty: the range is as many equal parts, each of one colour; `map` does not count
/// `no_data`          where a value is NaN. Values beyond the ends have the colours of the ends
struct ISOTET_API ColorScale {
    ColorMap map = ColorMap::viridis;
    double lower = 0, upper = 1;
    bool logarithmic = false;
    std::vector<Color> classes = {};
    Color no_data{0.72F, 0.72F, 0.72F, 1};

    /// The place of a value in the map, not limited to 0 to 1; NaN for what is no number.
    double place_of(double value) const noexcept;
    double value_of(double place) const noexcept; ///< the value at a place of the map
};

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
    const Surface* triangles = nullptr;      ///< in memory; a device uploads it for each picture
    const SurfaceColors* values = nullptr;   ///< of `triangles`; null: `color` everywhere
    const DeviceMesh* mesh = nullptr;        ///< uploaded (render.hpp)
    const DeviceSurface* surface = nullptr;  ///< where the Vulkan engine left it (device_grid.hpp)
    const DeviceColors* colors = nullptr;    ///< of `mesh` and `surface`; null: `color` everywhere. Tets have none
    Color color{0.70F, 0.75F, 0.80F, 1};     ///< its opacity does not count
    double opacity = 1;                      ///< of the sheet seen at a right angle; at a slant it is denser. 0: not
                                             ///< drawn
    const TetSurface* tets = nullptr;        ///< that give their triangles while they are drawn (draw_tets.hpp)
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
    const PackedGrid* grid = nullptr; ///< borrowed; with its field. Of a packed file all of it is read
    ColorScale scale;
    OpacityCurve opacity;                     ///< without points: only `isosurfaces` are seen
    double opacity_length = 1;                ///< that `opacity` is of, in the unit of coordinates; above 0
    std::vector<DrawnIsosurface> isosurfaces; ///< shaded by the gradient of the field in each tet
    std::vector<Plane> clips;                 ///< only normal . p <= offset is seen; rays are cut, not cells
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
    std::vector<DrawnVolume> volumes = {}; ///< that do not overlap; the CPU draws them
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

} // namespace isotet
