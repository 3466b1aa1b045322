// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTKHDF: unstructured grids, versions 1 and 2, partitions and time steps by ourselves; image data by VTK's reader.
#include <vtkHDFReader.h>
#include <vtkNew.h>

#include "io/vtk/hdf5_array.hpp"
#include "io/vtk/hdf5_walk.hpp"
#include "io/vtk/length_check.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/vtk_load.hpp"
#include "io/vtk/vtkhdf_grid.hpp"

namespace isotet::io::vtk {
namespace {

/// A file of one grid.
Result<Loaded> load_grid(const std::string& path, const ReadOptions& options, Depth depth) {
    const auto rows = Hdf5Rows::open(path);
    if (!rows) return rows.error();
    const HdfGrid grid(path, *rows, "/VTKHDF/");
    Loaded loaded;
    if (auto done = grid.announce_all(loaded.info); !done) return done.error();
    if (depth == Depth::description) return loaded;
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = *step;
    auto pieces = grid.load(options, *step, "");
    if (!pieces) return pieces.error();
    if (pieces->empty()) return broken(path, "it has no part");
    loaded.pieces = *std::move(pieces);
    return loaded;
}

Result<Loaded> load_by_vtk(const std::string& path, const ReadOptions& options, Depth depth) {
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

} // namespace

Result<Loaded> load_vtkhdf(const std::string& path, const ReadOptions& options, Depth depth) {
    if (auto complete = check_hdf5_length(path); !complete) return complete.error();
    if (auto names = check_hdf5_names(path, options.allow_outside); !names) return names.error();
    if (text_attribute(path, "/VTKHDF", "Type") != "UnstructuredGrid") return load_by_vtk(path, options, depth);
    return load_grid(path, options, depth);
}

} // namespace isotet::io::vtk
