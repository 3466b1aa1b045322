// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedra of EnSight Gold (nfaced) in all its forms.
#include <functional>
#include <string>

#include "support/temporary_folder.hpp"
#include "vtk_readers/polyhedral_ensight.hpp"

namespace isotet::test {
namespace {

/// Coordinates and values as the format has them.
Grid in_single(Grid grid) {
    const auto narrow = [](const Array& from, std::size_t components) {
        std::vector<float> to;
        for (std::size_t i = 0; i < from.tuples(); ++i)
            for (std::size_t c = 0; c < components; ++c) to.push_back(static_cast<float>(from.at(i, c)));
        return Array::own(std::move(to), components);
    };
    grid.points = narrow(grid.points, 3);
    for (Field& field : grid.point_fields) field.values = narrow(field.values, 1);
    return grid;
}

class EnsightPolyhedra : public testing::TestWithParam<GoldForm> {
protected:
    Result<ReadResult> read_files(const GoldFiles& files) {
        folder_.write("grid.geo", files.geometry);
        folder_.write("f.scl", files.f);
        folder_.write("g.scl", files.g);
        folder_.write("c.scl", files.c);
        return read(folder_.write("a.case", files.case_file));
    }
    Result<ReadResult> read_changed(const std::function<void(GoldPolyhedra&)>& change) {
        return read_files(polyhedral_ensight(octree_for_files(), GetParam(), change));
    }

    TemporaryFolder folder_;
};

TEST_P(EnsightPolyhedra, HaveNoHolesAndTheirOwnValues) {
    const Grid sample = octree_for_files();
    const auto result = read_files(polyhedral_ensight(sample, GetParam()));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(survey(result->grid).value().cells_by_type, survey(sample).value().cells_by_type);
    const GoldPolyhedra numbers(sample);
    for (std::size_t i = 0; i < numbers.cells.size(); ++i)
        ASSERT_EQ(result->grid.cell_fields.at(0).values.at(i), static_cast<double>(numbers.cells[i]));
    expect_sound_polyhedra(result->grid);
    if (GetParam() != GoldForm::ascii) expect_surface_of(in_single(sample), result->grid); // all digits
    ASSERT_EQ(result->info.blocks.size(), 1u);
    EXPECT_EQ(result->info.blocks[0].name, "solid");
}

TEST_P(EnsightPolyhedra, ThatAreHexahedraGiveTheirSurface) {
    const Grid hexahedra = hexahedra_for_files();
    const auto result = read_files(polyhedral_ensight(as_polyhedra(hexahedra, Listed::ascending, 4), GetParam()));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(linearize(result->grid).value().report.known_shapes, hexahedra.cells.count());
    expect_surface_of(in_single(hexahedra), result->grid);
}

TEST_P(EnsightPolyhedra, ThatAreBrokenAreErrors) {
    const auto expect = [&](const std::function<void(GoldPolyhedra&)>& change, const std::string& part) {
        const auto result = read_changed(change);
        ASSERT_FALSE(result) << part;
        EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
    };
    expect([](GoldPolyhedra& p) { p.faces[3][1] = 344; },
           "a.case: cells[104] (polyhedron) has a face with point 343, ");
    expect([](GoldPolyhedra& p) { p.faces[3][1] = 0; }, "a.case: cells[104] (polyhedron) has a face with point -1, ");
    expect([](GoldPolyhedra& p) { p.points_of_faces[3] += 1; }, "grid.geo: the connectivity should have ");
    expect([](GoldPolyhedra& p) { p.points_of_faces[3] = -1; }, "grid.geo: the corners of faces holds -1, ");
    expect([](GoldPolyhedra& p) { p.points_of_faces[3] -= 1; }, "grid.geo: ");
    expect([](GoldPolyhedra& p) { p.faces_of_cells[3] = 1'000'000; },
           "grid.geo: an element has 1000000 nodes or faces, ");
    expect([](GoldPolyhedra& p) { p.faces_of_cells[3] += 1; }, "grid.geo: ");
}

TEST_P(EnsightPolyhedra, OfAFileThatIsCutAreAnError) {
    GoldFiles files = polyhedral_ensight(octree_for_files(), GetParam());
    const std::string whole = files.geometry;
    const std::size_t cells = whole.find("nfaced");
    for (const std::size_t size : {cells + 10, cells + 200, (cells + whole.size()) / 2, whole.size() - 6}) {
        files.geometry = whole.substr(0, size);
        const auto result = read_files(files);
        ASSERT_FALSE(result) << size << " of " << whole.size();
        EXPECT_NE(result.error().message.find("grid.geo"), std::string::npos) << result.error().message;
    }
}

INSTANTIATE_TEST_SUITE_P(Forms, EnsightPolyhedra,
                         testing::Values(GoldForm::ascii, GoldForm::c, GoldForm::c_swapped, GoldForm::fortran));

} // namespace
} // namespace isotet::test
