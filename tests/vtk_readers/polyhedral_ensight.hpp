// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedral grids as parts of EnSight Gold.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vtk_readers/gold_text.hpp"
#include "vtk_readers/polyhedral_files.hpp"

namespace isotet::test {

/// The numbers of a part, from 1.
struct GoldPolyhedra {
    std::vector<std::vector<std::int32_t>> hexahedra, faces;
    std::vector<std::int32_t> faces_of_cells, points_of_faces;
    std::vector<std::size_t> cells; ///< of the grid, in the order of the file

    explicit GoldPolyhedra(const Grid& grid) {
        const auto reader = core::FaceReader::open(grid.cells).value();
        std::vector<std::size_t> polyhedra;
        for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) {
            if (reader.begin(cell) == reader.end(cell)) {
                auto& corners = hexahedra.emplace_back();
                for (const std::int64_t point : corners_of_cell(grid, cell))
                    corners.push_back(static_cast<std::int32_t>(point) + 1);
                cells.push_back(cell);
                continue;
            }
            polyhedra.push_back(cell);
            std::uint64_t at = reader.begin(cell);
            faces_of_cells.push_back(static_cast<std::int32_t>(reader.at(at++)));
            while (at < reader.end(cell)) {
                auto& face = faces.emplace_back(reader.at(at++));
                for (std::int32_t& point : face) point = static_cast<std::int32_t>(reader.at(at++)) + 1;
                points_of_faces.push_back(static_cast<std::int32_t>(face.size()));
            }
        }
        cells.insert(cells.end(), polyhedra.begin(), polyhedra.end());
    }
};

struct GoldFiles {
    std::string geometry, f, g, c;
    std::string case_file = "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nVARIABLE\n"
                            "scalar per node: f f.scl\nscalar per node: g g.scl\nscalar per element: c c.scl\n";
};

inline GoldFiles polyhedral_ensight(const Grid& grid, GoldForm form,
                                    const std::function<void(GoldPolyhedra&)>& change = {}) {
    const auto floats_of = [](const Array& values, std::size_t component) {
        std::vector<float> out;
        for (std::size_t i = 0; i < values.tuples(); ++i) out.push_back(static_cast<float>(values.at(i, component)));
        return out;
    };
    GoldPolyhedra numbers(grid);
    if (change) change(numbers);
    GoldText geometry(form, true);
    geometry.line("a grid").line("of polyhedra").line("node id off").line("element id off");
    geometry.line("part").integers({1}).line("solid").line("coordinates");
    geometry.integers({static_cast<std::int32_t>(grid.points.tuples())});
    for (std::size_t axis = 0; axis < 3; ++axis) geometry.floats(floats_of(grid.points, axis));
    if (!numbers.hexahedra.empty())
        geometry.line("hexa8").integers({static_cast<std::int32_t>(numbers.hexahedra.size())}).rows(numbers.hexahedra);
    geometry.line("nfaced").integers({static_cast<std::int32_t>(numbers.faces_of_cells.size())});
    geometry.integers(numbers.faces_of_cells).integers(numbers.points_of_faces).rows(numbers.faces);
    const auto of_nodes = [&](const Field& field) {
        GoldText file(form);
        return file.line(field.name)
            .line("part")
            .integers({1})
            .line("coordinates")
            .floats(floats_of(field.values, 0))
            .text();
    };
    GoldText of_cells(form);
    of_cells.line("c").line("part").integers({1});
    std::vector<float> values;
    for (const std::size_t cell : numbers.cells)
        values.push_back(static_cast<float>(grid.cell_fields[0].values.at(cell)));
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(numbers.hexahedra.size());
    if (!numbers.hexahedra.empty()) of_cells.line("hexa8").floats({values.begin(), middle});
    of_cells.line("nfaced").floats({middle, values.end()});
    return {geometry.text(), of_nodes(grid.point_fields[0]), of_nodes(grid.point_fields[1]), of_cells.text()};
}

} // namespace isotet::test
