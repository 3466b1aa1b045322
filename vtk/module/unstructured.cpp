// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "unstructured.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include <vtkAppendFilter.h>
#include <vtkCellArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVersionMacros.h>

#include "arrays.hpp"

namespace isotet_vtk {

namespace {

/// As integers of the type `To`: shared where they are.
template <class To>
isotet::Array integers(const isotet::Array& from) {
    if (from.type() == isotet::scalar_type_of<To>()) return from;
    std::vector<To> out(from.size());
    from.visit([&](auto values) {
        std::ranges::transform(values, out.begin(), [](auto value) { return static_cast<To>(value); });
    });
    return isotet::Array::own(std::move(out));
}

constexpr std::size_t corners_of_tet = 4;

/// `Values` is the array of VTK for the integers of offsets and corners.
template <class Values>
vtkSmartPointer<vtkCellArray> cell_array(const isotet::Array& offsets, const isotet::Array& corners) {
    using Index = typename Values::ValueType;
    vtkNew<Values> first, points;
    lend(first, integers<Index>(offsets));
    lend(points, integers<Index>(corners));
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    cells->SetData(first, points);
    return cells;
}

isotet::Array offsets_of(const isotet::Cells& cells) {
    if (!cells.offsets.empty()) return cells.offsets;
    std::vector<std::int64_t> offsets(cells.count() + 1);
    for (std::size_t c = 0; c < offsets.size(); ++c) offsets[c] = static_cast<std::int64_t>(corners_of_tet * c);
    return isotet::Array::own(std::move(offsets));
}

vtkSmartPointer<vtkUnsignedCharArray> types_of(const isotet::Cells& cells) {
    auto types = vtkSmartPointer<vtkUnsignedCharArray>::New();
    if (cells.types.empty()) {
        types->SetNumberOfValues(static_cast<vtkIdType>(cells.count()));
        types->FillValue(static_cast<unsigned char>(cells.uniform_type));
    } else {
        lend(types, cells.types);
    }
    return types;
}

#if VTK_MAJOR_VERSION > 9 || (VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION >= 4)
void set_polyhedra(const isotet::Cells& cells, vtkCellArray* corners, vtkUnsignedCharArray* types,
                   vtkUnstructuredGrid* out) {
    const isotet::Array stream = integers<std::int64_t>(cells.faces),
                        first = integers<std::int64_t>(cells.face_offsets);
    const auto face = stream.as<std::int64_t>();
    std::vector<std::int64_t> points, sizes{0}, faces{0};
    for (const std::int64_t begin : first.as<std::int64_t>().first(cells.count())) {
        const std::size_t cell = faces.size() - 1;
        auto at = static_cast<std::size_t>(begin);
        const bool has_faces = first.as<std::int64_t>()[cell + 1] > begin;
        const std::int64_t count = has_faces ? face[at++] : 0;
        for (std::int64_t f = 0; f < count; ++f) {
            const auto size = static_cast<std::size_t>(face[at++]);
            points.insert(points.end(), face.begin() + static_cast<std::ptrdiff_t>(at),
                          face.begin() + static_cast<std::ptrdiff_t>(at + size));
            sizes.push_back(static_cast<std::int64_t>(points.size()));
            at += size;
        }
        faces.push_back(faces.back() + count);
    }
    std::vector<std::int64_t> numbers(sizes.size() - 1);
    std::iota(numbers.begin(), numbers.end(), 0);
    const auto of_cells =
        cell_array<vtkTypeInt64Array>(isotet::Array::own(std::move(faces)), isotet::Array::own(std::move(numbers)));
    const auto of_faces =
        cell_array<vtkTypeInt64Array>(isotet::Array::own(std::move(sizes)), isotet::Array::own(std::move(points)));
    out->SetPolyhedralCells(types, corners, of_cells, of_faces);
}
#else
void set_polyhedra(const isotet::Cells& cells, vtkCellArray* corners, vtkUnsignedCharArray* types,
                   vtkUnstructuredGrid* out) {
    vtkNew<vtkIdTypeArray> faces, places;
    faces->DeepCopy(to_vtk(integers<std::int64_t>(cells.faces), nullptr));
    places->SetNumberOfValues(static_cast<vtkIdType>(cells.count()));
    const isotet::Array offsets = integers<std::int64_t>(cells.face_offsets);
    const auto first = offsets.as<std::int64_t>();
    for (std::size_t c = 0; c < cells.count(); ++c)
        places->SetValue(static_cast<vtkIdType>(c), first[c + 1] > first[c] ? static_cast<vtkIdType>(first[c]) : -1);
    out->SetCells(types, corners, places, faces);
}
#endif

} // namespace

void write_cells(const isotet::Grid& grid, vtkUnstructuredGrid* out) {
    vtkNew<vtkPoints> points;
    points->SetData(to_vtk(grid.points, "Points"));
    out->SetPoints(points);
    const isotet::Array offsets = offsets_of(grid.cells);
    const bool narrow =
        grid.cells.connectivity.type() == isotet::ScalarType::int32 && offsets.type() == isotet::ScalarType::int32;
    const vtkSmartPointer<vtkCellArray> corners = narrow
                                                      ? cell_array<vtkTypeInt32Array>(offsets, grid.cells.connectivity)
                                                      : cell_array<vtkTypeInt64Array>(offsets, grid.cells.connectivity);
    const auto types = types_of(grid.cells);
    if (grid.cells.faces.empty()) out->SetCells(types, corners);
    else set_polyhedra(grid.cells, corners, types, out);
}

vtkSmartPointer<vtkUnstructuredGrid> unstructured_of(vtkDataSet* data) {
    if (auto* const grid = vtkUnstructuredGrid::SafeDownCast(data)) return grid;
    vtkNew<vtkAppendFilter> convert;
    convert->SetInputData(data);
    convert->Update();
    return convert->GetOutput();
}

} // namespace isotet_vtk
