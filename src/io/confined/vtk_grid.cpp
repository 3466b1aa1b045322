// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <fmt/core.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include "io/reader.hpp"
#include "io/files/escape.hpp"
#include "io/vtk_xml/vtk_attributes.hpp"
#include "io/confined/structured.hpp"
#include "io/confined/vtk_grid.hpp"

namespace isotet::io::confined {
namespace {

/// The array of global numbers: the one marked so in the file, or one of a well-known name.
Array global_ids(vtkDataSetAttributes* attributes, std::span<const std::string_view> names) {
    vtkDataArray* ids = attributes->GetGlobalIds();
    for (const std::string_view name : names)
        if (!ids) ids = attributes->GetArray(std::string(name).c_str());
    if (!ids || ids->GetNumberOfComponents() != 1 || ids->GetDataType() == VTK_FLOAT ||
        ids->GetDataType() == VTK_DOUBLE)
        return {};
    return shared_array(ids);
}

std::vector<std::uint8_t> left_out_cells(vtkDataSet* data) {
    std::vector<std::uint8_t> result;
    const auto mark = [&](vtkDataArray* marks, auto is_out) {
        if (!marks || marks->GetNumberOfTuples() != data->GetNumberOfCells()) return;
        for (vtkIdType cell = 0; cell < marks->GetNumberOfTuples(); ++cell) {
            if (!is_out(static_cast<int>(marks->GetComponent(cell, 0)))) continue;
            result.resize(static_cast<std::size_t>(data->GetNumberOfCells()), 0);
            result[static_cast<std::size_t>(cell)] = 1;
        }
    };
    mark(data->GetCellData()->GetArray("vtkGhostType"), [](int ghost) { return (ghost & cell_is_out) != 0; });
    mark(data->GetCellData()->GetArray("vtkGhostLevels"), [](int level) { return level > 0; });
    return result;
}

std::vector<Field> fields_of(vtkDataSetAttributes* attributes, const ReadOptions& options, Association association) {
    std::vector<Field> fields;
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i) {
        vtkDataArray* values = attributes->GetArray(i); // null for arrays of strings
        if (!values || !values->GetName() || is_ghost_array(values->GetName())) continue;
        if (values->GetNumberOfComponents() < 1 || !wanted(options, association, values->GetName())) continue;
        fields.push_back({values->GetName(), shared_array(values)});
    }
    return fields;
}

bool is_uniform(const Array& offsets, const std::uint8_t* types, std::int64_t corners, std::uint8_t type) {
    return offsets.visit([&](auto begins) {
        for (std::size_t i = 0; i < begins.size(); ++i)
            if (static_cast<std::int64_t>(begins[i]) != static_cast<std::int64_t>(i) * corners) return false;
        return std::all_of(types, types + begins.size() - 1, [&](std::uint8_t t) { return t == type; });
    });
}

/// The faces of polyhedra: VTK tells where the part of each cell begins, or -1.
void add_faces(vtkUnstructuredGrid* grid, Cells& cells) {
    vtkIdTypeArray *stream = grid->GetFaces(), *begins = grid->GetFaceLocations();
    const vtkIdType count = grid->GetNumberOfCells();
    if (!stream || !begins || begins->GetNumberOfTuples() != count) return;
    const vtkIdType size = stream->GetNumberOfValues();
    std::vector<std::int64_t> faces, offsets{0};
    for (vtkIdType cell = 0; cell < count; ++cell) {
        vtkIdType at = begins->GetValue(cell);
        if (at >= 0 && at < size) {
            const vtkIdType of_cell = stream->GetValue(at++);
            faces.push_back(of_cell);
            for (vtkIdType face = 0; face < of_cell && at < size; ++face) {
                const vtkIdType points = stream->GetValue(at++);
                faces.push_back(points);
                for (vtkIdType i = 0; i < points && at < size; ++i) faces.push_back(stream->GetValue(at++));
            }
        }
        offsets.push_back(static_cast<std::int64_t>(faces.size()));
    }
    cells.faces = Array::own(std::move(faces));
    cells.face_offsets = Array::own(std::move(offsets));
}

Result<Cells> cells_of(vtkUnstructuredGrid* grid) {
    Cells cells;
    const vtkIdType count = grid->GetNumberOfCells();
    if (count == 0) return cells;
    vtkCellArray* array = grid->GetCells();
    vtkUnsignedCharArray* types = grid->GetCellTypesArray();
    if (!types || types->GetNumberOfTuples() != count || array->GetOffsetsArray()->GetNumberOfTuples() != count + 1)
        return Error{ErrorCode::invalid_data, fmt::format("there are {} cells, {} cell types and {} offsets", count,
                                                          types ? types->GetNumberOfTuples() : 0,
                                                          array->GetOffsetsArray()->GetNumberOfTuples())};
    cells.connectivity = shared_array(array->GetConnectivityArray());
    cells.offsets = shared_array(array->GetOffsetsArray());
    cells.types = shared_array(types);
    constexpr std::pair<std::uint8_t, int> linear[] = {{10, 4}, {11, 8}, {12, 8}, {13, 6}, {14, 5}};
    const auto first_type = cells.types.as<std::uint8_t>().front();
    for (const auto& [type, corners] : linear)
        if (type == first_type && is_uniform(cells.offsets, cells.types.as<std::uint8_t>().data(), corners, type) &&
            cells.connectivity.size() == static_cast<std::size_t>(count * corners)) {
            cells.offsets = cells.types = Array();
            cells.uniform_type = static_cast<CellType>(type);
            break;
        }
    if (!cells.types.empty()) add_faces(grid, cells);
    return cells;
}

} // namespace

std::optional<ScalarType> scalar_type(int vtk_type) {
    switch (vtk_type) {
    case VTK_CHAR:
    case VTK_SIGNED_CHAR: return ScalarType::int8;
    case VTK_BIT:
    case VTK_UNSIGNED_CHAR: return ScalarType::uint8;
    case VTK_SHORT: return ScalarType::int16;
    case VTK_UNSIGNED_SHORT: return ScalarType::uint16;
    case VTK_INT: return ScalarType::int32;
    case VTK_UNSIGNED_INT: return ScalarType::uint32;
    case VTK_LONG:
    case VTK_LONG_LONG:
    case VTK_ID_TYPE: return ScalarType::int64;
    case VTK_UNSIGNED_LONG:
    case VTK_UNSIGNED_LONG_LONG: return ScalarType::uint64;
    case VTK_FLOAT: return ScalarType::float32;
    case VTK_DOUBLE: return ScalarType::float64;
    default: return std::nullopt;
    }
}

Array shared_array(vtkDataArray* values) {
    if (!values) return {};
    vtkSmartPointer<vtkDataArray> array = values;
    if (!array->HasStandardMemoryLayout() || array->GetDataType() == VTK_BIT) {
        const int type = array->GetDataType() == VTK_BIT ? VTK_UNSIGNED_CHAR : array->GetDataType();
        array.TakeReference(vtkDataArray::CreateDataArray(type));
        array->DeepCopy(values);
    }
    const auto type = scalar_type(array->GetDataType());
    if (!type) return {};
    const auto components = static_cast<std::size_t>(std::max(1, array->GetNumberOfComponents()));
    auto owner = std::make_shared<vtkSmartPointer<vtkDataArray>>(array);
    return Array(*type, array->GetVoidPointer(0), static_cast<std::size_t>(array->GetNumberOfTuples()), components,
                 owner);
}

bool is_ghost_array(std::string_view name) { return name == "vtkGhostType" || name == "vtkGhostLevels"; }

Result<Piece> piece_of(vtkDataSet* data, const ReadOptions& options, std::string name,
                       std::vector<std::string>& notes) {
    Piece piece;
    piece.name = std::move(name);
    if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data)) {
        if (grid->GetPoints()) piece.grid.points = shared_array(grid->GetPoints()->GetData());
        auto cells = cells_of(grid);
        if (!cells) return cells.error();
        piece.grid.cells = std::move(*cells);
    } else if (auto structured = hexahedra_of(data, notes); !structured) {
        return structured.error();
    } else if (*structured) {
        piece.grid = std::move(**structured);
    } else {
        return Error{ErrorCode::invalid_data,
                     fmt::format("a data set of type {} has no volume cells: a grid is wanted", data->GetClassName())};
    }
    if (piece.grid.points.empty()) piece.grid.points = Array(ScalarType::float32, nullptr, 0, 3, nullptr);
    piece.left_out = left_out_cells(data);
    piece.point_ids = global_ids(data->GetPointData(), point_id_names);
    piece.cell_ids = global_ids(data->GetCellData(), cell_id_names);
    const std::size_t cell_count = piece.grid.cells.count();
    piece.grid.point_fields = fields_of(data->GetPointData(), options, Association::point);
    piece.grid.cell_fields = fields_of(data->GetCellData(), options, Association::cell);
    if (cell_count == 0 &&
        !vtkUnstructuredGrid::SafeDownCast(data)) { // a flat structured grid: its cells are not volumes
        piece.grid.cell_fields.clear();
        piece.cell_ids = Array();
        piece.left_out.clear();
    }
    return piece;
}

} // namespace isotet::io::confined
