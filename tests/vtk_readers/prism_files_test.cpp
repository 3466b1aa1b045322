// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK's pentagonal and hexagonal prisms: the cells that VTK means, from every format of VTK.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/read.hpp>

#include "vtk_readers/hdf5_writer.hpp"
#include "support/surface_bytes.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

/// A regular prism in VTK's order, with a field.
struct PrismOfVtk {
    int sides;
    std::uint8_t type() const { return sides == 5 ? 15 : 16; }

    std::vector<double> points() const {
        std::vector<double> out;
        for (const double z : {0.0, 1.0})
            for (int i = 0; i < sides; ++i) {
                const double angle = 2 * std::numbers::pi * i / sides;
                out.insert(out.end(), {std::cos(angle), std::sin(angle), z});
            }
        return out;
    }
    std::vector<double> values() const {
        std::vector<double> out;
        for (int i = 0; i < 2 * sides; ++i) out.push_back(i * i % 7);
        return out;
    }
    std::vector<std::int64_t> corners() const {
        std::vector<std::int64_t> out;
        for (int i = 0; i < 2 * sides; ++i) out.push_back(i);
        return out;
    }
    double six_volumes() const { return 3.0 * sides * std::sin(2 * std::numbers::pi / sides); }

    void add_to(vtkUnstructuredGrid* grid) const {
        vtkNew<vtkPoints> places;
        places->SetDataTypeToDouble();
        const auto all = points();
        vtkNew<vtkDoubleArray> field;
        field->SetName("f");
        vtkNew<vtkIdList> ids;
        for (int i = 0; i < 2 * sides; ++i) {
            places->InsertNextPoint(&all[static_cast<std::size_t>(3 * i)]);
            field->InsertNextValue(values()[static_cast<std::size_t>(i)]);
            ids->InsertNextId(i);
        }
        grid->SetPoints(places);
        grid->GetPointData()->AddArray(field);
        grid->InsertNextCell(type(), ids);
    }

    void write_vtkhdf(const std::string& path) const {
        Hdf5Writer file(path);
        write_one_cell(file, type(), points(), values());
    }
};

/// The faces as VTK has them for the type.
Grid by_faces_of_vtk(const PrismOfVtk& prism) {
    vtkNew<vtkUnstructuredGrid> grid;
    prism.add_to(grid);
    vtkCell* const cell = grid->GetCell(0);
    std::vector<std::int64_t> faces{cell->GetNumberOfFaces()};
    for (int f = 0; f < cell->GetNumberOfFaces(); ++f) {
        vtkIdList* const points = cell->GetFace(f)->GetPointIds();
        faces.push_back(points->GetNumberOfIds());
        for (vtkIdType i = 0; i < points->GetNumberOfIds(); ++i) faces.push_back(points->GetId(i));
    }
    Grid out;
    out.points = Array::own(prism.points(), 3);
    out.cells.connectivity = Array::own(prism.corners());
    out.cells.offsets = Array::own(std::vector<std::int64_t>{0, 2 * prism.sides});
    out.cells.types = Array::own(std::vector<std::uint8_t>{42});
    out.cells.face_offsets = Array::own(std::vector<std::int64_t>{0, static_cast<std::int64_t>(faces.size())});
    out.cells.faces = Array::own(std::move(faces));
    return out;
}

std::string prism_surface(const Grid& grid, const PrismOfVtk& prism) {
    const PointField field{"f", Array::own(prism.values()), false, {}};
    const auto result = Contour::create({grid, field, {}, {}}).value().extract(2.5).value();
    EXPECT_EQ(result.cells_left_out, 0u);
    EXPECT_GT(result.surfaces[0].surface.triangle_count(), 0u);
    return bytes_of(result.surfaces[0].surface);
}

TEST(PrismFiles, HaveTheFacesThatVtkGivesTheirTypes) {
    for (const PrismOfVtk prism : {PrismOfVtk{5}, PrismOfVtk{6}}) {
        const std::string expected = prism_surface(by_faces_of_vtk(prism), prism);
        const TemporaryFolder folder;
        vtkNew<vtkUnstructuredGrid> grid;
        prism.add_to(grid);
        vtkNew<vtkXMLUnstructuredGridWriter> xml;
        xml->SetFileName(folder.file("a.vtu").c_str());
        xml->SetInputData(grid);
        xml->Write();
        vtkNew<vtkUnstructuredGridWriter> legacy;
        legacy->SetFileName(folder.file("a.vtk").c_str());
        legacy->SetInputData(grid);
        legacy->SetFileTypeToBinary();
        legacy->Write();
        prism.write_vtkhdf(folder.file("a.vtkhdf"));
        for (const char* name : {"a.vtu", "a.vtk", "a.vtkhdf"}) {
            const auto result = read(folder.file(name));
            ASSERT_TRUE(result) << name << ": " << result.error().message;
            EXPECT_NEAR(relative_volumes(result->grid).value().at(0), prism.six_volumes(), 1e-12) << name;
            EXPECT_TRUE(prism_surface(result->grid, prism) == expected) << name;
        }
    }
}

} // namespace
} // namespace isotet::test
