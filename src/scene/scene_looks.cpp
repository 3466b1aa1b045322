// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Colours and opacities of isosurfaces that are shown together.
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
        return color_at(look.map, lower < upper ? (*isovalue - lower) / (upper - lower) : 0.5);
    }
    if (count < 2) return single_color;
    std::size_t below = 0;
    for (std::size_t i = 0; i < count; ++i) below += value_at(i) < isovalue ? 1 : 0;
    return color_at(look.map, 0.12 + 0.76 * static_cast<double>(below) / static_cast<double>(count - 1));
}

bool holds(const Box& box, const Box& other) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(box.lower[axis] <= other.lower[axis] && other.upper[axis] <= box.upper[axis])) return false;
    return true;
}

/// Whether a surface may hide another one: one that has its box inside this one's. Of surfaces side by side, such as planes,
/// all may.
bool box_hides_another(std::span<const Box> boxes, std::size_t which) {
    for (std::size_t i = 0; i < boxes.size(); ++i)
        if (i != which && !boxes[i].empty() && !holds(boxes[i], boxes[which])) return true;
    return false;
}

} // namespace

bool IsosurfaceScene::Data::hides_another(std::size_t which) const {
    if (boxes.size() != shown.size()) return shown[which].size() > smallest_size(); // they are on the device
    return box_hides_another(boxes, which);
}

std::uint64_t IsosurfaceScene::Data::smallest_size() const {
    std::uint64_t smallest = 0;
    for (const ShownSurface& one : shown)
        if (one.size() > 0 && (smallest == 0 || one.size() < smallest)) smallest = one.size();
    return smallest;
}

/// Colours and opacities, and what is around the surfaces.
void IsosurfaceScene::Data::dress() {
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto value_at = [&](std::size_t at) { return shown[at].isovalue; };
        scene.surfaces[i].color = color_among(shown.size(), i, value_at, look);
        scene.surfaces[i].opacity =
            look.opacity.value_or(shown.size() > 1 && hides_another(i) ? opacity_among_several : 1);
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
    const auto value_at = [&](std::size_t at) { return std::optional(volume.isosurfaces[at]); };
    for (std::size_t i = 0; i < volume.isosurfaces.size(); ++i)
        drawn.isosurfaces.push_back({volume.isosurfaces[i], color_among(volume.isosurfaces.size(), i, value_at, look)});
}

std::vector<SurfaceLook> looks_of(std::span<const double> isovalues, std::span<const Box> boxes,
                                  const SceneLook& look) {
    std::vector<SurfaceLook> looks(isovalues.size());
    const auto value_at = [&](std::size_t at) { return std::optional(isovalues[at]); };
    for (std::size_t i = 0; i < looks.size(); ++i) {
        looks[i].color = color_among(isovalues.size(), i, value_at, look);
        const bool hides = isovalues.size() > 1 && i < boxes.size() && box_hides_another(boxes, i);
        looks[i].opacity = look.opacity.value_or(hides ? opacity_among_several : 1);
    }
    return looks;
}

} // namespace isotet
