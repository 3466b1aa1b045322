// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/pieces/survey_unread.hpp"
#include "io/vtk_xml/cells_reader.hpp"
#include "io/vtk_xml/load.hpp"
#include "io/vtk_xml/unread_cells.hpp"

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

/// Where the tuples of a piece are among those of all.
struct Range {
    std::uint64_t first = 0, count = 0;
};

Range range_of(const Layout& layout, std::size_t piece) {
    Range range{0, layout.tuples[piece]};
    for (std::size_t i = 0; i < piece; ++i) range.first += layout.tuples[i];
    return range;
}

Array part_of(const Array& values, const Range& range) {
    if (values.empty()) return values;
    const std::size_t bytes = values.components() * size_of(values.type());
    return {values.type(), static_cast<const std::byte*>(values.data()) + range.first * bytes,
            static_cast<std::size_t>(range.count), values.components(), values.owner().lock()};
}

/// A piece of arrays that were loaded for all pieces at once. Nothing is copied but ghost marks.
Piece part_of(const Piece& whole, const Layout& points, const Layout& cells, std::size_t number) {
    const Range of_points = range_of(points, number), of_cells = range_of(cells, number);
    Piece piece;
    piece.name = fmt::format("piece {}", number + 1);
    piece.grid.points = part_of(whole.grid.points, of_points);
    for (const Field& field : whole.grid.point_fields)
        piece.grid.point_fields.push_back({field.name, part_of(field.values, of_points)});
    for (const Field& field : whole.grid.cell_fields)
        piece.grid.cell_fields.push_back({field.name, part_of(field.values, of_cells)});
    piece.point_ids = part_of(whole.point_ids, of_points);
    piece.cell_ids = part_of(whole.cell_ids, of_cells);
    if (!whole.left_out.empty()) {
        const auto first = whole.left_out.begin() + static_cast<std::ptrdiff_t>(of_cells.first);
        piece.left_out.assign(first, first + static_cast<std::ptrdiff_t>(of_cells.count));
    }
    return piece;
}

bool stores_float32(const Document& document, const pugi::xml_node& piece, std::size_t step) {
    for (const auto& element : piece.child("Points").children()) {
        if (element.type() != pugi::node_element || !is_of_step(element, step)) continue;
        const auto array = describe_array(document, element);
        if (array && *array) return (*array)->type == ScalarType::float32;
    }
    return false;
}

/// Beside pieces of float64 as well: which points are one is judged by the roundings of the types as stored.
Array as_float32(const Array& points) {
    std::vector<float> places(points.size());
    points.visit(
        [&](auto from) { std::ranges::transform(from, places.begin(), [](auto x) { return static_cast<float>(x); }); });
    return Array::own(std::move(places), points.components());
}

} // namespace

Result<Layouts> layouts_of_unstructured(const Document& document) {
    auto points = layout_by(document, "NumberOfPoints"), cells = layout_by(document, "NumberOfCells");
    if (!points) return points.error();
    if (!cells) return cells.error();
    return Layouts{std::move(*points), std::move(*cells)};
}

LeastCounts least_of_unstructured(const Document& document, const Layouts& layouts, std::size_t step) {
    const auto elements = pieces_of(document);
    LeastCounts all;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        LeastCounts piece;
        const Section points = describe_section(document, elements[i].child("Points"), step),
                      cells = describe_section(document, elements[i].child("Cells"), step);
        if (!points.arrays.empty()) {
            const DataArray& array = points.arrays.front();
            piece.points = std::min(layouts.points.tuples[i], stored_scalars(document, array) / 3);
            if (array.type == ScalarType::float64) piece.coordinates = array.type;
        }
        const auto corners = std::ranges::find(cells.arrays, "connectivity", &DataArray::name);
        if (corners != cells.arrays.end()) piece.corners = stored_scalars(document, *corners);
        piece.cells = std::min(layouts.cells.tuples[i], piece.corners); // a cell has one at least
        add(all, piece);
    }
    return all;
}

Result<std::vector<Piece>> load_unstructured(const std::shared_ptr<Document>& document, const Layouts& layouts,
                                             const Wanted& wanted, const Progress& progress, Loaded& loaded) {
    const auto elements = pieces_of(*document);
    const Layout &points = layouts.points, &cells = layouts.cells;
    const bool alone = elements.size() == 1;
    Piece whole;
    auto places = load_points(*document, elements, points, wanted.step, progress);
    if (!places) return places.error();
    whole.grid.points = std::move(*places);
    const Wanted of_pieces{wanted.options, wanted.step, wanted.ids || !alone, wanted.path};
    const bool may_wait = wanted.options.active_cells && !wanted.path.empty();
    std::vector<CellsRead> of_elements;
    bool all_wait = true, some_wait = false;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        auto part = read_cells(*document, {elements[i], cells.tuples[i], wanted.step}, may_wait, progress);
        if (!part) return part.error();
        all_wait = all_wait && (part->corners || cells.tuples[i] == 0);
        some_wait = some_wait || part->corners;
        of_elements.push_back(*std::move(part));
    }
    LaterFields later{document};
    const bool fields_wait = all_wait && some_wait && !are_counted(wanted.options);
    if (auto read = load_fields(*document, layouts, of_pieces, progress, loaded, whole, fields_wait ? &later : nullptr);
        !read)
        return read.error();
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        Piece& piece = pieces.emplace_back(alone ? whole : part_of(whole, points, cells, i));
        if (piece.grid.points.type() == ScalarType::float64 && stores_float32(*document, elements[i], wanted.step))
            piece.grid.points = as_float32(piece.grid.points);
        CellsRead& part = of_elements[i];
        if (fields_wait) piece.unread_fields = std::move(later.of_pieces[i]);
        if (part.corners)
            piece.unread = std::make_shared<const UnreadCells>(*std::move(part.places), std::move(part.cells.types),
                                                               ArrayInFile(wanted.path, document, *part.corners));
        else piece.grid.cells = std::move(part.cells);
    }
    return pieces;
}

} // namespace isotet::io::vtk_xml
