// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedral grids as Exodus files.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <vtk_exodusII.h>

#include "vtk_readers/polyhedral_files.hpp"

namespace isotet::test {

/// The blocks of a file. Numbers are those of the file, from 1.
struct ExodusBlocks {
    struct Ragged {
        std::vector<int> numbers, counts;
    };
    std::vector<int> hexahedra;
    std::vector<Ragged> faces;            ///< two blocks
    std::vector<Ragged> polyhedra;        ///< two blocks
    std::vector<std::size_t> cells_of[3]; ///< of the grid, in the order of the file: hexahedra, polyhedra
    std::string face_topology = "nsided";

    explicit ExodusBlocks(const Grid& grid) : faces(2), polyhedra(2) {
        const FaceTable table(grid);
        for (std::size_t face = 0; face < table.faces.size(); ++face) {
            Ragged& block = faces[face < table.faces.size() / 3 ? 0 : 1];
            for (const std::int64_t point : table.faces[face]) block.numbers.push_back(static_cast<int>(point) + 1);
            block.counts.push_back(static_cast<int>(table.faces[face].size()));
        }
        const auto reader = core::FaceReader::open(grid.cells).value();
        std::size_t polyhedron = 0;
        for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
            if (reader.begin(cell) == reader.end(cell)) {
                for (const std::int64_t point : corners_of_cell(grid, cell))
                    hexahedra.push_back(static_cast<int>(point) + 1);
                cells_of[0].push_back(cell);
                continue;
            }
            const std::size_t which = polyhedron < table.cells.size() / 2 ? 0 : 1;
            for (const std::int64_t face : table.cells[polyhedron])
                polyhedra[which].numbers.push_back(static_cast<int>(face) + 1);
            polyhedra[which].counts.push_back(static_cast<int>(table.cells[polyhedron].size()));
            cells_of[which + 1].push_back(cell);
            ++polyhedron;
        }
    }
};

/// Element blocks 10 (hexahedra), 20 and 30 (polyhedra).
inline void write_polyhedral_exodus(const Grid& grid, const std::string& path, int format = 0,
                                    const std::function<void(ExodusBlocks&)>& change = {}) {
    ExodusBlocks blocks(grid);
    if (change) change(blocks);
    int word = 8, stored = 8;
    const int file = ex_create(path.c_str(), EX_CLOBBER | format, &word, &stored);
    ASSERT_GE(file, 0);
    const auto points = static_cast<std::int64_t>(grid.points.tuples());
    ex_init_params counts{};
    counts.num_dim = 3;
    counts.num_nodes = points;
    counts.num_elem = static_cast<std::int64_t>(grid.cells.count());
    counts.num_elem_blk = blocks.hexahedra.empty() ? 2 : 3;
    counts.num_face_blk = 2;
    for (const auto& block : blocks.faces) counts.num_face += static_cast<std::int64_t>(block.counts.size());
    ASSERT_GE(ex_put_init_ext(file, &counts), 0);
    std::vector<double> axes[3];
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) axes[axis].push_back(grid.points.at(i, axis));
    ex_put_coord(file, axes[0].data(), axes[1].data(), axes[2].data());
    for (int b = 0; b < 2; ++b) {
        const auto& block = blocks.faces[static_cast<std::size_t>(b)];
        // Of other topologies the library writes as many nodes for each face as are stated.
        const bool ragged = blocks.face_topology == "nsided";
        const std::size_t stated = ragged ? block.numbers.size() : 4;
        auto numbers = block.numbers;
        if (!ragged) numbers.resize(4 * block.counts.size());
        ASSERT_GE(ex_put_block(file, EX_FACE_BLOCK, b + 1, blocks.face_topology.c_str(),
                               static_cast<std::int64_t>(block.counts.size()), static_cast<std::int64_t>(stated), 0, 0,
                               0),
                  0);
        ex_put_conn(file, EX_FACE_BLOCK, b + 1, numbers.data(), nullptr, nullptr);
        ex_put_entity_count_per_polyhedra(file, EX_FACE_BLOCK, b + 1, block.counts.data());
    }
    if (!blocks.hexahedra.empty()) {
        ex_put_block(file, EX_ELEM_BLOCK, 10, "HEX8", static_cast<std::int64_t>(blocks.hexahedra.size() / 8), 8, 0, 0,
                     0);
        ex_put_conn(file, EX_ELEM_BLOCK, 10, blocks.hexahedra.data(), nullptr, nullptr);
    }
    for (int b = 0; b < 2; ++b) {
        const auto& block = blocks.polyhedra[static_cast<std::size_t>(b)];
        const int id = 10 * (b + 2);
        ASSERT_GE(ex_put_block(file, EX_ELEM_BLOCK, id, "nfaced", static_cast<std::int64_t>(block.counts.size()), 0, 0,
                               static_cast<std::int64_t>(block.numbers.size()), 0),
                  0);
        ex_put_conn(file, EX_ELEM_BLOCK, id, nullptr, nullptr, block.numbers.data());
        ex_put_entity_count_per_polyhedra(file, EX_ELEM_BLOCK, id, block.counts.data());
    }
    char f[] = "f", g[] = "g", c[] = "c";
    char* point_names[] = {f, g};
    char* cell_names[] = {c};
    ex_put_variable_param(file, EX_NODAL, 2);
    ex_put_variable_names(file, EX_NODAL, 2, point_names);
    ex_put_variable_param(file, EX_ELEM_BLOCK, 1);
    ex_put_variable_names(file, EX_ELEM_BLOCK, 1, cell_names);
    const double time = 0;
    ex_put_time(file, 1, &time);
    for (int v = 0; v < 2; ++v)
        ex_put_var(file, 1, EX_NODAL, v + 1, 1, points, grid.point_fields[static_cast<std::size_t>(v)].values.data());
    for (int b = 0; b < 3; ++b) {
        std::vector<double> values;
        for (const std::size_t cell : blocks.cells_of[b]) values.push_back(grid.cell_fields[0].values.at(cell));
        if (!values.empty())
            ex_put_var(file, 1, EX_ELEM_BLOCK, 1, 10 * (b + 1), static_cast<std::int64_t>(values.size()),
                       values.data());
    }
    ASSERT_GE(ex_close(file), 0);
}

} // namespace isotet::test
