// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/grid_view.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <malloc.h>

#include <isotet/boundary.hpp>
#include <isotet/field_statistics.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/memory.hpp>

namespace isotet::view {

namespace {

double seconds_of(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void offer(const std::vector<Field>& fields, Association association, std::vector<OfferedField>& offered) {
    constexpr std::size_t max_components = 9;
    constexpr std::array<const char*, 3> axes{"x", "y", "z"};
    for (const Field& field : fields) {
        const std::size_t components = field.values.components();
        if (components == 1) offered.push_back({field.name, association});
        if (components == 1 || components > max_components) continue;
        offered.push_back({field.name + ":mag", association});
        for (std::size_t i = 0; i < components; ++i)
            offered.push_back({field.name + ":" + (components == 3 ? axes[i] : std::to_string(i)), association});
    }
}

const Field* find_named(const std::vector<Field>& fields, const std::string& name) {
    const auto found = std::ranges::find(fields, name, &Field::name);
    return found == fields.end() ? nullptr : &*found;
}

/// A cell field that colours triangles as they are: not averaged to the points.
const Field* whole_cell_field(const Grid& grid, const std::string& name) {
    const Field* cells = find_named(grid.cell_fields, name);
    return cells && cells->values.components() == 1 && !find_named(grid.point_fields, name) ? cells : nullptr;
}

/// The ends of a colour map over all values; on a logarithmic scale of those above 0.
ValueRange range_of_values(const Array& values, bool logarithmic) {
    ValueRange range{INFINITY, -INFINITY};
    values.visit([&](auto scalars) {
        for (const auto scalar : scalars) {
            const auto value = static_cast<double>(scalar);
            if (!std::isfinite(value) || (logarithmic && value <= 0)) continue;
            range.lower = std::min(range.lower, value);
            range.upper = std::max(range.upper, value);
        }
    });
    if (range.lower < range.upper) return range;
    const double value = std::isfinite(range.lower) ? range.lower : logarithmic ? 1 : 0;
    const double half = value == 0 ? 1 : std::abs(value) / 2;
    return {value - half, value + half};
}

/// Of what colours a surface.
std::string color_key(const ViewState& state) {
    if (state.color_by.empty()) return "|";
    std::string key = fmt::format("|{}|{}", state.color_by, state.logarithmic);
    if (state.range) key += fmt::format("|{}|{}", state.range->lower, state.range->upper);
    return key;
}

std::string mesh_key(const ViewState& state, double isovalue, std::size_t step) {
    return fmt::format("{}|{}|{}", isovalue, state.field, step) + color_key(state);
}

std::string slice_key(const ViewState& state, const Plane& plane, std::size_t step) {
    return fmt::format("slice|{},{},{}|{}|{}", plane.normal[0], plane.normal[1], plane.normal[2], plane.offset, step) +
           color_key(state);
}

bool same_values(const Array& a, const Array& b) {
    return a.type() == b.type() && a.size() == b.size() &&
           (a.data() == b.data() || std::memcmp(a.data(), b.data(), a.bytes()) == 0);
}

/// Whether the boundary of both is the same.
bool same_cells(const Grid& a, const Grid& b) {
    return same_values(a.points, b.points) && same_values(a.cells.types, b.cells.types) &&
           same_values(a.cells.offsets, b.cells.offsets) && same_values(a.cells.connectivity, b.cells.connectivity);
}

/// Triangles of a surface above which a preview is sent.
std::uint64_t limit_of(const ShowMessage& message, const GridViewOptions& options) {
    constexpr std::uint64_t least = 10'000;
    const std::uint64_t own = message.moving ? options.preview_triangles : options.max_triangles;
    return std::clamp<std::uint64_t>(message.most.value_or(own), std::min<std::uint64_t>(least, own),
                                     options.max_triangles);
}

bool holds(const std::vector<std::string>& keys, const std::string& key) {
    return std::ranges::find(keys, key) != keys.end();
}

} // namespace

std::vector<OfferedField> offered_fields(const Grid& grid) {
    std::vector<OfferedField> offered;
    offer(grid.point_fields, Association::point, offered);
    offer(grid.cell_fields, Association::cell, offered);
    if (offered.empty())
        for (const char* axis : {"x", "y", "z"}) offered.push_back({axis, Association::point});
    return offered;
}

Result<std::unique_ptr<GridView>> GridView::create(Grid grid, const GridViewOptions& options) {
    std::unique_ptr<GridView> view(new GridView);
    const auto places = statistics_of(grid.points, {options.threads, {}});
    if (!places) return places.error();
    if (places->size() == 3 && (*places)[0].lower <= (*places)[0].upper)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            view->bounds_.lower[axis] = (*places)[axis].lower;
            view->bounds_.upper[axis] = (*places)[axis].upper;
        }
    view->fields_ = offered_fields(grid);
    view->cell_count_ = grid.cells.count();
    view->grid_ = std::move(grid);
    view->options_ = options;
    view->step_ = options.step;
    if (options.read_step && options.steps > 1)
        view->steps_ = std::make_unique<StepReader>(options.read_step, options.threads);
    return view;
}

Result<PointField> GridView::field_of(const std::string& name, const Run& run) {
    constexpr std::size_t max_found = 8; // averaged fields and magnitudes take memory
    if (const auto found = found_.find(name); found != found_.end()) return found->second;
    const auto offered = std::ranges::find(fields_, name, &OfferedField::name);
    if (offered == fields_.end() || offered->association == Association::cell)
        if (Result<void> here = need_cells(run); !here) return here.error(); // it may be averaged
    Result<PointField> field = find_field(grid_, name, {}, run);
    if (!field) return field;
    if (found_.size() >= max_found) found_.clear();
    found_.emplace(name, *field);
    return field;
}

Result<ContourInput> GridView::input_of(const std::string& field, const std::string& color_by, const Run& run) {
    Result<PointField> contoured = field_of(field, run);
    if (!contoured) return contoured.error();
    ContourInput input{grid_, *std::move(contoured), {}, {}};
    if (color_by.empty()) return input;
    if (const Field* cells = whole_cell_field(grid_, color_by)) {
        input.cell_fields = {*cells};
        return input;
    }
    Result<PointField> colors = field_of(color_by, run);
    if (!colors) return colors.error();
    input.point_fields = {{color_by, colors->values}};
    return input;
}

Result<std::optional<ColorScale>> GridView::scale_of(const ViewState& state, const Run& run) {
    if (state.color_by.empty()) return std::optional<ColorScale>();
    if (state.logarithmic && state.range && state.range->lower <= 0)
        return Error{ErrorCode::invalid_argument,
                     fmt::format("the range of colours begins with {}, but a logarithmic scale takes positive numbers",
                                 state.range->lower)};
    Array values;
    if (const Field* cells = whole_cell_field(grid_, state.color_by)) values = cells->values;
    else {
        const Result<PointField> field = field_of(state.color_by, run);
        if (!field) return field.error();
        values = field->values;
    }
    const ValueRange range = state.range ? *state.range : range_of_values(values, state.logarithmic);
    ColorScale scale;
    scale.map = state.map;
    scale.lower = range.lower;
    scale.upper = range.upper;
    scale.logarithmic = state.logarithmic;
    return std::optional(scale);
}

/// Another step takes the place of the grid; the sessions find out what is the same.
Result<void> GridView::go_to_step(const ShowMessage& message, const Run& run) {
    const auto& wanted = message.state.step;
    if (wanted && *wanted != step_) {
        if (!steps_ || *wanted >= options_.steps)
            return Error{
                ErrorCode::invalid_argument,
                fmt::format("step {} is asked for, but the file has steps 0 to {}", *wanted, options_.steps - 1)};
        Result<Grid> grid = steps_->take(*wanted, run);
        if (!grid) return grid.error();
        const bool same = same_cells(*grid, grid_);
        {
            const std::lock_guard lock(grid_mutex_);
            grid_ = *std::move(grid);
            step_ = *wanted;
        }
        found_.clear();
        if (!same)
            if (Result<void> found = find_boundary(run); !found) return found;
    }
    if (steps_ && message.next && *message.next < options_.steps && *message.next != step_)
        steps_->read_ahead(*message.next);
    return {};
}

Result<void> GridView::pack(const std::string& field, const Run& run) {
    // The cache of fields is frame()'s: this thread finds its own, in a copy that shares the arrays.
    std::unique_lock lock(grid_mutex_);
    const Grid grid = grid_;
    const std::size_t step = step_;
    lock.unlock();
    Result<PointField> contoured = find_field(grid, field, {}, run);
    if (!contoured) return contoured.error();
    ContourOptions options;
    options.method = Method::clusters;
    options.source_cells = !grid.cell_fields.empty();
    const bool lean = may_release_cells(grid);
    options.source_cells |= lean; // for picks
    Result<Contour> contour = Contour::create({grid, *contoured, {}, {}}, options);
    if (!contour) return contour.error();
    if (Result<void> ready = contour->prepare(run); !ready) return ready;
    if (lean) lean_.emplace(*contour->packed(), *std::move(contoured));
    else packed_.contour = *std::move(contour);
    packed_.field = field;
    packed_.step = step;
    is_packed_.store(true, std::memory_order_release);
    return {};
}

Result<void> GridView::find_boundary(const Run& run) {
    std::unique_lock lock(grid_mutex_);
    const Grid grid = grid_;
    lock.unlock();
    Result<Surface> boundary = boundary_of(grid, run);
    if (!boundary) return boundary.error();
    Result<Mesh> mesh = mesh_of(*boundary, nullptr, run);
    if (!mesh) return mesh.error();
    const std::lock_guard boundary_lock(boundary_mutex_);
    boundary_ = std::make_shared<const Mesh>(*std::move(mesh));
    return {};
}

bool GridView::may_release_cells(const Grid& grid) const {
    return options_.steps == 1 && options_.read_step && !has_cells_to_linearize(grid.cells);
}

/// Reads the file again where the cells were released.
Result<void> GridView::need_cells(const Run& run) {
    if (has_cells_) return {};
    Result<Grid> again = options_.read_step(step_, run);
    if (!again) return again.error();
    if (again->points.tuples() != grid_.points.tuples() || again->cells.count() != cell_count_)
        return Error{ErrorCode::invalid_data,
                     fmt::format("the file has changed: it had {} points and {} cells, and now {} and {}",
                                 grid_.points.tuples(), cell_count_, again->points.tuples(), again->cells.count())};
    const std::lock_guard lock(grid_mutex_);
    grid_.cells = std::move(again->cells);
    has_cells_ = true;
    return {};
}

void GridView::rest() {
    if (is_packed_.load(std::memory_order_acquire) && lean_ && has_cells_) {
        if (!sample_) sample_ = sample_of_cells(grid_);
        direct_.contour.reset();
        const std::lock_guard lock(grid_mutex_);
        grid_.cells = {};
        has_cells_ = false;
    }
    release_memory();
    malloc_trim(0);
}

/// The field that colours, as surfaces carry it.
Result<ExtractOptions> GridView::carried_fields(const std::string& color_by, const Run& run) {
    ExtractOptions options;
    if (color_by.empty()) return options;
    if (const Field* cells = whole_cell_field(grid_, color_by)) {
        options.cell_fields = {*cells};
        return options;
    }
    const Result<PointField> colors = field_of(color_by, run);
    if (!colors) return colors.error();
    options.point_fields = {{color_by, colors->values}};
    return options;
}

Result<std::shared_ptr<const Mesh>> GridView::packed_mesh_at(const ViewState& state, double isovalue,
                                                             const std::string& key, Making& making, const Run& run) {
    if (auto kept = kept_mesh(key)) return kept;
    const Result<PointField> field = field_of(state.field, run);
    if (!field) return field.error();
    const Result<ExtractOptions> options = carried_fields(state.color_by, run);
    if (!options) return options.error();
    const auto start = std::chrono::steady_clock::now();
    const Result<Surface> surface = lean_->isosurface(*field, isovalue, *options, run);
    if (!surface) return surface.error();
    making.facts.extract_seconds += seconds_of(start);
    return keep(key, *surface, making.facts.scale, making.facts, run);
}

Result<GridView::Source*> GridView::source_for(const ViewState& state, const Run& run) {
    const bool packed = is_packed_.load(std::memory_order_acquire);
    Source& source = packed ? packed_ : direct_;
    if (packed) direct_.contour.reset();
    if (source.contour && source.field == state.field && source.color_by == state.color_by && source.step == step_)
        return &source;
    Result<ContourInput> input = input_of(state.field, state.color_by, run);
    if (!input) return input.error();
    if (source.contour) {
        const Result<ContourUpdate> update = source.contour->set(*std::move(input), run);
        if (!update) return update.error();
    } else {
        ContourOptions options;
        options.method = Method::direct;
        Result<Contour> contour = Contour::create(*std::move(input), options);
        if (!contour) return contour.error();
        source.contour = *std::move(contour);
    }
    source.field = state.field;
    source.color_by = state.color_by;
    source.step = step_;
    return &source;
}

std::shared_ptr<const Mesh> GridView::kept_mesh(const std::string& key) {
    const auto kept = std::ranges::find(kept_, key, &Kept::key);
    if (kept == kept_.end()) return nullptr;
    kept->used = true;
    return kept->mesh;
}

Result<std::shared_ptr<const Mesh>> GridView::keep(const std::string& key, const Surface& surface,
                                                   const std::optional<ColorScale>& scale, FrameFacts& facts,
                                                   const Run& run) {
    const auto coding = std::chrono::steady_clock::now();
    std::optional<SurfaceColors> colors;
    if (scale && !surface.point_fields.empty())
        colors = SurfaceColors{surface.point_fields.front().values, Association::point, *scale};
    else if (scale && !surface.cell_fields.empty())
        colors = SurfaceColors{surface.cell_fields.front().values, Association::cell, *scale};
    Result<Mesh> mesh = mesh_of(surface, colors ? &*colors : nullptr, run);
    if (!mesh) return mesh.error();
    facts.mesh_seconds += seconds_of(coding);
    kept_.push_back({key, std::make_shared<const Mesh>(*std::move(mesh)), true});
    return kept_.back().mesh;
}

Result<std::shared_ptr<const Mesh>> GridView::mesh_at(Source& source, double isovalue, const std::string& key,
                                                      const std::optional<ColorScale>& scale, FrameFacts& facts,
                                                      const Run& run) {
    if (auto kept = kept_mesh(key)) return kept;
    const auto start = std::chrono::steady_clock::now();
    Result<ContourResult> extracted = source.contour->extract(isovalue, run);
    if (!extracted) return extracted.error();
    facts.extract_seconds += seconds_of(start);
    facts.method = name_of(extracted->method);
    facts.notes.insert(facts.notes.end(), extracted->notes.begin(), extracted->notes.end());
    return keep(key, extracted->surfaces.front().surface, scale, facts, run);
}

std::optional<ColorField> GridView::color_field(const ViewState& state, const ColorScale& scale, const Run& run) {
    ColorField colors{state.color_by, {}, Association::point, scale, false, {}};
    if (const Field* cells = whole_cell_field(grid_, state.color_by)) {
        colors.values = cells->values;
        colors.association = Association::cell;
        return colors;
    }
    const Result<PointField> field = field_of(state.color_by, run);
    if (!field) return std::nullopt; // scale_of() has told it
    colors.values = field->values;
    return colors;
}

Result<std::shared_ptr<const Mesh>> GridView::slice_at(const ViewState& state, const Plane& plane,
                                                       const std::string& key, const std::optional<ColorScale>& scale,
                                                       FrameFacts& facts, const Run& run) {
    if (auto kept = kept_mesh(key)) return kept;
    const auto cut = [&]() -> Result<Surface> {
        if (is_packed_.load(std::memory_order_acquire) && lean_) {
            const Result<ExtractOptions> options = carried_fields(state.color_by, run);
            if (!options) return options.error();
            return lean_->slice(grid_.points, plane, *options, run);
        }
        const std::optional<ColorField> colors = scale ? color_field(state, *scale, run) : std::nullopt;
        return slice_of(grid_, plane, colors ? &*colors : nullptr, run);
    };
    const auto start = std::chrono::steady_clock::now();
    const Result<Surface> slice = cut();
    if (!slice) return slice.error();
    facts.extract_seconds += seconds_of(start);
    return keep(key, *slice, scale, facts, run);
}

/// Sends the mesh, or a preview of it, unless the page has it.
void GridView::add(FrameSurface surface, const std::shared_ptr<const Mesh>& mesh, const std::vector<std::string>& known,
                   Making& making) {
    surface.triangles = mesh->triangle_count();
    const bool has_it_in_full = holds(known, surface.key);
    if (!has_it_in_full && surface.triangles > making.most && !mesh->flat) {
        making.facts.preview = true;
        surface.key += fmt::format("|{}", making.most);
        if (!holds(known, surface.key)) {
            const auto coding = std::chrono::steady_clock::now();
            making.meshes.push_back(std::make_shared<const Mesh>(preview_of(*mesh, making.most)));
            making.facts.mesh_seconds += seconds_of(coding);
            surface.mesh = making.meshes.back().get();
        }
    } else if (!has_it_in_full) {
        making.meshes.push_back(mesh);
        surface.mesh = mesh.get();
    }
    making.keys.push_back(surface.key);
    making.surfaces.push_back(std::move(surface));
}

Result<void> GridView::add_isosurfaces(const ViewState& state, const std::vector<std::string>& known, Making& making,
                                       const Run& run) {
    const bool lean = is_packed_.load(std::memory_order_acquire) && lean_;
    if (lean) direct_.contour.reset();
    Result<Source*> source = lean ? Result<Source*>(nullptr) : source_for(state, run);
    if (!source) return source.error();
    std::vector<std::shared_ptr<const Mesh>> meshes;
    std::vector<double> values; // each once
    std::vector<Box> boxes;
    for (const double isovalue : state.isovalues) {
        const std::string key = mesh_key(state, isovalue, step_);
        auto mesh = lean ? packed_mesh_at(state, isovalue, key, making, run)
                         : mesh_at(**source, isovalue, key, making.facts.scale, making.facts, run);
        if (!mesh) return mesh.error();
        meshes.push_back(*mesh);
        if (std::ranges::find(values, isovalue) != values.end()) continue;
        values.push_back(isovalue);
        boxes.push_back((*mesh)->box);
    }
    SceneLook look;
    look.map = state.map;
    look.opacity = state.opacity;
    const std::vector<SurfaceLook> looks = looks_of(values, boxes, look);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const double isovalue = state.isovalues[i];
        const auto which = static_cast<std::size_t>(std::ranges::find(values, isovalue) - values.begin());
        FrameSurface surface;
        surface.key = mesh_key(state, isovalue, step_);
        surface.isovalue = isovalue;
        surface.color = looks[which].color;
        surface.opacity = looks[which].opacity;
        add(std::move(surface), meshes[i], known, making);
    }
    if (making.facts.method.empty())
        making.facts.method = name_of(lean ? Method::clusters : (*source)->contour->method());
    return {};
}

Result<void> GridView::add_slices(const ViewState& state, const std::vector<std::string>& known, Making& making,
                                  const Run& run) {
    for (const Plane& plane : state.slices) {
        FrameSurface surface;
        surface.key = slice_key(state, plane, step_);
        surface.kind = "slice";
        surface.color = looks_of(std::span(&plane.offset, 1), {}, {}).front().color; // as IsosurfaceScene
        auto mesh = slice_at(state, plane, surface.key, making.facts.scale, making.facts, run);
        if (!mesh) return mesh.error();
        add(std::move(surface), *mesh, known, making);
    }
    return {};
}

void GridView::add_boundary(const ViewState& state, const std::vector<std::string>& known, Making& making) {
    if (state.boundary <= 0) return;
    std::unique_lock lock(boundary_mutex_);
    const std::shared_ptr<const Mesh> boundary = boundary_;
    lock.unlock();
    if (!boundary) return;
    FrameSurface surface;
    surface.key = fmt::format("boundary|{}", static_cast<const void*>(boundary.get()));
    surface.kind = "boundary";
    surface.color = {0.62F, 0.66F, 0.70F, 1};
    surface.opacity = state.boundary;
    add(std::move(surface), boundary, known, making);
}

Result<Frame> GridView::frame(const ShowMessage& message, double wait_seconds, std::vector<std::string>& known,
                              const Run& run) {
    const ViewState& state = message.state;
    if (Result<void> there = go_to_step(message, run); !there) return there.error();
    if (message.picture) return picture_frame(message, wait_seconds, known, run);
    scene_.reset();
    Result<std::optional<ColorScale>> scale = scale_of(state, run);
    if (!scale) return scale.error();
    for (Kept& kept : kept_) kept.used = false;
    Making making;
    making.most = limit_of(message, options_);
    making.facts.number = message.number;
    making.facts.wait_seconds = wait_seconds;
    making.facts.scale = *scale;
    making.facts.step = step_;
    if (Result<void> added = add_isosurfaces(state, known, making, run); !added) return added.error();
    if (Result<void> added = add_slices(state, known, making, run); !added) return added.error();
    add_boundary(state, known, making);
    std::erase_if(kept_, [](const Kept& kept) { return !kept.used; });
    Frame frame{frame_bytes(making.facts, making.surfaces), making.facts.preview};
    known = std::move(making.keys);
    return frame;
}

Result<Surface> GridView::surface_of_pick(const PickMessage& message, const Run& run) {
    const bool packed = is_packed_.load(std::memory_order_acquire) && lean_;
    ExtractOptions with_all;
    with_all.source_cells = true;
    with_all.point_fields = grid_.point_fields;
    with_all.cell_fields = grid_.cell_fields;
    const Plane* plane = message.slice ? &message.state.slices[*message.slice] : nullptr;
    if (packed && plane) return lean_->slice(grid_.points, *plane, with_all, run);
    PointField field;
    if (plane) field = {"height", heights_over(grid_.points, *plane), false, {}};
    else if (Result<PointField> found = field_of(message.state.field, run); found) field = *std::move(found);
    else return found.error();
    const double isovalue = plane ? plane->offset : message.state.isovalues.front();
    if (packed) return lean_->isosurface(field, isovalue, with_all, run);
    ContourOptions options;
    options.method = Method::direct;
    options.source_cells = true;
    Result<Contour> contour =
        Contour::create({grid_, std::move(field), grid_.point_fields, grid_.cell_fields}, options);
    if (!contour) return contour.error();
    Result<ContourResult> extracted = contour->extract(isovalue, run);
    if (!extracted) return extracted.error();
    return std::move(extracted->surfaces.front().surface);
}

Result<Picked> GridView::pick_along(const PickMessage& message, const Run& run) {
    std::optional<Picked> first;
    double nearest = INFINITY;
    const auto look = [&](const PickMessage& one, std::span<const Plane> clips) -> Result<void> {
        const Result<Surface> surface = surface_of_pick(one, run);
        if (!surface) return surface.error();
        const auto along = first_on_ray(*surface, message.point, *message.ray, clips);
        if (!along || *along >= nearest) return {};
        nearest = *along;
        std::array<double, 3> place = message.point;
        for (std::size_t axis = 0; axis < 3; ++axis) place[axis] += nearest * (*message.ray)[axis];
        first = nearest_on(*surface, place);
        if (first && !one.slice) first->isovalue = one.state.isovalues.front();
        return {};
    };
    PickMessage one = message;
    for (const double isovalue : message.state.isovalues) {
        one.state.isovalues = {isovalue};
        if (Result<void> ok = look(one, message.state.clips); !ok) return ok.error();
    }
    for (std::size_t i = 0; i < message.state.slices.size(); ++i) {
        one.slice = i;
        if (Result<void> ok = look(one, {}); !ok) return ok.error();
    }
    if (!first) return Error{ErrorCode::cancelled, "the ray meets nothing"}; // a page is told nothing
    return *std::move(first);
}

Result<Picked> GridView::pick(const PickMessage& message, const Run& run) {
    if (message.ray) return pick_along(message, run);
    const Result<Surface> surface = surface_of_pick(message, run);
    if (!surface) return surface.error();
    std::optional<Picked> picked = nearest_on(*surface, message.point);
    if (!picked) return Error{ErrorCode::invalid_data, "the surface has no triangle here"};
    return *std::move(picked);
}

Result<Chart> GridView::chart(const std::string& field, const Run& run) {
    const Result<PointField> found = field_of(field, run);
    if (!found) return found.error();
    if (has_cells_) return chart_of(grid_, *found, run);
    Result<Chart> chart = chart_of(sample_->grid, *found, run);
    if (chart)
        for (double& triangles : chart->triangles) triangles *= sample_->cells_each;
    return chart;
}

Result<ContourSpectrum> GridView::spectrum(const std::string& field, const Run& run) {
    constexpr std::uint64_t steps = 256;
    const std::string key = fmt::format("{}|{}", step_, field);
    if (spectrum_ && spectrum_key_ == key) return *spectrum_;
    const Result<PointField> found = field_of(field, run);
    if (!found) return found.error();
    if (Result<void> here = need_cells(run); !here) return here.error();
    Result<ContourSpectrum> spectrum = contour_spectrum_over_range(grid_, *found, steps, run);
    if (!spectrum) return spectrum;
    spectrum_ = *spectrum;
    spectrum_key_ = key;
    return spectrum;
}

} // namespace isotet::view
