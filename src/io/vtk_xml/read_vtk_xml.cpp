// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/read_vtk_xml.hpp"

#include <algorithm>
#include <array>

#include "io/files/escape.hpp"
#include "io/pieces/join/join.hpp"
#include "io/vtk_xml/load.hpp"

namespace isotet::io {
namespace {

struct Named {
    const char *name, *title, *extension, *type; ///< the last one: of the element VTKFile
};
constexpr std::array kinds{
    Named{"vtu", "VTK XML unstructured grid", ".vtu", "UnstructuredGrid"},
    Named{"pvtu", "VTK XML unstructured grid in pieces", ".pvtu", "PUnstructuredGrid"},
    Named{"vti", "VTK XML image data", ".vti", "ImageData"},
    Named{"pvti", "VTK XML image data in pieces", ".pvti", "PImageData"},
    Named{"vtr", "VTK XML rectilinear grid", ".vtr", "RectilinearGrid"},
    Named{"pvtr", "VTK XML rectilinear grid in pieces", ".pvtr", "PRectilinearGrid"},
    Named{"vts", "VTK XML structured grid", ".vts", "StructuredGrid"},
    Named{"pvts", "VTK XML structured grid in pieces", ".pvts", "PStructuredGrid"},
    Named{"vtm", "VTK XML multi-block data", ".vtm", "vtkMultiBlockDataSet"},
    Named{"vtpc", "VTK XML partitioned data set collection", ".vtpc", "vtkPartitionedDataSetCollection"},
    Named{"vtpd", "VTK XML partitioned data set", ".vtpd", "vtkPartitionedDataSet"},
    Named{"vth", "VTK XML overlapping AMR", ".vth", "vtkOverlappingAMR"},
    Named{"vthb", "VTK XML hierarchical boxes (AMR)", ".vthb", "vtkHierarchicalBoxDataSet"},
    Named{"pvd", "ParaView collection of VTK files", ".pvd", "Collection"}};

bool is_collection(const Named& kind) { return std::string_view(kind.type) == "Collection"; }

Result<Loaded> load(const Named& kind, const std::string& path, const ReadOptions& options, Depth depth,
                    const Progress& progress) {
    auto loaded = is_collection(kind) ? load_times(path, index_of_collection(path), options, depth, progress)
                                      : load_vtk_file(path, kind.type, options, depth, false, progress);
    if (loaded) loaded->info.format = kind.name;
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
        auto loaded = load(kinds[number], path, options, Depth::description, progress);
        return loaded ? Result<FileInfo>(std::move(loaded->info)) : loaded.error();
    };
    result.read = [](const std::string& path, const ReadOptions& options, const Progress& progress) {
        return load_and_join([&] { return load(kinds[number], path, options, Depth::arrays, progress); }, options,
                             progress);
    };
    if (is_collection(kinds[number]))
        result.file_of_time = [](const std::string& path, const ReadOptions& options, const Progress&) {
            return file_of_time(path, index_of_collection(path), options);
        };
    return result;
}

template <std::size_t... numbers>
std::vector<GridReader> all_readers(std::index_sequence<numbers...>) {
    return {reader<numbers>()...};
}

} // namespace

std::string_view vtk_type_of_name(std::string_view name) {
    for (const Named& kind : kinds)
        if (name.ends_with(kind.extension)) return is_collection(kind) ? std::string_view() : kind.type;
    return {};
}

Result<Loaded> load_vtk_file(const std::string& path, std::string_view type, const ReadOptions& options, Depth depth,
                             bool ids, const Progress& progress) {
    if (type == "vtkOverlappingAMR" || type == "vtkHierarchicalBoxDataSet")
        return load_amr(path, options, depth, progress);
    if (type.starts_with("vtk")) return load_blocks(path, type, options, depth, progress);
    if (type.starts_with("P")) return vtk_xml::load_pieces(path, type, options, depth, progress);
    return vtk_xml::load_file(path, type, options, depth, ids, progress);
}

std::optional<Result<Loaded>> load_vtk_xml(const std::string& format, const std::string& path,
                                           const ReadOptions& options, const Progress& progress) {
    const auto kind = std::ranges::find_if(kinds, [&](const Named& one) { return format == one.name; });
    if (kind == kinds.end()) return std::nullopt;
    return load(*kind, path, options, Depth::arrays, progress);
}

std::vector<GridReader> vtk_xml_readers() { return all_readers(std::make_index_sequence<kinds.size()>()); }

} // namespace isotet::io
