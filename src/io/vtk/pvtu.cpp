// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// PVTU: an index of VTU files, which are read one by one.
#include <fmt/core.h>
#include <pugixml.hpp>

#include "io/vtk/escape.hpp"
#include "io/vtk/index_file.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/vtk_log.hpp"

namespace isotet::io::vtk {

Result<Loaded> load_pvtu(const std::string& path, const ReadOptions& options, Depth depth) {
    pugi::xml_document document;
    const auto parsed = document.load_file(path.c_str());
    if (!parsed) return broken(path, fmt::format("broken XML at byte {}: {}", parsed.offset, parsed.description()));
    const auto pieces = document.select_nodes("/VTKFile/PUnstructuredGrid/Piece");
    if (pieces.empty()) return broken(path, "the index names no pieces");
    Loaded loaded;
    std::size_t done = 0;
    for (const auto& node : pieces) {
        auto file = named_file(path, node.node().attribute("Source").as_string(), options.allow_outside);
        if (!file) return file.error();
        auto piece = load_vtu(*file, options, depth);
        if (!piece) return piece.error();
        for (FieldInfo& field : piece->info.fields) announce(loaded.info, std::move(field));
        for (Piece& part : piece->pieces) loaded.pieces.push_back(std::move(part));
        loaded.notes.insert(loaded.notes.end(), piece->notes.begin(), piece->notes.end());
        if (depth == Depth::description) break; // pieces have the same fields
        report_progress(static_cast<double>(++done) / static_cast<double>(pieces.size()));
    }
    return loaded;
}

} // namespace isotet::io::vtk
