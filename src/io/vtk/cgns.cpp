// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// CGNS in ADF or HDF5. Fields keep the names of the file (VelocityX), zones are pieces.
#include <vtkCGNSReader.h>
#include <vtkNew.h>

#include "io/vtk/length_check.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/vtk_load.hpp"

namespace isotet::io::vtk {

Result<Loaded> load_cgns(const std::string& path, const ReadOptions& options, Depth depth) {
    if (auto complete = check_hdf5_length(path); !complete) return complete.error();
    vtkNew<vtkCGNSReader> reader;
    reader->SetFileName(path.c_str());
    reader->SetUse3DVector(false);
    reader->SetLoadBndPatch(false);
    reader->SetDoublePrecisionMesh(1); // float32 meshes stay float32 all the same: their zones say so
    return load_with(*reader, path, options, depth, [&](const ReadOptions& chosen, FileInfo& info) {
        reader->EnableAllBases();
        choose_arrays_by_name(*reader, chosen, info);
    });
}

} // namespace isotet::io::vtk
