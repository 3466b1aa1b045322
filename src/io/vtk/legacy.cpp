// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Legacy VTK files, grids of any kind.
#include <fmt/core.h>
#include <vtkDataSet.h>
#include <vtkDataSetReader.h>
#include <vtkNew.h>

#include "io/reader.hpp"
#include "io/own/escape.hpp"
#include "io/vtk/legacy_layout.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/vtk_grid.hpp"

namespace isotet::io::vtk {

Result<Loaded> load_legacy(const std::string& path, const ReadOptions& options, Depth depth) {
    auto layout = legacy_layout(path);
    if (!layout) return layout.error();
    if (!layout->dataset.ends_with("_grid") && layout->dataset != "structured_points")
        return broken(
            path, fmt::format("a legacy VTK file of type \"{}\" has no cells with a volume", escaped(layout->dataset)));
    Loaded loaded;
    loaded.info = std::move(layout->info);
    if (depth == Depth::description) return loaded;
    auto step = choose_step(loaded.info, options);
    if (!step) return step.error();

    vtkNew<vtkDataSetReader> reader;
    reader->SetFileName(path.c_str());
    reader->ReadAllScalarsOn();
    reader->ReadAllVectorsOn();
    reader->ReadAllNormalsOn();
    reader->ReadAllTensorsOn();
    reader->ReadAllColorScalarsOn();
    reader->ReadAllTCoordsOn();
    reader->ReadAllFieldsOn();
    if (auto done = update(*reader, path, {}, 0); !done) return done.error();
    if (!reader->GetOutput()) return broken(path, "VTK's reader found no grid in it");
    announce_fields(reader->GetOutput(), loaded.info);
    auto piece = piece_of(reader->GetOutput(), options, path, loaded.notes);
    if (!piece) return piece.error();
    loaded.pieces.push_back(std::move(*piece));
    return loaded;
}

} // namespace isotet::io::vtk
