// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/read_vtk_xml.hpp"

#include <array>

#include "io/own/escape.hpp"
#include "io/own/join.hpp"
#include "io/own/vtk_xml/load.hpp"

namespace isotet::io {
namespace {

struct Named {
    const char *name, *title, *extension, *type; ///< the last one: of the element VTKFile
};
constexpr std::array kinds{Named{"vtu", "VTK XML unstructured grid", ".vtu", "UnstructuredGrid"},
                           Named{"pvtu", "VTK XML unstructured grid in pieces", ".pvtu", "PUnstructuredGrid"},
                           Named{"vti", "VTK XML image data", ".vti", "ImageData"},
                           Named{"vtr", "VTK XML rectilinear grid", ".vtr", "RectilinearGrid"},
                           Named{"vts", "VTK XML structured grid", ".vts", "StructuredGrid"},
                           Named{"pvd", "ParaView collection of VTK files", ".pvd", "Collection"}};

Result<Loaded> load_kind(const Named& kind, const std::string& path, const ReadOptions& options, Depth depth,
                         const Progress& progress) {
    const std::string_view name = kind.name;
    auto loaded = name == "pvtu"  ? vtk_xml::load_parallel(path, options, depth, progress)
                  : name == "pvd" ? load_collection(path, options, depth, progress)
                                  : vtk_xml::load_file(path, kind.type, options, depth, false, progress);
    if (loaded) loaded->info.format = name;
    return loaded;
}

/// GridReader holds plain functions: one set for each kind.
template <std::size_t number>
GridReader reader() {
    GridReader result;
    result.format = Format{kinds[number].name, kinds[number].title, {kinds[number].extension}};
    result.format.reads_grid = true;
    result.recognizes = [](std::string_view head, std::string_view) {
        return vtk_xml::type_of(head) == kinds[number].type ? 2 : 0;
    };
    result.inspect = [](const std::string& path, const ReadOptions& options, const Progress& progress) {
        auto loaded = load_kind(kinds[number], path, options, Depth::description, progress);
        return loaded ? Result<FileInfo>(std::move(loaded->info)) : loaded.error();
    };
    result.read = [](const std::string& path, const ReadOptions& options, const Progress& progress) {
        auto loaded = load_kind(kinds[number], path, options, Depth::arrays, progress);
        if (!loaded) return Result<ReadResult>(loaded.error());
        return join(std::move(*loaded), options.merge_pieces_by_coordinates);
    };
    return result;
}

template <std::size_t... numbers>
std::vector<GridReader> all_readers(std::index_sequence<numbers...>) {
    return {reader<numbers>()...};
}

} // namespace

std::vector<GridReader> vtk_xml_readers() { return all_readers(std::make_index_sequence<kinds.size()>()); }

} // namespace isotet::io
