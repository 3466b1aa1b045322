// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/amr/boxes_as_pieces.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "io/amr/point_values.hpp"
#include "io/amr/shown_cells.hpp"
#include "io/vtk_xml/load.hpp"

namespace isotet::io::amr {
namespace {

constexpr std::uint64_t bytes_a_cell = 200; // points, corners, numbers; what finding values at points takes

Result<void> require_room(const Hierarchy& hierarchy) {
    std::uint64_t cells = 0;
    for (const Level& level : hierarchy.levels)
        for (const CellBox& box : level.boxes) { // below 2^62 each
            cells += box.cells();
            if (cells > (std::uint64_t{1} << 48))
                return Error{ErrorCode::out_of_memory, "the boxes have more than 2^48 cells together"};
        }
    return core::require_memory("the boxes of all levels", bytes_a_cell * cells);
}

/// Points and hexahedra of a box.
Result<void> add_cells(const Lattice& lattice, std::size_t level, const CellBox& box, Piece& piece) {
    const vtk_xml::GridSize size{box.cells(0) + 1, box.cells(1) + 1, box.cells(2) + 1};
    core::Buffer<double> points(3 * box.points());
    core::Buffer<std::int64_t> numbers(box.points());
    core::parallel_each(box.points(), std::size_t{1} << 14, [&](std::size_t at) {
        const Place along{static_cast<std::int64_t>(at % size.x), static_cast<std::int64_t>(at / size.x % size.y),
                          static_cast<std::int64_t>(at / (size.x * size.y))};
        Place place;
        for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = box.first[axis] + along[axis];
        place = lattice.from_level(level, place);
        for (std::size_t axis = 0; axis < 3; ++axis) points[3 * at + axis] = lattice.coordinate(place[axis], axis);
        numbers[at] = static_cast<std::int64_t>(lattice.number_of(place));
    });
    piece.grid.points = std::move(points).to_array(3);
    piece.point_ids = std::move(numbers).to_array();
    std::vector<std::string> notes; // of all boxes together
    auto cells = vtk_xml::cells_of_box(size, notes);
    if (!cells) return cells.error();
    piece.grid.cells = *std::move(cells);
    return {};
}

std::string summary_of(const Hierarchy& hierarchy) {
    std::size_t boxes = 0;
    for (const Level& level : hierarchy.levels) boxes += level.boxes.size();
    return fmt::format(
        "{} boxes on {} level{} were read as one grid of hexahedra: cells under finer ones are left out, and "
        "fields of cells are given at points, too (docs/formats.md)",
        boxes, hierarchy.levels.size(), hierarchy.levels.size() == 1 ? "" : "s");
}

/// Fields that were read for their values at points, or for those in cells only.
void leave_wanted(const ReadOptions& options, Grid& grid) {
    std::erase_if(grid.point_fields,
                  [&](const Field& field) { return !wanted(options, Association::point, field.name); });
    std::erase_if(grid.cell_fields,
                  [&](const Field& field) { return !wanted(options, Association::cell, field.name); });
}

} // namespace

ReadOptions options_of_boxes(const ReadOptions& options) {
    ReadOptions all = options;
    if (!options.point_fields) all.cell_fields.reset();
    else if (all.cell_fields)
        all.cell_fields->insert(all.cell_fields->end(), options.point_fields->begin(), options.point_fields->end());
    return all;
}

void announce_point_values(FileInfo& info) {
    const std::vector<FieldInfo> known = info.fields;
    for (FieldInfo field : known) {
        if (field.association != Association::cell) continue;
        field.association = Association::point;
        if (field.type != ScalarType::float32) field.type = ScalarType::float64;
        announce(info, std::move(field));
    }
}

Result<void> boxes_as_pieces(const Hierarchy& hierarchy, const ReadOptions& options, Loaded& loaded,
                             const Progress& progress) {
    const auto lattice = Lattice::make(hierarchy);
    if (!lattice) return lattice.error();
    if (auto fits = require_room(hierarchy); !fits) return fits;
    std::vector<Piece>& pieces = loaded.pieces;
    std::vector<Marks> marks;
    for (Piece& piece : pieces) marks.push_back(std::exchange(piece.left_out, {}));
    if (auto done = mark_covered(hierarchy, *lattice, marks, progress); !done) return done;
    if (auto done = add_point_values(hierarchy, *lattice, marks, pieces, progress); !done) return done;
    std::size_t number = 0;
    for (std::size_t level = 0; level < hierarchy.levels.size(); ++level)
        for (const CellBox& box : hierarchy.levels[level].boxes) {
            Piece& piece = pieces[number];
            leave_wanted(options, piece.grid);
            if (auto done = add_cells(*lattice, level, box, piece); !done) return done;
            piece.left_out = std::move(marks[number++]);
        }
    loaded.notes.push_back(summary_of(hierarchy));
    return {};
}

} // namespace isotet::io::amr
