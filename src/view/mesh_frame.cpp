// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Frames that are meshes: surfaces, slices and the boundary, extracted here and drawn by the page.
#include <algorithm>
#include <chrono>
#include <cstring>

#include <fmt/format.h>

#include <isotet/boundary.hpp>
#include <isotet/scene.hpp>

#include "view/grid_view.hpp"

namespace isotet::view {

namespace {

double seconds_of(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Of what colours a surface.
std::string color_key(const ViewState& state) {
    if (state.color_by.empty()) return "|";
    std::string key = fmt::format("|{}|{}", state.color_by, state.logarithmic);
    if (state.range) key += fmt::format("|{}|{}", state.range->lower, state.range->upper);
    return key;
}

std::string cells_key(const ViewState& state) {
    std::string key;
    for (const std::string& cells : state.cells) key += "|cells " + cells;
    return key;
}

std::string mesh_key(const ViewState& state, double isovalue, std::size_t step) {
    std::string key = fmt::format("{}|{}|{}", isovalue, state.field, step);
    if (state.keep) key += "|" + to_text(*state.keep);
    return key + cells_key(state) + color_key(state);
}

std::string slice_key(const ViewState& state, const Plane& plane, std::size_t step) {
    return fmt::format("slice|{},{},{}|{}|{}", plane.normal[0], plane.normal[1], plane.normal[2], plane.offset, step) +
           cells_key(state) + color_key(state);
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

Result<std::shared_ptr<const Mesh>> GridView::packed_mesh_at(const ViewState& state, double isovalue,
                                                             const std::string& key, FrameParts& making,
                                                             const Run& run) {
    if (auto kept = kept_mesh(key)) return kept;
    const Result<PointField> field = field_of(state.field, run);
    if (!field) return field.error();
    const Result<ExtractOptions> options = carried_fields(state.color_by, run);
    if (!options) return options.error();
    const auto start = std::chrono::steady_clock::now();
    const Result<Surface> surface = lean_->isosurface(*field, step_, isovalue, *options, run);
    if (!surface) return surface.error();
    making.facts.extract_seconds += seconds_of(start);
    return keep(key, state, *surface, making.facts, run);
}

/// The boundary is found once for each grid, field and colours. It needs the cells.
Result<Solid> GridView::solid_at(const ViewState& state, double isovalue, const Run& run) {
    const std::string wanted = fmt::format("{}|{}|{}", state.field, state.color_by, step_);
    if (!solids_ || solids_key_ != wanted) {
        solids_.reset();
        if (Result<void> here = need_cells(run); !here) return here.error();
        Result<ContourInput> input = input_of(state.field, state.color_by, run);
        if (!input) return input.error();
        ContourOptions options;
        options.method = Method::direct;
        Result<Solids> solids = Solids::create(*std::move(input), options, run);
        if (!solids) return solids.error();
        solids_ = *std::move(solids);
        solids_key_ = wanted;
    }
    return solids_->extract(state.solid == SolidSide::above ? SolidRange::above(isovalue) : SolidRange::below(isovalue),
                            run);
}

Result<std::shared_ptr<const Mesh>> GridView::solid_mesh_at(const ViewState& state, double isovalue,
                                                            const std::string& key, FrameParts& making,
                                                            const Run& run) {
    if (auto kept = kept_mesh(key)) return kept;
    const auto start = std::chrono::steady_clock::now();
    const Result<Solid> solid = solid_at(state, isovalue, run);
    if (!solid) return solid.error();
    const Result<Surface> drawn = drawn_solid(*solid, state.keep, run);
    if (!drawn) return drawn.error();
    making.facts.extract_seconds += seconds_of(start);
    making.facts.method = name_of(solid->contour.method);
    making.facts.notes.insert(making.facts.notes.end(), solid->contour.notes.begin(), solid->contour.notes.end());
    return keep(key, *drawn, making.facts.scale, making.facts, run);
}

std::shared_ptr<const Mesh> GridView::kept_mesh(const std::string& key) {
    const auto kept = std::ranges::find(kept_, key, &Kept::key);
    if (kept == kept_.end()) return nullptr;
    kept->used = true;
    return kept->mesh;
}

/// Of an isosurface, the parts that the state keeps.
Result<std::shared_ptr<const Mesh>> GridView::keep(const std::string& key, const ViewState& state,
                                                   const Surface& surface, FrameFacts& facts, const Run& run) {
    if (!state.keep) return keep(key, surface, facts.scale, facts, run);
    const auto start = std::chrono::steady_clock::now();
    const Result<Surface> some = keep_parts(surface, *state.keep, PartsOf::isosurface, run);
    if (!some) return some.error();
    facts.extract_seconds += seconds_of(start);
    return keep(key, *some, facts.scale, facts, run);
}

Result<std::shared_ptr<const Mesh>> GridView::keep(const std::string& key, const Surface& surface,
                                                   const std::optional<ColorScale>& scale, FrameFacts& facts,
                                                   const Run& run) {
    const auto coding = std::chrono::steady_clock::now();
    std::optional<SurfaceColors> colors;
    if (scale && !surface.point_fields.empty())
        colors = SurfaceColors{surface.point_fields.front().values, Association::point, *scale};
    else if (scale && !surface.cell_fields.empty())
        colors = SurfaceColors{scale->classes.empty() ? surface.cell_fields.front().values
                                                      : places_in_classes(surface.cell_fields.front().values),
                               Association::cell, *scale};
    Result<Mesh> mesh = mesh_of(surface, colors ? &*colors : nullptr, run);
    if (!mesh) return mesh.error();
    facts.mesh_seconds += seconds_of(coding);
    kept_.push_back({key, std::make_shared<const Mesh>(*std::move(mesh)), true});
    return kept_.back().mesh;
}

Result<std::shared_ptr<const Mesh>> GridView::mesh_at(Source& source, const ViewState& state, double isovalue,
                                                      const std::string& key, FrameFacts& facts, const Run& run) {
    if (auto kept = kept_mesh(key)) return kept;
    const auto start = std::chrono::steady_clock::now();
    Result<ContourResult> extracted = source.contour->extract(isovalue, run);
    if (!extracted) return extracted.error();
    facts.extract_seconds += seconds_of(start);
    facts.method = name_of(extracted->method);
    facts.notes.insert(facts.notes.end(), extracted->notes.begin(), extracted->notes.end());
    return keep(key, state, extracted->surfaces.front().surface, facts, run);
}

/// The refined grid is for one isovalue, and takes memory: it is made for the mesh, which is kept.
Result<GridView::Shown> GridView::refined_at(const ViewState& state, double isovalue, const std::string& key,
                                             FrameParts& making, const Run& run) {
    if (!kept_mesh(key)) {
        Result<ContourInput> input = input_of(state.field, state.color_by, run);
        if (!input) return input.error();
        ContourOptions options;
        options.method = Method::direct;
        options.refine = options_.refine;
        Result<Contour> contour = Contour::create(*std::move(input), options);
        if (!contour) return contour.error();
        const auto start = std::chrono::steady_clock::now();
        const Result<ContourResult> extracted = contour->extract(isovalue, run);
        if (!extracted) return extracted.error();
        making.facts.extract_seconds += seconds_of(start);
        const auto made = keep(key, state, extracted->surfaces.front().surface, making.facts, run);
        if (!made) return made.error();
        kept_.back().field_bound = extracted->refinement.field_bound;
    }
    const auto kept = std::ranges::find(kept_, key, &Kept::key);
    return Shown{key, kept->mesh, kept->field_bound};
}

/// Refined where that is asked for, or was done before. `source` is null where the packed grid serves all.
Result<GridView::Shown> GridView::surface_at(const ShowMessage& message, double isovalue, Source* source,
                                             FrameParts& making, const Run& run) {
    const ViewState& state = message.state;
    const std::string key = mesh_key(state, isovalue, step_), refined_key = "refined|" + key;
    if (state.solid) {
        const std::string solid_key = fmt::format("{}|{}", name_of(*state.solid), key);
        auto mesh = solid_mesh_at(state, isovalue, solid_key, making, run);
        if (!mesh) return mesh.error();
        return Shown{solid_key, *std::move(mesh), {}};
    }
    if ((message.refined && refines()) || kept_mesh(refined_key)) {
        Result<Shown> refined = refined_at(state, isovalue, refined_key, making, run);
        if (refined || refined.error().code == ErrorCode::cancelled) return refined;
        making.facts.notes.push_back("The surface is not refined: " + refined.error().message);
    }
    auto mesh = source ? mesh_at(*source, state, isovalue, key, making.facts, run)
                       : packed_mesh_at(state, isovalue, key, making, run);
    if (!mesh) return mesh.error();
    return Shown{key, *std::move(mesh), {}};
}

std::optional<ColorField> GridView::color_field(const ViewState& state, const ColorScale& scale, const Run& run) {
    ColorField colors{state.color_by, {}, Association::point, scale, false, {}};
    if (const Field* cells = cell_colors(grid_, state.color_by)) {
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
        if (uses_packed() && lean_) {
            const Result<ExtractOptions> options = carried_fields(state.color_by, run);
            if (!options) return options.error();
            return lean_->slice(grid_.points, plane, step_, *options, run);
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
                   FrameParts& making) {
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

Result<void> GridView::add_isosurfaces(const ShowMessage& message, const std::vector<std::string>& known,
                                       FrameParts& making, const Run& run) {
    const ViewState& state = message.state;
    const bool packed = uses_packed(), lean = packed && lean_;
    if (!state.isosurfaces) {
        making.facts.method = name_of(packed ? Method::clusters : Method::direct);
        return {};
    }
    if (lean) session_.contour.reset();
    if (!state.solid) solids_.reset();
    Result<Source*> source = lean || state.solid ? Result<Source*>(nullptr) : source_for(state, run);
    if (!source) return source.error();
    std::vector<Shown> shown;
    std::vector<double> values; // each once
    std::vector<SurfacePoints> points;
    for (const double isovalue : state.isovalues) {
        auto surface = surface_at(message, isovalue, *source, making, run);
        if (!surface) return surface.error();
        shown.push_back(*std::move(surface));
        if (std::ranges::find(values, isovalue) != values.end()) continue;
        values.push_back(isovalue);
        points.push_back(some_points_of(*shown.back().mesh));
    }
    if (std::ranges::all_of(shown, [](const Shown& one) { return one.field_bound.has_value(); }))
        for (const Shown& one : shown)
            making.facts.field_bound = std::max(making.facts.field_bound.value_or(0), *one.field_bound);
    SceneLook look;
    look.map = state.map;
    look.opacity = state.opacity;
    const std::vector<SurfaceLook> looks = looks_of(values, points, look);
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const double isovalue = state.isovalues[i];
        const auto which = static_cast<std::size_t>(std::ranges::find(values, isovalue) - values.begin());
        FrameSurface surface;
        surface.key = std::move(shown[i].key);
        surface.isovalue = isovalue;
        surface.color = looks[which].color;
        surface.opacity = looks[which].opacity;
        add(std::move(surface), shown[i].mesh, known, making);
    }
    if (making.facts.method.empty())
        making.facts.method = name_of(state.solid && solids_ ? solids_->method()
                                      : *source              ? (*source)->contour->method()
                                                             : Method::clusters);
    return {};
}

Result<void> GridView::add_slices(const ViewState& state, const std::vector<std::string>& known, FrameParts& making,
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

/// The cell of each triangle.
Result<void> GridView::find_boundary_cells(const Surface& boundary, std::uint64_t number, const Run& run) {
    if (boundary_cells_of_ == number) return {};
    const Result<DrawnGrid> drawn = is_of_file() ? DrawnGrid{grid_, false} : grid_with_joined_points(grid_, run);
    if (!drawn) return drawn.error();
    Result<std::vector<std::uint64_t>> cells = boundary_cells(boundary, drawn->grid, run);
    if (!cells) return cells.error();
    boundary_cells_ = *std::move(cells);
    boundary_cells_of_ = number;
    return {};
}

/// With the field that colours it.
Result<Surface> GridView::colored_boundary(Surface boundary, std::uint64_t number, const ColorField& colors,
                                           const Run& run) {
    if (colors.association == Association::point) {
        if (Result<void> colored = color_boundary_by_points(boundary, grid_, colors, run); !colored)
            return colored.error();
        return boundary;
    }
    if (Result<void> here = need_cells(run); !here) return here.error();
    if (is_of_file() && cells_.empty()) { // its faces are cut in another way
        Result<Surface> found = boundary_of(grid_, run);
        if (!found) return found;
        boundary = *std::move(found);
    }
    if (Result<void> cells = find_boundary_cells(boundary, number, run); !cells) return cells.error();
    ColorField now = colors; // of a packed file the values came with the cells
    if (const Field* const cells = cell_colors(grid_, colors.name)) now.values = cells->values;
    color_boundary_by_cells(boundary, boundary_cells_, now);
    return boundary;
}

Result<void> GridView::add_boundary(const ViewState& state, const std::vector<std::string>& known, FrameParts& making,
                                    const Run& run) {
    if (state.boundary <= 0) return {};
    std::unique_lock lock(boundary_mutex_);
    const bool is_of_another_grid = boundary_ && boundary_grid_ != grid_number_; // finding it was cancelled
    lock.unlock();
    if (is_of_another_grid)
        if (Result<void> again = find_boundary(run); !again) return again;
    lock.lock();
    std::shared_ptr<const Mesh> boundary = boundary_;
    const std::shared_ptr<const Surface> found = boundary_surface_;
    const std::uint64_t number = boundary_number_;
    lock.unlock();
    if (!boundary) return {};
    FrameSurface surface;
    surface.key = fmt::format("boundary|{}", number);
    const auto& scale = making.facts.scale;
    const auto colors =
        state.colored_boundary && !state.color_by.empty() && scale ? color_field(state, *scale, run) : std::nullopt;
    if (colors) {
        surface.key += fmt::format("|{}{}", step_, color_key(state));
        boundary = kept_mesh(surface.key);
        if (!boundary) {
            const Result<Surface> colored = colored_boundary(*found, number, *colors, run);
            if (!colored) return colored.error();
            Result<std::shared_ptr<const Mesh>> made = keep(surface.key, *colored, scale, making.facts, run);
            if (!made) return made.error();
            boundary = *std::move(made);
        }
    }
    surface.kind = "boundary";
    surface.color = {0.62F, 0.66F, 0.70F, 1};
    surface.opacity = state.boundary;
    add(std::move(surface), boundary, known, making);
    return {};
}

/// What is told of the field and its colours; no surface yet.
Result<FrameParts> GridView::frame_begun(const ShowMessage& message, const Run& run) {
    Result<std::optional<ColorScale>> scale = scale_of(message.state, run);
    if (!scale) return scale.error();
    FrameParts making;
    making.most = limit_of(message, options_);
    making.facts.number = message.number;
    making.facts.scale = *scale;
    if (*scale && !(*scale)->classes.empty()) making.facts.classes = classes_->field.classes;
    if (Result<void> told = tell_field(message.state.field, making.facts, run); !told) return told.error();
    return making;
}

Result<FrameParts> GridView::frame_parts(const ShowMessage& message, const std::vector<std::string>& known,
                                         const Run& run) {
    const ViewState& state = message.state;
    if (Result<void> there = show_grid(state.step, state.cells, run); !there) return there.error();
    scene_.reset();
    Result<FrameParts> begun = frame_begun(message, run);
    if (!begun) return begun;
    FrameParts making = *std::move(begun);
    for (Kept& kept : kept_) kept.used = false;
    if (Result<void> added = add_isosurfaces(message, known, making, run); !added) return added.error();
    if (Result<void> added = add_slices(state, known, making, run); !added) return added.error();
    if (Result<void> added = add_boundary(state, known, making, run); !added) return added.error();
    std::erase_if(kept_, [](const Kept& kept) { return !kept.used; });
    return making;
}

Result<Frame> GridView::frame(const ShowMessage& message, double wait_seconds, std::vector<std::string>& known,
                              const Run& run) {
    const ViewState& state = message.state;
    if (Result<void> there = show_grid(state.step, state.cells, run); !there) {
        if (message.picture || !leaves_no_cell(state.step, state.cells, run)) return there.error();
        const Result<FrameParts> nothing = frame_begun(message, run);
        if (!nothing) return nothing.error();
        known.clear();
        return Frame{frame_bytes(nothing->facts, {}), false};
    }
    read_ahead(message);
    if (message.picture) return picture_frame(message, wait_seconds, known, run);
    Result<FrameParts> parts = frame_parts(message, known, run);
    if (!parts) return parts.error();
    parts->facts.wait_seconds = wait_seconds;
    Frame frame{frame_bytes(parts->facts, parts->surfaces), parts->facts.preview};
    known = std::move(parts->keys);
    return frame;
}

} // namespace isotet::view
