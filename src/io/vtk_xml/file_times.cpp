// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Indexes of files by time: what the file of a time is, and whose times and blocks are told.
#include <iterator>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"
#include "io/reader.hpp"
#include "io/vtk_legacy/read_legacy_vtk.hpp"
#include "io/vtk_xml/read_vtk_xml.hpp"

namespace isotet::io {
namespace {

Result<Loaded> load_named(const std::string& index, const std::string& name, const ReadOptions& options, Depth depth,
                          bool ids, const Progress& progress) {
    const bool legacy = name.ends_with(".vtk");
    const std::string_view type = vtk_type_of_name(name);
    // Never another index by time, so nothing can include itself.
    if (!legacy && type.empty())
        return broken(index,
                      fmt::format("it names \"{}\", but only .vtu, .vti, .vtr, .vts, those in pieces, .vtm, .vtpc, "
                                  ".vtpd and .vtk are read",
                                  escaped(name)));
    const auto file = named_file(index, name, options.allow_outside);
    if (!file) return file.error();
    return legacy ? load_legacy_file(*file, options, depth, progress)
                  : load_vtk_file(*file, type, options, depth, ids, progress);
}

} // namespace

Result<Loaded> load_times(const std::string& path, const NamesByTime& names, const ReadOptions& options, Depth depth,
                          const Progress& progress) {
    Loaded loaded;
    for (const auto& [time, of_time] : names) {
        loaded.info.times.push_back(time);
        for (const std::string& name : of_time)
            if (const auto file = named_file(path, name, options.allow_outside)) loaded.info.files.push_back(*file);
    }
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = *step;
    ReadOptions of_entries = options;
    of_entries.step.reset();
    const auto& of_step = std::next(names.begin(), static_cast<std::ptrdiff_t>(*step))->second;
    if (of_step.size() > 1) of_entries.blocks.clear(); // only the blocks of a single file can be told apart
    for (const std::string& name : of_step) {
        auto part = load_named(path, name, of_entries, depth, of_step.size() > 1, progress);
        if (!part) return part.error();
        if (of_step.size() == 1) loaded.info.blocks = std::move(part->info.blocks);
        append(loaded, std::move(*part));
    }
    return loaded;
}

} // namespace isotet::io
