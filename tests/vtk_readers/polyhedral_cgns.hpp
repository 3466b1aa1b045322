// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedral grids as CGNS files.
#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "vtk_readers/polyhedral_files.hpp"

#include <vtk_cgns.h> // last: its macros rename common words
#include VTK_CGNS(cgnslib.h)
#include VTK_CGNS(cgns_io.h)

namespace isotet::test {

/// How a grid is stored.
struct CgnsWay {
    bool hdf5 = false, cells_first = false;
    int face_sections = 1;
    unsigned wrong_signs = 0; ///< a seed
    bool parents = false;     ///< instead of NFACE_n
    bool local_parents = false;
    bool old_layout = false; ///< of CGNS before 3.4: counts between the numbers
};

/// The arrays of a zone. Numbers are those of the file, from 1.
struct CgnsArrays {
    std::vector<cgsize_t> face_points, face_offsets{0}, cell_faces, cell_offsets{0};
    std::vector<cgsize_t> parents; ///< of the left sides, then of the right ones

    CgnsArrays(const FaceTable& table, const CgnsWay& way) {
        const auto faces = static_cast<cgsize_t>(table.faces.size()), cells = static_cast<cgsize_t>(table.cells.size());
        const cgsize_t first_face = way.cells_first ? cells + 1 : 1;
        std::mt19937 random(way.wrong_signs);
        for (const FaceLoop& loop : table.faces) {
            for (const std::int64_t point : loop) face_points.push_back(point + 1);
            face_offsets.push_back(static_cast<cgsize_t>(face_points.size()));
        }
        parents.assign(2 * table.faces.size(), 0);
        for (std::size_t cell = 0; cell < table.cells.size(); ++cell) {
            for (std::size_t i = 0; i < table.cells[cell].size(); ++i) {
                const std::int64_t face = table.cells[cell][i];
                const bool minus = way.wrong_signs != 0 ? random() % 2 != 0 : table.second[cell][i];
                cell_faces.push_back((minus ? -1 : 1) * (face + first_face));
                const auto side = static_cast<std::size_t>(face + (table.second[cell][i] ? faces : 0));
                parents[side] = static_cast<cgsize_t>(cell) + 1 + (way.local_parents ? 0 : faces);
            }
            cell_offsets.push_back(static_cast<cgsize_t>(cell_faces.size()));
        }
    }
};

/// Numbers with the count of each element before it.
inline std::vector<cgsize_t> with_counts(const std::vector<cgsize_t>& numbers, const std::vector<cgsize_t>& offsets) {
    std::vector<cgsize_t> out;
    for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
        out.push_back(offsets[i + 1] - offsets[i]);
        out.insert(out.end(), numbers.begin() + offsets[i], numbers.begin() + offsets[i + 1]);
    }
    return out;
}

/// Takes ElementStartOffset away, and writes other numbers.
inline void make_section_old(int file, const std::string& section, const std::vector<cgsize_t>& numbers) {
    int tree = 0;
    double root = 0, node = 0, connectivity = 0, offsets = 0;
    cg_get_cgio(file, &tree);
    cgio_get_root_id(tree, &root);
    ASSERT_EQ(cgio_get_node_id(tree, root, ("/Base/Zone/" + section).c_str(), &node), 0);
    ASSERT_EQ(cgio_get_node_id(tree, node, "ElementStartOffset", &offsets), 0);
    ASSERT_EQ(cgio_delete_node(tree, node, offsets), 0);
    ASSERT_EQ(cgio_get_node_id(tree, node, "ElementConnectivity", &connectivity), 0);
    const auto size = static_cast<cgsize_t>(numbers.size());
    ASSERT_EQ(cgio_set_dimensions(tree, connectivity, sizeof(cgsize_t) == 8 ? "I8" : "I4", 1, &size), 0);
    ASSERT_EQ(cgio_write_all_data(tree, connectivity, numbers.data()), 0);
}

inline void write_cgns(const Grid& grid, const CgnsWay& way, const std::string& path,
                       const std::function<void(CgnsArrays&)>& change = {}) {
    const FaceTable table(grid);
    ASSERT_EQ(table.cells.size(), grid.cells.count()) << "all cells must be polyhedra";
    CgnsArrays arrays(table, way);
    if (change) change(arrays);
    const auto points = static_cast<cgsize_t>(grid.points.tuples()), cells = static_cast<cgsize_t>(grid.cells.count());
    const auto faces = static_cast<cgsize_t>(arrays.face_offsets.size() - 1);
    int file = 0, base = 0, zone = 0, at = 0, solution = 0;
    ASSERT_EQ(cg_set_file_type(way.hdf5 ? CG_FILE_HDF5 : CG_FILE_ADF), 0);
    ASSERT_EQ(cg_open(path.c_str(), CG_MODE_WRITE, &file), 0) << cg_get_error();
    cg_base_write(file, "Base", 3, 3, &base);
    const cgsize_t size[3] = {points, cells, 0};
    cg_zone_write(file, base, "Zone", size, CG_Unstructured, &zone);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        for (std::size_t i = 0; i < grid.points.tuples(); ++i) values.push_back(grid.points.at(i, axis));
        const char name[] = {'C', 'o', 'o', 'r', 'd', 'i', 'n', 'a', 't', 'e', "XYZ"[axis], '\0'};
        cg_coord_write(file, base, zone, CG_RealDouble, name, values.data(), &at);
    }
    const cgsize_t first_face = way.cells_first ? cells + 1 : 1, first_cell = way.cells_first ? 1 : faces + 1;
    const auto write_section = [&](const std::string& name, CG_ElementType_t type, cgsize_t first,
                                   const std::vector<cgsize_t>& numbers, const std::vector<cgsize_t>& offsets) {
        const auto count = static_cast<cgsize_t>(offsets.size()) - 1;
        ASSERT_EQ(cg_poly_section_write(file, base, zone, name.c_str(), type, first, first + count - 1, 0,
                                        numbers.data(), offsets.data(), &at),
                  0)
            << cg_get_error();
        if (way.old_layout) make_section_old(file, name, with_counts(numbers, offsets));
    };
    for (int part = 0; part < way.face_sections; ++part) {
        const cgsize_t begin = faces * part / way.face_sections, end = faces * (part + 1) / way.face_sections;
        std::vector<cgsize_t> offsets(arrays.face_offsets.begin() + begin, arrays.face_offsets.begin() + end + 1);
        const cgsize_t from = offsets.front();
        const std::vector<cgsize_t> numbers(arrays.face_points.begin() + from,
                                            arrays.face_points.begin() + std::max(from, offsets.back()));
        for (cgsize_t& offset : offsets) offset -= from;
        write_section("Faces" + std::to_string(part), CG_NGON_n, first_face + begin, numbers, offsets);
        if (!way.parents) continue;
        std::vector<cgsize_t> parents;
        for (const cgsize_t side : {cgsize_t{0}, faces})
            parents.insert(parents.end(), arrays.parents.begin() + side + begin, arrays.parents.begin() + side + end);
        parents.resize(static_cast<std::size_t>(4 * (end - begin)), 0); // and their faces' numbers, which are not known
        cg_parent_data_write(file, base, zone, at, parents.data());
    }
    if (!way.parents) write_section("Cells", CG_NFACE_n, first_cell, arrays.cell_faces, arrays.cell_offsets);
    for (const auto& [location, fields] :
         {std::pair(CG_Vertex, &grid.point_fields), std::pair(CG_CellCenter, &grid.cell_fields)}) {
        cg_sol_write(file, base, zone, location == CG_Vertex ? "AtPoints" : "AtCells", location, &solution);
        for (const Field& field : *fields)
            cg_field_write(file, base, zone, solution, CG_RealDouble, field.name.c_str(), field.values.data(), &at);
    }
    ASSERT_EQ(cg_close(file), 0) << cg_get_error();
}

} // namespace isotet::test
