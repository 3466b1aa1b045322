// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render_scene.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "number_format.hpp"
#include "stopwatch.hpp"

namespace isotet::cli {

namespace {

constexpr double opacity_among_several = 0.35;

/// Isosurfaces have colours of their own: from the dark to the light of the map, in the order of their values.
Color color_among(const std::vector<SurfaceCounts>& surfaces, std::size_t which, ColorMap map) {
    if (surfaces.size() < 2) return DrawnSurface{}.color;
    const auto below = std::ranges::count_if(
        surfaces, [&](const SurfaceCounts& one) { return one.isovalue < surfaces[which].isovalue; });
    return color_at(map, 0.12 + 0.76 * static_cast<double>(below) / static_cast<double>(surfaces.size() - 1));
}

} // namespace

Result<void> RenderScene::load() {
    const Stopwatch uploading;
    scene_.bounds = input_.bounds;
    if (input_.boundary) {
        Result<DeviceMesh> mesh = DeviceMesh::upload(device_, *input_.boundary);
        if (!mesh) return mesh.error();
        boundary_ = *std::move(mesh);
    }
    if (command_.method.draw) {
        const PackedGrid packed = *input_.contour->packed();
        input_.lower = packed.field().lower;
        input_.upper = packed.field().upper;
        Result<RenderTets> tets = RenderTets::load(command_, packed, device_, console_);
        if (!tets) return tets.error();
        tets_ = *std::move(tets);
    }
    upload_seconds_ = uploading.seconds();
    return {};
}

std::string_view RenderScene::method() const {
    if (input_.surface) return "none";
    return tets_ ? name_of(*command_.method.draw) : name_of(method_);
}

Result<void> RenderScene::show(const std::vector<double>& isovalues) {
    scene_.surfaces.clear();
    scene_.lines.clear();
    meshes_.clear();
    mesh_colors_.clear();
    counts_.clear();
    const Stopwatch extracting;
    const Result<void> done = input_.surface ? add_mesh(*input_.surface)
                              : tets_        ? choose_tets(isovalues)
                                             : show_extracted(isovalues);
    if (!done) return done;
    extract_seconds_ += extracting.seconds();
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        counts_[i].isovalue = isovalues[i];
        if (!is_empty(i)) continue;
        const std::string values = !(input_.lower <= input_.upper)
                                       ? fmt::format("'{}' has no finite value", input_.field)
                                   : input_.lower == input_.upper
                                       ? fmt::format("all values of '{}' are {}", input_.field, shortest(input_.lower))
                                       : fmt::format("the values of '{}' go from {} to {}", input_.field,
                                                     shortest(input_.lower), shortest(input_.upper));
        console_.note(fmt::format("there is no surface at {}: {}", shortest(isovalues[i]), values));
    }
    dress();
    return {};
}

/// Of tets it is not known before they are drawn; values on both sides of the isovalue make a surface, as a rule.
bool RenderScene::is_empty(std::size_t surface) const {
    if (!tets_) return counts_[surface].triangles == 0;
    const double isovalue = *counts_[surface].isovalue;
    return !(input_.lower < isovalue && isovalue <= input_.upper);
}

Result<void> RenderScene::choose_tets(const std::vector<double>& isovalues) {
    if (Result<void> shown = tets_->show(isovalues); !shown) return shown;
    for (const TetSurface& surface : tets_->surfaces()) {
        scene_.surfaces.emplace_back().tets = &surface;
        counts_.push_back({.isovalue = {}, .tets = surface.tets(), .sent_bytes = surface.sent_bytes()});
    }
    return {};
}

/// By the session: surfaces stay on its device, or come from the CPU.
Result<void> RenderScene::show_extracted(const std::vector<double>& isovalues) {
    Contour& contour = *input_.contour;
    if (contour.has_device()) {
        const Result<void> done = extract_on_device(isovalues);
        if (done || command_.engine == EngineChoice::vulkan || done.error().code == ErrorCode::cancelled) return done;
        console_.note(done.error().message + ": the CPU extracts instead");
        scene_.surfaces.clear();
        counts_.clear();
    }
    if (on_device_ || !input_.source.grid.points.empty()) { // surfaces must carry the field that colours
        on_device_ = false;
        if (auto set = contour.set(std::exchange(input_.source, {}), console_.run()); !set) return set.error();
    }
    Result<ContourResult> result = contour.extract(isovalues, console_.run());
    if (!result) return result.error();
    console_.notes(result->notes);
    method_ = result->method;
    input_.lower = result->field.lower;
    input_.upper = result->field.upper;
    input_.pack_seconds += result->pack_seconds;
    for (const Extraction& extraction : result->surfaces)
        if (Result<void> added = add_mesh(extraction.surface); !added) return added;
    return {};
}

Result<void> RenderScene::extract_on_device(const std::vector<double>& isovalues) {
    const PackedGrid packed = *input_.contour->packed();
    if (input_.colors && !grid_colors_) {
        const ColorField& field = *input_.colors;
        Result<DeviceColors> colors =
            DeviceColors::of_grid(device_, packed, field.values, field.association, field.scale);
        if (!colors) return colors.error();
        grid_colors_ = *std::move(colors);
    }
    Result<std::vector<DeviceSurface>> surfaces = input_.contour->extract_on_device(isovalues, console_.run());
    if (!surfaces) return surfaces.error();
    surfaces_ = *std::move(surfaces);
    on_device_ = true;
    work_ = input_.contour->device_work();
    method_ = Method::clusters;
    input_.lower = packed.field().lower;
    input_.upper = packed.field().upper;
    for (const DeviceSurface& surface : surfaces_) {
        DrawnSurface& drawn = scene_.surfaces.emplace_back();
        drawn.surface = &surface;
        if (grid_colors_) drawn.colors = &*grid_colors_;
        counts_.push_back({.isovalue = {}, .vertices = surface.vertex_count(), .triangles = surface.triangle_count()});
    }
    return {};
}

Result<void> RenderScene::add_mesh(const Surface& surface) {
    Result<DeviceMesh> mesh = DeviceMesh::upload(device_, surface);
    if (!mesh) return mesh.error();
    DrawnSurface& drawn = scene_.surfaces.emplace_back();
    drawn.mesh = &meshes_.emplace_back(*std::move(mesh));
    counts_.push_back({.isovalue = {}, .vertices = surface.vertex_count(), .triangles = surface.triangle_count()});
    return input_.colors ? add_colors(drawn, surface) : Result<void>();
}

Result<void> RenderScene::add_colors(DrawnSurface& drawn, const Surface& surface) {
    const ColorField& field = *input_.colors;
    const auto& carried = field.association == Association::point ? surface.point_fields : surface.cell_fields;
    const Array& values = input_.surface ? field.values : carried.front().values; // else interpolated by the engine
    Result<DeviceColors> colors = DeviceColors::of_mesh(device_, values, field.association, field.scale);
    if (!colors) return colors.error();
    drawn.colors = &mesh_colors_.emplace_back(*std::move(colors));
    return {};
}

/// Colours and opacities, and what is around the surfaces.
void RenderScene::dress() {
    std::size_t smallest = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i)
        if (counts_[i].size() > 0 && (counts_[smallest].size() == 0 || counts_[i].size() < counts_[smallest].size()))
            smallest = i;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        DrawnSurface& drawn = scene_.surfaces[i];
        drawn.color = color_among(counts_, i, command_.scale.map);
        drawn.opacity = command_.opacity.value_or(counts_.size() == 1 || i == smallest ? 1 : opacity_among_several);
    }
    if (command_.outline) scene_.lines.push_back(outline_of(input_.bounds));
    for (DrawnLines& lines : scene_.lines) lines.width = std::max(1.0, command_.picture.height / 600.0);
    if (!boundary_) return;
    DrawnSurface& drawn = scene_.surfaces.emplace_back();
    drawn.mesh = &*boundary_;
    drawn.color = {0.62F, 0.66F, 0.70F, 1};
    drawn.opacity = command_.boundary.value_or(default_boundary_opacity);
}

void RenderScene::fit(Camera& camera, double aspect) const {
    const auto fit_to = [&](const auto& all) {
        if (command_.orbit > 0) camera.fit_orbit(all, aspect);
        else camera.fit(all, aspect);
    };
    if (input_.surface && !command_.outline) fit_to(*input_.surface);
    else if (input_.boundary && !command_.outline) fit_to(*input_.boundary);
    else fit_to(input_.bounds);
}

std::vector<std::string> RenderScene::isovalue_texts() const {
    std::vector<double> isovalues;
    for (const SurfaceCounts& surface : counts_) isovalues.push_back(surface.isovalue.value_or(0));
    return told_apart(isovalues);
}

Annotation RenderScene::annotation() const {
    Annotation annotation;
    if (command_.plain) return annotation;
    std::uint64_t all = 0;
    for (const SurfaceCounts& surface : counts_) all += surface.size();
    const std::string drawn = tets_ ? counted(all, "tet") + " drawn" : counted(all, "triangle");
    const std::string name = std::filesystem::path(command_.grid.file).filename().string();
    const std::string time = input_.time ? fmt::format("  ·  time {}", rounded(*input_.time)) : "";
    if (input_.surface) annotation.caption = fmt::format("{}  ·  {}", name, drawn);
    else if (counts_.size() == 1)
        annotation.caption =
            fmt::format("{}  ·  {}  ·  {} = {}  ·  {}", name, counted(input_.cells, "cell"), input_.field,
                        rounded(*counts_.front().isovalue, (input_.upper - input_.lower) / 1000), drawn);
    else
        annotation.caption = fmt::format("{}  ·  {}  ·  {} at {} isovalues  ·  {}", name, counted(input_.cells, "cell"),
                                         input_.field, counts_.size(), drawn);
    annotation.caption += time;
    if (input_.colors) {
        annotation.title = input_.colors->name;
        annotation.scale = input_.colors->scale;
        if (input_.colors->has_no_data) annotation.no_data = "no data";
    } else if (counts_.size() > 1) {
        annotation.title = input_.field;
        std::vector<std::size_t> order(counts_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::sort(order, std::greater(),
                          [&](std::size_t i) { return counts_[i].isovalue; }); // large values above
        const std::vector<std::string> values = isovalue_texts();
        for (const std::size_t i : order) annotation.legend.push_back({scene_.surfaces[i].color, values[i]});
    }
    return annotation;
}

} // namespace isotet::cli
