// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a page shows: a small value that `isotet render` has options for.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/fields.hpp>
#include <isotet/isosurface_scene.hpp>
#include <isotet/result.hpp>
#include <isotet/scene.hpp>
#include <isotet/surface.hpp>

#include "view/json.hpp"

namespace isotet::view {

inline constexpr std::size_t max_isovalues = 32;
inline constexpr std::size_t max_name_bytes = 4096;
inline constexpr std::size_t max_planes = 6;            ///< to clip with, and as many slices
inline constexpr std::size_t max_cell_choices = 9; ///< of messages: those of a pasted line, and hidden classes
inline constexpr double default_boundary_opacity = 0.1; ///< as SceneLook has it

/// The field as a volume, as isotet render --volume draws it: the server draws.
struct VolumeState {
    std::string opacity = "ramp";        ///< as parse_opacity() takes it
    std::optional<double> length = {};   ///< that the opacity is of, above 0; nothing: default_opacity_length()
    bool surfaces = true;                ///< isosurfaces are drawn with it
    bool shaded = false;                 ///< as DrawnVolume::shaded

    friend bool operator==(const VolumeState&, const VolumeState&) = default;
};

struct ViewState {
    std::string field;             ///< as find_field() takes it
    std::vector<double> isovalues; ///< the one that the slider moves, then the pinned ones
    bool isosurfaces = true;       ///< they are shown, or solids in their place
    std::string color_by;          ///< a point or cell field; empty: a colour a surface
    ColorMap map = ColorMap::viridis;
    std::optional<ValueRange> range; ///< values at the ends of the map, lower < upper; nothing: the field's
    bool logarithmic = false;
    std::optional<double> opacity; ///< 0 to 1, of all surfaces; nothing: as render chooses
    bool outline = false;
    std::optional<Camera> camera; ///< of what `stretch` makes of the grid
    std::optional<std::array<double, 3>>
        stretch;                                ///< factors of the axes, above 0; planes are in coordinates of the grid
    double boundary = default_boundary_opacity; ///< opacity of the grid's boundary, 0 to 1; 0: it is not shown
    bool colored_boundary = false;              ///< by `color_by`
    bool edges = false;                         ///< as SceneLook::edges
    std::optional<SolidSide> solid;             ///< in place of isosurfaces: solids on this side of them
    std::optional<PartChoice> keep;             ///< of each surface or solid only these connected parts; touching the
                                                ///< boundary only
    std::vector<Plane> clips, slices;           ///< as SceneLook; at most `max_planes` each
    std::vector<std::string> cells;             ///< as GridOptions::cells: others are left out of all that is shown
    std::optional<std::uint64_t> step;          ///< nothing: the one that is read
    std::optional<VolumeState> volume;          ///< coloured by `field`, as then nothing is by another one
};

/// Texts of --cells as messages have them: at most `max_cell_choices`, none longer than `max_name_bytes`.
bool take_cells(const Json& json, std::vector<std::string>& cells);

/// "above" and "below", and back.
std::string_view name_of(SolidSide side);
std::optional<SolidSide> parse_solid_side(std::string_view name);

inline constexpr std::string_view shown_parts_rule =
    "largest, a number of parts from 1, area>A, volume>V, touching:boundary, parts:I,J or not:I,J";

/// A choice that can be shown: nothing where it is none, or names a region of the file.
std::optional<PartChoice> parse_shown_parts(std::string_view text);

bool operator==(const ViewState& a, const ViewState& b);

/// A state as messages hold it, and back. Keys that are left out have the values above.
///
/// Errors   invalid_argument: a key of another type, more than `max_isovalues`, a number that is not finite or out of
///          its range, a text that is too long, a camera or a map that is none
Json to_json(const ViewState& state);
Result<ViewState> state_of(const Json& json);

} // namespace isotet::view
