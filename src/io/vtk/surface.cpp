// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTP files that isotet's own reader does not take: compressed ones.
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include "io/own/surface_parts.hpp"
#include "io/vtk/length_check.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/vtk_grid.hpp"

namespace isotet::io::vtk {
namespace {

std::vector<Attribute> attributes_of(vtkDataSetAttributes* attributes) {
    std::vector<Attribute> result;
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i) {
        vtkDataArray* values = attributes->GetArray(i);
        if (!values || !values->GetName() || is_ghost_array(values->GetName())) continue;
        result.push_back({values->GetName(), shared_array(values), values == attributes->GetNormals()});
    }
    return result;
}

/// Calls add(corners) for each cell. Offsets were not checked by VTK.
template <class Index, class Add>
bool each_cell(std::span<const Index> points, std::span<const Index> begins, const Add& add) {
    std::vector<std::uint64_t> corners;
    for (std::size_t cell = 0; cell + 1 < begins.size(); ++cell) {
        const auto begin = static_cast<std::uint64_t>(begins[cell]), end = static_cast<std::uint64_t>(begins[cell + 1]);
        if (begin > end || end > points.size()) return false;
        corners.assign(points.begin() + static_cast<std::ptrdiff_t>(begin),
                       points.begin() + static_cast<std::ptrdiff_t>(end));
        add(std::span<const std::uint64_t>(corners));
    }
    return true;
}

/// VTK keeps both arrays in the same type, int32 or int64.
template <class Add>
bool each_cell(vtkCellArray* cells, const Add& add) {
    const Array points = shared_array(cells->GetConnectivityArray()), begins = shared_array(cells->GetOffsetsArray());
    return cells->IsStorage64Bit() ? each_cell(points.as<std::int64_t>(), begins.as<std::int64_t>(), add)
                                   : each_cell(points.as<std::int32_t>(), begins.as<std::int32_t>(), add);
}

} // namespace

Result<SurfaceFile> load_surface(const std::string& path) {
    if (auto complete = check_xml_length(path); !complete) return complete.error();
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(path.c_str());
    if (auto done = update(*reader, path, {}, 0); !done) return done.error();
    vtkPolyData* data = reader->GetOutput();
    SurfaceParts parts;
    parts.positions = data->GetPoints() ? shared_array(data->GetPoints()->GetData())
                                        : Array(ScalarType::float32, nullptr, 0, 3, nullptr);
    parts.cells.skip_cells(static_cast<std::uint64_t>(data->GetNumberOfVerts() + data->GetNumberOfLines()));
    const bool sound = each_cell(data->GetPolys(), [&](auto corners) { parts.cells.add_polygon(corners); }) &&
                       each_cell(data->GetStrips(), [&](auto corners) { parts.cells.add_strip(corners); });
    if (!sound) return broken(path, "the offsets of its polygons fall, or exceed the list of corners");
    parts.point_data = attributes_of(data->GetPointData());
    parts.cell_data = attributes_of(data->GetCellData());
    auto surface = assemble(std::move(parts));
    if (!surface) return broken(path, surface.error().message);
    return SurfaceFile{std::move(*surface), "vtp"};
}

} // namespace isotet::io::vtk
