// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is shown for some isovalues: surfaces of the session, on its device or in memory, or tets that stand for them.
#include <algorithm>
#include <iterator>
#include <utility>

#include "base/errors.hpp"
#include "base/stopwatch.hpp"
#include "scene/clip_surface.hpp"
#include "scene/colored_surface.hpp"
#include "scene/scene_data.hpp"

namespace isotet {

namespace {

/// Device memory that pictures of this size need beside a store, with the numbers of all tets.
std::uint64_t picture_bytes(const PictureOptions& picture, std::uint64_t tets) {
    constexpr std::uint64_t max_samples = std::uint64_t{1} << 24, bytes_per_sample = 28, corners_of_quads = 2'000'000;
    const std::uint64_t samples = std::uint64_t{picture.width} * picture.height * picture.samples * picture.samples;
    return std::min(samples, max_samples) * bytes_per_sample + 4 * tets + corners_of_quads;
}

} // namespace

/// Starts the session. A device colours by the grid's own values; on the CPU surfaces carry the field that colours.
Result<void> IsosurfaceScene::Data::start(IsosurfaceOptions wanted, const Run& run) {
    ContourOptions options;
    const bool by_gradient = look.shade_by == ShadeBy::gradient && !look.solid;
    options.normals =
        by_gradient || wanted.draw || wanted.where == ExtractOn::device ? Normals::gradient : Normals::none;
    options.method = wanted.draw || look.volume ? Method::clusters : wanted.contour.method;
    options.surfaces = wanted.contour.surfaces;
    const bool by_cells = look.colors && look.colors->association == Association::cell;
    const bool by_points = look.colors && !by_cells;
    ContourInput plain{std::move(wanted.grid), std::move(wanted.field), {}, {}, std::move(wanted.part)},
        carrying = plain;
    if (by_points) carrying.point_fields.push_back({look.colors->name, look.colors->values});
    if (by_cells) carrying.cell_fields.push_back({look.colors->name, look.colors->values});
    options.expected_isovalues = wanted.contour.expected_isovalues;
    required = wanted.where == ExtractOn::device;
    if (!device && (required || wanted.draw))
        return invalid_argument("a scene without a device, but it is to extract, or to draw tets, on one");
    options.split_cells = wanted.contour.split_cells || wanted.draw;
    const bool in_memory = // surfaces are worked on
        !look.clips.empty() || look.shade_by == ShadeBy::vertices || draws_surface_edges() || look.keep;
    const bool card = device && device->info().kind != DeviceKind::software &&
                      method_for(options.surfaces, true, options.method) == Method::clusters;
    const bool use_device =
        !wanted.draw && (required || (card && !in_memory && !look.solid && wanted.where == ExtractOn::best));
    if (!use_device && !wanted.draw && !look.volume) options.refine = wanted.contour.refine;
    if (use_device) {
        options.engine = vulkan_engine(*device);
        options.engine_required = required;
        options.edge_ends = by_points;
        options.source_cells = by_cells;
        without_device = carrying;
    }
    if (look.solid) {
        if (use_device || wanted.draw || look.volume)
            return invalid_argument("solids on a device or with a volume, but the CPU makes them alone");
        Result<Solids> created = Solids::create(std::move(carrying), options, run);
        if (!created) return created.error();
        solids = *std::move(created);
        return {};
    }
    if (look.keep && (use_device || wanted.draw))
        return invalid_argument("parts of surfaces on a device, but the CPU finds them");
    const core::Stopwatch packing;
    Result<Contour> created = Contour::create(use_device ? std::move(plain) : std::move(carrying), options, run);
    if (!created) return created.error();
    contour = *std::move(created);
    if (Result<void> ready = contour->prepare(run); !ready) return ready;
    if (look.volume) volume_grid = contour->packed();
    if (volume_grid) report.field = volume_grid->field();
    if (!contour->packed() && !contour->linear_grid()) return {};
    report.pack_seconds = packing.seconds();
    pack_is_told = true;
    return {};
}

/// Starts the session on a packed grid, from which the CPU extracts.
Result<void> IsosurfaceScene::Data::start_packed(const IsosurfaceOptions& wanted, const Run& run) {
    const auto by_cells = [](const std::optional<ColorField>& field) {
        return field && field->association == Association::cell;
    };
    const bool reworks = look.solid || (!look.slices.empty() && !wanted.packed->sliced) || wanted.draw ||
                         by_cells(look.boundary_colors) || wanted.where == ExtractOn::device;
    const bool by_points = (look.colors && !by_cells(look.colors)) || look.boundary_colors;
    if (reworks || (by_points && !wanted.packed->colors))
        return invalid_argument("a packed grid is given, of which the CPU draws isosurfaces, slices, and the boundary "
                                "coloured by packed fields, and nothing else");
    bounds = wanted.bounds;
    if (auto looked = look_around_packed(wanted, run); !looked) return looked;
    if (look.volume && (device || !wanted.packed->contours))
        return invalid_argument(device ? "a volume, and surfaces that stay on a device" : "a volume without a field");
    if (!wanted.packed->contours) return {};
    if (look.volume) {
        volume_grid = wanted.packed->grid;
        report.field = volume_grid->field();
    }
    ContourInput input;
    input.packed = wanted.packed->grid;
    if (by_cells(look.colors)) input.cell_fields = {{look.colors->name, look.colors->values}};
    else if (look.colors) input.packed_fields = {*wanted.packed->colors};
    ContourOptions options;
    options.precision = wanted.packed->grid.precision();
    options.normals = look.shade_by == ShadeBy::gradient ? Normals::gradient : Normals::none;
    Result<Contour> created = Contour::create(std::move(input), options, run);
    if (!created) return created.error();
    contour = *std::move(created);
    return {};
}

Result<void> IsosurfaceScene::Data::load_tets(const IsosurfaceOptions& options, const Run& run) {
    const core::Stopwatch uploading;
    const PackedGrid packed = *contour->packed();
    report.field = packed.field();
    TetStoreOptions store_options;
    store_options.gradients = options.draw == DrawMethod::textures || options.draw == DrawMethod::mesh;
    store_options.picture_bytes = picture_bytes(options.picture, packed.report().tets);
    Result<TetStore> uploaded = TetStore::upload(*device, packed, *options.draw, store_options, run);
    if (!uploaded) return uploaded.error();
    store = *std::move(uploaded);
    report.store = store->report();
    if (options.index != SearchIndex::none) {
        Result<TetIndex> created = TetIndex::create(packed, options.index, run);
        if (!created) return created.error();
        index = *std::move(created);
    }
    report.upload_seconds += uploading.seconds();
    return {};
}

Result<void> IsosurfaceScene::Data::show_tets(std::span<const double> isovalues) {
    for (const double isovalue : isovalues) {
        std::optional<std::span<const std::uint32_t>> active;
        if (index) {
            const auto found = index->find(isovalue);
            if (!found) return found.error();
            active = *found;
        }
        Result<TetSurface> surface_of_tets = active ? store->at(isovalue, *active) : store->at(isovalue);
        if (!surface_of_tets) return surface_of_tets.error();
        tets.push_back(*std::move(surface_of_tets));
    }
    for (const TetSurface& one : tets) {
        scene.surfaces.emplace_back().tets = &one;
        shown.push_back({.isovalue = {}, .tets = one.tets(), .sent_bytes = one.sent_bytes()});
    }
    return {};
}

/// By the session: surfaces stay on its device, or come from the CPU.
Result<void> IsosurfaceScene::Data::show_extracted(std::span<const double> isovalues, const Run& run) {
    if (contour->engine() == "vulkan") {
        const Result<void> done = show_on_device(isovalues, run);
        if (done || required || done.error().code == ErrorCode::cancelled) return done;
        notes.push_back(done.error().message + ": the CPU extracts instead");
        clear();
    }
    report.on_device = false;
    if (!without_device.grid.points.empty()) // surfaces must carry the field that colours
        if (auto set = contour->set(std::exchange(without_device, {}), run); !set) return set.error();
    Result<ContourResult> result = contour->extract(isovalues, run);
    if (!result) return result.error();
    std::ranges::move(result->notes, std::back_inserter(notes));
    report.method = result->method;
    report.field = result->field;
    if (!std::exchange(pack_is_told, false)) report.pack_seconds += result->pack_seconds;
    for (Extraction& extraction : result->surfaces) {
        if (look.keep) {
            Result<Surface> kept = keep_parts(extraction.surface, *look.keep, PartsOf::isosurface, run);
            if (!kept) return kept.error();
            extraction.surface = *std::move(kept);
        }
        if (Result<void> added = add_surface(std::move(extraction.surface)); !added) return added;
    }
    return {};
}

Result<void> IsosurfaceScene::Data::show_on_device(std::span<const double> isovalues, const Run& run) {
    const PackedGrid packed = *contour->packed();
    if (look.colors && !grid_colors) {
        Result<DeviceColors> colors =
            DeviceColors::of_grid(*device, packed, look.colors->values, look.colors->association, look.colors->scale);
        if (!colors) return colors.error();
        grid_colors = *std::move(colors);
    }
    Result<SurfacesOnDevice> surfaces = extract_on_device(*contour, isovalues, run);
    if (!surfaces) return surfaces.error();
    on_device = std::move(surfaces->surfaces);
    report.on_device = true;
    report.method = Method::clusters;
    report.extract_work = surfaces->work;
    report.field = packed.field();
    for (const DeviceSurface& one : on_device) {
        DrawnSurface& drawn = scene.surfaces.emplace_back();
        drawn.surface = &one;
        if (grid_colors) drawn.colors = &*grid_colors;
        shown.push_back({.isovalue = {}, .vertices = one.vertex_count(), .triangles = one.triangle_count()});
    }
    return {};
}

Result<void> IsosurfaceScene::Data::add_surface(Surface one) {
    shown.push_back({.isovalue = {}, .vertices = one.vertex_count(), .triangles = one.triangle_count()});
    if (surface && look.colors) { // of a surface that was given
        auto& fields = look.colors->association == Association::point ? one.point_fields : one.cell_fields;
        fields = {{look.colors->name, look.colors->values}};
    }
    for (const Plane& plane : look.clips) one = scene::clipped(one, plane);
    if (look.shade_by == ShadeBy::vertices || (look.solid && look.shade_by == ShadeBy::gradient)) {
        Result<Array> normals = vertex_normals(one);
        if (!normals) return normals.error();
        one.normals = *std::move(normals);
        one.normals_kind = Normals::vertex;
    } else if (look.shade_by == ShadeBy::faces) {
        one.normals_kind = Normals::none;
    }
    boxes.push_back(bounds_of(one));
    points.push_back(some_points_of(one));
    if (draws_surface_edges()) surface_edges.push_back(scene::edges_of(one));
    DrawnSurface& drawn = scene.surfaces.emplace_back();
    std::optional<SurfaceColors> colors;
    if (look.colors) colors = scene::carried_colors(one, *look.colors);
    if (!device) {
        drawn.triangles = &extracted.emplace_back(std::move(one));
        if (colors) drawn.values = &values.emplace_back(*std::move(colors));
        return {};
    }
    Result<DeviceMesh> mesh = DeviceMesh::upload(*device, one);
    if (!mesh) return mesh.error();
    drawn.mesh = &meshes.emplace_back(*std::move(mesh));
    if (!colors) return {};
    Result<DeviceColors> uploaded = DeviceColors::of_mesh(*device, colors->values, colors->association, colors->scale);
    if (!uploaded) return uploaded.error();
    drawn.colors = &mesh_colors.emplace_back(*std::move(uploaded));
    return {};
}

void IsosurfaceScene::Data::clear() {
    scene.surfaces.clear();
    scene.lines.clear();
    surface_edges.clear();
    tets.clear();
    on_device.clear();
    mesh_colors.clear();
    meshes.clear();
    extracted.clear();
    values.clear();
    boxes.clear();
    points.clear();
    shown.clear();
}

} // namespace isotet
