// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/isosurface_scene.hpp>

#include <algorithm>
#include <deque>
#include <iterator>
#include <utility>

#include <isotet/boundary.hpp>
#include <isotet/device_grid.hpp>

#include "core/errors.hpp"
#include "core/guard.hpp"
#include "core/stopwatch.hpp"
#include "scene/clip_surface.hpp"
#include "scene/colored_surface.hpp"

namespace isotet {

namespace {

constexpr double opacity_among_several = 0.35;

constexpr Color single_color{0.92F, 0.48F, 0.16F, 1}; ///< stands out from the boundary, and from blue and green

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

/// Device memory that pictures of this size need beside a store, with the numbers of all tets.
std::uint64_t picture_bytes(const PictureOptions& picture, std::uint64_t tets) {
    constexpr std::uint64_t max_samples = std::uint64_t{1} << 24, bytes_per_sample = 28, corners_of_quads = 2'000'000;
    const std::uint64_t samples = std::uint64_t{picture.width} * picture.height * picture.samples * picture.samples;
    return std::min(samples, max_samples) * bytes_per_sample + 4 * tets + corners_of_quads;
}

} // namespace

struct IsosurfaceScene::Data {
    std::optional<Device> device; ///< that draws; nothing: the CPU does
    SceneLook look = {};
    std::optional<Surface> surface = {}; ///< that was given; else there is
    std::optional<Contour> contour = {}; ///< with gradient normals
    ContourInput without_device = {};    ///< of the session, if it has a device: to go on without it
    bool required = false;               ///< the device
    Box bounds = {};
    std::optional<Surface> boundary = {};
    std::vector<Surface> slices = {};
    std::vector<DrawnLines> edges = {};         ///< of slices and boundary
    std::vector<DrawnLines> surface_edges = {}; ///< of what is shown
    std::optional<TetStore> store = {};
    std::optional<TetIndex> index = {};
    std::optional<DeviceColors> grid_colors = {};
    std::vector<TetSurface> tets = {};
    std::vector<DeviceSurface> on_device = {};
    std::deque<DeviceMesh> meshes = {}; ///< places that do not move
    std::deque<DeviceColors> mesh_colors = {};
    std::deque<Surface> extracted = {}; ///< without a device
    std::deque<SurfaceColors> values = {};
    std::deque<DeviceMesh> fixed_meshes = {}; ///< of what is there for all isovalues
    std::deque<DeviceColors> fixed_colors = {};
    std::deque<SurfaceColors> fixed_values = {};
    std::vector<DrawnSurface> fixed = {}; ///< slices and boundary
    std::vector<Box> boxes = {};          ///< of surfaces shown; empty where they are on the device
    Scene scene = {};
    std::vector<ShownSurface> shown = {};
    SceneReport report = {};
    std::vector<std::string> notes = {};

    Result<void> look_around(const Grid& grid, const Run& run);
    Result<void> add_fixed(const Surface& one, const ColorField* field, const Color& color, double opacity);
    Result<void> start(IsosurfaceOptions options, const Run& run);
    Result<void> load_tets(const IsosurfaceOptions& options, const Run& run);
    Result<void> show_tets(std::span<const double> isovalues);
    Result<void> show_extracted(std::span<const double> isovalues, const Run& run);
    Result<void> show_on_device(std::span<const double> isovalues, const Run& run);
    Result<void> add_surface(Surface one);
    bool draws_surface_edges() const { return look.edges && (surface || (!boundary && slices.empty())); }
    bool hides_another(std::size_t which) const;
    std::uint64_t smallest_size() const;
    void dress();
    void clear();
};

/// The boundary if it is drawn, slices, and the box around the grid.
Result<void> IsosurfaceScene::Data::look_around(const Grid& grid, const Run& run) {
    const core::Stopwatch looking;
    if (look.boundary_opacity > 0) {
        Result<Surface> found = boundary_of(grid, run);
        if (!found) return found.error();
        boundary = *std::move(found);
        bounds = bounds_of(*boundary);
        report.boundary_faces = boundary->triangle_count();
        if (look.boundary_colors)
            if (auto colored = scene::color_boundary(*boundary, grid, *look.boundary_colors, run); !colored)
                return colored;
        for (const Plane& plane : look.clips) boundary = scene::clipped(*boundary, plane);
        if (look.edges) edges.push_back(scene::edges_of(*boundary));
    } else {
        const Result<GridReport> surveyed = survey(grid, {.faces = false}, run);
        if (!surveyed) return surveyed.error();
        bounds.add(surveyed->lower);
        bounds.add(surveyed->upper);
    }
    report.boundary_seconds = looking.seconds();
    const ColorField* colors = look.colors ? &*look.colors : nullptr;
    for (const Plane& plane : look.slices) {
        Result<Surface> slice = slice_of(grid, plane, colors, run);
        if (!slice) return slice.error();
        report.slice_triangles += slice->triangle_count();
        if (look.edges) edges.push_back(scene::edges_of(*slice));
        slices.push_back(*std::move(slice));
    }
    for (const Surface& slice : slices)
        if (auto added = add_fixed(slice, colors, single_color, 1); !added) return added;
    if (!boundary) return {};
    return add_fixed(*boundary, look.boundary_colors ? &*look.boundary_colors : nullptr, {0.62F, 0.66F, 0.70F, 1},
                     look.boundary_opacity);
}

/// Adds what is drawn for all isovalues. Its first field of points or cells colours it.
Result<void> IsosurfaceScene::Data::add_fixed(const Surface& one, const ColorField* field, const Color& color,
                                              double opacity) {
    DrawnSurface& drawn = fixed.emplace_back();
    drawn.color = color;
    drawn.opacity = opacity;
    if (!device) {
        drawn.triangles = &one;
        if (field) drawn.values = &fixed_values.emplace_back(scene::carried_colors(one, *field));
        return {};
    }
    Result<DeviceMesh> mesh = DeviceMesh::upload(*device, one);
    if (!mesh) return mesh.error();
    drawn.mesh = &fixed_meshes.emplace_back(*std::move(mesh));
    if (!field) return {};
    const SurfaceColors carried = scene::carried_colors(one, *field);
    Result<DeviceColors> colors = DeviceColors::of_mesh(*device, carried.values, carried.association, carried.scale);
    if (!colors) return colors.error();
    drawn.colors = &fixed_colors.emplace_back(*std::move(colors));
    return {};
}

/// Starts the session. A device colours by the grid's own values; on the CPU surfaces carry the field that colours.
Result<void> IsosurfaceScene::Data::start(IsosurfaceOptions wanted, const Run& run) {
    ContourOptions options;
    options.normals = look.shade_by == ShadeBy::gradient || wanted.draw || wanted.where == ExtractOn::device
                          ? Normals::gradient
                          : Normals::none;
    options.method = wanted.draw ? Method::clusters : wanted.method;
    options.surfaces = wanted.surfaces;
    const bool by_cells = look.colors && look.colors->association == Association::cell;
    const bool by_points = look.colors && !by_cells;
    ContourInput plain{std::move(wanted.grid), std::move(wanted.field), {}, {}}, carrying = plain;
    if (by_points) carrying.point_fields.push_back({look.colors->name, look.colors->values});
    if (by_cells) carrying.cell_fields.push_back({look.colors->name, look.colors->values});
    required = wanted.where == ExtractOn::device;
    if (!device && (required || wanted.draw))
        return invalid_argument("a scene without a device, but it is to extract, or to draw tets, on one");
    options.split_cells = wanted.split_cells || wanted.draw;
    const bool in_memory = // surfaces are worked on
        !look.clips.empty() || look.shade_by == ShadeBy::vertices || draws_surface_edges();
    const bool card = device && device->info().kind != DeviceKind::software &&
                      options.method.value_or(method_for(options.surfaces, true)) == Method::clusters;
    const bool use_device = !wanted.draw && (required || (card && !in_memory && wanted.where == ExtractOn::best));
    if (!use_device && !wanted.draw) options.refine = wanted.refine;
    if (use_device) {
        options.engine = vulkan_engine(*device);
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
    report.pack_seconds += result->pack_seconds;
    for (Extraction& extraction : result->surfaces)
        if (Result<void> added = add_surface(std::move(extraction.surface)); !added) return added;
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
    if (look.shade_by == ShadeBy::vertices) {
        Result<Array> normals = vertex_normals(one);
        if (!normals) return normals.error();
        one.normals = *std::move(normals);
        one.normals_kind = Normals::vertex;
    } else if (look.shade_by == ShadeBy::faces) {
        one.normals_kind = Normals::none;
    }
    boxes.push_back(bounds_of(one));
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
    shown.clear();
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

IsosurfaceScene::IsosurfaceScene(std::unique_ptr<Data> data) : data_(std::move(data)) {}
IsosurfaceScene::IsosurfaceScene(IsosurfaceScene&&) noexcept = default;
IsosurfaceScene& IsosurfaceScene::operator=(IsosurfaceScene&&) noexcept = default;
IsosurfaceScene::~IsosurfaceScene() = default;

Result<IsosurfaceScene> IsosurfaceScene::create(const std::optional<Device>& device, IsosurfaceOptions options,
                                                SceneLook look, const Run& run) {
    return core::guarded("making a scene", [&]() -> Result<IsosurfaceScene> {
        auto data = std::make_unique<Data>(Data{device, std::move(look)});
        options.grid.point_fields = options.grid.cell_fields = {};
        if (auto looked = data->look_around(options.grid, run); !looked) return looked.error();
        const IsosurfaceOptions tets{{}, {}, 1, {}, ExtractOn::cpu, options.draw, options.index, options.picture};
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

const Scene& IsosurfaceScene::scene() const noexcept { return data_->scene; }
const std::vector<ShownSurface>& IsosurfaceScene::surfaces() const noexcept { return data_->shown; }
const SceneReport& IsosurfaceScene::report() const noexcept { return data_->report; }
std::vector<std::string> IsosurfaceScene::take_notes() { return std::exchange(data_->notes, {}); }

} // namespace isotet
