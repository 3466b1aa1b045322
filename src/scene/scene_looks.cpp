// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Colours and opacities of isosurfaces that are shown together.
#include "scene/hiding.hpp"
#include "scene/scene_data.hpp"

namespace isotet {

namespace {

constexpr double opacity_among_several = 0.35;

using scene::single_color;

/// Isosurfaces have colours of their own: from the dark to the light of the map, in the order of their values, or by their
/// place in a range.
template <class ValueAt>
Color color_among(std::size_t count, std::size_t which, const ValueAt& value_at, const SceneLook& look) {
    const std::optional<double> isovalue = value_at(which);
    if (look.isovalue_range && isovalue) {
        const auto [lower, upper] = *look.isovalue_range;
        return color_at(look.map_colors, look.map, lower < upper ? (*isovalue - lower) / (upper - lower) : 0.5);
    }
    if (count < 2) return single_color;
    std::size_t below = 0;
    for (std::size_t i = 0; i < count; ++i) below += value_at(i) < isovalue ? 1 : 0;
    return color_at(look.map_colors, look.map,
                    0.12 + 0.76 * static_cast<double>(below) / static_cast<double>(count - 1));
}

} // namespace

/// By surface: whether it hides another one. Of those on a device only their sizes are known.
std::vector<bool> IsosurfaceScene::Data::find_hiding() const {
    const scene::Hiding hiding(points);
    const std::uint64_t smallest = smallest_size();
    std::vector<bool> found;
    for (std::size_t i = 0; i < shown.size(); ++i)
        found.push_back(points.size() == shown.size() ? hiding.hides_any(i) : shown[i].size() > smallest);
    return found;
}

std::uint64_t IsosurfaceScene::Data::smallest_size() const {
    std::uint64_t smallest = 0;
    for (const ShownSurface& one : shown)
        if (one.size() > 0 && (smallest == 0 || one.size() < smallest)) smallest = one.size();
    return smallest;
}

/// Colours and opacities, and what is around the surfaces.
void IsosurfaceScene::Data::dress() {
    const std::vector<bool> hides = look.opacity ? std::vector<bool>(shown.size()) : find_hiding();
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto value_at = [&](std::size_t at) { return shown[at].isovalue; };
        scene.surfaces[i].color = color_among(shown.size(), i, value_at, look);
        scene.surfaces[i].opacity = look.opacity.value_or(hides[i] ? opacity_among_several : 1);
    }
    scene.lines = edges;
    scene.lines.insert(scene.lines.end(), surface_edges.begin(), surface_edges.end());
    for (DrawnLines& lines : scene.lines) lines.lift = 1e-3;
    if (look.outline) scene.lines.push_back(outline_of(bounds));
    for (DrawnLines& lines : scene.lines) lines.width = look.line_width * (lines.lift > 0 ? 0.6 : 1);
    scene.surfaces.insert(scene.surfaces.end(), fixed.begin(), fixed.end());
    scene.volumes.clear();
    if (volume_grid) add_volume();
}

/// The field as a volume; the isosurfaces that its rays meet have the colours of others.
void IsosurfaceScene::Data::add_volume() {
    const VolumeLook& volume = *look.volume;
    DrawnVolume& drawn = scene.volumes.emplace_back();
    drawn.grid = &*volume_grid;
    drawn.scale = volume.scale;
    drawn.opacity = volume.opacity;
    drawn.opacity_length = report.opacity_length = volume.opacity_length.value_or(default_opacity_length(bounds));
    drawn.clips = look.clips;
    drawn.shaded = volume.shaded;
    const auto value_at = [&](std::size_t at) { return std::optional(volume.isosurfaces[at]); };
    for (std::size_t i = 0; i < volume.isosurfaces.size(); ++i)
        drawn.isosurfaces.push_back({volume.isosurfaces[i], color_among(volume.isosurfaces.size(), i, value_at, look)});
}

std::vector<SurfaceLook> looks_of(std::span<const double> isovalues, std::span<const SurfacePoints> points,
                                  const SceneLook& look) {
    std::vector<SurfaceLook> looks(isovalues.size());
    const scene::Hiding hiding(look.opacity ? std::span<const SurfacePoints>() : points);
    const auto value_at = [&](std::size_t at) { return std::optional(isovalues[at]); };
    for (std::size_t i = 0; i < looks.size(); ++i) {
        looks[i].color = color_among(isovalues.size(), i, value_at, look);
        looks[i].opacity = look.opacity.value_or(i < points.size() && hiding.hides_any(i) ? opacity_among_several : 1);
    }
    return looks;
}

} // namespace isotet
