// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Our reader of OpenFOAM cases against VTK's: the same points, cells and values of cells.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkOpenFOAMReader.h>
#include <vtkUnstructuredGrid.h>

#include <isotet/read.hpp>

#include "readers/foam_sample.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

vtkSmartPointer<vtkUnstructuredGrid> inside_of_case(const std::string& marker) {
    vtkNew<vtkOpenFOAMReader> reader;
    reader->SetFileName(marker.c_str());
    reader->DecomposePolyhedraOff();
    reader->CreateCellToPointOff();
    reader->SkipZeroTimeOff();
    reader->Update();
    const vtkSmartPointer<vtkCompositeDataIterator> block =
        vtkSmartPointer<vtkCompositeDataIterator>::Take(reader->GetOutput()->NewIterator());
    block->InitTraversal();
    return block->IsDoneWithTraversal() ? nullptr : vtkUnstructuredGrid::SafeDownCast(block->GetCurrentDataObject());
}

TEST(SameAsVtkOpenfoam, GivesTheSameCellsAndValues) {
    const FoamBox box = foam_box(4, [](int x, int y, int z) { return x < 2 && y > 0 && z != 2; });
    const auto f = [](const std::array<double, 3>& p) { return p[0] * p[1] - 0.3 * p[2]; };
    for (const FoamStyle style : {FoamStyle{false, 32, 64}, FoamStyle{true, 32, 64}}) {
        const TemporaryFolder folder;
        FoamFiles files;
        files["system/controlDict"] =
            foam_file("dictionary", "controlDict", {}, "startTime 0;\nendTime 1;\ndeltaT 1;\n");
        add_mesh(files, "", box, style);
        add_fields(files, "1/", box, f, style);
        for (const auto& [name, content] : files) folder.write(name, content);
        const std::string marker = folder.write("case.foam", "");
        const auto theirs = inside_of_case(marker);
        ASSERT_TRUE(theirs);
        const auto ours = read(marker);
        ASSERT_TRUE(ours) << ours.error().message;
        const Grid& grid = ours->grid;
        ASSERT_EQ(grid.points.tuples(), static_cast<std::size_t>(theirs->GetNumberOfPoints()));
        for (vtkIdType i = 0; i < theirs->GetNumberOfPoints(); ++i)
            for (int k = 0; k < 3; ++k)
                ASSERT_EQ(static_cast<float>(grid.points.at(static_cast<std::size_t>(i), static_cast<std::size_t>(k))),
                          static_cast<float>(theirs->GetPoint(i)[k]));
        ASSERT_EQ(grid.cells.count(), static_cast<std::size_t>(theirs->GetNumberOfCells()));
        vtkDataArray* values = theirs->GetCellData()->GetArray("T");
        ASSERT_TRUE(values);
        for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
            const auto their_cell = static_cast<vtkIdType>(cell);
            ASSERT_EQ(grid.cells.types.at(cell), theirs->GetCellType(their_cell)) << cell;
            std::set<vtkIdType> our_points, their_points;
            for (auto k = static_cast<std::size_t>(grid.cells.offsets.at(cell));
                 k < static_cast<std::size_t>(grid.cells.offsets.at(cell + 1)); ++k)
                our_points.insert(static_cast<vtkIdType>(grid.cells.connectivity.at(k)));
            vtkIdList* ids = theirs->GetCell(their_cell)->GetPointIds();
            their_points.insert(ids->begin(), ids->end());
            ASSERT_EQ(our_points, their_points) << cell;
            ASSERT_EQ(static_cast<float>(grid.cell_fields.at(0).values.at(cell)),
                      static_cast<float>(values->GetComponent(their_cell, 0)));
        }
    }
}

} // namespace
} // namespace isotet::test
