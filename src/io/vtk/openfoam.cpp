// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// An OpenFOAM case, not decomposed: the cells of the region's interior, with the fields that the case has on them.
#include <string_view>

#include <vtkNew.h>
#include <vtkOpenFOAMReader.h>

#include "io/vtk/loaders.hpp"
#include "io/vtk/vtk_load.hpp"

namespace isotet::io::vtk {

Result<Loaded> load_openfoam(const std::string& path, const ReadOptions& options, Depth depth) {
    vtkNew<vtkOpenFOAMReader> reader;
    reader->SetFileName(path.c_str());
    reader->CreateCellToPointOff(); // no point fields made up from cell fields
    reader->DecomposePolyhedraOff();
    reader->AddDimensionsToArrayNamesOff();
    reader->ReadZonesOff();
    reader->SkipZeroTimeOff();
    return load_with(*reader, path, options, depth, [&](const ReadOptions& chosen, FileInfo& info) {
        reader->DisableAllPatchArrays();
        for (int i = 0; i < reader->GetNumberOfPatchArrays(); ++i) {
            const std::string_view name = reader->GetPatchArrayName(i);
            if (name == "internalMesh" || name.ends_with("/internalMesh")) reader->SetPatchArrayStatus(name.data(), 1);
        }
        choose_arrays_by_name(*reader, chosen, info);
    });
}

} // namespace isotet::io::vtk
