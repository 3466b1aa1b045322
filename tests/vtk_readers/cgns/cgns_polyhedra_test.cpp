// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedra of CGNS: faces (NGON_n), and cells by faces (NFACE_n) or faces by cells (ParentElements).
#include <functional>
#include <string>

#include "support/temporary_folder.hpp"
#include "vtk_readers/polyhedral_cgns.hpp"

namespace isotet::test {
namespace {

Result<ReadResult> read_cgns(const Grid& grid, const CgnsWay& way,
                             const std::function<void(CgnsArrays&)>& change = {}) {
    const TemporaryFolder folder;
    write_cgns(grid, way, folder.file("a.cgns"), change);
    return read(folder.file("a.cgns"));
}

TEST(CgnsPolyhedra, HaveNoHolesHoweverTheyAreStored) {
    const Grid sample = all_polyhedra(octree_for_files());
    for (const CgnsWay& way :
         {CgnsWay{}, CgnsWay{.hdf5 = true}, CgnsWay{.cells_first = true}, CgnsWay{.face_sections = 3},
          CgnsWay{.cells_first = true, .face_sections = 2}, CgnsWay{.wrong_signs = 7}, CgnsWay{.parents = true},
          CgnsWay{.hdf5 = true, .face_sections = 2, .parents = true}, CgnsWay{.parents = true, .local_parents = true},
          CgnsWay{.old_layout = true}, CgnsWay{.face_sections = 2, .old_layout = true}}) {
        SCOPED_TRACE(testing::Message() << "HDF5 " << way.hdf5 << ", cells first " << way.cells_first << ", sections "
                                        << way.face_sections << ", parents " << way.parents << ", old "
                                        << way.old_layout);
        const auto result = read_cgns(sample, way);
        ASSERT_TRUE(result) << result.error().message;
        ASSERT_EQ(result->grid.cells.count(), sample.cells.count());
        ASSERT_EQ(result->grid.cell_fields.size(), 1u);
        EXPECT_EQ(result->grid.cell_fields[0].values.at(7), 7);
        EXPECT_EQ(result->info.blocks.at(0).cells, sample.cells.count());
        expect_sound_polyhedra(result->grid);
        expect_surface_of(sample, result->grid);
    }
}

TEST(CgnsPolyhedra, ThatAreHexahedraGiveTheirSurface) {
    const Grid hexahedra = hexahedra_for_files();
    for (const bool parents : {false, true}) {
        const auto result = read_cgns(as_polyhedra(hexahedra, Listed::ascending, 4), {.parents = parents});
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(linearize(result->grid).value().report.known_shapes, hexahedra.cells.count());
        expect_surface_of(hexahedra, result->grid);
    }
}

TEST(CgnsPolyhedra, ThatAreBrokenAreErrors) {
    const Grid sample = as_polyhedra(hexahedra_for_files(), Listed::ascending, 0);
    const auto expect = [&](const CgnsWay& way, const std::function<void(CgnsArrays&)>& change,
                            const std::string& part) {
        const auto result = read_cgns(sample, way, change);
        ASSERT_FALSE(result) << part;
        EXPECT_NE(result.error().message.find("a.cgns: zone \"Base/Zone\": "), std::string::npos)
            << result.error().message;
        EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
    };
    for (const bool hdf5 : {false, true}) {
        expect(
            {.hdf5 = hdf5}, [](CgnsArrays& a) { a.face_points[5] = 126; },
            "a face has point 126, but the points are 1 to 125");
        expect({.hdf5 = hdf5}, [](CgnsArrays& a) { a.face_points[5] = 0; }, "a face has point 0");
        expect({.hdf5 = hdf5}, [](CgnsArrays& a) { a.cell_faces[5] = 0; }, "a cell has face 0, which is in no section");
        expect({.hdf5 = hdf5}, [](CgnsArrays& a) { a.cell_faces[5] = -100000; }, "a cell has face -100000");
        expect({.hdf5 = hdf5}, [](CgnsArrays& a) { a.cell_offsets[5] = 9999; }, "cell 4 has faces 24 to 9999 of 384");
        expect(
            {.hdf5 = hdf5}, [](CgnsArrays& a) { std::swap(a.face_offsets[5], a.face_offsets[6]); },
            "face 5 has points 24 to 20");
    }
    expect({.parents = true}, [](CgnsArrays& a) { a.parents[3] = -1; }, "a face has cell -1");
    expect({.parents = true}, [](CgnsArrays& a) { a.parents[3] = 1000000; }, "but 240 faces only");
    expect(
        {.face_sections = 2, .old_layout = true}, [](CgnsArrays& a) { a.cell_faces.back() = 0; }, "a cell has face 0");
}

} // namespace
} // namespace isotet::test
