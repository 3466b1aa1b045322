// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Frames that are pictures: drawn here, by the scene and the renderer of `isotet render`.
#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/render.hpp>
#include <isotet/scene.hpp>

#include "view/grid_view.hpp"

namespace isotet::view {

namespace {

double picture_seconds(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Of what a scene is made of, the isovalues and how the volume looks aside.
std::string scene_key(const ShowMessage& message, std::size_t step) {
    ViewState state = message.state;
    state.isovalues.clear();
    state.camera.reset();
    if (state.volume) state.volume = VolumeState{};
    return fmt::format("{}|{}|{}", text_of(to_json(state)), step, (*message.picture)[1]);
}

SceneLook look_of(const ShowMessage& message, std::optional<ColorField> colors,
                  const std::optional<ColorScale>& scale) {
    const ViewState& state = message.state;
    SceneLook look;
    if (state.volume && scale) {
        look.volume.emplace(VolumeLook{*scale, {}});
        look.isovalue_range = {scale->lower, scale->upper}; // surfaces have the colours of the volume there
    }
    if (state.colored_boundary && !state.volume) look.boundary_colors = colors;
    look.colors = std::move(colors);
    look.map = state.map;
    look.opacity = state.opacity;
    look.boundary_opacity = state.boundary;
    look.outline = state.outline;
    look.edges = state.edges;
    if (!state.volume) look.solid = state.solid;
    look.keep = state.keep;
    look.clips = state.clips;
    look.slices = state.slices;
    for (std::vector<Plane>* planes : {&look.clips, &look.slices})
        for (Plane& plane : *planes)
            if (state.stretch) plane = stretched(plane, *state.stretch);
    look.line_width = std::max(1.0, (*message.picture)[1] / 600.0);
    return look;
}

} // namespace

Result<void> GridView::make_scene(const ShowMessage& message, const std::optional<ColorScale>& scale, const Run& run) {
    const ViewState& state = message.state;
    std::vector<double> isovalues; // each once
    if (state.volume ? state.volume->surfaces : state.isosurfaces)
        for (const double one : state.isovalues)
            if (std::ranges::find(isovalues, one) == isovalues.end()) isovalues.push_back(one);
    const std::string key = scene_key(message, step_);
    if (!scene_ || scene_key_ != key) {
        scene_.reset();
        IsosurfaceOptions options;
        options.contour.surfaces = isovalues.size();
        options.where = ExtractOn::cpu;
        const bool from_file = draws_from_file(state), colored = scale && !state.color_by.empty();
        if (from_file) {
            if (Result<void> taken = draw_from_file(state, options, run); !taken) return taken;
        } else {
            Result<PointField> field = field_of(state.field, run);
            if (!field) return field.error();
            if (Result<void> here = need_cells(run); !here) return here;
            options.grid = grid_;
            if (state.stretch) options.grid.points = stretched(grid_.points, *state.stretch);
            options.field = *std::move(field);
        }
        std::optional<ColorField> colors = colored ? color_field(state, *scale, run) : std::nullopt;
        if (colors && from_file)
            if (const auto known = file_cells_.find(colors->name); known != file_cells_.end())
                colors->values = known->second.values;
        if (colored && !scale->classes.empty()) {
            const Array numbers = colors->values;
            colors = classes_->field;
            if (is_of_file()) colors->values = places_in_classes(numbers);
        }
        auto scene = IsosurfaceScene::create({}, std::move(options), look_of(message, std::move(colors), scale), run);
        if (!scene) return scene.error();
        scene_ = *std::move(scene);
        scene_key_ = key;
        scene_isovalues_.reset();
    }
    if (scene_isovalues_ == isovalues && scene_volume_ == state.volume) return {};
    scene_isovalues_.reset();
    if (state.volume && scale)
        if (Result<void> looks = show_volume(state, *scale, run); !looks) return looks;
    if (Result<void> shown = scene_->show(isovalues, run); !shown) return shown;
    scene_isovalues_ = std::move(isovalues);
    scene_volume_ = state.volume;
    return {};
}

/// Whether a picture needs nothing of a packed file but what surfaces and rays meet.
bool GridView::draws_from_file(const ViewState& state) const {
    if (!is_of_file() || !cells_.empty() || state.stretch || (state.solid && !state.volume)) return false;
    const bool by_cells = !state.volume && cell_colors(grid_, state.color_by);
    const bool can_color = by_cells ? !state.colored_boundary && lean_->knows_cells()
                                    : state.color_by.empty() || lean_->has(state.color_by, step_);
    return can_color && lean_->has(state.field, step_);
}

Result<void> GridView::draw_from_file(const ViewState& state, IsosurfaceOptions& options, const Run& run) {
    const Result<PackedGrid> grid = options_.packed->grid(state.field, step_, run);
    if (!grid) return grid.error();
    options.packed = PackedScene{*grid, {}, true, [this](const Plane& plane, const Run& slicing) {
                                     return lean_->sliced(plane, step_, slicing);
                                 }};
    if (lean_->has(state.color_by, step_)) {
        const Result<PackedGrid> colors = options_.packed->grid(state.color_by, step_, run);
        if (!colors) return colors.error();
        options.packed->colors = *colors;
    }
    const PackedFileInfo& info = options_.packed->info();
    options.bounds = {info.lower, info.upper};
    for (const PackedPointsInfo& points : info.moved_points)
        if (points.step <= step_) options.bounds = {points.lower, points.upper};
    return {};
}

/// From the scene's next show() on.
Result<void> GridView::show_volume(const ViewState& state, const ColorScale& scale, const Run& run) {
    Result<OpacityCurve> opacity = opacity_of_volume(state, run);
    if (!opacity) return opacity.error();
    scene_opacity_ = *std::move(opacity);
    scene_->set_volume({scale, scene_opacity_, state.volume->length, {}, state.volume->shaded});
    return {};
}

Result<OpacityCurve> GridView::opacity_of_volume(const ViewState& state, const Run& run) {
    const Result<OpacityText> text = parse_opacity(state.volume->opacity);
    if (!text) return text.error();
    if (text->preset && volume_field_ != state.field) {
        const Result<PointField> field = field_of(state.field, run);
        if (!field) return field.error();
        const ValueRange range = typical_range(field->values);
        if (!(range.lower <= range.upper))
            return Error{ErrorCode::invalid_data,
                         fmt::format("field '{}' has no finite value: there is nothing to draw", state.field)};
        volume_range_ = range;
        volume_field_ = state.field;
    }
    return opacity_of(*text, volume_range_);
}

Result<Frame> GridView::picture_frame(const ShowMessage& message, double wait_seconds, std::vector<std::string>& known,
                                      const Run& run) {
    if (!message.state.camera) return Error{ErrorCode::invalid_argument, "a picture takes a camera"};
    Result<std::optional<ColorScale>> scale = scale_of(message.state, run);
    if (!scale) return scale.error();
    const auto start = std::chrono::steady_clock::now();
    if (Result<void> made = make_scene(message, *scale, run); !made) return made.error();
    FrameFacts facts;
    facts.number = message.number;
    facts.preview = message.moving;
    facts.wait_seconds = wait_seconds;
    facts.scale = *scale;
    if (*scale && !(*scale)->classes.empty()) facts.classes = classes_->field.classes;
    if (Result<void> told = tell_field(message.state.field, facts, run); !told) return told.error();
    facts.method = name_of(scene_->report().method);
    facts.notes = scene_->take_notes();
    facts.extract_seconds = picture_seconds(start);
    const auto drawing = std::chrono::steady_clock::now();
    PictureOptions options;
    const std::uint32_t part = !message.moving ? 1 : message.state.volume ? volume_part_ : 2;
    options.width = std::max(1U, (*message.picture)[0] / part);
    options.height = std::max(1U, (*message.picture)[1] / part);
    if (message.moving) options.samples = 1;
    else options.occlusion = default_occlusion;
    options.camera = *message.state.camera;
    const Result<Picture> picture = draw(scene_->scene(), options, run);
    if (!picture) return picture.error();
    Result<EncodedPicture> encoded = message.moving ? encode_jpeg(*picture) : encode_png(*picture);
    if (!encoded) return encoded.error();
    facts.picture = *std::move(encoded);
    facts.mesh_seconds = picture_seconds(drawing);
    if (message.moving && message.state.volume) { // about five pictures a second
        constexpr double slow = 0.2, fast = 0.06;
        if (facts.mesh_seconds > slow) volume_part_ = std::min(volume_part_ + 1, 4U);
        if (facts.mesh_seconds < fast) volume_part_ = std::max(volume_part_ - 1, 2U);
    }
    if (message.state.volume) {
        facts.opacity = scene_opacity_.points;
        facts.opacity_length = scene_->report().opacity_length;
    }
    std::vector<FrameSurface> surfaces;
    for (const double isovalue : message.state.isovalues) {
        if (scene_isovalues_->empty()) break; // a volume or the boundary alone
        const auto which =
            static_cast<std::size_t>(std::ranges::find(*scene_isovalues_, isovalue) - scene_isovalues_->begin());
        FrameSurface& surface = surfaces.emplace_back();
        surface.key = "picture";
        surface.isovalue = isovalue;
        surface.color = scene_->scene().surfaces[which].color;
        surface.opacity = scene_->scene().surfaces[which].opacity;
        surface.triangles = scene_->surfaces()[which].triangles;
    }
    known.clear();
    return Frame{frame_bytes(facts, surfaces), facts.preview};
}

} // namespace isotet::view
