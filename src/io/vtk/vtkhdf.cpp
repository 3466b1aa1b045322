// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTKHDF, unstructured grids and image data.
#include <optional>

#include <vtkHDFReader.h>
#include <vtkNew.h>

#include "io/vtk/hdf5_array.hpp"
#include "io/vtk/hdf5_walk.hpp"
#include "io/vtk/length_check.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/vtk_load.hpp"

namespace isotet::io::vtk {
namespace {

/// What an unstructured grid holds, by the types of its data sets: VTK's reader would read all of them to tell. Nothing
/// for what this does not understand.
std::optional<Loaded> described(const std::string& path) {
    if (text_attribute(path, "/VTKHDF", "Type") != "UnstructuredGrid") return std::nullopt;
    Loaded loaded;
    for (const auto association : {Association::point, Association::cell}) {
        const std::string group = association == Association::point ? "/VTKHDF/PointData" : "/VTKHDF/CellData";
        for (const std::string& name : data_sets_of(path, group)) {
            const auto shape = read_hdf5_array(path, group + "/" + name, {}, Depth::description);
            if (!shape || shape->dimensions.empty() || shape->dimensions.size() > 2) return std::nullopt;
            if (is_ghost_array(name)) continue;
            const std::uint64_t components = shape->dimensions.size() == 2 ? shape->dimensions[1] : 1;
            announce(loaded.info, {name, association, shape->values.type(), static_cast<std::size_t>(components)});
        }
    }
    return loaded;
}

} // namespace

Result<Loaded> load_vtkhdf(const std::string& path, const ReadOptions& options, Depth depth) {
    if (auto complete = check_hdf5_length(path); !complete) return complete.error();
    if (auto names = check_hdf5_names(path, options.allow_outside); !names) return names.error();
    if (depth == Depth::description)
        if (auto known = described(path)) return std::move(*known);
    vtkNew<vtkHDFReader> reader;
    reader->SetFileName(path.c_str());
    return load_with(*reader, path, options, depth, [&](const ReadOptions& chosen, FileInfo& info) {
        for (int i = 0; i < reader->GetNumberOfPointArrays(); ++i)
            if (!wanted(chosen, Association::point, reader->GetPointArrayName(i)))
                announce(info, {reader->GetPointArrayName(i), Association::point, ScalarType::float64, 1});
        for (int i = 0; i < reader->GetNumberOfCellArrays(); ++i)
            if (!wanted(chosen, Association::cell, reader->GetCellArrayName(i)))
                announce(info, {reader->GetCellArrayName(i), Association::cell, ScalarType::float64, 1});
        choose_arrays(reader->GetPointDataArraySelection(), chosen, Association::point);
        choose_arrays(reader->GetCellDataArraySelection(), chosen, Association::cell);
    });
}

} // namespace isotet::io::vtk
