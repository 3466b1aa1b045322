// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "core/errors.hpp"
#include "io/own/vtk_xml/cells_reader.hpp"
#include "io/own/vtk_xml/join_cells.hpp"
#include "io/own/vtk_xml/load.hpp"

namespace isotet::io::vtk_xml {

namespace {

/// Tuples of each piece, by an attribute that counts them.
Result<Layout> layout_by(const Document& document, const char* attribute) {
    Layout layout;
    for (const auto& element : pieces_of(document)) {
        const auto count = count_of(element, attribute);
        if (!count) return count.error();
        if (*count > document.source.size() * 0x4000ULL - layout.total) // no compressor makes that of the file
            return invalid_data(
                fmt::format("{} points or cells are announced in a file of {} bytes", *count, document.source.size()));
        layout.tuples.push_back(*count);
        layout.total += *count;
    }
    return layout;
}

} // namespace

Result<Layouts> layouts_of_unstructured(const Document& document) {
    if (!document.primary().child("Piece")) return invalid_data(fmt::format("the {} has no Piece", document.type));
    auto points = layout_by(document, "NumberOfPoints"), cells = layout_by(document, "NumberOfCells");
    if (!points) return points.error();
    if (!cells) return cells.error();
    return Layouts{std::move(*points), std::move(*cells)};
}

Result<Piece> load_unstructured(Document& document, const Layouts& layouts, const Wanted& wanted,
                                const Progress& progress, Loaded& loaded) {
    const auto elements = pieces_of(document);
    const Layout &points = layouts.points, &cells = layouts.cells;
    Piece piece;
    auto places = load_points(document, elements, points, wanted.step, progress);
    if (!places) return places.error();
    piece.grid.points = std::move(*places);
    if (auto read = load_fields(document, layouts, wanted, progress, loaded, piece); !read) return read.error();
    std::vector<Cells> parts;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const CellsElement element{elements[i], cells.tuples[i], wanted.step};
        const ActiveWish active{piece.grid, wanted.options};
        const bool active_may_do =
            wanted.options.active_cells && elements.size() == 1 && !wanted.ids && piece.left_out.empty();
        auto part = read_cells(document, element, active_may_do ? &active : nullptr, progress);
        if (!part) return part.error();
        if (part->only_active) piece.cells_in_file = cells.total;
        if (elements.size() > 1)
            if (auto checked = check_corners(part->cells, points.tuples[i]); !checked) return checked.error();
        parts.push_back(std::move(part->cells));
    }
    piece.grid.cells = parts.size() == 1 ? std::move(parts.front()) : join_cells(parts, points.tuples);
    return piece;
}

} // namespace isotet::io::vtk_xml
