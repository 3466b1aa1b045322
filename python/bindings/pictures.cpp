// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <isotet/pack.hpp>
#include <isotet/render.hpp>
#include <isotet/scene.hpp>

#include "arrays.hpp"
#include "call.hpp"
#include "parts.hpp"

namespace isotet::python {

using namespace nb::literals;

namespace {

/// What is drawn, and how, in the words of isotet.render().
struct RenderRequest {
    std::vector<Surface> surfaces;                  ///< share arrays
    std::vector<Color> colors;                      ///< one a surface; empty: those of the map, or one that stands out
    std::vector<SurfaceColors> values;              ///< one a surface; empty: each has its color
    std::optional<std::pair<double, double>> range; ///< of values; nothing: theirs
    ColorMap map = ColorMap::viridis;
    std::vector<Color> map_colors; ///< not empty: of a file, in its place
    double opacity = 1;
    double zoom = 1;
    bool fitted = false; ///< the camera says all
    PictureOptions picture;
    Annotation annotation;
    std::optional<PackedGrid> volume;
    OpacityText volume_opacity;
    std::optional<double> opacity_length;
    std::vector<double> volume_isovalues; ///< of surfaces that rays meet
    bool volume_shading = false;
    bool legend = true;
    bool smooth = true; ///< by the normals of vertices; else every triangle is flat
};

template <class Value>
Value parsed(const char* what, const std::string& word, std::optional<Value> (*parse)(std::string_view)) {
    if (const std::optional<Value> value = parse(word)) return *value;
    throw nb::value_error((std::string(what) + " is '" + word + "', which isotet does not know").c_str());
}

std::optional<ColorMap> map_of(std::string_view name) { return parse_color_map(name); }
std::optional<View> view_of(std::string_view name) { return parse_view(name); }
std::optional<Color> color_of(std::string_view text) { return parse_color(text); }

/// Of the volume where there is one, else of what colours surfaces.
Result<ColorScale> scale_of(const RenderRequest& request, const Run& run) {
    ColorOptions options;
    options.scale.map = request.map;
    options.scale.colors = request.map_colors;
    if (request.volume && request.volume->field().lower < request.volume->field().upper)
        options.range = ValueRange{request.volume->field().lower, request.volume->field().upper};
    if (request.range) options.range = ValueRange{request.range->first, request.range->second};
    std::vector<Array> values;
    for (const SurfaceColors& colors : request.values) values.push_back(colors.values);
    return color_scale(values, options, run);
}

Result<void> set_normals(RenderRequest& request, const Run& run) {
    for (Surface& surface : request.surfaces) {
        surface.normals_kind = Normals::none;
        if (!request.smooth) continue;
        auto normals = vertex_normals(surface, run);
        if (!normals) return normals.error();
        surface.normals = *std::move(normals);
        surface.normals_kind = Normals::vertex;
    }
    return {};
}

Color color_of_surface(const RenderRequest& request, std::size_t i) {
    if (i < request.colors.size()) return request.colors[i];
    if (request.surfaces.size() == 1) return DrawnSurface{}.color;
    return color_at(request.map_colors, request.map,
                    static_cast<double>(i) / static_cast<double>(request.surfaces.size() - 1));
}

void add_volume(Scene& scene, RenderRequest& request, const ColorScale& scale) {
    const FieldReport& field = request.volume->field();
    const Box box = bounds_of(*request.volume);
    DrawnVolume& drawn = scene.volumes.emplace_back();
    drawn.grid = &*request.volume;
    drawn.scale = scale;
    drawn.opacity = opacity_of(request.volume_opacity, {field.lower, field.upper});
    drawn.opacity_length = request.opacity_length.value_or(default_opacity_length(box));
    drawn.shaded = request.volume_shading;
    for (const double isovalue : request.volume_isovalues)
        drawn.isosurfaces.push_back({isovalue, scale.color_at(scale.place_of(isovalue))});
    scene.bounds.add(box);
    if (request.legend) request.annotation.opacity = drawn.opacity;
}

/// The text of a file, and the name of one of its colour maps.
using NamedText = std::pair<std::string, std::string>;

Result<std::vector<Color>> colors_of(const NamedText& file) {
    Result<ColorMapFile> map = parse_color_map_file(file.first, file.second);
    if (!map) return map.error();
    if (map->colors.empty())
        return Error{ErrorCode::invalid_data, "the colour map '" + map->name + "' has no RGBPoints"};
    return std::move(map->colors);
}

Result<Picture> picture_of(RenderRequest& request, const Run& run) {
    if (auto set = set_normals(request, run); !set) return set.error();
    Scene scene;
    if (!request.values.empty() || request.volume) {
        const auto scale = scale_of(request, run);
        if (!scale) return scale.error();
        for (SurfaceColors& colors : request.values) colors.scale = *scale;
        if (request.legend) request.annotation.scale = *scale;
        if (request.volume) add_volume(scene, request, *scale);
    }
    for (std::size_t i = 0; i < request.surfaces.size(); ++i) {
        DrawnSurface& drawn = scene.surfaces.emplace_back();
        drawn.triangles = &request.surfaces[i];
        if (!request.values.empty()) drawn.values = &request.values[i];
        drawn.color = color_of_surface(request, i);
        drawn.opacity = request.opacity;
        scene.bounds.add(bounds_of(request.surfaces[i]));
    }
    PictureOptions options = request.picture;
    const PictureSize whole{options.width, options.height};
    std::optional<PictureSize> room;
    if (!request.annotation.empty()) {
        const auto beside = room_beside(request.annotation, whole);
        if (!beside) return beside.error();
        room = *beside;
    }
    if (room) {
        options.width = room->width;
        options.height = room->height;
    }
    if (!request.fitted && !scene.bounds.empty()) {
        options.camera.fit(scene.bounds, static_cast<double>(options.width) / options.height);
        options.camera.zoom(request.zoom);
    }
    auto picture = draw(scene, options, run);
    if (!picture || !room) return picture;
    return annotate(*picture, request.annotation, whole, options.background);
}

} // namespace

void add_pictures(nb::module_& module) {
    nb::class_<Camera>(module, "Camera").def("text", [](const Camera& self) { return to_text(self); });

    module.def(
        "camera_of_view",
        [](const std::string& view, bool parallel) {
            return camera_of(parsed("view", view, view_of), parallel ? Projection::parallel : Projection::perspective);
        },
        "view"_a, "parallel"_a);

    module.def(
        "camera_of_angles",
        [](double azimuth, double elevation, bool parallel) {
            return camera_of(azimuth, elevation, UpAxis::plus_z,
                             parallel ? Projection::parallel : Projection::perspective);
        },
        "azimuth"_a, "elevation"_a, "parallel"_a);

    module.def("parse_camera", [](const std::string& text) { return parse_camera(text); }, "text"_a);

    module.def(
        "render",
        [](const std::vector<const Surface*>& surfaces, const std::vector<std::string>& colors,
           const std::vector<ArrayIn>& values, bool of_triangles, const std::variant<std::string, NamedText>& map,
           const std::optional<std::pair<double, double>>& range, double opacity, const Camera& camera, bool fitted,
           double zoom, std::pair<std::uint32_t, std::uint32_t> size, std::uint32_t samples,
           const std::string& background, const std::string& title, bool legend, bool smooth,
           const std::optional<PackedGrid>& volume, const std::variant<std::string, NamedText>& volume_opacity,
           std::optional<double> opacity_length, const std::vector<double>& volume_isovalues, bool volume_shading,
           double occlusion, const CallOptions& how) {
            RenderRequest request;
            request.picture.occlusion = occlusion;
            request.volume = volume;
            if (const auto* const file = std::get_if<NamedText>(&volume_opacity))
                request.volume_opacity =
                    call(how, [&](const Run&) { return parse_opacity_file(file->first, file->second); });
            else if (const auto& text = std::get<std::string>(volume_opacity); !text.empty())
                request.volume_opacity = call(how, [&](const Run&) { return parse_opacity(text); });
            request.opacity_length = opacity_length;
            request.volume_isovalues = volume_isovalues;
            request.volume_shading = volume_shading;
            for (const Surface* surface : surfaces) request.surfaces.push_back(*surface);
            request.smooth = smooth;
            for (const std::string& color : colors) request.colors.push_back(parsed("color", color, color_of));
            for (const ArrayIn& array : values)
                request.values.push_back(
                    {array_in(array), of_triangles ? Association::cell : Association::point, ColorScale{}});
            if (const auto* const file = std::get_if<NamedText>(&map))
                request.map_colors = call(how, [&](const Run&) { return colors_of(*file); });
            else request.map = parsed("color_map", std::get<std::string>(map), map_of);
            request.range = range;
            request.opacity = opacity;
            request.zoom = zoom;
            request.fitted = fitted;
            request.picture.width = size.first;
            request.picture.height = size.second;
            request.picture.samples = samples;
            request.picture.background = parsed("background", background, color_of);
            request.picture.camera = camera;
            request.annotation.title = title;
            request.legend = legend;
            const Picture picture = call(how, [&](const Run& run) { return picture_of(request, run); });
            std::vector<std::uint8_t> bytes;
            bytes.reserve(4 * picture.pixels.size());
            for (const auto& pixel : picture.pixels) bytes.insert(bytes.end(), pixel.begin(), pixel.end());
            return array_out(Array::own(std::move(bytes), 4));
        },
        "surfaces"_a, "colors"_a, "values"_a, "of_triangles"_a, "color_map"_a, "range"_a.none(), "opacity"_a,
        "camera"_a, "fitted"_a, "zoom"_a, "size"_a, "samples"_a, "background"_a, "title"_a, "legend"_a, "smooth"_a,
        "volume"_a.none(), "volume_opacity"_a, "opacity_length"_a.none(), "volume_isovalues"_a, "volume_shading"_a,
        "occlusion"_a, "call"_a);
}

} // namespace isotet::python
