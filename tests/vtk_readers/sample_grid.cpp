// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vtk_readers/sample_grid.hpp"

#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkLongLongArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

constexpr std::array<std::array<double, 3>, 14> places = {{{0, 0, 0},
                                                           {1, 0, 0},
                                                           {1, 1, 0},
                                                           {0, 1, 0},
                                                           {0, 0, 1},
                                                           {1, 0, 1},
                                                           {1, 1, 1},
                                                           {0, 1, 1},
                                                           {2, 0, 0},
                                                           {2, 1, 0},
                                                           {2, 0, 1},
                                                           {2, 1, 1},
                                                           {3, 0.5, 0.5},
                                                           {0.5, 2, 0.5}}};

struct Cell {
    int type;
    std::vector<vtkIdType> corners;
};
const std::vector<Cell>& cells() {
    static const std::vector<Cell> list = {
        {10, {0, 1, 2, 5}},       {10, {0, 2, 7, 5}},         {10, {0, 2, 3, 7}},
        {10, {0, 5, 7, 4}},       {10, {2, 7, 5, 6}},         {12, {1, 8, 9, 2, 5, 10, 11, 6}},
        {14, {8, 9, 11, 10, 12}}, {13, {2, 3, 13, 6, 7, 13}}, {5, {0, 1, 2}}};
    return list;
}

template <class VtkArray>
vtkSmartPointer<VtkArray> field(const char* name, int components, vtkIdType tuples) {
    auto array = vtkSmartPointer<VtkArray>::New();
    array->SetName(name);
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(tuples);
    return array;
}

const Array* find(const std::vector<Field>& fields, const std::string& name) {
    for (const Field& one : fields)
        if (one.name == name) return &one.values;
    return nullptr;
}

std::vector<std::int64_t> corners_of(const Grid& grid, std::size_t cell) {
    std::vector<std::int64_t> result;
    const auto begin = static_cast<std::size_t>(grid.cells.offsets.at(cell)),
               end = static_cast<std::size_t>(grid.cells.offsets.at(cell + 1));
    for (std::size_t i = begin; i < end; ++i)
        result.push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(i)));
    return result;
}

void expect_field(const std::vector<Field>& fields, const std::string& name, ScalarType type, std::size_t components,
                  std::size_t tuples, const std::function<double(std::size_t, std::size_t)>& value) {
    const Array* values = find(fields, name);
    ASSERT_TRUE(values) << name;
    EXPECT_EQ(values->type(), type) << name;
    ASSERT_EQ(values->components(), components) << name;
    ASSERT_EQ(values->tuples(), tuples) << name;
    for (std::size_t i = 0; i < tuples; ++i)
        for (std::size_t c = 0; c < components; ++c) EXPECT_EQ(values->at(i, c), value(i, c)) << name << " " << i;
}

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> sample_grid() {
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const auto& place : places) points->InsertNextPoint(place.data());
    grid->SetPoints(points);
    for (const Cell& cell : cells())
        grid->InsertNextCell(cell.type, static_cast<vtkIdType>(cell.corners.size()), cell.corners.data());
    const vtkIdType point_count = places.size(), cell_count = grid->GetNumberOfCells();
    const auto height = field<vtkDoubleArray>("height", 1, point_count);
    const auto velocity = field<vtkFloatArray>("velocity", 3, point_count);
    const auto number = field<vtkIntArray>("number", 1, point_count);
    for (vtkIdType i = 0; i < point_count; ++i) {
        height->SetValue(i, places[static_cast<std::size_t>(i)][2] + 0.1);
        number->SetValue(i, static_cast<int>(i) - 3);
        for (int c = 0; c < 3; ++c) velocity->SetComponent(i, c, static_cast<double>(i) * 4 + c);
    }
    const auto region = field<vtkLongLongArray>("region", 1, cell_count);
    const auto quality = field<vtkFloatArray>("quality: a/b", 1, cell_count);
    for (vtkIdType i = 0; i < cell_count; ++i) {
        region->SetValue(i, 5000000000 + i);
        quality->SetValue(i, static_cast<float>(i) / 8);
    }
    for (vtkDataArray* array : std::initializer_list<vtkDataArray*>{height, velocity, number})
        grid->GetPointData()->AddArray(array);
    for (vtkDataArray* array : std::initializer_list<vtkDataArray*>{region, quality})
        grid->GetCellData()->AddArray(array);
    return grid;
}

void expect_sample(const Result<ReadResult>& result) {
    ASSERT_TRUE(result) << result.error().message;
    const Grid& grid = result->grid;
    ASSERT_EQ(grid.points.tuples(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(grid.points.at(i, axis), places[i][axis]);
    ASSERT_EQ(grid.cells.count(), cells().size());
    for (std::size_t i = 0; i < cells().size(); ++i) {
        EXPECT_EQ(grid.cells.types.at(i), cells()[i].type);
        EXPECT_EQ(corners_of(grid, i), std::vector<std::int64_t>(cells()[i].corners.begin(), cells()[i].corners.end()));
    }
    const std::size_t points = places.size(), count = cells().size();
    expect_field(grid.point_fields, "height", ScalarType::float64, 1, points,
                 [](auto i, auto) { return places[i][2] + 0.1; });
    expect_field(grid.point_fields, "velocity", ScalarType::float32, 3, points,
                 [](auto i, auto c) { return static_cast<double>(i * 4 + c); });
    expect_field(grid.point_fields, "number", ScalarType::int32, 1, points,
                 [](auto i, auto) { return static_cast<double>(i) - 3; });
    expect_field(grid.cell_fields, "region", ScalarType::int64, 1, count,
                 [](auto i, auto) { return 5e9 + static_cast<double>(i); });
    expect_field(grid.cell_fields, "quality: a/b", ScalarType::float32, 1, count,
                 [](auto i, auto) { return static_cast<double>(i) / 8; });
}

void write_vtu(vtkUnstructuredGrid* grid, const std::string& path, Encoding encoding) {
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetFileName(path.c_str());
    writer->SetInputData(grid);
    if (encoding == Encoding::ascii) writer->SetDataModeToAscii();
    else if (encoding == Encoding::base64) writer->SetDataModeToBinary();
    else writer->SetDataModeToAppended();
    writer->SetEncodeAppendedData(encoding == Encoding::appended_base64);
    if (encoding != Encoding::appended_raw_compressed) writer->SetCompressorTypeToNone();
    writer->Write();
}

void read_prefixes(const std::string& content, const std::string& name, std::size_t step,
                   const std::function<void(const Result<ReadResult>&, std::size_t)>& judge) {
    const TemporaryFolder folder;
    for (std::size_t length = 1; length < content.size(); length += step)
        judge(read(folder.write(name, std::string_view(content).substr(0, length))), length);
}

} // namespace isotet::test
