// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/grid_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <isotet/boundary.hpp>
#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/memory.hpp>
#include <isotet/scene.hpp>

namespace isotet::view {

namespace {

Result<Surface> drawn_boundary(const Grid& grid, const Run& run) {
    const Result<DrawnGrid> drawn = grid_with_joined_points(grid, run);
    if (!drawn) return drawn.error();
    return boundary_of(drawn->grid, run);
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
    for (const ComponentGroup& group : component_groups(scalar_names(fields))) { // U:x, U:y, U:z have "U:" in common
        const std::string name = group.name + (group.name.ends_with(':') ? "mag" : ":mag");
        if (std::ranges::find(offered, name, &OfferedField::name) == offered.end())
            offered.push_back({name, association});
    }
}

bool same_values(const Array& a, const Array& b) {
    return a.type() == b.type() && a.size() == b.size() &&
           (a.data() == b.data() || std::memcmp(a.data(), b.data(), a.bytes()) == 0);
}

/// A checksum of what the cells hold.
std::uint64_t sum_of(const Cells& cells) {
    auto sum = static_cast<std::uint64_t>(cells.uniform_type);
    for (const Array* array : {&cells.connectivity, &cells.offsets, &cells.types, &cells.faces, &cells.face_offsets})
        sum = XXH3_64bits_withSeed(array->data(), array->bytes(), sum ^ static_cast<std::uint64_t>(array->type()));
    return sum;
}

/// Whether the boundary of both is the same.
bool same_cells(const Grid& a, const Grid& b) {
    const auto have_same = [&](auto... arrays) { return (same_values(a.cells.*arrays, b.cells.*arrays) && ...); };
    return same_values(a.points, b.points) && a.cells.uniform_type == b.cells.uniform_type &&
           have_same(&Cells::types, &Cells::offsets, &Cells::connectivity, &Cells::faces, &Cells::face_offsets);
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
    view->options_ = options;
    if (options.packed) grid.cell_fields = view->cell_fields_of_file(options.step);
    view->fields_ = offered_fields(grid);
    view->cell_count_ = grid.cells.count();
    view->grid_ = std::move(grid);
    view->step_ = options.step;
    if (options.read_step && options.steps > 1)
        view->steps_ = std::make_unique<StepReader>(options.read_step, options.threads);
    if (options.packed) view->open_packed();
    return view;
}

/// The cells that are here are a sample.
void GridView::open_packed() {
    cell_count_ = options_.cells;
    const std::uint64_t taken = std::max<std::uint64_t>(1, grid_.cells.count());
    sample_ = CellSample{{grid_.points, std::exchange(grid_.cells, {}), {}, {}},
                         static_cast<double>(options_.cells) / static_cast<double>(taken)};
    has_cells_ = false;
    lean_.emplace(*options_.packed);
    is_packed_.store(true, std::memory_order_release);
}

/// Without values: they are read when they are needed.
std::vector<Field> GridView::cell_fields_of_file(std::size_t step) const {
    std::map<std::string, Field> fields;
    for (const PackedCellFieldInfo& field : options_.packed->info().cell_fields)
        if (field.step <= step)
            fields.insert_or_assign(field.name,
                                    Field{field.name, Array(field.type, nullptr, 0, field.components, nullptr)});
    std::vector<Field> all;
    for (auto& [name, field] : fields) all.push_back(std::move(field));
    return all;
}

/// The cell field that colours surfaces, by the cells that they know as theirs; null: the field is none of cells.
Result<const Field*> GridView::cell_colors_at(const std::string& name, const Run& run) {
    const Field* const cells = cell_colors(grid_, name);
    if (!cells || !is_of_file() || !cells_.empty()) return cells;
    if (const auto known = file_cells_.find(name); known != file_cells_.end()) return &known->second;
    Result<Field> read = options_.packed->cell_field(name, step_, run);
    if (!read) return read.error();
    return &file_cells_.insert_or_assign(name, *std::move(read)).first->second;
}

Result<PointField> GridView::field_of(const std::string& name, const Run& run) {
    constexpr std::size_t max_found = 8; // averaged fields and magnitudes take memory
    if (const auto found = found_.find(name); found != found_.end()) return found->second;
    const auto offered = std::ranges::find(fields_, name, &OfferedField::name);
    const bool may_average = offered == fields_.end() || offered->association == Association::cell;
    if (may_average && !grid_.cell_fields.empty())
        if (Result<void> here = need_cells(run); !here) return here.error();
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
    if (const Field* cells = cell_colors(grid_, color_by)) {
        input.cell_fields = {*cells};
        return input;
    }
    Result<PointField> colors = field_of(color_by, run);
    if (!colors) return colors.error();
    input.point_fields = {{color_by, colors->values}};
    return input;
}

/// The field that colours as classes; null: it has none, or others are asked for.
Result<const ColorField*> GridView::classes_of(const ViewState& state, const Run& run) {
    if (state.volume || state.color_by.empty() || state.range || state.logarithmic) return nullptr;
    const Result<const Field*> colors = cell_colors_at(state.color_by, run);
    if (!colors) return colors.error();
    const Field* const cells = *colors;
    if (!cells) return nullptr;
    const std::string key = fmt::format("{}|{}", step_, state.color_by);
    if (!classes_ || classes_->key != key) {
        ColorOptions options;
        for (const RegionName& region : options_.regions)
            if (region.field == state.color_by) options.names[static_cast<double>(region.number)] = region.name;
        Grid of_cells = grid_;
        if (is_of_file()) {
            of_cells.cells = {};
            of_cells.cell_fields = {*cells};
        }
        Result<FoundColors> found = find_colors(of_cells, state.color_by, options, run);
        if (!found) return found.error();
        classes_ = Classes{key, {}, std::move(found->field)};
        if (!classes_->field.scale.classes.empty()) {
            const auto places = classes_->field.values.as<float>();
            cells->values.visit([&](auto numbers) {
                for (std::size_t i = 0; i < places.size(); ++i)
                    if (!std::isnan(places[i])) classes_->places.emplace(static_cast<double>(numbers[i]), places[i]);
            });
        }
    }
    return classes_->field.scale.classes.empty() ? nullptr : &classes_->field;
}

/// What colours a surface that carries numbers of the field.
Array GridView::places_in_classes(const Array& numbers) const {
    std::vector<float> places(numbers.size(), NAN);
    numbers.visit([&](auto values) {
        for (std::size_t i = 0; i < places.size(); ++i)
            if (const auto number = static_cast<double>(values[i]); !std::isnan(number)) // a map would find one for it
                if (const auto place = classes_->places.find(number); place != classes_->places.end())
                    places[i] = place->second;
    });
    return Array::own(std::move(places));
}

Result<std::optional<ColorScale>> GridView::scale_of(const ViewState& state, const Run& run) {
    const std::string& name = state.volume ? state.field : state.color_by;
    if (name.empty()) return std::optional<ColorScale>();
    if (state.volume && !state.color_by.empty() && state.color_by != name)
        return Error{
            ErrorCode::invalid_argument,
            fmt::format("colours are those of '{}', but the volume is one of '{}', and a picture has one colour "
                        "scale",
                        state.color_by, name)};
    Array values;
    const Result<const ColorField*> classes = classes_of(state, run);
    if (!classes) return classes.error();
    if (*classes) return std::optional((*classes)->scale);
    const Result<const Field*> cells = state.volume ? Result<const Field*>(nullptr) : cell_colors_at(name, run);
    if (!cells) return cells.error();
    if (*cells) values = (*cells)->values;
    else {
        const Result<PointField> field = field_of(name, run);
        if (!field) return field.error();
        values = field->values;
    }
    ColorOptions options;
    options.scale.map = state.map;
    options.scale.logarithmic = state.logarithmic;
    options.range = state.range;
    const Result<ColorScale> scale = color_scale({&values, 1}, options, run);
    if (!scale) return scale.error();
    return std::optional(*scale);
}

/// With all of its cells, unless it is of a file and has none.
Result<Grid> GridView::grid_of_step(std::optional<std::uint64_t> wanted, const Run& run) {
    Grid now = grid_;
    if (all_cells_) now.cells = *all_cells_;
    if (!wanted || *wanted == step_) return now;
    if (!steps_ || *wanted >= options_.steps)
        return Error{ErrorCode::invalid_argument,
                     fmt::format("step {} is asked for, but the file has steps 0 to {}", *wanted, options_.steps - 1)};
    Result<Grid> grid = steps_->take(*wanted, run);
    if (grid && is_of_file()) {
        grid->cells = now.cells; // all steps have the same
        grid->cell_fields = cell_fields_of_file(*wanted);
    }
    return grid;
}

/// Another step, or its cells, take the place of the grid; the sessions find out what is the same.
Result<void> GridView::show_grid(std::optional<std::uint64_t> wanted, const std::vector<std::string>& cells,
                                 const Run& run) {
    const bool other_cells = options_.only_cells && cells != cells_;
    if ((!wanted || *wanted == step_) && !other_cells) return {};
    const std::vector<std::string>& chosen = options_.only_cells ? cells : cells_;
    if (!chosen.empty())
        if (Result<void> here = need_cells(run); !here) return here;
    Result<Grid> grid = grid_of_step(wanted, run);
    if (!grid) return grid.error();
    if (is_of_file() && !grid->cell_fields.empty() && wanted && *wanted != step_) { // fields of another step
        if (chosen.empty()) grid->cells = {};
        else {
            Result<Grid> there = options_.read_cells(*wanted, run);
            if (!there) return there.error();
            grid->cell_fields = std::move(there->cell_fields);
        }
    }
    Cells all = grid->cells;
    if (!chosen.empty()) {
        grid = options_.only_cells(*std::move(grid), chosen);
        if (!grid) return grid.error();
    }
    const bool all_same = is_of_file() && chosen.empty() && cells_.empty() &&
                          same_points(options_.packed->info(), step_, wanted.value_or(step_));
    const bool same = all_same || same_cells(*grid, grid_);
    {
        const std::lock_guard lock(grid_mutex_);
        grid_ = *std::move(grid);
        all_cells_ = chosen.empty() ? std::nullopt : std::optional(std::move(all));
        if (step_ != wanted.value_or(step_)) file_cells_.clear();
        step_ = wanted.value_or(step_);
        if (is_of_file()) has_cells_ = grid_.cells.count() > 0;
        if (!same) ++grid_number_;
    }
    if (other_cells) {
        cells_ = cells;
        chosen_.contour.reset();
        solids_.reset();
        scene_.reset();
        spectrum_.reset();
    }
    found_.clear();
    if (!same) return find_boundary(run);
    return {};
}

/// Whether a choice is right, and what it leaves out is all.
bool GridView::leaves_no_cell(std::optional<std::uint64_t> wanted, const std::vector<std::string>& cells,
                              const Run& run) {
    if (!options_.only_cells || cells.empty()) return false;
    const Result<Grid> grid = grid_of_step(wanted, run);
    if (!grid) return false;
    std::vector<std::string> shown;
    for (const std::string& choice : cells)
        if (!choice.starts_with('!')) shown.push_back(choice);
        else if (!options_.only_cells(*grid, {choice.substr(1)})) return false;
    if (shown.size() == cells.size() || !(shown.empty() || options_.only_cells(*grid, shown))) return false;
    const auto left = options_.only_cells(*grid, cells);
    return !left && left.error().code == ErrorCode::invalid_argument;
}

void GridView::read_ahead(const ShowMessage& message) {
    if (steps_ && message.next && *message.next < options_.steps && *message.next != step_)
        steps_->read_ahead(*message.next);
}

/// The step and its field; the range of its values where the file has several steps.
Result<void> GridView::tell_field(const std::string& field, FrameFacts& facts, const Run& run) {
    facts.step = step_;
    facts.field = field;
    std::string key = fmt::format("{}|{}", step_, field);
    if (key == range_key_) facts.range = range_;
    if (!steps_ || key == range_key_) return {};
    const Result<PointField> found = field_of(field, run);
    if (!found) return found.error();
    const auto statistics = statistics_of(found->values, run);
    if (!statistics) return statistics.error();
    range_.reset();
    if (!statistics->empty() && statistics->front().lower <= statistics->front().upper)
        range_ = ValueRange{statistics->front().lower, statistics->front().upper};
    range_key_ = std::move(key);
    facts.range = range_;
    return {};
}

/// The session of all cells; with `field` where there is none yet.
Result<std::shared_ptr<Contour>> GridView::session_to_pack(const Grid& grid, const std::string& field, std::size_t step,
                                                           const std::vector<double>& isovalues, const Run& run) {
    const std::lock_guard lock(session_mutex_);
    if (session_.contour) return session_.contour;
    Result<PointField> contoured = find_field(grid, field, {}, run);
    if (!contoured) return contoured.error();
    if (auto set = set_source(session_, {grid, *std::move(contoured), {}, {}}, isovalues, run); !set)
        return set.error();
    session_.field = field;
    session_.color_by.clear();
    session_.step = step;
    return session_.contour;
}

Result<void> GridView::pack(const std::string& field, const Run& run, const std::vector<double>& isovalues) {
    if (is_of_file()) return {};
    // The cache of fields is frame()'s: this thread finds its own, in a copy that shares the arrays.
    std::unique_lock lock(grid_mutex_);
    Grid grid = grid_;
    const std::size_t step = step_;
    if (all_cells_) grid.cells = *all_cells_;
    lock.unlock();
    if (has_only_flat_cells(grid.cells)) return {};
    const auto session = session_to_pack(grid, field, step, isovalues, run);
    if (!session) return session.error();
    std::optional<PackedGrid> packed;
    while (!packed) { // another field may come in between
        if (Result<void> ready = (*session)->prepare(run); !ready) return ready;
        packed = (*session)->packed();
    }
    if (may_release_cells(grid)) {
        Result<PointField> contoured = find_field(grid, packed->field().name, {}, run);
        if (!contoured) return contoured.error();
        lean_.emplace(*packed, *std::move(contoured), options_.engine);
    }
    is_packed_.store(true, std::memory_order_release);
    return {};
}

Result<void> GridView::take_packed(const PackedGrid& packed, const std::string& field, const Run& run) {
    Result<PointField> contoured = field_of(field, run);
    if (!contoured) return contoured.error();
    lean_.emplace(packed, *std::move(contoured), options_.engine);
    is_packed_.store(true, std::memory_order_release);
    return {};
}

Result<void> GridView::find_boundary(const Run& run) {
    std::unique_lock lock(grid_mutex_);
    const Grid grid = grid_;
    const std::uint64_t number = grid_number_;
    const std::size_t step = step_;
    const bool all = !all_cells_;
    lock.unlock();
    Result<Surface> boundary =
        is_of_file() && all ? PackedSource(*options_.packed).boundary(step, run) : drawn_boundary(grid, run);
    if (!boundary) return boundary.error();
    Result<Mesh> mesh = mesh_of(*boundary, nullptr, run);
    if (!mesh) return mesh.error();
    lock.lock();
    if (number != grid_number_) return {}; // another step came meanwhile, and finds its own
    const std::lock_guard boundary_lock(boundary_mutex_);
    boundary_ = std::make_shared<const Mesh>(*std::move(mesh));
    boundary_surface_ = std::make_shared<const Surface>(*std::move(boundary));
    boundary_grid_ = number;
    ++boundary_number_;
    return {};
}

bool GridView::may_release_cells(const Grid& grid) const {
    return options_.steps == 1 && options_.read_step && !has_cells_to_linearize(grid.cells);
}

/// Reads the file again where the cells were released.
Result<void> GridView::need_cells(const Run& run) {
    if (has_cells_) return {};
    Result<Grid> again = (is_of_file() ? options_.read_cells : options_.read_step)(step_, run);
    if (!again) return again.error();
    const bool first = is_of_file() && !cells_sum_;
    if (!same_values(again->points, grid_.points) || (!first && sum_of(again->cells) != *cells_sum_))
        return Error{ErrorCode::invalid_data,
                     "the file has changed since it was read: it has other points or cells now, "
                     "so what needs its cells cannot be shown. Start isotet view again"};
    const std::lock_guard lock(grid_mutex_);
    grid_.cells = std::move(again->cells);
    if (is_of_file()) grid_.cell_fields = std::move(again->cell_fields);
    has_cells_ = true;
    return {};
}

void GridView::rest() {
    if (uses_packed() && lean_ && has_cells_ && !solids_) {
        if (!sample_) sample_ = sample_of_cells(grid_);
        if (!cells_sum_) cells_sum_ = sum_of(grid_.cells);
        session_.contour.reset();
        const std::lock_guard lock(grid_mutex_);
        grid_.cells = {};
        if (is_of_file()) grid_.cell_fields = cell_fields_of_file(step_);
        has_cells_ = false;
    }
    release_memory();
}

/// The field that colours, as surfaces carry it.
Result<ExtractOptions> GridView::carried_fields(const std::string& color_by, const Run& run) {
    ExtractOptions options;
    if (color_by.empty()) return options;
    const Result<const Field*> cells = cell_colors_at(color_by, run);
    if (!cells) return cells.error();
    if (*cells) {
        options.cell_fields = {**cells};
        return options;
    }
    const Result<PointField> colors = field_of(color_by, run);
    if (!colors) return colors.error();
    options.point_fields = {{color_by, colors->values}};
    return options;
}

Result<void> GridView::set_source(Source& source, ContourInput input, const std::vector<double>& isovalues,
                                  const Run& run) {
    ContourOptions options;
    options.engine = options_.engine;
    options.extract_while_packing = true;
    options.source_cells = !input.grid.cell_fields.empty() || may_release_cells(input.grid); // for colours and picks
    options.expected_isovalues = isovalues; // making all polyhedra linear takes longer than these surfaces
    options.surfaces = isovalues.size();
    const std::uint64_t cells = input.grid.cells.count();
    if (source.contour) {
        const Result<ContourUpdate> update = source.contour->set(std::move(input), options, run);
        if (!update) return update.error();
    } else {
        Result<Contour> contour = Contour::create(std::move(input), options, run);
        if (!contour) return contour.error();
        source.contour = std::make_shared<Contour>(*std::move(contour));
    }
    const auto linear = source.contour->linear_grid();
    source.isovalues = linear && linear->grid.cells.count() < cells ? isovalues : std::vector<double>();
    return {};
}

Result<GridView::Source*> GridView::source_for(const ViewState& state, const Run& run) {
    std::unique_lock lock(session_mutex_, std::defer_lock);
    if (cells_.empty() && !uses_packed()) lock.lock();
    Source& source = cells_.empty() ? session_ : chosen_;
    const bool is_for_these = source.isovalues.empty() || source.isovalues == state.isovalues;
    if (source.contour && source.field == state.field && source.color_by == state.color_by && source.step == step_ &&
        is_for_these)
        return &source;
    Result<ContourInput> input = input_of(state.field, state.color_by, run);
    if (!input) return input.error();
    if (auto set = set_source(source, *std::move(input), state.isovalues, run); !set) return set.error();
    source.field = state.field;
    source.color_by = state.color_by;
    source.step = step_;
    return &source;
}

Result<Chart> GridView::chart(const std::string& field, std::optional<std::uint64_t> step, const Run& run,
                              const std::vector<std::string>& cells) {
    if (Result<void> there = show_grid(step, cells, run); !there) {
        if (leaves_no_cell(step, cells, run)) return Chart{};
        return there.error();
    }
    const Result<PointField> found = field_of(field, run);
    if (!found) return found.error();
    if (uses_packed() && has_cells_to_linearize(grid_.cells)) { // the linear ones are known
        ViewState state;
        state.field = field;
        state.color_by = session_.color_by;
        const Result<Source*> source = source_for(state, run);
        if (!source) return source.error();
        const auto expected = [&](double isovalue) {
            const auto prediction = (*source)->contour->predict(isovalue);
            return prediction ? prediction->triangles : 0;
        };
        return chart_of(found->values, expected, run);
    }
    if (has_cells_) return chart_of(grid_, *found, run);
    Result<Chart> chart = chart_of(sample_->grid, *found, run);
    if (chart)
        for (double& triangles : chart->triangles) triangles *= sample_->cells_each;
    return chart;
}

Result<ContourSpectrum> GridView::spectrum(const std::string& field, std::optional<std::uint64_t> step, const Run& run,
                                           const std::vector<std::string>& cells) {
    constexpr std::uint64_t steps = 256;
    if (Result<void> there = show_grid(step, cells, run); !there) return there.error();
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
