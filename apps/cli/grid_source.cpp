// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid_source.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "coincident_points.hpp"
#include "number_format.hpp"

namespace isotet::cli {

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

} // namespace

Result<GridSource> GridSource::open(const GridOptions& options, const CommonOptions& common, const Console& console) {
    GridSource source;
    source.options_ = options;
    if (options.file.starts_with(made_prefix)) {
        Result<MakeOptions> made = parse_make(std::string_view(options.file).substr(made_prefix.size()));
        if (!made) return made.error();
        source.info_ = info_of(*made);
        source.made_ = *std::move(made);
        return source;
    }
    ReadOptions& read_options = source.read_options_;
    read_options.format = options.format;
    read_options.merge_pieces_by_coordinates = options.merge_pieces;
    read_options.allow_outside = options.allow_outside;
    read_options.displace = options.displace;
    read_options.reader_program = "/proc/self/exe"; // this program, wherever it lies
    Result<FileInfo> info = inspect(options.file, read_options, console.run());
    if (!info) return info.error();
    source.info_ = *std::move(info);
    return source;
}

std::vector<std::string> GridSource::names(Association association) const {
    std::vector<std::string> names;
    for (const FieldInfo& field : info_.fields) {
        if (field.association == association) names.push_back(field.name);
    }
    return names;
}

Result<Grid> GridSource::read(const FieldsToRead& fields, std::size_t step, Console& console) const {
    Grid grid;
    if (made_) {
        MakeOptions made = *made_;
        if (fields.point) made.fields = *fields.point;
        Result<Grid> result = make_grid(made, console.run());
        if (!result) return result.error();
        grid = *std::move(result);
    } else {
        ReadOptions read_options = read_options_;
        read_options.point_fields = fields.point;
        read_options.cell_fields = fields.cell;
        if (!info_.times.empty()) read_options.step = step;
        Result<ReadResult> result = isotet::read(options_.file, read_options, console.run());
        if (!result) return result.error();
        console.notes(result->notes);
        grid = std::move(result->grid);
    }
    if (!options_.merge_points) {
        console.note(coincident_points_note(grid));
        return grid;
    }
    Result<MergedPoints> merged = merge_points(grid, *options_.merge_points, console.run());
    if (!merged) return merged.error();
    console.note(fmt::format("{} points were welded to others", grouped(merged->merged)));
    return std::move(merged->grid);
}

std::optional<double> time_of(const FileInfo& info, std::size_t step) {
    if (step >= info.times.size()) return std::nullopt;
    return info.times[step];
}

namespace {

/// "0, 0.1, 0.2 ... 4": the first few and the last.
std::string list_of(const std::vector<double>& times) {
    constexpr std::size_t most = 10;
    std::string list;
    for (std::size_t i = 0; i < std::min(times.size(), most); ++i) list += (i ? ", " : "") + shortest(times[i]);
    if (times.size() > most) list += " ... " + shortest(times.back());
    return list;
}

Result<std::size_t> step_at(const std::vector<double>& times, double time) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (std::abs(times[i] - time) < std::abs(times[nearest] - time)) nearest = i;
    }
    constexpr double tolerance = 1e-12; // relative: a time that went through text and back
    if (times.empty()) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("time {} was asked for, but the file knows no time", shortest(time))};
    }
    if (std::abs(times[nearest] - time) <= tolerance * std::max(std::abs(time), std::abs(times[nearest])))
        return nearest;
    return Error{ErrorCode::invalid_argument,
                 fmt::format("time {} was asked for, but the file has {} times: {}; the nearest is {}", shortest(time),
                             times.size(), list_of(times), shortest(times[nearest]))};
}

} // namespace

Result<std::vector<std::size_t>> choose_steps(const FileInfo& info, const GridOptions& options, Steps steps,
                                              Console& console) {
    const std::size_t count = std::max<std::size_t>(info.times.size(), 1);
    if (steps == Steps::all) {
        std::vector<std::size_t> all(count);
        for (std::size_t i = 0; i < count; ++i) all[i] = i;
        return all;
    }
    if (options.time) {
        const Result<std::size_t> step = step_at(info.times, *options.time);
        if (!step) return step.error();
        return std::vector<std::size_t>{*step};
    }
    if (options.step) {
        if (*options.step < count) return std::vector<std::size_t>{static_cast<std::size_t>(*options.step)};
        return Error{ErrorCode::invalid_argument,
                     fmt::format("step {} was asked for, but the file has {} time step{}, numbered from 0",
                                 *options.step, count, count == 1 ? "" : "s")};
    }
    if (count > 1) {
        console.note(
            fmt::format("the file has {} time steps: step 0, time {}, was taken; --time and --step choose another",
                        count, shortest(info.times[0])));
    }
    return std::vector<std::size_t>{0};
}

} // namespace isotet::cli
