// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/grid_source.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/contour.hpp>
#include <isotet/fields.hpp>
#include <isotet/first_view.hpp>
#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/jobs/many_files.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/slice.hpp>

#include "grid/orientation.hpp"
#include "grid/points/coincident_points.hpp"
#include "jobs/block_field.hpp"
#include "jobs/cell_choice.hpp"
#include "base/parallel.hpp"
#include "jobs/refuse.hpp"
#include "jobs/room_for_grid.hpp"
#include "jobs/step_choice.hpp"

namespace isotet::jobs {

namespace {

constexpr std::string_view made_prefix = "make:";

FileInfo info_of(const MakeOptions& made) {
    FileInfo info;
    info.format = "make";
    for (const std::string& name : made.fields) {
        const ScalarType type = name == "integer" ? ScalarType::int32 : ScalarType::float32;
        info.fields.push_back({name, Association::point, type, 1});
    }
    return info;
}

/// Its triangles as cells.
Grid grid_of(const Surface& surface) {
    Grid grid;
    grid.points = surface.positions;
    grid.cells.connectivity = surface.triangles.visit([]<class Number>(std::span<const Number> corners) {
        return Array::own(std::vector(corners.begin(), corners.end()));
    });
    constexpr std::uint8_t triangle = 5;
    std::vector<std::uint64_t> offsets(surface.triangle_count() + 1);
    for (std::size_t i = 0; i < offsets.size(); ++i) offsets[i] = 3 * i;
    grid.cells.offsets = Array::own(std::move(offsets));
    grid.cells.types = Array::own(std::vector<std::uint8_t>(surface.triangle_count(), triangle));
    grid.point_fields = surface.point_fields;
    grid.cell_fields = surface.cell_fields;
    return grid;
}

FileInfo info_of(const SurfaceFile& file, const Grid& grid, const std::string& path) {
    FileInfo info;
    info.format = file.format;
    info.cells = grid.cells.count();
    info.files = {path};
    info.fields = describe_fields(grid);
    return info;
}

/// `gap`   that it must span
std::string tolerance_of_rounding(const Array& points, double gap, const Run& run) {
    const double spanning = gap > 0 ? std::pow(10.0, std::ceil(std::log10(gap))) : 0;
    const double tolerance = std::max(rounding_of(points, run), spanning);
    return tolerance > 0 ? fmt::format("1e{}", std::lround(std::log10(tolerance))) : "0";
}

std::string coincident_points_note(const Grid& grid, const Run& run) {
    const core::DoubledPoints found = core::estimate_doubled_points(grid, run);
    if (found.points == 0) return {};
    const char* const ending = found.points == 1 ? "s" : "";
    return fmt::format("{}{} {} other points: the surface has seams there; `merge_points` {} joins them",
                       found.estimated ? "about " : "", counted(found.points, "point"),
                       found.gap > 0 ? fmt::format("lie{} up to {:.2g} beside", ending, found.gap)
                                     : fmt::format("coincide{} with", ending),
                       tolerance_of_rounding(grid.points, found.gap, run));
}

/// What is said of fields whose values differ at merged points; empty where none does.
std::string jumps_note(const MergedPoints& merged, MergedValues values) {
    std::string list;
    for (const FieldJump& jump : merged.jumps)
        if (jump.largest > 0)
            list += fmt::format("{}'{}' by up to {}", list.empty() ? "" : ", ", jump.field, shortest(jump.largest));
    if (list.empty()) return {};
    return fmt::format("values of merged points differ: {}; {}", list,
                       values == MergedValues::mean
                           ? "they have the mean"
                           : "they have that of the lowest number, `merge_values` mean takes means");
}

/// Merges points, and notes what that did.
Result<Grid> merged(const Grid& grid, const MergeOptions& options, Caller& caller, const Run& run) {
    Result<MergedPoints> result = merge_points(grid, options, run);
    if (!result && result.error().code == ErrorCode::invalid_argument)
        return Error{result.error().code, "`merge_points`: " + result.error().message};
    if (!result) return result.error();
    caller.note(fmt::format("{} merged with others",
                            result->merged == 1 ? "1 point was" : grouped(result->merged) + " points were"));
    if (result->collapsed_cells > 0)
        caller.note(fmt::format("`merge_points` {} is longer than edges of {}, which collapse: there the surface is "
                                "not that of the grid",
                                shortest(options.tolerance), counted(result->collapsed_cells, "cell")));
    caller.note(jumps_note(*result, options.values));
    return std::move(result->grid);
}

/// Whether values at hanging points differ from those of the larger cells by more than roundings.
bool is_apart(double difference, const Array& values, const Array& hanging) {
    constexpr double rounding = 1e-5; // of the largest value there
    double largest = 0;
    for (const std::uint64_t point : hanging.as<std::uint64_t>())
        for (std::size_t c = 0; c < values.components(); ++c)
            if (const double value = std::abs(values.at(point, c)); std::isfinite(value))
                largest = std::max(largest, value);
    return difference > rounding * largest;
}

/// Gives hanging points the values of the larger cells where these are asked for, and says how they differ.
Result<void> choose_hanging_values(ClosedGrid& closed, HangingChoice choice, Caller& caller, const Run& run) {
    std::string list;
    for (Field& field : closed.grid.point_fields) {
        const Result<double> largest = closed.largest_difference(field.values, run);
        if (!largest) return largest.error();
        if (!is_apart(*largest, field.values, closed.points)) continue;
        list += fmt::format("{}'{}' by up to {:.3g}", list.empty() ? "" : ", ", field.name, *largest);
        if (choice != HangingChoice::interpolate) continue;
        Result<Array> values = closed.interpolated(field.values, run);
        if (!values) return values.error();
        field.values = *std::move(values);
    }
    if (!list.empty())
        caller.note(fmt::format("values at hanging points differ from those of the larger cells: {}; {}", list,
                                choice == HangingChoice::interpolate
                                    ? "they have those of the larger cells"
                                    : "they have their own, `hanging_points` interpolate takes those of the cells"));
    return {};
}

/// Cells list their hanging points, and what was found is noted.
/// `known`   of steps before, or null
Result<Grid> closed(Grid grid, HangingChoice choice, KnownClosing* known, Caller& caller, const Run& run) {
    if (choice == HangingChoice::not_sought) return grid;
    Result<ClosedGrid> found = known ? known->of(grid, run) : close_hanging_points(grid, run);
    if (!found) return found.error();
    if (choice == HangingChoice::leave) {
        if (found->report.points > 0)
            caller.note(
                fmt::format("{} on faces or edges of larger cells: surfaces have open edges along {} there, and solids "
                            "walls, as `hanging_points` leave asks; `hanging_points` close joins the cells",
                            counted(found->report.points, "point") + (found->report.points == 1 ? " hangs" : " hang"),
                            counted(found->report.faces, "face")));
        return grid;
    }
    caller.notes(found->report.notes());
    if (found->report.points > 0)
        if (auto chosen = choose_hanging_values(*found, choice, caller, run); !chosen) return chosen.error();
    return std::move(found->grid);
}

ReadOptions read_options_of(const GridOptions& options) {
    ReadOptions read;
    read.format = options.format;
    read.merge_pieces_by_coordinates = !options.keep_pieces;
    read.allow_outside = options.allow_outside;
    read.patches = options.patches;
    read.displace = options.displace;
    read.blocks = options.blocks;
    read.more_files = options.more_files;
    read.step = options.step;
    return read;
}

} // namespace

FileKinds kinds_of(const std::string& file) {
    if (file.starts_with(made_prefix)) return {true, false};
    const std::string ending = ending_of(file);
    FileKinds kinds;
    for (const Format& format : formats()) {
        if (std::ranges::find(format.extensions, ending) == format.extensions.end()) continue;
        kinds.grid = kinds.grid || format.reads_grid;
        kinds.surface = kinds.surface || format.reads_surface;
    }
    return kinds;
}

std::string quoted_list(const std::vector<std::string>& names) {
    constexpr std::size_t max_shown = 12;
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), max_shown); ++i)
        list += fmt::format("{}'{}'", i ? ", " : "", names[i]);
    if (names.size() > max_shown) list += fmt::format(" and {} more", names.size() - max_shown);
    return list;
}

/// Files whose names differ in more than numbers are steps where they have a field in common, or none at all.
Result<void> check_steps(const GridOptions& options, ReadOptions read_options, const Run& run) {
    if (options.more_files.empty() || are_time_steps(options)) return {};
    read_options.more_files.clear();
    read_options.step.reset();
    std::set<std::string> names;
    for (const GridOptions& one : each_file(options)) {
        const Result<FileInfo> info = inspect(one.file, read_options, run);
        if (!info) return info.error();
        const auto is_known = [&](const FieldInfo& field) { return names.contains(field.name); };
        if (!names.empty() && !info->fields.empty() && std::ranges::none_of(info->fields, is_known))
            return refusal(
                "'{}' and '{}' have no field in common: they are different grids, no time steps of one. Give one "
                "after another, or, for surfaces, {{name}} in the name of the output",
                options.file, one.file);
        for (const FieldInfo& field : info->fields) names.insert(field.name);
    }
    return {};
}

Result<void> GridSource::open_made(const GridOptions& options) {
    if (!options.more_files.empty())
        return refusal("'{}' would be a further time step, but '{}' is made", options.more_files.front(), options.file);
    if (!options.blocks.empty())
        return Error{ErrorCode::invalid_argument,
                     fmt::format("`block` {}: a made grid has no blocks", options.blocks.front())};
    Result<MakeOptions> made = parse_make(std::string_view(options.file).substr(made_prefix.size()));
    if (!made) return made.error();
    info_ = info_of(*made);
    info_.files = options.other_inputs;
    made_ = *std::move(made);
    return take_choices();
}

Result<GridSource> GridSource::open(const GridOptions& options, Caller& caller) {
    GridSource source;
    source.options_ = options;
    if (options.file.starts_with(made_prefix)) {
        if (auto made = source.open_made(options); !made) return made.error();
        return source;
    }
    ReadOptions& read_options = source.read_options_ = read_options_of(options);
    if (!options.heads) read_options.kept = keep_files();
    if (auto steps = check_steps(options, read_options, caller.run()); !steps) return steps.error();
    if (options.time && !options.blocks.empty()) { // which may be in that step alone
        ReadOptions whole = read_options;
        whole.blocks.clear();
        if (const Result<FileInfo> all = inspect(options.file, whole, caller.run()); all && all->times.size() > 1)
            if (const Result<std::size_t> step = step_at(all->times, *options.time)) read_options.step = *step;
    }
    if (!options.heads && !read_options.step) read_options.step = 0; // else some formats tell of all
    Result<FileInfo> info = inspect(options.file, read_options, caller.run());
    if (!info && options.step) { // choose_steps() refuses a step that is not there
        read_options.step = 0;
        info = inspect(options.file, read_options, caller.run());
    }
    source.described_ = read_options.step.value_or(0);
    read_options.step.reset();
    if (!info && !options.step) {
        info = source.inspect_later(info.error(), caller);
        source.described_ = source.first_step_;
    }
    if (info && !options.heads) source.step_fields_[*source.described_] = info->fields;
    if (!info) {
        const FileKinds kinds = kinds_of(options.file);
        if (info.error().code != ErrorCode::file || !kinds.surface || kinds.grid || !options.format.empty() ||
            !std::filesystem::exists(options.file))
            return info.error();
        Result<SurfaceFile> surface = read_surface(options.file, {}, caller.run());
        if (!surface) return surface.error();
        source.surface_ = std::make_shared<const Grid>(grid_of(surface->surface));
        info = info_of(*surface, *source.surface_, options.file);
        caller.notes(surface->notes);
    }
    source.info_ = *std::move(info);
    source.info_.files.insert(source.info_.files.end(), options.other_inputs.begin(), options.other_inputs.end());
    source.knows_blocks_ = options.blocks.empty() && options.more_files.empty() && has_block_field(source.info_);
    if (options.time && source.info_.times.size() > 1)
        if (const Result<std::size_t> step = step_at(source.info_.times, *options.time))
            if (auto looked = source.look_at(*step, caller.run()); !looked) return looked.error();
    const bool any_step = source.info_.times.size() > 1 && !options.time && !options.step; // another may have the field
    if (!options.displace.empty() && !any_step &&
        !match_field_name(options.displace, source.names(Association::point))) {
        Error error = source.no_such_field(options.displace);
        error.message = "`displace` takes a point field: " + error.message;
        return error;
    }
    if (auto taken = source.take_choices(); !taken) {
        if (!any_step) return taken.error();
        if (auto found = source.find_choices(caller); !found) return found.error();
    }
    return source;
}

/// Goes on to the first step that has the fields that cells are chosen by.
Result<void> GridSource::find_choices(Caller& caller) {
    const std::size_t count = info_.times.size();
    const auto has_them = [&](std::size_t step) -> Result<bool> {
        if (caller.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
        if (auto looked = look_at(step, caller.run()); !looked) {
            if (looked.error().code == ErrorCode::cancelled || looked.error().code == ErrorCode::out_of_memory)
                return looked.error();
            return false;
        }
        return static_cast<bool>(take_choices());
    };
    const auto found = first_step_with(first_step_, count, has_them);
    if (!found) return found.error();
    if (*found) {
        if (**found != first_step_) why_first_ = ", what is chosen is not in those before";
        first_step_ = **found;
        return {};
    }
    std::vector<std::size_t> all = steps_to_look_at(first_step_, count);
    all.insert(all.begin(), first_step_);
    if (auto looked = look_at_steps(all, caller); !looked) return looked;
    return take_choices();
}

/// What the file holds at the first step that has the chosen blocks; nothing where none has.
std::optional<FileInfo> GridSource::inspect_first_with_blocks(Caller& caller) {
    ReadOptions whole = read_options_, chosen = read_options_;
    whole.blocks.clear();
    const Result<FileInfo> all = inspect(options_.file, whole, caller.run());
    for (std::size_t step = 1; all && step < all->times.size() && !caller.cancelled(); ++step) {
        chosen.step = step;
        Result<FileInfo> info = inspect(options_.file, chosen, caller.run());
        if (!info) continue;
        first_step_ = step;
        why_first_ = ", what is chosen is not in those before";
        return *std::move(info);
    }
    return std::nullopt;
}

/// What a series holds at the first step that can be read; nothing where none can. Another step of one broken file fails
/// for the same reason.
std::optional<FileInfo> GridSource::inspect_first_sound(const Error& error, Caller& caller) {
    constexpr std::size_t most = 1000;
    ReadOptions later = read_options_;
    std::string last = error.message;
    for (std::size_t step = 1; step < most && !caller.cancelled(); ++step) {
        later.step = step;
        Result<FileInfo> info = inspect(options_.file, later, caller.run());
        if (info) {
            if (step >= info->times.size()) return std::nullopt; // what has no steps takes any
            first_step_ = step;
            why_first_ = fmt::format(", step 0 cannot be read ({})", error.message);
            return *std::move(info);
        }
        if (info.error().code == ErrorCode::invalid_argument || info.error().message == last) return std::nullopt;
        last = info.error().message;
    }
    return std::nullopt;
}

/// What the file holds at a later step than the first, which fails.
Result<FileInfo> GridSource::inspect_later(const Error& error, Caller& caller) {
    std::optional<FileInfo> info;
    std::error_code none;
    if (!options_.blocks.empty() && error.code == ErrorCode::invalid_argument) info = inspect_first_with_blocks(caller);
    else if ((error.code == ErrorCode::file || error.code == ErrorCode::invalid_data) &&
             std::filesystem::is_regular_file(options_.file, none))
        info = inspect_first_sound(error, caller);
    if (caller.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
    if (!info) return error;
    return *std::move(info);
}

bool GridSource::lacks_blocks(std::size_t step, const Run& run) const {
    if (options_.blocks.empty()) return false;
    ReadOptions options = read_options_;
    options.step = step;
    const Result<FileInfo> info = inspect(options_.file, options, run);
    if (info || info.error().code != ErrorCode::invalid_argument) return false;
    options.blocks.clear();
    return static_cast<bool>(inspect(options_.file, options, run));
}

bool GridSource::lacks_fields_of_choices(std::size_t step, const Run& run) const {
    if (!choices_) return false;
    ReadOptions options = read_options_;
    options.step = step;
    const Result<FileInfo> info = inspect(options_.file, options, run);
    return info && std::ranges::any_of(*choices_, [&](const CellChoice& choice) {
               return !(knows_blocks_ && choice.field == block_field_name) &&
                      std::ranges::none_of(info->fields, [&](const FieldInfo& field) {
                          return field.association == Association::cell && field.name == choice.field;
                      });
           });
}

Result<std::vector<std::size_t>> GridSource::choose_steps(Steps steps, Caller& caller) const {
    const std::string chosen_parts = fmt::format(
        "{}{}{}", options_.blocks.empty() ? "" : "the blocks " + quoted_list(options_.blocks),
        !options_.blocks.empty() && choices_ ? " and " : "", choices_ ? "the cells " + text_of(*choices_) : "");
    const std::size_t count = info_.times.size();
    if (steps == Steps::one && first_step_ > 0 && !options_.step && !options_.time) {
        caller.note(note_of_step(info_.times, first_step_, why_first_));
        return std::vector<std::size_t>{first_step_};
    }
    auto chosen = jobs::choose_steps(info_, options_, steps, caller);
    if (!chosen || steps == Steps::one || count < 2 || chosen_parts.empty()) return chosen;
    std::vector<std::size_t> without;
    for (const std::size_t step : *chosen) {
        if (caller.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
        if (lacks_blocks(step, caller.run()) || lacks_fields_of_choices(step, caller.run())) without.push_back(step);
    }
    if (without.empty()) return chosen;
    caller.note(fmt::format("{} of the {} time steps {} not have {} and {} skipped: {}", without.size(), count,
                            without.size() == 1 ? "does" : "do", chosen_parts, without.size() == 1 ? "is" : "are",
                            fmt::join(without, ", ")));
    std::erase_if(*chosen, [&](std::size_t step) { return std::ranges::binary_search(without, step); });
    return chosen;
}

Result<void> GridSource::take_choices() {
    if (options_.cells.empty()) return {};
    Result<std::vector<CellChoice>> choices = parse_cell_choices(options_.cells, cell_names());
    if (!choices) return choices.error();
    if (const auto regions = region_names(); !regions.empty())
        if (auto checked = check_cell_choices(*choices, regions); !checked) return checked.error();
    choices_ = std::make_shared<const std::vector<CellChoice>>(*std::move(choices));
    return {};
}

Result<void> GridSource::look_at(std::size_t step, const Run& run) {
    ReadOptions options = read_options_;
    options.step = step;
    Result<FileInfo> info = inspect(options_.file, options, run);
    if (!info) return info.error();
    step_fields_[step] = info->fields;
    info->times = std::move(info_.times);
    for (const std::string& file : info_.files)
        if (std::ranges::find(info->files, file) == info->files.end()) info->files.push_back(file);
    info_ = *std::move(info);
    described_ = step;
    return {};
}

Result<void> GridSource::look_at_steps(const std::vector<std::size_t>& steps, Caller& caller) {
    if (made_ || surface_ || info_.times.size() < 2) return {};
    if (steps.size() == 1 && described_ == steps.front() && step_fields_.contains(steps.front())) return {};
    if (steps.size() > 1) closing_ = std::make_shared<KnownClosing>();
    std::vector<FieldInfo> fields;
    std::vector<LeftOut> left_out;
    broken_.clear();
    for (const std::size_t step : steps) {
        if (caller.cancelled()) return Error{ErrorCode::cancelled, "interrupted"};
        if (auto looked = look_at(step, caller.run()); !looked) { // it may have all fields: reading it tells
            if (auto kept = keep_broken(step, looked.error(), steps.size(), broken_); !kept) return kept;
            continue;
        }
        for (const FieldInfo& field : info_.fields)
            if (std::ranges::none_of(fields, [&](const FieldInfo& known) {
                    return known.name == field.name && known.association == field.association;
                }))
                fields.push_back(field);
        left_out.insert(left_out.end(), info_.left_out.begin(), info_.left_out.end());
    }
    info_.fields = std::move(fields);
    info_.left_out = std::move(left_out);
    if (steps.size() > 1) described_.reset();
    return {};
}

bool GridSource::has_field(std::size_t step, const std::string& name) const {
    const auto looked = step_fields_.find(step);
    if (looked == step_fields_.end() || name == "x" || name == "y" || name == "z") return true;
    if (knows_blocks_ && name == block_field_name) return true;
    std::vector<std::string> names;
    for (const FieldInfo& field : looked->second) names.push_back(field.name);
    return match_field_name(name, names).has_value() || needs_of_expression(name, names);
}

Error GridSource::no_such_field(const std::string& name) const {
    for (const LeftOut& item : info_.left_out)
        if (item.name == name && item.what.ends_with("field"))
            return {ErrorCode::invalid_data, fmt::format("{} '{}' cannot be read: {}", item.what, name, item.reason)};
    std::vector<std::string> all;
    for (const FieldInfo& field : info_.fields)
        if (std::ranges::find(all, field.name) == all.end()) all.push_back(field.name);
    if (!options_.blocks.empty() && std::ranges::find(all, name) != all.end())
        return {ErrorCode::invalid_argument, fmt::format("the field '{}' is in no block that was chosen", name)};
    const std::size_t colon = std::min(name.rfind(':'), name.size());
    if (const auto field = std::ranges::find(info_.fields, name.substr(0, colon), &FieldInfo::name);
        colon < name.size() && field != info_.fields.end())
        return {ErrorCode::invalid_argument,
                fmt::format("field '{}' has no component '{}': components are {}, mag, or numbers from 0", field->name,
                            name.substr(colon + 1),
                            field->components == 6   ? "xx, yy, zz, xy, yz, xz"
                            : field->components == 9 ? "xx, xy, xz, yx, yy, yz, zx, zy, zz"
                                                     : "x, y, z")};
    return {ErrorCode::invalid_argument,
            fmt::format("there is no field '{}': the grid has {}", name,
                        all.empty() ? "none; x, y and z are its coordinates" : quoted_list(nearest_first(name, all)))};
}

std::vector<std::string> GridSource::names(Association association) const {
    std::vector<std::string> names;
    for (const FieldInfo& field : info_.fields) {
        if (field.association == association) names.push_back(field.name);
    }
    return names;
}

std::vector<std::string> GridSource::cell_names() const {
    std::vector<std::string> all = names(Association::cell);
    if (knows_blocks_) all.emplace_back(block_field_name);
    return all;
}

std::vector<RegionName> GridSource::region_names() const {
    std::vector<RegionName> all = info_.regions;
    if (!knows_blocks_) return all;
    std::vector<RegionName> blocks = names_of_blocks(info_);
    all.insert(all.end(), std::make_move_iterator(blocks.begin()), std::make_move_iterator(blocks.end()));
    return all;
}

/// Whether the numbers of blocks are asked for by name.
bool GridSource::names_blocks(const FieldsToRead& fields) const {
    return knows_blocks_ && fields.cell && std::ranges::find(*fields.cell, block_field_name) != fields.cell->end();
}

/// The field of blocks where it is asked for and is not there, with their names.
Result<void> GridSource::add_blocks(ReadResult& read, const FieldsToRead& fields) const {
    const bool named = names_blocks(fields);
    if ((!named && !(fields.blocks && knows_blocks_)) ||
        std::ranges::find(read.grid.cell_fields, block_field_name, &Field::name) != read.grid.cell_fields.end())
        return {};
    Result<void> added = add_block_field(read.grid, read.info.blocks.empty() ? info_.blocks : read.info.blocks);
    if (!added) return named ? added : Result<void>();
    if (read.info.regions.empty()) read.info.regions = info_.regions;
    std::vector<RegionName> names = names_of_blocks(info_);
    read.info.regions.insert(read.info.regions.end(), std::make_move_iterator(names.begin()),
                             std::make_move_iterator(names.end()));
    return {};
}

struct GridSource::Kept {
    std::mutex mutex;
    std::optional<ReadResult> read;
    FieldsToRead fields;
    std::size_t step = 0;
    std::optional<SurveyedGrid> surveyed; ///< instead of `read`

    std::optional<ReadResult> take(const FieldsToRead& wanted, std::size_t wanted_step, CellsToRead cells);
    bool is_there() {
        const std::lock_guard lock(mutex);
        return read && !read->cells_in_file;
    }
};

namespace {

using Names = std::optional<std::vector<std::string>>; // nothing: all

bool holds_all(const Names& there, const Names& wanted) {
    if (!there) return true;
    return wanted && std::ranges::all_of(*wanted, [&](const std::string& name) {
               return std::ranges::find(*there, name) != there->end();
           });
}

void leave(std::vector<Field>& fields, const Names& wanted) {
    if (!wanted) return;
    std::erase_if(fields, [&](const Field& field) { return std::ranges::find(*wanted, field.name) == wanted->end(); });
}

} // namespace

std::optional<ReadResult> GridSource::Kept::take(const FieldsToRead& wanted, std::size_t wanted_step,
                                                 CellsToRead cells) {
    const std::lock_guard lock(mutex);
    if (!read || step != wanted_step || !holds_all(fields.point, wanted.point) || !holds_all(fields.cell, wanted.cell))
        return std::nullopt;
    if (read->cells_in_file && cells == CellsToRead::all) return std::nullopt;
    leave(read->grid.point_fields, wanted.point);
    leave(read->grid.cell_fields, wanted.cell);
    return std::exchange(read, std::nullopt);
}

void GridSource::keep(ReadResult read, const FieldsToRead& fields, std::size_t step) {
    kept_ = std::make_shared<Kept>();
    kept_->read = std::move(read);
    kept_->fields = fields;
    kept_->step = step;
}

Result<ReadResult> GridSource::read_unclosed(const FieldsToRead& fields, std::size_t step, CellsToRead cells,
                                             Caller& caller, const Run& run) const {
    if (made_) {
        MakeOptions made = *made_;
        if (fields.point) made.fields = *fields.point;
        Result<Grid> grid = make_grid(made, run);
        if (!grid) return grid.error();
        ReadResult result;
        result.grid = *std::move(grid);
        return result;
    }
    if (surface_) {
        ReadResult result;
        result.grid = *surface_;
        leave(result.grid.point_fields, fields.point);
        leave(result.grid.cell_fields, fields.cell);
        return result;
    }
    ReadOptions options = read_options_;
    if (cells == CellsToRead::some && is_packed_file() && !options_.merge_points && options_.displace.empty() &&
        options_.cells.empty())
        options.some_cells = FieldSample::max_cells;
    Result<ReadResult> result = read_file(fields, step, std::move(options), run);
    if (result) caller.notes(result->notes);
    return result;
}

void GridSource::note_choice(std::uint64_t count, std::uint64_t of, Caller& caller) const {
    caller.note(fmt::format("{} of {} are in {}", grouped(count), counted(of, "cell"), text_of(*choices_)));
}

/// Whether points hang on cells, or faces do not fit, before cells are chosen: points beside a face that the choice opens
/// hang on nothing.
bool GridSource::hangs_as_a_whole(const Grid& grid, const Run& run) const {
    if (options_.merge_points || options_.hanging_points == HangingChoice::not_sought) return true;
    const Result<ClosedGrid> whole = close_hanging_points({grid.points, grid.cells, {}, {}}, run);
    return !whole || whole->report.points > 0 || whole->report.open_faces > 0;
}

/// Empties the other cells, and notes how many are left. A number that a step of several lacks is noted, else an error.
/// Returns whether points may hang.
Result<bool> GridSource::choose(ReadResult& read, Caller* caller, const Run& run) const {
    if (!choices_) return true;
    const bool may_hang = hangs_as_a_whole(read.grid, run);
    const std::vector<RegionName>& regions = read.info.regions.empty() ? info_.regions : read.info.regions;
    Result<ChosenCells> chosen = choose_cells(std::move(read.grid), *choices_, regions);
    if (!chosen) return chosen.error();
    if (!chosen->missing.empty() && info_.times.size() < 2)
        return Error{ErrorCode::invalid_argument, chosen->missing.front()};
    read.grid = std::move(chosen->grid);
    if (!caller) return may_hang;
    caller->notes(chosen->missing);
    note_choice(chosen->count, chosen->of, *caller);
    return may_hang;
}

Result<Grid> GridSource::only_cells(Grid grid, const std::vector<std::string>& cells,
                                    const std::vector<RegionName>& regions) const {
    const auto choices = parse_cell_choices(cells, cell_names());
    if (!choices) return choices.error();
    Result<ChosenCells> chosen = choose_cells(std::move(grid), *choices, regions.empty() ? region_names() : regions);
    if (!chosen) return chosen.error();
    return std::move(chosen->grid);
}

/// The same, and what cells are chosen by.
FieldsToRead GridSource::and_of_choices(FieldsToRead fields) const {
    if (!choices_) return fields;
    for (const CellChoice& choice : *choices_) {
        if (fields.cell && std::ranges::find(*fields.cell, choice.field) == fields.cell->end())
            fields.cell->push_back(choice.field);
        if (choice.field == block_field_name) fields.blocks = true;
    }
    return fields;
}

Result<ReadResult> GridSource::read_cells(const FieldsToRead& fields, std::size_t step, CellsToRead cells,
                                          Caller& caller, const Run& run) const {
    if (kept_)
        if (auto kept = kept_->take(fields, step, cells)) {
            if (auto added = add_blocks(*kept, fields); !added) return added.error();
            return *std::move(kept);
        }
    const FieldsToRead with_choices = and_of_choices(fields);
    FieldsToRead of_file = with_choices;
    if (knows_blocks_ && of_file.cell) std::erase(*of_file.cell, block_field_name);
    Result<ReadResult> result = read_unclosed(of_file, step, cells, caller, run);
    if (!result || result->cells_in_file) return result;
    if (auto added = add_blocks(*result, with_choices); !added) return added.error();
    const Result<bool> may_hang = choose(*result, &caller, run);
    if (!may_hang) return may_hang.error();
    if (choices_) leave(result->grid.cell_fields, fields.cell);
    return finish(*std::move(result), fields, caller, run, *may_hang);
}

/// All of its cells were read, and none is chosen any more.
Result<ReadResult> GridSource::finish(ReadResult read, const FieldsToRead& fields, Caller& caller, const Run& run,
                                      bool may_hang) const {
    if (knows_blocks_ && !fields.blocks && !names_blocks(fields))
        std::erase_if(read.grid.cell_fields, [](const Field& field) { return field.name == block_field_name; });
    if (options_.merge_points) {
        Result<Grid> joined = merged(read.grid, {*options_.merge_points, options_.merge_values}, caller, run);
        if (!joined) return joined.error();
        read.grid = *std::move(joined);
    } else {
        caller.note(coincident_points_note(read.grid, run));
    }
    if (!may_hang) return read;
    Result<Grid> grid = closed(std::move(read.grid), options_.hanging_points, closing_.get(), caller, run);
    if (!grid) return grid.error();
    read.grid = *std::move(grid);
    return read;
}

/// Whether cells are chosen or changed, or not read from a file that has them one after another.
bool GridSource::needs_all_cells(const FieldsToRead& fields) const {
    return made_ || surface_ || is_packed_file() || options_.merge_points || !options_.cells.empty() ||
           names_blocks(fields);
}

Result<SurveyedGrid> GridSource::read_sample(const FieldsToRead& fields, std::size_t step, Caller& caller,
                                             const Run& run) const {
    const bool interpolates = options_.hanging_points == HangingChoice::interpolate;
    if (needs_all_cells(fields) || interpolates || fields.blocks || kept_) {
        Result<ReadResult> all = read_some(fields, step, caller, run);
        if (!all) return all.error();
        return SurveyedGrid{*std::move(all)};
    }
    ReadOptions options = read_options_;
    choose_fields(fields, step, options);
    if (auto room = require_room_once(fields, step, false); !room) return room.error();
    Result<SurveyedGrid> some = isotet::read_surveyed(options_.file, options, run);
    if (!some) return some;
    caller.notes(some->read.notes);
    if (some->report) return some;
    Result<ReadResult> whole = finish(std::move(some->read), fields, caller, run);
    if (!whole) return whole.error();
    some->read = *std::move(whole);
    return some;
}

Result<Grid> GridSource::read(const FieldsToRead& fields, std::size_t step, Caller& caller, const Run& run) const {
    Result<ReadResult> result = read_cells(fields, step, CellsToRead::all, caller, run);
    if (!result) return result.error();
    return std::move(result->grid);
}

Result<ReadResult> GridSource::read_some(const FieldsToRead& fields, std::size_t step, Caller& caller,
                                         const Run& run) const {
    return read_cells(fields, step, CellsToRead::some, caller, run);
}

void GridSource::keep(SurveyedGrid read, std::size_t step) {
    kept_ = std::make_shared<Kept>();
    kept_->surveyed = std::move(read);
    kept_->step = step;
}

Result<SurveyedGrid> GridSource::read_surveyed(const FieldsToRead& fields, std::size_t step, Caller& caller) const {
    if (kept_) {
        const std::lock_guard lock(kept_->mutex);
        if (kept_->surveyed && kept_->step == step) return *std::exchange(kept_->surveyed, std::nullopt);
    }
    if (needs_all_cells(fields)) {
        Result<ReadResult> all = read_cells(fields, step, CellsToRead::all, caller, caller.run());
        if (!all) return all.error();
        return SurveyedGrid{*std::move(all)};
    }
    ReadOptions options = read_options_;
    choose_fields(fields, step, options);
    if (auto room = require_room_once(fields, step, false); !room) return room.error();
    Result<SurveyedGrid> result = isotet::read_surveyed(options_.file, options, caller.run());
    if (!result) return result;
    caller.notes(result->read.notes);
    if (!result->report) caller.note(coincident_points_note(result->read.grid, caller.run()));
    return result;
}

/// Whether readers can choose the cells.
bool GridSource::chooses_while_reading(const FieldsToRead& fields, const ReadActiveCells& active) const {
    return !choices_ || (!is_packed_file() && !(fields.blocks && knows_blocks_) && !active.choose &&
                         active.shares.empty() && !active.bounds && !active.boundary);
}

Result<ReadResult> GridSource::read_active(const FieldsToRead& fields, std::size_t step, const ReadActiveCells& active,
                                           Caller& caller) const {
    const bool interpolates = options_.hanging_points == HangingChoice::interpolate; // values of cells that are not cut
    const FieldsToRead with_choices = and_of_choices(fields);
    if (made_ || surface_ || options_.merge_points || !chooses_while_reading(with_choices, active) ||
        names_blocks(with_choices) || interpolates || (kept_ && kept_->is_there()))
        return read_numbered(fields, step, caller);
    ReadOptions options = read_options_;
    options.active_cells = active;
    if (choices_) {
        auto conditions = conditions_of(*choices_, info_.regions);
        if (!conditions) return conditions.error();
        options.active_cells->conditions = *std::move(conditions);
    }
    Result<ReadResult> result = read_file(with_choices, step, std::move(options), caller.run());
    if (!result) return result;
    caller.notes(result->notes);
    if (result->cells_in_file) {
        if (choices_) note_choice(result->chosen_cells.value_or(0), *result->cells_in_file, caller);
        if (choices_) leave(result->grid.cell_fields, fields.cell);
        return result;
    }
    const Result<bool> may_hang = choose(*result, &caller, caller.run());
    if (!may_hang) return may_hang.error();
    if (choices_) leave(result->grid.cell_fields, fields.cell);
    caller.note(coincident_points_note(result->grid, caller.run()));
    if (!*may_hang) return result;
    Result<Grid> grid = closed(std::move(result->grid), options_.hanging_points, closing_.get(), caller, caller.run());
    if (!grid) return grid.error();
    result->grid = *std::move(grid);
    return result;
}

Result<ReadResult> GridSource::read_the_rest(const FieldsToRead& fields, std::size_t step, const Run& run) const {
    Result<ReadResult> result = read_file(and_of_choices(fields), step, read_options_, run);
    if (!result) return result;
    const Result<bool> may_hang = choose(*result, nullptr, run);
    if (!may_hang) return may_hang.error();
    if (choices_) leave(result->grid.cell_fields, fields.cell);
    if (!*may_hang || options_.hanging_points == HangingChoice::leave) return result;
    Result<ClosedGrid> all = close_hanging_points(result->grid, run);
    if (!all) return all.error();
    result->grid = std::move(all->grid);
    return result;
}

Result<Grid> GridSource::read_block(const BlockInfo& block, std::size_t step, Caller& caller) const {
    ReadOptions options = read_options_;
    options.blocks = {std::to_string(block.number)};
    Result<ReadResult> result = read_file({}, step, std::move(options), caller.run());
    if (!result) return result.error();
    return std::move(result->grid);
}

Result<ReadResult> GridSource::read_file(const FieldsToRead& fields, std::size_t step, ReadOptions options,
                                         const Run& run) const {
    choose_fields(fields, step, options);
    if (auto room = require_room_once(fields, step, !options.active_cells); !room) return room.error();
    return isotet::read(options_.file, options, run);
}

/// Later ones may be read while others are still there.
Result<void> GridSource::require_room_once(const FieldsToRead& fields, std::size_t step, bool all_cells) const {
    if (described_ != step || has_room_->exchange(true)) return {};
    const bool keeps_points = !options_.merge_points && options_.cells.empty() && info_.files.size() <= 1;
    return require_room(options_.file, least_bytes_of(info_, fields, all_cells), keeps_points ? beside_ : BesideGrid(),
                        info_.least.points);
}

void GridSource::choose_fields(const FieldsToRead& fields, std::size_t step, ReadOptions& options) const {
    options.point_fields = fields.point;
    options.cell_fields = fields.cell;
    if (!info_.times.empty()) options.step = step;
    options.skip_missing_fields = info_.times.size() > 1 && described_ != step;
}

Result<void> keep_broken(std::size_t step, Error error, std::size_t steps, std::vector<BrokenStep>& broken) {
    const bool is_of_the_file = error.code == ErrorCode::invalid_data || error.code == ErrorCode::file;
    if (!is_of_the_file || steps == 1) return error;
    if (broken.size() + 1 == steps) return broken.empty() ? error : broken.front().error; // none can be read
    broken.push_back({step, std::move(error)});
    return {};
}

std::string cells_left_out_note(const Grid& grid, const Run& run) {
    const auto is_split = [&](std::uint8_t type) {
        constexpr std::uint8_t polyhedron = 42;
        return is_curved(type) || (Contour::contours(type) && (type != polyhedron || !grid.cells.faces.empty()));
    };
    std::string list;
    for (const auto& [type, count] : count_cells_by_type(grid.cells, run)) {
        if (type == 0 || is_split(type)) continue; // not chosen, or the session tells about these
        list += fmt::format("{}{} {}", list.empty() ? "" : ", ", grouped(count), name_of_cell_type(type));
    }
    return list.empty() ? list : "cells left out, their types are not contoured: " + list;
}

std::uint64_t emptied_cells(const Grid& grid, const GridOptions& options, const Run& run) {
    if (options.cells.empty()) return 0;
    const auto counts = count_cells_by_type(grid.cells, run);
    const auto empty = counts.find(0);
    return empty == counts.end() ? 0 : empty->second;
}

std::optional<double> time_of(const FileInfo& info, std::size_t step) {
    if (step >= info.times.size()) return std::nullopt;
    return info.times[step];
}

} // namespace isotet::jobs
