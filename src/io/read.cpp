// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet::inspect() and isotet::read(): picks the reader, and checks whatever it gives back.
#include <isotet/read.hpp>

#include <algorithm>
#include <exception>
#include <functional>
#include <new>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/boundary.hpp>
#include <isotet/fields.hpp>

#include "base/system/fresh_memory.hpp"
#include "base/parallel.hpp"
#include "base/rising_progress.hpp"
#include "grid/cell/linear_names.hpp"
#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "grid/patches.hpp"
#include "io/files/kept_files.hpp"
#include "io/files/text_scanner.hpp"
#include "io/formats.hpp"
#include "io/pieces/block_choice.hpp"
#include "io/pieces/join/join.hpp"
#include "io/pieces/region_choice.hpp"
#include "io/pieces/survey_unread.hpp"
#include "io/pieces/uniform_cells.hpp"
#include "io/reader.hpp"
#include "io/vtk_legacy/read_legacy_vtk.hpp"
#include "io/vtk_xml/read_vtk_xml.hpp"

namespace isotet {

namespace io {

bool wanted(const ReadOptions& options, Association association, std::string_view name) {
    const auto& names = association == Association::point ? options.point_fields : options.cell_fields;
    return !names || std::find(names->begin(), names->end(), name) != names->end();
}

Result<std::size_t> choose_step(const FileInfo& info, const ReadOptions& options) {
    const std::size_t step = options.step.value_or(0);
    const std::size_t steps = std::max<std::size_t>(info.times.size(), 1);
    if (step < steps) return step;
    return Error{ErrorCode::invalid_argument,
                 fmt::format("step {} is not there, but the file has {} step{}, counted from 0", step, steps,
                             steps == 1 ? "" : "s")};
}

namespace {

const char* adjective(Association association) { return association == Association::point ? "point" : "cell"; }

/// "point fields 'a' and 'b' are left out: ...": one sentence for each kind and reason.
void say_left_out(ReadResult& result) {
    const std::vector<LeftOut>& items = result.info.left_out;
    std::vector<bool> said(items.size());
    for (std::size_t first = 0; first < items.size(); ++first) {
        if (said[first]) continue;
        std::vector<std::string> names;
        for (std::size_t i = first; i < items.size(); ++i) {
            if (items[i].what != items[first].what || items[i].reason != items[first].reason) continue;
            names.push_back(in_quotes(items[i].name));
            said[i] = true;
        }
        result.notes.push_back(fmt::format("{}{} {} {} left out: {}", items[first].what, names.size() == 1 ? "" : "s",
                                           fmt::join(names, ", "), names.size() == 1 ? "is" : "are",
                                           items[first].reason));
    }
}

/// Why a field is not read; empty where nothing is known about it.
std::string reason_left_out(const FileInfo& info, std::string_view what, const std::string& name) {
    for (const LeftOut& item : info.left_out)
        if (item.name == name && (item.what == what || item.what == "field")) return item.reason;
    return {};
}

/// Every name asked for must be in the file, and what is in the file must have come back.
Result<void> check_names(const std::vector<std::string>& asked, Association association, const ReadResult& result,
                         const ReadOptions& options) {
    const auto& read = association == Association::point ? result.grid.point_fields : result.grid.cell_fields;
    for (const std::string& name : asked) {
        if (std::any_of(read.begin(), read.end(), [&](const Field& field) { return field.name == name; })) continue;
        if (const std::string reason =
                reason_left_out(result.info, fmt::format("{} field", adjective(association)), name);
            !reason.empty())
            return Error{ErrorCode::invalid_data, fmt::format("{} field {} cannot be read: {}", adjective(association),
                                                              in_quotes(name), reason)};
        if (options.skip_missing_fields) continue;
        std::vector<std::string> names;
        bool in_file = false;
        for (const FieldInfo& field : result.info.fields) {
            if (field.association != association) continue;
            names.push_back(field.name);
            in_file = in_file || field.name == name;
        }
        if (in_file && !options.blocks.empty()) continue; // it is that of another block
        if (in_file) {
            const bool has_steps = result.info.times.size() > 1;
            return Error{ErrorCode::invalid_argument,
                         fmt::format("{} field {} has no values{}", adjective(association), in_quotes(name),
                                     has_steps ? fmt::format(" at step {}", result.step) : "")};
        }
        for (std::string& other : names = nearest_first(name, std::move(names))) other = in_quotes(other);
        return Error{ErrorCode::invalid_argument,
                     fmt::format("{} field {} is not in the file, {}", adjective(association), in_quotes(name),
                                 names.empty() ? fmt::format("which has no {} fields", adjective(association))
                                               : fmt::format("which has {}", fmt::join(names, ", ")))};
    }
    return {};
}

/// Readers of formats that have blocks know them all. Regions are known when the cells have been read.
Result<void> check_blocks(const FileInfo& info, const ReadOptions& options) {
    if (options.blocks.empty() || !info.blocks.empty() || !region_field(info).empty()) return {};
    return Error{ErrorCode::invalid_argument,
                 fmt::format("block {} cannot be chosen: the file ({}) has no blocks that can be read alone",
                             in_quotes(options.blocks.front()), info.format)};
}

/// What every grid must hold to, whoever read it.
Result<void> check_grid(const Grid& grid, const Progress& progress) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto sound = core::check_cells(grid, *cells, progress); !sound) return sound;
    if (auto sound = core::check_patches(grid); !sound) return sound;
    return core::check_faces(grid, *cells, progress);
}

/// The cells at a boundary that was asked for with them.
Result<void> check_cells_at_boundary(const ReadOptions& options, const Progress& progress) {
    if (!options.active_cells || !options.active_cells->boundary) return {};
    const StreamedBoundary& boundary = *options.active_cells->boundary;
    return boundary.is_there && boundary.wants_cells ? check_grid(boundary.cells, progress) : Result<void>();
}

/// Cell fields of all cells do not fit some of them.
Grid without_values_of_others(const ReadResult& read) {
    Grid grid = read.grid;
    if (read.cells_in_file) grid.cell_fields.clear();
    return grid;
}

/// The point field called so, or gathered from the fields of its components.
Result<Field> vector_called(const std::string& name, const Grid& grid) {
    std::vector<std::string> names;
    for (const Field& field : grid.point_fields) names.push_back(field.name);
    const auto match = match_field_name(name, names);
    if (match && !match->parts.empty()) return gather_components(grid.point_fields, name, match->parts);
    const auto field = std::ranges::find(grid.point_fields, name, &Field::name);
    if (field != grid.point_fields.end()) return *field;
    return Field{name, Array{}};
}

/// Adds a vector field to the coordinates, in double.
Result<void> displace(const std::string& name, ReadResult& result) {
    Grid& grid = result.grid;
    const Result<Field> field = vector_called(name, grid);
    if (!field) return field.error();
    if (field->values.components() != 3)
        return Error{ErrorCode::invalid_argument,
                     fmt::format("field {} has {} components, but displacing takes a point field of 3", in_quotes(name),
                                 field->values.empty() ? 0 : field->values.components())};
    std::vector<double> moved(grid.points.size());
    const auto for_each_coordinate = [&](const Array& array, const auto& put) {
        array.visit([&](auto values) {
            core::parallel_each(moved.size(), std::size_t{1} << 16U,
                                [&](std::size_t i) { put(moved[i], static_cast<double>(values[i])); });
        });
    };
    for_each_coordinate(grid.points, [](double& sum, double coordinate) { sum = coordinate; });
    for_each_coordinate(field->values, [](double& sum, double step) { sum += step; });
    grid.points = Array::own(std::move(moved), 3);
    result.notes.push_back(fmt::format("points are displaced by the field {}", in_quotes(name)));
    return {};
}

/// The displacement, or the fields of its components, must be read even where the surface does not carry it.
Result<ReadOptions> with_displacement(const GridReader& reader, const std::string& path, ReadOptions options,
                                      const Progress& progress) {
    if (options.displace.empty() || !options.point_fields) return options;
    const auto info = reader.inspect(path, options, progress);
    if (!info) return info.error();
    std::vector<std::string> names;
    for (const FieldInfo& field : info->fields)
        if (field.association == Association::point) names.push_back(field.name);
    const auto match = match_field_name(options.displace, names);
    for (const std::string& part :
         match && !match->parts.empty() ? match->parts : std::vector<std::string>{options.displace})
        if (!wanted(options, Association::point, part)) options.point_fields->push_back(part);
    return options;
}

/// Bezier cells with weights are rational: their values are no weighted sums with fixed weights.
Result<void> check_bezier(const ReadResult& result) {
    constexpr std::uint8_t first_bezier = 75, last_bezier = 81;
    constexpr std::string_view name = "RationalWeights";
    if (std::ranges::none_of(result.info.fields, [&](const FieldInfo& field) {
            return field.name == name && field.association == Association::point;
        }))
        return {};
    const Array& types = result.grid.cells.types;
    for (std::size_t cell = 0; cell < types.tuples(); ++cell)
        if (types.at(cell) >= first_bezier && types.at(cell) <= last_bezier)
            return Error{ErrorCode::invalid_data,
                         fmt::format("cell {} is a rational Bezier cell (there is a point field "
                                     "'{}'), but only those without weights are handled",
                                     cell, name)};
    return {};
}

/// Where blocks are chosen, and regions may be meant, the field that numbers them must be read, and the names of surfaces.
Result<ReadOptions> with_regions(const GridReader& reader, const std::string& path, ReadOptions options,
                                 const Progress& progress) {
    if (options.blocks.empty() || !may_have_regions(reader.format.name)) return options;
    const auto info = reader.inspect(path, options, progress);
    if (!info) return info.error();
    const std::string_view field = region_field(*info);
    if (field.empty()) return options;
    if (!wanted(options, Association::cell, field)) options.cell_fields->emplace_back(field);
    options.patches = true;
    return options;
}

/// The pieces of a file whose cells may stay in it; nothing where the format has none.
std::optional<Result<Loaded>> load_uncounted(const std::string& format, const std::string& path,
                                             const ReadOptions& options, const Progress& progress) {
    if (format == "vtk") return load_legacy_file(path, options, Depth::arrays, progress);
    return load_vtk_xml(format, path, options, progress);
}

Result<ReadResult> read_surveyed(const GridReader& reader, const std::string& path, const ReadOptions& options,
                                 const Progress& progress, SurveyedGrid& counted) {
    if (options.active_cells) return reader.read(path, options, progress);
    Result<SurveyedGrid> surveyed = Error{};
    if (reader.survey) {
        surveyed = reader.survey(path, options, progress);
    } else {
        const ReadOptions counting = to_be_counted(options);
        auto loaded = load_uncounted(reader.format.name, path, counting, progress);
        if (!loaded) return reader.read(path, options, progress);
        if (!*loaded) return loaded->error();
        (*loaded)->info.format = reader.format.name;
        surveyed = join_counted(**std::move(loaded), counting, progress);
    }
    if (!surveyed) return surveyed.error();
    counted.report = std::move(surveyed->report);
    counted.sampled = std::move(surveyed->sampled);
    return std::move(surveyed->read);
}

/// The file of one step of an index by time, and the options to read it with; nothing where the index is read as one.
struct StepInIndex {
    FileOfTime file;
    ReadOptions options;

    /// `info`   of the file
    Result<void> give_times(const GridReader& index, FileInfo& info) {
        if (info.times.size() > 1)
            return broken(file.path,
                          fmt::format("it has {} time steps, but an index names a file for each", info.times.size()));
        info.format = index.format.name;
        info.times = std::move(file.times);
        for (std::string& other : file.files)
            if (std::ranges::find(info.files, other) == info.files.end()) info.files.push_back(std::move(other));
        return {};
    }
};

Result<std::optional<StepInIndex>> step_in_index(const GridReader& reader, const std::string& path,
                                                 const ReadOptions& options, const Progress& progress) {
    if (!reader.file_of_time) return std::optional<StepInIndex>();
    auto file = reader.file_of_time(path, options, progress);
    if (!file) return file.error();
    if (!*file) return std::optional<StepInIndex>();
    StepInIndex step{**std::move(file), options};
    step.options.step.reset();
    step.options.format.clear();
    const auto inner = choose_reader(step.file.path, step.options);
    if (!inner) return inner.error();
    if ((*inner)->file_of_time)
        return broken(path, fmt::format("it names {}, which is an index by time, too", in_quotes(step.file.path)));
    step.options.format = (*inner)->format.name;
    return std::optional(std::move(step));
}

/// How a reader is called: as itself, or for counting.
using ReadWith =
    std::function<Result<ReadResult>(const GridReader& reader, const std::string& path, const ReadOptions& options)>;

Result<ReadResult> read_checked(const std::string& path, const ReadOptions& options, const Progress& progress,
                                const ReadWith& read_with) {
    const auto reader = choose_reader(path, options);
    if (!reader) return reader.error();
    auto in_index = step_in_index(**reader, path, options, progress);
    if (!in_index) return in_index.error();
    if (StepInIndex* const step = *in_index ? &**in_index : nullptr) {
        auto read = read_checked(step->file.path, step->options, progress, read_with);
        if (!read) return read;
        if (auto given = step->give_times(**reader, read->info); !given) return given.error();
        read->step = options.step.value_or(0);
        read->notes.insert(read->notes.begin(), step->file.notes.begin(), step->file.notes.end());
        return read;
    }
    auto displaced_options = with_displacement(**reader, path, options, progress);
    if (!displaced_options) return displaced_options.error();
    const auto extended = with_regions(**reader, path, *std::move(displaced_options), progress);
    if (!extended) return extended.error();
    const ReadOptions& all = *extended;
    auto result = read_with(**reader, path, all);
    if (!result) return result;
    say_left_out(*result);
    if (auto known = check_blocks(result->info, options); !known) return known.error();
    if (const auto step = choose_step(result->info, options); !step) return step.error();
    if (all.point_fields) {
        if (auto known = check_names(*all.point_fields, Association::point, *result, all); !known) return known.error();
    }
    if (all.cell_fields) {
        if (auto known = check_names(*all.cell_fields, Association::cell, *result, all); !known) return known.error();
    }
    const auto in_file = [&](Error error) {
        if (error.code == ErrorCode::invalid_data) error.message = path + ": " + error.message;
        return error;
    };
    if (auto checked = check_grid(without_values_of_others(*result), progress); !checked)
        return in_file(checked.error());
    if (auto checked = check_cells_at_boundary(options, progress); !checked) return in_file(checked.error());
    if (auto checked = check_bezier(*result); !checked) return in_file(checked.error());
    if (core::has_linear_names(result->grid.cells)) {
        result->grid.cells = core::with_linear_names(std::move(result->grid.cells));
        vtk_xml::simplify(result->grid.cells);
        if (auto checked = check_grid(result->grid, progress); !checked) return in_file(checked.error());
    }
    if (const std::string_view regions = region_field(result->info); !options.blocks.empty() && !regions.empty()) {
        if (auto chosen = choose_regions(*result, options); !chosen) return chosen.error();
        if (!wanted(options, Association::cell, regions))
            std::erase_if(result->grid.cell_fields, [&](const Field& field) { return field.name == regions; });
    }
    if (options.displace.empty()) return result;
    if (auto displaced = displace(options.displace, *result); !displaced) return displaced.error();
    std::erase_if(result->grid.point_fields,
                  [&](const Field& field) { return !wanted(options, Association::point, field.name); });
    // Displaced coordinates may be too large or not finite.
    if (auto checked = check_grid(result->grid, progress); !checked) return in_file(checked.error());
    return result;
}

/// The file of a step, where each step has one, and the options to read it with.
struct FileOfStep {
    std::string path;
    ReadOptions options;
    std::vector<std::string> all;
};

Result<FileOfStep> file_of_step(const std::string& path, const ReadOptions& options) {
    FileOfStep found{path, options, {path}};
    found.all.insert(found.all.end(), options.more_files.begin(), options.more_files.end());
    const std::size_t step = options.step.value_or(0);
    if (step >= found.all.size())
        return Error{ErrorCode::invalid_argument,
                     fmt::format("step {} is not there, but there are {} files, a step each, counted from 0", step,
                                 found.all.size())};
    found.path = found.all[step];
    found.options.more_files.clear();
    found.options.step.reset();
    return found;
}

/// Steps are numbered; a file of several steps is none of a series.
Result<void> number_steps(const FileOfStep& file, FileInfo& info) {
    if (info.times.size() > 1)
        return Error{ErrorCode::invalid_argument, fmt::format("several files are a time step each, but {} has {} steps",
                                                              file.path, info.times.size())};
    info.times.clear();
    for (std::size_t i = 0; i < file.all.size(); ++i) info.times.push_back(static_cast<double>(i));
    for (const std::string& other : file.all)
        if (std::ranges::find(info.files, other) == info.files.end()) info.files.push_back(other);
    return {};
}

Result<FileInfo> inspect_one(const std::string& path, const ReadOptions& options, const Progress& progress) {
    const auto reader = choose_reader(path, options);
    if (!reader) return reader.error();
    auto in_index = step_in_index(**reader, path, options, progress);
    if (!in_index) return in_index.error();
    if (StepInIndex* const step = *in_index ? &**in_index : nullptr) {
        auto info = inspect_one(step->file.path, step->options, progress);
        if (!info) return info;
        if (auto given = step->give_times(**reader, *info); !given) return given.error();
        return info;
    }
    if (options.kept) options.kept->look_at(path);
    auto info = (*reader)->inspect(path, options, progress);
    if (!info) return info;
    if (auto known = check_blocks(*info, options); !known) return known.error();
    if (!info->blocks.empty() && region_field(*info).empty())
        if (const auto chosen = chosen_blocks(info->blocks, options); !chosen) return chosen.error();
    if (!options.blocks.empty()) info->least = {};
    if (info->cells == 0)
        for (const BlockInfo& block : info->blocks) info->cells += block.cells;
    return info;
}

Result<FileInfo> inspect_step(const std::string& path, const ReadOptions& options, const Progress& progress) {
    if (options.more_files.empty()) return inspect_one(path, options, progress);
    const auto file = file_of_step(path, options);
    if (!file) return file.error();
    auto info = inspect_one(file->path, file->options, progress);
    if (!info) return info;
    if (auto numbered = number_steps(*file, *info); !numbered) return numbered.error();
    return info;
}

/// `surveyed`   gets the counts, where cells are counted; else null
Result<ReadResult> read_step(const std::string& path, const ReadOptions& options, const Progress& progress,
                             SurveyedGrid* surveyed = nullptr) {
    const auto read_it = [&](const std::string& of_step, const ReadOptions& all) {
        return read_checked(of_step, all, progress,
                            [&](const GridReader& reader, const std::string& file, const ReadOptions& extended) {
                                return surveyed ? read_surveyed(reader, file, extended, progress, *surveyed)
                                                : reader.read(file, extended, progress);
                            });
    };
    if (options.more_files.empty()) return read_it(path, options);
    const auto file = file_of_step(path, options);
    if (!file) return file.error();
    auto result = read_it(file->path, file->options);
    if (!result) return result;
    if (auto numbered = number_steps(*file, result->info); !numbered) return numbered.error();
    result->step = options.step.value_or(0);
    return result;
}

/// What is kept of a grid's files while it is read is gone behind it.
template <class Work>
auto with_kept_files(ReadOptions options, const Work& work) {
    if (!options.kept) options.kept = keep_files();
    auto result = work(options);
    options.kept->forget();
    return result;
}

/// The only place where a failed allocation of a reader becomes an error.
template <class Value, class Work>
Result<Value> without_exceptions(const std::string& path, const Run& run, const Work& work) {
    try {
        const Progress rises = core::rising(run.progress);
        Result<Value> result = Error{};
        core::with_threads(run.threads, [&] { result = work(rises); });
        return result;
    } catch (const std::bad_alloc&) {
        return core::ran_out_of_memory("reading " + path);
    } catch (const std::exception& exception) {
        return Error{ErrorCode::internal, fmt::format("reading {} failed: {}", path, exception.what())};
    } catch (...) { // by a callback of the caller
        return Error{ErrorCode::internal,
                     fmt::format("reading {} failed: something was thrown that is no std::exception", path)};
    }
}

} // namespace

} // namespace io

Result<FileInfo> inspect(const std::string& path, const ReadOptions& options, const Run& run) {
    return io::without_exceptions<FileInfo>(
        path, run, [&](const Progress& progress) { return io::inspect_step(path, options, progress); });
}

Result<SurveyedGrid> read_surveyed(const std::string& path, const ReadOptions& options, const Run& run) {
    return io::without_exceptions<SurveyedGrid>(path, run, [&](const Progress& progress) -> Result<SurveyedGrid> {
        SurveyedGrid surveyed;
        auto read = io::with_kept_files(
            options, [&](const ReadOptions& all) { return io::read_step(path, all, progress, &surveyed); });
        if (!read) return read.error();
        surveyed.read = *std::move(read);
        return surveyed;
    });
}

Result<ReadResult> read(const std::string& path, const ReadOptions& options, const Run& run) {
    return io::without_exceptions<ReadResult>(path, run, [&](const Progress& progress) {
        return io::with_kept_files(options, [&](const ReadOptions& all) { return io::read_step(path, all, progress); });
    });
}

} // namespace isotet
