// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/grid_view.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include <isotet/field_statistics.hpp>

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

std::string mesh_key(const ViewState& state, double isovalue) {
    std::string key = fmt::format("{}|{}|{}", isovalue, state.field, state.color_by);
    if (state.color_by.empty()) return key;
    key += state.logarithmic ? "|log" : "|";
    if (state.range) key += fmt::format("|{}|{}", state.range->lower, state.range->upper);
    return key;
}

/// Colours that tell isovalues apart, as isotet render has them.
Color color_of(const std::vector<double>& isovalues, std::size_t which, ColorMap map) {
    constexpr Color single{0.92F, 0.48F, 0.16F, 1};
    if (isovalues.size() < 2) return single;
    const auto below = std::ranges::count_if(isovalues, [&](double one) { return one < isovalues[which]; });
    return color_at(map, 0.12 + 0.76 * static_cast<double>(below) / static_cast<double>(isovalues.size() - 1));
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
    view->grid_ = std::move(grid);
    view->options_ = options;
    return view;
}

Result<PointField> GridView::field_of(const std::string& name, const Run& run) {
    constexpr std::size_t max_found = 8; // averaged fields and magnitudes take memory
    if (const auto found = found_.find(name); found != found_.end()) return found->second;
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

Result<void> GridView::pack(const std::string& field, const Run& run) {
    // The cache of fields is frame()'s: this thread finds its own.
    Result<PointField> contoured = find_field(grid_, field, {}, run);
    if (!contoured) return contoured.error();
    ContourOptions options;
    options.method = Method::clusters;
    options.source_cells = !grid_.cell_fields.empty();
    Result<Contour> contour = Contour::create({grid_, *std::move(contoured), {}, {}}, options);
    if (!contour) return contour.error();
    if (Result<void> ready = contour->prepare(run); !ready) return ready;
    packed_.contour = *std::move(contour);
    packed_.field = field;
    is_packed_.store(true, std::memory_order_release);
    return {};
}

Result<GridView::Source*> GridView::source_for(const ViewState& state, const Run& run) {
    const bool packed = is_packed_.load(std::memory_order_acquire);
    Source& source = packed ? packed_ : direct_;
    if (packed) direct_.contour.reset();
    if (source.contour && source.field == state.field && source.color_by == state.color_by) return &source;
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
    return &source;
}

Result<std::shared_ptr<const Mesh>> GridView::mesh_at(Source& source, double isovalue, const std::string& key,
                                                      const std::optional<ColorScale>& scale, FrameFacts& facts,
                                                      const Run& run) {
    if (const auto kept = std::ranges::find(kept_, key, &Kept::key); kept != kept_.end()) {
        kept->used = true;
        return kept->mesh;
    }
    const auto start = std::chrono::steady_clock::now();
    Result<ContourResult> extracted = source.contour->extract(isovalue, run);
    if (!extracted) return extracted.error();
    facts.extract_seconds += seconds_of(start);
    facts.method = name_of(extracted->method);
    facts.notes.insert(facts.notes.end(), extracted->notes.begin(), extracted->notes.end());
    const auto coding = std::chrono::steady_clock::now();
    const Surface& surface = extracted->surfaces.front().surface;
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

Result<Frame> GridView::frame(const ShowMessage& message, double wait_seconds, std::vector<std::string>& known,
                              const Run& run) {
    const ViewState& state = message.state;
    Result<std::optional<ColorScale>> scale = scale_of(state, run);
    if (!scale) return scale.error();
    Result<Source*> source = source_for(state, run);
    if (!source) return source.error();
    const std::uint64_t most = limit_of(message, options_);
    FrameFacts facts;
    facts.number = message.number;
    facts.wait_seconds = wait_seconds;
    facts.scale = *scale;
    for (Kept& kept : kept_) kept.used = false;
    std::vector<FrameSurface> surfaces;
    std::vector<std::shared_ptr<const Mesh>> meshes; // that `surfaces` points to
    std::vector<std::string> keys;
    for (std::size_t i = 0; i < state.isovalues.size(); ++i) {
        const std::string key = mesh_key(state, state.isovalues[i]);
        auto mesh = mesh_at(**source, state.isovalues[i], key, *scale, facts, run);
        if (!mesh) return mesh.error();
        FrameSurface surface{key, state.isovalues[i], color_of(state.isovalues, i, state.map), nullptr,
                             (*mesh)->triangle_count()};
        const bool has_it_in_full = holds(known, key);
        if (!has_it_in_full && surface.triangles > most && !(*mesh)->flat) {
            facts.preview = true;
            surface.key += fmt::format("|{}", most);
            if (!holds(known, surface.key)) {
                const auto coding = std::chrono::steady_clock::now();
                meshes.push_back(std::make_shared<const Mesh>(preview_of(**mesh, most)));
                facts.mesh_seconds += seconds_of(coding);
                surface.mesh = meshes.back().get();
            }
        } else if (!has_it_in_full) {
            meshes.push_back(*mesh);
            surface.mesh = meshes.back().get();
        }
        keys.push_back(surface.key);
        surfaces.push_back(std::move(surface));
    }
    std::erase_if(kept_, [](const Kept& kept) { return !kept.used; });
    if (facts.method.empty()) facts.method = name_of((*source)->contour->method());
    Frame frame{frame_bytes(facts, surfaces), facts.preview};
    known = std::move(keys);
    return frame;
}

Result<Chart> GridView::chart(const std::string& field, const Run& run) {
    const Result<PointField> found = field_of(field, run);
    if (!found) return found.error();
    return chart_of(grid_, *found, run);
}

} // namespace isotet::view
