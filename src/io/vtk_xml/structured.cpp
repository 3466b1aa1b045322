// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTI, VTR and VTS: boxes of points whose cells are implied, hexahedra, or quadrilaterals of a plane. Each piece is a box
// within the whole one.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "io/files/scalars.hpp"
#include "io/files/text_scanner.hpp"
#include "io/vtk_xml/load.hpp"

namespace isotet::io::vtk_xml {
namespace {

/// First and last point along each axis.
struct Extent {
    std::array<std::int64_t, 3> first{}, last{};

    std::uint64_t points(std::size_t axis) const {
        return last[axis] < first[axis] ? 0 : static_cast<std::uint64_t>(last[axis] - first[axis]) + 1;
    }
    /// Of a flat axis one, as VTK counts the values of cells.
    std::uint64_t cells(std::size_t axis) const {
        const std::uint64_t count = points(axis);
        return count > 1 ? count - 1 : count;
    }
    bool contains(const Extent& other) const {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (other.first[axis] < first[axis] || other.last[axis] > last[axis]) return false;
        return true;
    }
};

/// Whether the piece has no cells of the whole: it is flat along an axis along which that is not.
bool lies_between_cells(const Extent& whole, const Extent& piece) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (piece.points(axis) < 2 && whole.points(axis) > 1) return true;
    return false;
}

std::uint64_t all_points(const Extent& extent) { return extent.points(0) * extent.points(1) * extent.points(2); }
std::uint64_t all_cells(const Extent& extent) { return extent.cells(0) * extent.cells(1) * extent.cells(2); }

Result<Extent> extent_of(const pugi::xml_node& element, const char* attribute) {
    const char* const text = element.attribute(attribute).value();
    TextScanner scanner(text);
    Extent extent;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::int32_t first = 0, last = 0;
        if (!scanner.number(first) || !scanner.number(last))
            return invalid_data(fmt::format("{} is {}, not six integers", attribute, in_quotes(text)));
        extent.first[axis] = first;
        extent.last[axis] = last;
    }
    // Of fewer points no product in bytes overflows.
    constexpr std::uint64_t most = std::uint64_t{1} << 48;
    if (extent.points(0) > most || extent.points(1) > most || extent.points(2) > most ||
        extent.points(0) * extent.points(1) > most / std::max<std::uint64_t>(extent.points(2), 1))
        return invalid_data(fmt::format("{} is {}: too many points", attribute, in_quotes(text)));
    return extent;
}

/// Numbers of an attribute; those that `numbers` holds where it is missing.
template <std::size_t count>
Result<void> read_numbers_of(const pugi::xml_node& element, const char* attribute, std::array<double, count>& numbers) {
    const pugi::xml_attribute stated = element.attribute(attribute);
    TextScanner scanner(stated.value());
    for (double& number : numbers)
        if (stated && !scanner.number(number))
            return invalid_data(fmt::format("{} is {}, not {} numbers", attribute, in_quotes(stated.value()), count));
    return {};
}

/// The whole grid and its pieces.
struct Boxes {
    Extent whole;
    std::vector<Extent> pieces;
};

/// Calls visit(row of the piece, its first place in the whole) for each row along x.
template <class Visit>
void each_row(const Extent& whole, const Extent& piece, bool of_points, const Visit& visit) {
    if (!of_points && lies_between_cells(whole, piece)) return;
    const auto count = [&](const Extent& extent, std::size_t axis) {
        return of_points ? extent.points(axis) : extent.cells(axis);
    };
    const auto shift = [&](std::size_t axis) {
        return static_cast<std::uint64_t>(piece.first[axis] - whole.first[axis]);
    };
    std::size_t row = 0;
    for (std::uint64_t z = 0; z < count(piece, 2); ++z)
        for (std::uint64_t y = 0; y < count(piece, 1); ++y, ++row)
            visit(row, ((z + shift(2)) * count(whole, 1) + y + shift(1)) * count(whole, 0) + shift(0));
}

/// Every point and cell must be in a piece: what no piece has would be uninitialized memory.
Result<void> check_cover(const Boxes& boxes, bool of_points) {
    const std::uint64_t total = of_points ? all_points(boxes.whole) : all_cells(boxes.whole);
    if (boxes.pieces.size() == 1 && total == (of_points ? all_points(boxes.pieces[0]) : all_cells(boxes.pieces[0])))
        return {};
    std::uint64_t in_pieces = 0;
    for (const Extent& piece : boxes.pieces) in_pieces += of_points ? all_points(piece) : all_cells(piece);
    const auto missing = [&](std::uint64_t found) {
        return invalid_data(fmt::format("the pieces have {} of the {} {} of the whole extent", found, total,
                                        of_points ? "points" : "cells"));
    };
    if (in_pieces < total) return missing(in_pieces);
    if (in_pieces / 8 > total) return invalid_data("the pieces overlap by more than their boundaries");
    if (auto fits = core::require_memory("joining the pieces of a structured grid", total); !fits) return fits;
    std::vector<bool> seen(static_cast<std::size_t>(total));
    std::uint64_t found = 0;
    for (const Extent& piece : boxes.pieces)
        each_row(boxes.whole, piece, of_points, [&](std::size_t, std::uint64_t begin) {
            for (std::uint64_t i = begin; i < begin + (of_points ? piece.points(0) : piece.cells(0)); ++i) {
                found += seen[static_cast<std::size_t>(i)] ? 0 : 1;
                seen[static_cast<std::size_t>(i)] = true;
            }
        });
    if (found < total) return missing(found);
    return {};
}

Result<Boxes> boxes_of(const Document& document) {
    const auto whole = extent_of(document.primary(), "WholeExtent");
    if (!whole) return whole.error();
    Boxes boxes{*whole, {}};
    for (const auto& element : pieces_of(document)) {
        const auto piece = extent_of(element, element == document.primary() ? "WholeExtent" : "Extent");
        if (!piece) return piece.error();
        if (!whole->contains(*piece)) return invalid_data("a piece reaches out of the whole extent");
        boxes.pieces.push_back(*piece);
    }
    return boxes;
}

/// Without pieces of their own, values lie in the file as in the grid.
Layout layout_of(const Boxes& boxes, bool of_points) {
    Layout layout;
    for (const Extent& piece : boxes.pieces) layout.tuples.push_back(of_points ? all_points(piece) : all_cells(piece));
    layout.total = of_points ? all_points(boxes.whole) : all_cells(boxes.whole);
    if (boxes.pieces.size() == 1) return layout;
    layout.place = [&boxes, of_points](std::size_t piece, const std::byte* from, std::byte* to, std::size_t tuple) {
        const Extent& box = boxes.pieces[piece];
        const auto bytes = static_cast<std::size_t>(of_points ? box.points(0) : box.cells(0)) * tuple;
        each_row(boxes.whole, box, of_points, [&](std::size_t row, std::uint64_t begin) {
            std::memcpy(to + begin * tuple, from + row * bytes, bytes);
        });
    };
    return layout;
}

/// Points of all places of a box, each from its numbers along the axes.
template <class Place>
Result<Array> made_points(const GridSize& size, const Place& place) {
    const auto count = static_cast<std::size_t>(size.x * size.y * size.z);
    return filled_array(ScalarType::float64, count, 3, [&](std::byte* to) {
        auto* const points = reinterpret_cast<double*>(to);
        core::parallel_each(count, std::size_t{1} << 16, [&](std::size_t i) {
            place(i % size.x, i / size.x % size.y, i / (size.x * size.y), points + 3 * i);
        });
        return Result<void>();
    });
}

GridSize size_of_box(const Extent& extent) { return {extent.points(0), extent.points(1), extent.points(2)}; }

Result<Array> image_points(const Document& document, const Extent& whole) {
    ImagePoints image{whole.first, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
    std::array<double, 3> spacing{1, 1, 1};
    const pugi::xml_node element = document.primary();
    if (auto read = read_numbers_of(element, "Origin", image.origin); !read) return read.error();
    if (auto read = read_numbers_of(element, "Spacing", spacing); !read) return read.error();
    if (auto read = read_numbers_of(element, "Direction", image.matrix); !read) return read.error();
    for (std::size_t i = 0; i < 9; ++i) image.matrix[i] *= spacing[i % 3];
    return points_of(size_of_box(whole), image);
}

/// Coordinates along one axis, from the pieces.
Result<std::vector<double>> ticks_of(Document& document, const Boxes& boxes, std::size_t axis,
                                     const Progress& progress) {
    std::vector<Array> parts;
    const auto elements = pieces_of(document);
    for (std::size_t p = 0; p < elements.size(); ++p) {
        std::vector<pugi::xml_node> arrays;
        for (const auto& child : elements[p].child("Coordinates").children())
            if (child.type() == pugi::node_element) arrays.push_back(child);
        if (arrays.size() != 3)
            return invalid_data(fmt::format("the coordinates of a piece are {} arrays, not 3", arrays.size()));
        const auto described = describe_array(document, arrays[axis]);
        if (!described) return described.error();
        if (!*described || (*described)->components != 1)
            return invalid_data("coordinates along an axis are not numbers with one component");
        auto values = load_array(document, **described, boxes.pieces[p].points(axis), progress);
        if (!values) return values.error();
        parts.push_back(std::move(*values));
    }
    std::vector<double> ticks(static_cast<std::size_t>(boxes.whole.points(axis))); // the pieces cover it
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const auto first = static_cast<std::size_t>(boxes.pieces[p].first[axis] - boxes.whole.first[axis]);
        for (std::size_t i = 0; i < parts[p].tuples(); ++i) ticks[first + i] = parts[p].at(i);
    }
    return ticks;
}

Result<Array> rectilinear_points(Document& document, const Boxes& boxes, const Progress& progress) {
    std::array<std::vector<double>, 3> ticks;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        auto read = ticks_of(document, boxes, axis, progress);
        if (!read) return read.error();
        ticks[axis] = std::move(*read);
    }
    return points_of(size_of_box(boxes.whole), ticks);
}

template <class Index>
Array hexahedra(const GridSize& points) {
    const std::uint64_t x_cells = points.x - 1, y_cells = points.y - 1, rows = y_cells * (points.z - 1);
    core::Buffer<Index> corners(static_cast<std::size_t>(8 * x_cells * rows));
    const auto row = static_cast<Index>(points.x), slice = static_cast<Index>(points.x * points.y);
    core::parallel_each(static_cast<std::size_t>(rows), 64, [&](std::size_t r) {
        const std::uint64_t y = r % y_cells, z = r / y_cells;
        Index* to = corners.data() + 8 * x_cells * r;
        for (std::uint64_t x = 0; x < x_cells; ++x, to += 8) {
            const auto p = static_cast<Index>((z * points.y + y) * points.x + x), top = static_cast<Index>(p + slice);
            const Index cell[] = {
                p,   static_cast<Index>(p + 1),   static_cast<Index>(p + row + 1),   static_cast<Index>(p + row),
                top, static_cast<Index>(top + 1), static_cast<Index>(top + row + 1), static_cast<Index>(top + row)};
            std::memcpy(to, cell, sizeof cell);
        }
    });
    return std::move(corners).to_array();
}

/// Those of a plane.
template <class Index>
Cells quadrilaterals(const GridSize& points) {
    constexpr std::uint8_t vtk_quad = 9;
    const std::array<std::uint64_t, 3> along{points.x, points.y, points.z}, strides{1, points.x, points.x * points.y};
    const std::size_t first = along[0] > 1 ? 0 : 1, second = along[2] > 1 ? 2 : 1;
    const std::uint64_t per_row = along[first] - 1, count = per_row * (along[second] - 1);
    core::Buffer<Index> corners(static_cast<std::size_t>(4 * count));
    core::Buffer<std::int64_t> offsets(static_cast<std::size_t>(count + 1));
    core::Buffer<std::uint8_t> types(static_cast<std::size_t>(count));
    offsets[0] = 0;
    core::parallel_each(static_cast<std::size_t>(count), std::size_t{1} << 14, [&](std::size_t cell) {
        const std::uint64_t p = cell % per_row * strides[first] + cell / per_row * strides[second];
        const std::uint64_t places[] = {p, p + strides[first], p + strides[first] + strides[second],
                                        p + strides[second]};
        for (std::size_t k = 0; k < 4; ++k) corners[4 * cell + k] = static_cast<Index>(places[k]);
        offsets[cell + 1] = static_cast<std::int64_t>(4 * (cell + 1));
        types[cell] = vtk_quad;
    });
    Cells cells;
    cells.connectivity = std::move(corners).to_array();
    cells.offsets = std::move(offsets).to_array();
    cells.types = std::move(types).to_array();
    return cells;
}

/// A line or a point.
bool is_thin(const GridSize& points) { return (points.x > 1) + (points.y > 1) + (points.z > 1) < 2; }

} // namespace

Result<Array> points_of(const GridSize& size, const ImagePoints& image) {
    return made_points(size, [&](std::uint64_t x, std::uint64_t y, std::uint64_t z, double* to) {
        const auto i = static_cast<double>(static_cast<std::int64_t>(x) + image.first[0]),
                   j = static_cast<double>(static_cast<std::int64_t>(y) + image.first[1]),
                   k = static_cast<double>(static_cast<std::int64_t>(z) + image.first[2]);
        const double* row = image.matrix.data();
        for (std::size_t axis = 0; axis < 3; ++axis, row += 3)
            to[axis] = row[0] * i + row[1] * j + row[2] * k + image.origin[axis];
    });
}

Result<Array> points_of(const GridSize& size, const std::array<std::vector<double>, 3>& ticks) {
    return made_points(size, [&](std::uint64_t x, std::uint64_t y, std::uint64_t z, double* to) {
        to[0] = ticks[0][x];
        to[1] = ticks[1][y];
        to[2] = ticks[2][z];
    });
}

std::uint64_t cells_in_box(const GridSize& points) {
    if (points.x * points.y * points.z == 0 || is_thin(points)) return 0;
    const auto along = [](std::uint64_t count) { return std::max<std::uint64_t>(count - 1, 1); };
    return along(points.x) * along(points.y) * along(points.z);
}

Result<Cells> cells_of_box(const GridSize& points, std::vector<std::string>& notes) {
    Cells cells;
    cells.uniform_type = CellType::hexahedron;
    const std::uint64_t points_in_all = points.x * points.y * points.z, count = cells_in_box(points);
    const bool narrow = points_in_all < (1U << 31U), plane = count > 0 && !flatness(points).empty();
    if (count > 0) {
        const std::uint64_t bytes = plane ? 4 * (narrow ? 4 : 8) + 9 : 8 * (narrow ? 4 : 8);
        if (auto fits = core::require_memory("cells of a structured grid", bytes * points_in_all); !fits)
            return fits.error();
        if (plane) cells = narrow ? quadrilaterals<std::int32_t>(points) : quadrilaterals<std::int64_t>(points);
        else cells.connectivity = narrow ? hexahedra<std::int32_t>(points) : hexahedra<std::int64_t>(points);
    }
    if (count == 0) {
        if (const std::string flat = flatness(points); !flat.empty())
            notes.push_back(fmt::format("{} has no cells with an area", flat));
    } else if (plane) {
        notes.push_back(fmt::format("{} was read as {} quadrilaterals", flatness(points), count));
    } else {
        notes.push_back(fmt::format("a structured grid of {} x {} x {} points was read as {} hexahedra", points.x,
                                    points.y, points.z, count));
    }
    return cells;
}

std::string flatness(const GridSize& points) {
    std::vector<std::uint64_t> along;
    for (const std::uint64_t count : {points.x, points.y, points.z}) {
        if (count == 0) return {};
        if (count > 1) along.push_back(count);
    }
    if (along.size() == 3) return {};
    if (along.size() == 2) return fmt::format("a plane of {} x {} points", along[0], along[1]);
    return along.size() == 1 ? fmt::format("a line of {} points", along[0]) : "a single point";
}

void leave_out_around(const GridSize& points, std::span<const std::uint8_t> hidden,
                      std::vector<std::uint8_t>& left_out) {
    if (std::ranges::none_of(hidden, [](std::uint8_t mark) { return mark != 0; })) return;
    const auto along = [](std::uint64_t count) { return std::max<std::uint64_t>(count - 1, 1); };
    const std::uint64_t x_cells = along(points.x), y_cells = along(points.y), rows = y_cells * along(points.z);
    left_out.resize(static_cast<std::size_t>(x_cells * rows));
    core::parallel_each(static_cast<std::size_t>(rows), 64, [&](std::size_t row) {
        std::uint8_t* const out = left_out.data() + row * x_cells;
        const std::uint64_t first_y = row % y_cells, first_z = row / y_cells;
        for (std::uint64_t z = first_z; z < std::min(first_z + 2, points.z); ++z)
            for (std::uint64_t y = first_y; y < std::min(first_y + 2, points.y); ++y) {
                const std::uint8_t* const line = hidden.data() + (z * points.y + y) * points.x;
                for (std::uint64_t x = 0; x < x_cells; ++x)
                    out[x] = out[x] != 0 || line[x] != 0 || line[std::min(x + 1, points.x - 1)] != 0;
            }
    });
}

void mark_around_hidden(const Array& marks, std::string_view name, const GridSize& points,
                        std::vector<std::uint8_t>& left_out) {
    constexpr int hidden_point = 2;
    if (name != "vtkGhostType" || cells_in_box(points) == 0) return;
    std::vector<std::uint8_t> hidden(marks.tuples());
    marks.visit([&](auto values) {
        core::parallel_each(hidden.size(), std::size_t{1} << 16, [&](std::size_t point) {
            const auto value = static_cast<double>(values[point * marks.components()]);
            hidden[point] = value > 0 && value < 0x1p31 && (static_cast<int>(value) & hidden_point) != 0;
        });
    });
    leave_out_around(points, hidden, left_out);
}

Result<Layouts> layouts_of_structured(const Document& document) {
    const auto boxes = boxes_of(document);
    if (!boxes) return boxes.error();
    Layouts layouts{layout_of(*boxes, true), layout_of(*boxes, false)};
    layouts.points.place = layouts.cells.place = {}; // what is counted has no places
    return layouts;
}

Result<std::uint64_t> count_structured(const Document& document) {
    const auto whole = extent_of(document.primary(), "WholeExtent");
    if (!whole) return whole.error();
    return cells_in_box(size_of_box(*whole));
}

Result<void> leave_out_overlaps(std::span<Loaded> parts) {
    std::vector<Piece*> pieces;
    std::vector<Extent> boxes;
    Extent whole;
    std::uint64_t total = 0;
    for (Loaded& part : parts)
        for (Piece& piece : part.pieces) {
            if (!piece.extent || piece.grid.cells.count() == 0) continue;
            Extent box;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                box.first[axis] = (*piece.extent)[2 * axis];
                box.last[axis] = (*piece.extent)[2 * axis + 1];
                whole.first[axis] = boxes.empty() ? box.first[axis] : std::min(whole.first[axis], box.first[axis]);
                whole.last[axis] = boxes.empty() ? box.last[axis] : std::max(whole.last[axis], box.last[axis]);
            }
            pieces.push_back(&piece);
            boxes.push_back(box);
            total += all_cells(box);
        }
    // Planes in a box have cells of their own.
    for (std::size_t i = boxes.size(); i-- > 0;)
        if (lies_between_cells(whole, boxes[i])) {
            total -= all_cells(boxes[i]);
            boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(i));
            pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(i));
        }
    if (boxes.size() < 2) return {};
    double in_whole = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) in_whole *= static_cast<double>(whole.cells(axis));
    if (in_whole > 64 * static_cast<double>(total))
        return invalid_data(
            fmt::format("the pieces fill {} of the {:.0f} cells of the box around them", total, in_whole));
    if (auto fits = core::require_memory("joining the pieces of a structured grid", all_cells(whole)); !fits)
        return fits;
    std::vector<std::uint8_t> seen(static_cast<std::size_t>(all_cells(whole)));
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        std::vector<std::uint8_t>& left_out = pieces[i]->left_out;
        left_out.resize(pieces[i]->grid.cells.count());
        const auto width = static_cast<std::size_t>(boxes[i].cells(0));
        each_row(whole, boxes[i], false, [&](std::size_t row, std::uint64_t begin) {
            std::uint8_t* const out = left_out.data() + row * width;
            std::uint8_t* const known = seen.data() + begin;
            for (std::size_t x = 0; x < width; ++x) {
                out[x] = out[x] != 0 || known[x] != 0;
                known[x] |= out[x] == 0;
            }
        });
        if (std::ranges::all_of(left_out, [](std::uint8_t out) { return out == 0; })) left_out.clear();
    }
    return {};
}

Result<Piece> load_structured(Document& document, const Wanted& wanted, const Progress& progress, Loaded& loaded) {
    const auto boxes = boxes_of(document);
    if (!boxes) return boxes.error();
    for (const bool of_points : {true, false})
        if (auto covered = check_cover(*boxes, of_points); !covered) return covered.error();
    const Layouts layouts{layout_of(*boxes, true), layout_of(*boxes, false)};
    // Fields first: if they are as long as the extent says, the file is as large as the grid.
    Piece piece;
    Wanted of_box = wanted;
    of_box.box = size_of_box(boxes->whole);
    if (auto read = load_fields(document, layouts, of_box, progress, loaded, piece); !read) return read.error();
    Result<Array> places = Array();
    if (document.type == "ImageData") places = image_points(document, boxes->whole);
    else if (document.type == "RectilinearGrid") places = rectilinear_points(document, *boxes, progress);
    else places = load_points(document, pieces_of(document), layouts.points, wanted.step, progress);
    if (!places) return places.error();
    piece.grid.points = std::move(*places);
    const Extent& whole = boxes->whole;
    piece.extent = {whole.first[0], whole.last[0], whole.first[1], whole.last[1], whole.first[2], whole.last[2]};
    auto cells_of_all = cells_of_box(size_of_box(boxes->whole), loaded.notes);
    if (!cells_of_all) return cells_of_all.error();
    piece.grid.cells = std::move(*cells_of_all);
    piece.flat = flatness(size_of_box(boxes->whole));
    if (piece.grid.cells.count() == 0) { // a line or a point: its cells are none of a grid
        piece.grid.cell_fields.clear();
        piece.cell_ids = Array();
        piece.left_out.clear();
    }
    return piece;
}

} // namespace isotet::io::vtk_xml
