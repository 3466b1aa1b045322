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

Result<NamesByTime> entries(const std::string& path) {
    if (const auto file = open_plain_file(path); !file) return file.error();
    pugi::xml_document document;
    const auto parsed = document.load_file(path.c_str());
    if (!parsed) return broken(path, fmt::format("broken XML at byte {}: {}", parsed.offset, parsed.description()));
    NamesByTime files;
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

} // namespace

Result<Loaded> load_collection(const std::string& path, const ReadOptions& options, Depth depth,
                               const Progress& progress) {
    const auto names = entries(path);
    return names ? load_times(path, *names, options, depth, progress) : names.error();
}

} // namespace isotet::io
