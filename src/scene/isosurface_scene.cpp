// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/isosurface_scene.hpp>

#include <utility>

#include "base/errors.hpp"
#include "base/guard.hpp"
#include "base/stopwatch.hpp"
#include "scene/scene_data.hpp"

namespace isotet {

IsosurfaceScene::IsosurfaceScene(std::unique_ptr<Data> data) : data_(std::move(data)) {}
IsosurfaceScene::IsosurfaceScene(IsosurfaceScene&&) noexcept = default;
IsosurfaceScene& IsosurfaceScene::operator=(IsosurfaceScene&&) noexcept = default;
IsosurfaceScene::~IsosurfaceScene() = default;

Result<IsosurfaceScene> IsosurfaceScene::create(const std::optional<Device>& device, IsosurfaceOptions options,
                                                SceneLook look, const Run& run) {
    return core::guarded("making a scene", [&]() -> Result<IsosurfaceScene> {
        auto data = std::make_unique<Data>(Data{device, std::move(look)});
        if (options.packed) {
            if (auto started = data->start_packed(options, run); !started) return started.error();
            data->scene.bounds = data->bounds;
            return IsosurfaceScene(std::move(data));
        }
        if (data->look.volume && (device || options.draw || options.field.values.empty()))
            return invalid_argument(options.field.values.empty() ? "a volume without a field"
                                                                 : "a volume, and surfaces that stay on a device");
        options.grid.point_fields = options.grid.cell_fields = {};
        data->bounds = options.bounds;
        if (options.boundary && data->look.boundary_opacity > 0) {
            data->take_boundary(*std::move(options.boundary));
            if (auto added = data->add_boundary(); !added) return added.error();
        } else if (!(options.part && options.part->whole))
            if (auto looked = data->look_around(options.grid, options.known_boundary.get(), run); !looked)
                return looked.error();
        IsosurfaceOptions tets;
        tets.where = ExtractOn::cpu;
        tets.draw = options.draw;
        tets.index = options.index;
        tets.picture = options.picture;
        if (!options.field.values.empty())
            if (auto started = data->start(std::move(options), run); !started) return started.error();
        if (tets.draw)
            if (auto loaded = data->load_tets(tets, run); !loaded) return loaded.error();
        data->scene.bounds = data->bounds;
        return IsosurfaceScene(std::move(data));
    });
}

Result<IsosurfaceScene> IsosurfaceScene::create(const std::optional<Device>& device, Surface surface, SceneLook look) {
    return core::guarded("making a scene", [&]() -> Result<IsosurfaceScene> {
        auto data = std::make_unique<Data>(Data{device, std::move(look), std::move(surface)});
        data->scene.bounds = data->bounds = bounds_of(*data->surface);
        return IsosurfaceScene(std::move(data));
    });
}

Result<void> IsosurfaceScene::show(std::span<const double> isovalues, const Run& run) {
    return core::guarded("making a scene", [&]() -> Result<void> {
        Data& data = *data_;
        data.clear();
        const core::Stopwatch extracting;
        const Result<void> done = data.surface   ? data.add_surface(*data.surface)
                                  : data.store   ? data.show_tets(isovalues)
                                  : data.solids  ? data.show_solids(isovalues, run)
                                  : data.contour ? data.show_extracted(isovalues, run)
                                                 : Result<void>();
        if (!done) return done;
        for (std::size_t i = 0; i < isovalues.size() && i < data.shown.size(); ++i)
            data.shown[i].isovalue = isovalues[i];
        data.report.extract_seconds += extracting.seconds();
        data.dress();
        return {};
    });
}

void IsosurfaceScene::set_volume(const VolumeLook& look) {
    if (data_->look.volume) data_->look.volume = look;
}

void IsosurfaceScene::fit(Camera& camera, double aspect, Fit fit) const {
    const auto fit_to = [&](const auto& all) {
        if (fit == Fit::orbit) camera.fit_orbit(all, aspect);
        else camera.fit(all, aspect);
    };
    if (data_->surface && !data_->look.outline) fit_to(*data_->surface);
    else if (data_->boundary && !data_->look.outline && !data_->look.clips.empty()) {
        Box left = bounds_of(*data_->boundary);
        for (const Surface& slice : data_->slices) left.add(bounds_of(slice));
        fit_to(left.empty() ? data_->bounds : left);
    } else if (data_->boundary && !data_->look.outline) fit_to(*data_->boundary);
    else fit_to(data_->bounds);
}

void IsosurfaceScene::fit_surfaces(Camera& camera, double aspect) const {
    const Data& data = *data_;
    if (data.extracted.size() == 1 && data.slices.empty()) return camera.fit(data.extracted.front(), aspect);
    Box box;
    for (const Box& one : data.boxes) box.add(one);
    for (const Surface& slice : data.slices) box.add(bounds_of(slice));
    camera.fit(box.empty() ? data.bounds : box, aspect);
}

const Box& IsosurfaceScene::bounds() const noexcept { return data_->bounds; }

const Scene& IsosurfaceScene::scene() const noexcept { return data_->scene; }
const std::vector<ShownSurface>& IsosurfaceScene::surfaces() const noexcept { return data_->shown; }
const SceneReport& IsosurfaceScene::report() const noexcept { return data_->report; }
std::vector<std::string> IsosurfaceScene::take_notes() { return std::exchange(data_->notes, {}); }

} // namespace isotet
