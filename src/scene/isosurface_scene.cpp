// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/isosurface_scene.hpp>

#include <algorithm>
#include <deque>
#include <iterator>
#include <utility>

#include <isotet/boundary.hpp>
#include <isotet/device_grid.hpp>

#include "core/guard.hpp"
#include "core/stopwatch.hpp"

namespace isotet {

namespace {

constexpr double opacity_among_several = 0.35;

/// Isosurfaces have colours of their own: from the dark to the light of the map, in the order of their values.
Color color_among(const std::vector<ShownSurface>& surfaces, std::size_t which, ColorMap map) {
    if (surfaces.size() < 2) return DrawnSurface{}.color;
    const auto below = std::ranges::count_if(
        surfaces, [&](const ShownSurface& one) { return one.isovalue < surfaces[which].isovalue; });
    return color_at(map, 0.12 + 0.76 * static_cast<double>(below) / static_cast<double>(surfaces.size() - 1));
}

/// Device memory that pictures of this size need beside a store, with the numbers of all tets.
std::uint64_t picture_bytes(const PictureOptions& picture, std::uint64_t tets) {
    constexpr std::uint64_t max_samples = std::uint64_t{1} << 24, bytes_per_sample = 28, corners_of_quads = 2'000'000;
    const std::uint64_t samples = std::uint64_t{picture.width} * picture.height * picture.samples * picture.samples;
    return std::min(samples, max_samples) * bytes_per_sample + 4 * tets + corners_of_quads;
}

} // namespace

struct IsosurfaceScene::Data {
    Device device;
    SceneLook look = {};
    std::optional<Surface> surface = {};  ///< that was given; else there is
    std::optional<Contour> contour = {};  ///< with gradient normals
    ContourInput without_device = {};     ///< of the session, if it has a device: to go on without it
    bool required = false;           ///< the device
    Box bounds = {};
    std::optional<Surface> boundary = {};
    std::optional<DeviceMesh> boundary_mesh = {};
    std::optional<TetStore> store = {};
    std::optional<TetIndex> index = {};
    std::optional<DeviceColors> grid_colors = {};
    std::vector<TetSurface> tets = {};
    std::vector<DeviceSurface> on_device = {};
    std::deque<DeviceMesh> meshes = {}; ///< places that do not move
    std::deque<DeviceColors> mesh_colors = {};
    Scene scene = {};
    std::vector<ShownSurface> shown = {};
    SceneReport report = {};
    std::vector<std::string> notes = {};

    Result<void> look_around(const Grid& grid, const Run& run);
    Result<void> start(IsosurfaceOptions options, const Run& run);
    Result<void> load_tets(const IsosurfaceOptions& options, const Run& run);
    Result<void> show_tets(std::span<const double> isovalues);
    Result<void> show_extracted(std::span<const double> isovalues, const Run& run);
    Result<void> show_on_device(std::span<const double> isovalues, const Run& run);
    Result<void> add_mesh(const Surface& extracted);
    void dress();
    void clear();
};

/// The boundary if it is drawn, and the box around the grid.
Result<void> IsosurfaceScene::Data::look_around(const Grid& grid, const Run& run) {
    const core::Stopwatch looking;
    if (look.boundary_opacity > 0) {
        Result<Surface> found = boundary_of(grid, run);
        if (!found) return found.error();
        boundary = *std::move(found);
        bounds = bounds_of(*boundary);
        report.boundary_faces = boundary->triangle_count();
        Result<DeviceMesh> mesh = DeviceMesh::upload(device, *boundary);
        if (!mesh) return mesh.error();
        boundary_mesh = *std::move(mesh);
    } else {
        const Result<GridReport> surveyed = survey(grid, {.faces = false}, run);
        if (!surveyed) return surveyed.error();
        bounds.add(surveyed->lower);
        bounds.add(surveyed->upper);
    }
    report.boundary_seconds = looking.seconds();
    return {};
}

/// Starts the session. A device colours by the grid's own values; on the CPU surfaces carry the field that colours.
Result<void> IsosurfaceScene::Data::start(IsosurfaceOptions wanted, const Run& run) {
    ContourOptions options;
    options.normals = Normals::gradient;
    options.method = wanted.draw ? Method::clusters : wanted.method;
    options.surfaces = wanted.surfaces;
    const bool by_cells = look.colors && look.colors->association == Association::cell;
    const bool by_points = look.colors && !by_cells;
    ContourInput plain{std::move(wanted.grid), std::move(wanted.field), {}, {}}, carrying = plain;
    if (by_points) carrying.point_fields.push_back({look.colors->name, look.colors->values});
    if (by_cells) carrying.cell_fields.push_back({look.colors->name, look.colors->values});
    const bool card = device.info().kind != DeviceKind::software &&
                      options.method.value_or(method_for(options.surfaces, true)) == Method::clusters;
    required = wanted.where == ExtractOn::device;
    const bool use_device = !wanted.draw && (required || (card && wanted.where == ExtractOn::best));
    if (use_device) {
        options.engine = vulkan_engine(device);
        options.engine_required = required;
        options.edge_ends = by_points;
        options.source_cells = by_cells;
        without_device = carrying;
    }
    Result<Contour> created = Contour::create(use_device ? std::move(plain) : std::move(carrying), options);
    if (!created) return created.error();
    contour = *std::move(created);
    const core::Stopwatch packing;
    if (Result<void> ready = contour->prepare(run); !ready) return ready;
    if (contour->packed()) report.pack_seconds = packing.seconds();
    return {};
}

Result<void> IsosurfaceScene::Data::load_tets(const IsosurfaceOptions& options, const Run& run) {
    const core::Stopwatch uploading;
    const PackedGrid packed = *contour->packed();
    report.field = packed.field();
    TetStoreOptions store_options;
    store_options.gradients = options.draw == DrawMethod::textures || options.draw == DrawMethod::mesh;
    store_options.picture_bytes = picture_bytes(options.picture, packed.report().tets);
    Result<TetStore> uploaded = TetStore::upload(device, packed, *options.draw, store_options, run);
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
    report.pack_seconds += result->pack_seconds;
    for (const Extraction& extraction : result->surfaces)
        if (Result<void> added = add_mesh(extraction.surface); !added) return added;
    return {};
}

Result<void> IsosurfaceScene::Data::show_on_device(std::span<const double> isovalues, const Run& run) {
    const PackedGrid packed = *contour->packed();
    if (look.colors && !grid_colors) {
        Result<DeviceColors> colors =
            DeviceColors::of_grid(device, packed, look.colors->values, look.colors->association, look.colors->scale);
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

Result<void> IsosurfaceScene::Data::add_mesh(const Surface& extracted) {
    Result<DeviceMesh> mesh = DeviceMesh::upload(device, extracted);
    if (!mesh) return mesh.error();
    DrawnSurface& drawn = scene.surfaces.emplace_back();
    drawn.mesh = &meshes.emplace_back(*std::move(mesh));
    shown.push_back({.isovalue = {}, .vertices = extracted.vertex_count(), .triangles = extracted.triangle_count()});
    if (!look.colors) return {};
    const ColorField& field = *look.colors;
    const auto& carried = field.association == Association::point ? extracted.point_fields : extracted.cell_fields;
    const Array& values = surface ? field.values : carried.front().values; // else interpolated by the session
    Result<DeviceColors> colors = DeviceColors::of_mesh(device, values, field.association, field.scale);
    if (!colors) return colors.error();
    drawn.colors = &mesh_colors.emplace_back(*std::move(colors));
    return {};
}

/// Colours and opacities, and what is around the surfaces.
void IsosurfaceScene::Data::dress() {
    std::size_t smallest = 0;
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (shown[i].size() > 0 && (shown[smallest].size() == 0 || shown[i].size() < shown[smallest].size()))
            smallest = i;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        scene.surfaces[i].color = color_among(shown, i, look.map);
        scene.surfaces[i].opacity =
            look.opacity.value_or(shown.size() == 1 || i == smallest ? 1 : opacity_among_several);
    }
    if (look.outline) scene.lines.push_back(outline_of(bounds));
    for (DrawnLines& lines : scene.lines) lines.width = look.line_width;
    if (!boundary_mesh) return;
    DrawnSurface& drawn = scene.surfaces.emplace_back();
    drawn.mesh = &*boundary_mesh;
    drawn.color = {0.62F, 0.66F, 0.70F, 1};
    drawn.opacity = look.boundary_opacity;
}

void IsosurfaceScene::Data::clear() {
    scene.surfaces.clear();
    scene.lines.clear();
    tets.clear();
    on_device.clear();
    mesh_colors.clear();
    meshes.clear();
    shown.clear();
}

IsosurfaceScene::IsosurfaceScene(std::unique_ptr<Data> data) : data_(std::move(data)) {}
IsosurfaceScene::IsosurfaceScene(IsosurfaceScene&&) noexcept = default;
IsosurfaceScene& IsosurfaceScene::operator=(IsosurfaceScene&&) noexcept = default;
IsosurfaceScene::~IsosurfaceScene() = default;

Result<IsosurfaceScene> IsosurfaceScene::create(const Device& device, IsosurfaceOptions options, SceneLook look,
                                                const Run& run) {
    return core::guarded("making a scene", [&]() -> Result<IsosurfaceScene> {
        auto data = std::make_unique<Data>(Data{device, std::move(look)});
        options.grid.point_fields = options.grid.cell_fields = {};
        if (auto looked = data->look_around(options.grid, run); !looked) return looked.error();
        const IsosurfaceOptions tets{{}, {}, 1, {}, ExtractOn::cpu, options.draw, options.index, options.picture};
        if (auto started = data->start(std::move(options), run); !started) return started.error();
        if (tets.draw)
            if (auto loaded = data->load_tets(tets, run); !loaded) return loaded.error();
        data->scene.bounds = data->bounds;
        return IsosurfaceScene(std::move(data));
    });
}

Result<IsosurfaceScene> IsosurfaceScene::create(const Device& device, Surface surface, SceneLook look) {
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
        const Result<void> done = data.surface ? data.add_mesh(*data.surface)
                                  : data.store ? data.show_tets(isovalues)
                                               : data.show_extracted(isovalues, run);
        if (!done) return done;
        for (std::size_t i = 0; i < isovalues.size() && i < data.shown.size(); ++i)
            data.shown[i].isovalue = isovalues[i];
        data.report.extract_seconds += extracting.seconds();
        data.dress();
        return {};
    });
}

void IsosurfaceScene::fit(Camera& camera, double aspect, Fit fit) const {
    const auto fit_to = [&](const auto& all) {
        if (fit == Fit::orbit) camera.fit_orbit(all, aspect);
        else camera.fit(all, aspect);
    };
    if (data_->surface && !data_->look.outline) fit_to(*data_->surface);
    else if (data_->boundary && !data_->look.outline) fit_to(*data_->boundary);
    else fit_to(data_->bounds);
}

const Scene& IsosurfaceScene::scene() const noexcept { return data_->scene; }
const std::vector<ShownSurface>& IsosurfaceScene::surfaces() const noexcept { return data_->shown; }
const SceneReport& IsosurfaceScene::report() const noexcept { return data_->report; }
std::vector<std::string> IsosurfaceScene::take_notes() { return std::exchange(data_->notes, {}); }

} // namespace isotet
