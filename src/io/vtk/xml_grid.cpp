// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTU, VTI, VTR and VTS: one file, one grid.
#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkDataSet.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "io/reader.hpp"
#include "io/vtk/length_check.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/vtk_grid.hpp"

namespace isotet::io::vtk {
namespace {

void announce_header(vtkInformation* output, vtkInformationInformationVectorKey* key, Association association,
                     FileInfo& info) {
    vtkInformationVector* fields = output->Get(key);
    for (int i = 0; fields && i < fields->GetNumberOfInformationObjects(); ++i) {
        vtkInformation* field = fields->GetInformationObject(i);
        const char* name = field->Get(vtkDataObject::FIELD_NAME());
        const auto type = scalar_type(field->Get(vtkDataObject::FIELD_ARRAY_TYPE()));
        if (!name || !type || is_ghost_array(name)) continue;
        const int components = field->Get(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS());
        announce(info, {name, association, *type, static_cast<std::size_t>(std::max(1, components))});
    }
}

template <class Reader>
Result<Loaded> load_xml(const std::string& path, const ReadOptions& options, Depth depth) {
    if (auto complete = check_xml_length(path); !complete) return complete.error();
    Loaded loaded;
    vtkNew<Reader> reader;
    reader->SetFileName(path.c_str());
    if (auto ready = update_information(*reader, path); !ready) return ready.error();
    loaded.info.times = announced_times(*reader);
    vtkInformation* output = reader->GetOutputInformation(0);
    announce_header(output, vtkDataObject::POINT_DATA_VECTOR(), Association::point, loaded.info);
    announce_header(output, vtkDataObject::CELL_DATA_VECTOR(), Association::cell, loaded.info);
    if (depth == Depth::description) return loaded;

    auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = *step;
    choose_arrays(reader->GetPointDataArraySelection(), options, Association::point);
    choose_arrays(reader->GetCellDataArraySelection(), options, Association::cell);
    if (auto done = update(*reader, path, loaded.info.times, loaded.step); !done) return done.error();
    auto piece = piece_of(reader->GetOutputAsDataSet(), options, path, loaded.notes);
    if (!piece) return piece.error();
    loaded.pieces.push_back(std::move(*piece));
    return loaded;
}

} // namespace

Result<Loaded> load_vtu(const std::string& path, const ReadOptions& options, Depth depth) {
    return load_xml<vtkXMLUnstructuredGridReader>(path, options, depth);
}
Result<Loaded> load_vti(const std::string& path, const ReadOptions& options, Depth depth) {
    return load_xml<vtkXMLImageDataReader>(path, options, depth);
}
Result<Loaded> load_vtr(const std::string& path, const ReadOptions& options, Depth depth) {
    return load_xml<vtkXMLRectilinearGridReader>(path, options, depth);
}
Result<Loaded> load_vts(const std::string& path, const ReadOptions& options, Depth depth) {
    return load_xml<vtkXMLStructuredGridReader>(path, options, depth);
}

} // namespace isotet::io::vtk
