// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Indexes of files by time: what the file of a time is, and whose times and blocks are told.
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"
#include "io/reader.hpp"
#include "io/vtk_legacy/read_legacy_vtk.hpp"
#include "io/vtk_xml/read_vtk_xml.hpp"

namespace isotet::io {
namespace {

bool is_read_here(std::string_view name) { return name.ends_with(".vtk") || !vtk_type_of_name(name).empty(); }

Result<Loaded> load_named(const std::string& index, const std::string& name, const ReadOptions& options, Depth depth,
                          bool ids, const Progress& progress) {
    if (!is_read_here(name))
        return broken(
            index, fmt::format("it names \"{}\" beside others of one time, but parts of a grid are read of .vtu, .vti, "
                               ".vtr, .vts, those in pieces, .vtm, .vtpc, .vtpd and .vtk only",
                               escaped(name)));
    const auto file = named_file(index, name, options.allow_outside);
    if (!file) return file.error();
    const std::string_view type = vtk_type_of_name(name);
    return type.empty() ? load_legacy_file(*file, options, depth, progress)
                        : load_vtk_file(*file, type, options, depth, ids, progress);
}

/// The times, and the files that are there.
FileInfo info_of(const std::string& path, const TimeIndex& index, const ReadOptions& options) {
    FileInfo info;
    for (const auto& [time, of_time] : index.names) {
        info.times.push_back(time);
        for (const std::string& name : of_time)
            if (const auto file = named_file(path, name, options.allow_outside)) info.files.push_back(*file);
    }
    return info;
}

const std::vector<std::string>& names_of_step(const TimeIndex& index, std::size_t step) {
    return std::next(index.names.begin(), static_cast<std::ptrdiff_t>(step))->second;
}

} // namespace

Result<Loaded> load_times(const std::string& path, const Result<TimeIndex>& index, const ReadOptions& options,
                          Depth depth, const Progress& progress) {
    if (!index) return index.error();
    Loaded loaded;
    loaded.info = info_of(path, *index, options);
    loaded.notes = index->notes;
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = *step;
    ReadOptions of_entries = options;
    of_entries.step.reset();
    const auto& of_step = names_of_step(*index, *step);
    if (of_step.size() > 1) of_entries.blocks.clear(); // only the blocks of a single file can be told apart
    for (const std::string& name : of_step) {
        auto part = load_named(path, name, of_entries, depth, of_step.size() > 1, progress);
        if (!part) return part.error();
        if (of_step.size() == 1) loaded.info.blocks = std::move(part->info.blocks);
        append(loaded, std::move(*part));
    }
    return loaded;
}

Result<std::optional<FileOfTime>> file_of_time(const std::string& path, const Result<TimeIndex>& index,
                                               const ReadOptions& options) {
    if (!index) return index.error();
    FileInfo info;
    for (const auto& [time, names] : index->names) info.times.push_back(time);
    const auto step = choose_step(info, options);
    if (!step) return step.error();
    const auto& of_step = names_of_step(*index, *step);
    if (of_step.size() > 1 || is_read_here(of_step.front())) return std::optional<FileOfTime>();
    const auto file = named_file(path, of_step.front(), options.allow_outside);
    if (!file) return file.error();
    info = info_of(path, *index, options);
    return std::optional(FileOfTime{*file, std::move(info.times), std::move(info.files), index->notes});
}

} // namespace isotet::io
