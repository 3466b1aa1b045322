// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTKHDF, unstructured grids and image data.
#include <vtkHDFReader.h>
#include <vtkNew.h>

#include "io/vtk/length_check.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/vtk_load.hpp"

namespace isotet::io::vtk {

Result<Loaded> load_vtkhdf(const std::string& path, const ReadOptions& options, Depth depth) {
    if (auto complete = check_hdf5_length(path); !complete) return complete.error();
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
