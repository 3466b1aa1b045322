// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// PVD: an index of VTK XML files by time step; the parts and groups of one time are pieces of one grid.
#include <algorithm>
#include <map>

#include <fmt/core.h>
#include <pugixml.hpp>

#include "io/own/text_scanner.hpp"
#include "io/own/escape.hpp"
#include "io/own/index_file.hpp"
#include "io/own/plain_file.hpp"
#include "io/own/read_vtk_xml.hpp"
#include "io/own/vtk_xml/load.hpp"
#include "io/reader.hpp"

namespace isotet::io {
namespace {

using FilesByTime = std::map<double, std::vector<std::string>>;

Result<FilesByTime> entries(const std::string& path) {
    if (const auto file = open_plain_file(path); !file) return file.error();
    pugi::xml_document document;
    const auto parsed = document.load_file(path.c_str());
    if (!parsed) return broken(path, fmt::format("broken XML at byte {}: {}", parsed.offset, parsed.description()));
    FilesByTime files;
    for (const auto& found : document.select_nodes("/VTKFile/Collection/DataSet")) {
        const pugi::xml_attribute stated = found.node().attribute("timestep");
        double time = 0;
        if (stated && *stated.value() && (!parse_number(stated.value(), time) || time != time))
            return broken(path,
                          fmt::format("a data set has timestep \"{}\", which is no number", escaped(stated.value())));
        files[time].push_back(found.node().attribute("file").as_string());
    }
    if (files.empty()) return broken(path, "the collection has no data sets");
    return files;
}

/// The type of the file of an entry, by its name; empty for others. Never another collection, so nothing can include
/// itself.
std::string_view type_of_entry(std::string_view name) {
    for (const auto& [ending, type] :
         {std::pair(".vtu", "UnstructuredGrid"), std::pair(".pvtu", "PUnstructuredGrid"),
          std::pair(".vti", "ImageData"), std::pair(".vtr", "RectilinearGrid"), std::pair(".vts", "StructuredGrid")})
        if (name.ends_with(ending)) return type;
    return {};
}

} // namespace

Result<Loaded> load_collection(const std::string& path, const ReadOptions& options, Depth depth,
                               const Progress& progress) {
    auto files = entries(path);
    if (!files) return files.error();
    Loaded loaded;
    for (const auto& [time, names] : *files) {
        loaded.info.times.push_back(time);
        for (const std::string& name : names)
            if (const auto file = named_file(path, name, options.allow_outside)) loaded.info.files.push_back(*file);
    }
    ReadOptions of_entries = options;
    of_entries.step.reset();
    auto step = choose_step(loaded.info, depth == Depth::arrays ? options : of_entries);
    if (!step) return step.error();
    loaded.step = *step;
    for (const std::string& name : std::next(files->begin(), static_cast<std::ptrdiff_t>(*step))->second) {
        const std::string_view type = type_of_entry(name);
        if (type.empty())
            return broken(path, fmt::format("it names \"{}\", but only .vtu, .pvtu, .vti, .vtr and .vts are read",
                                            escaped(name)));
        auto file = named_file(path, name, options.allow_outside);
        if (!file) return file.error();
        auto part = type == "PUnstructuredGrid" ? vtk_xml::load_parallel(*file, of_entries, depth, progress)
                                                : vtk_xml::load_file(*file, type, of_entries, depth, true, progress);
        if (!part) return part.error();
        for (std::string& piece : part->info.files) loaded.info.files.push_back(std::move(piece));
        for (FieldInfo& field : part->info.fields) announce(loaded.info, std::move(field));
        for (Piece& piece : part->pieces) loaded.pieces.push_back(std::move(piece));
        loaded.notes.insert(loaded.notes.end(), part->notes.begin(), part->notes.end());
    }
    return loaded;
}

} // namespace isotet::io
