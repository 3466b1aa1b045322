// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/vtk_xml/columns.hpp"

#include <algorithm>
#include <limits>

#include <fmt/core.h>

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "io/own/first_error.hpp"
#include "io/own/text_scanner.hpp"
#include "io/own/vtk_attributes.hpp"
#include "io/reader.hpp"

namespace isotet::io::vtk_xml {
namespace {

const DataArray* find_array(const std::vector<DataArray>& arrays, std::string_view name) {
    const auto found = std::ranges::find(arrays, name, &DataArray::name);
    return found == arrays.end() ? nullptr : &*found;
}

/// The array of global numbers: the one marked so, or one of a well-known name. Null for a floating one.
const DataArray* global_ids(const Section& section, std::span<const std::string_view> names) {
    const DataArray* ids = section.global_ids.empty() ? nullptr : find_array(section.arrays, section.global_ids);
    for (const std::string_view name : names)
        if (!ids) ids = find_array(section.arrays, name);
    return ids && ids->components == 1 && !is_floating(ids->type) ? ids : nullptr;
}

/// The arrays of one kind (point data or cell data) that are read, and what becomes of them.
struct Selection {
    std::vector<std::vector<DataArray>> columns; ///< for each array its descriptions in all pieces
    std::size_t ids = none;
    std::vector<bool> is_field, is_ghost;
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
};

Result<Selection> select(const Document& document, const char* element, Association association, const Wanted& wanted) {
    std::vector<Section> sections;
    for (const auto& piece : pieces_of(document)) {
        auto section = describe_section(document, piece.child(element), wanted.step);
        if (!section) return section.error();
        sections.push_back(std::move(*section));
    }
    const bool of_points = association == Association::point;
    const DataArray* const ids = !wanted.ids ? nullptr
                                 : of_points ? global_ids(sections[0], point_id_names)
                                             : global_ids(sections[0], cell_id_names);
    Selection selection;
    for (const DataArray& array : sections[0].arrays) {
        const bool ghost = is_ghost_array(array.name);
        const bool field = !ghost && io::wanted(wanted.options, association, array.name);
        if (!field && &array != ids && !(ghost && !of_points)) continue;
        if (&array == ids) selection.ids = selection.columns.size();
        selection.is_field.push_back(field);
        selection.is_ghost.push_back(ghost);
        auto& column = selection.columns.emplace_back();
        for (const Section& section : sections) {
            const DataArray* const part = find_array(section.arrays, array.name);
            if (!part)
                return invalid_data(
                    fmt::format("{} {} of the first piece is missing in another one", element, in_quotes(array.name)));
            column.push_back(*part);
        }
    }
    return selection;
}

} // namespace

void mark_left_out(const Array& marks, std::string_view name, std::vector<std::uint8_t>& left_out) {
    left_out.resize(marks.tuples(), 0);
    const bool levels = name == "vtkGhostLevels";
    marks.visit([&](auto values) {
        core::parallel_each(left_out.size(), std::size_t{1} << 16, [&](std::size_t cell) {
            const auto value = static_cast<double>(values[cell * marks.components()]);
            const int mark = value > 0 && value < 0x1p31 ? static_cast<int>(value) : 0;
            if (levels ? mark > 0 : (mark & cell_is_out) != 0) left_out[cell] = 1;
        });
    });
    if (std::ranges::none_of(left_out, [](std::uint8_t out) { return out != 0; })) left_out.clear();
}

bool is_ghost_array(std::string_view name) { return name == "vtkGhostType" || name == "vtkGhostLevels"; }

bool is_of_step(const pugi::xml_node& element, std::size_t step) {
    const pugi::xml_attribute steps = element.attribute("TimeStep");
    if (!steps) return true;
    TextScanner scanner(steps.value());
    for (std::size_t number = 0; scanner.number(number);)
        if (number == step) return true;
    return false;
}

std::vector<pugi::xml_node> pieces_of(const Document& document) {
    std::vector<pugi::xml_node> pieces;
    for (const auto& piece : document.primary().children("Piece")) pieces.push_back(piece);
    if (pieces.empty()) pieces.push_back(document.primary());
    return pieces;
}

Result<Section> describe_section(const Document& document, const pugi::xml_node& element, std::size_t step) {
    Section section;
    section.global_ids = element.attribute("GlobalIds").value();
    for (const auto& child : element.children()) {
        if (child.type() != pugi::node_element || !is_of_step(child, step)) continue;
        auto array = describe_array(document, child);
        if (!array) return array.error();
        if (!*array) continue;
        if ((*array)->name.empty()) return invalid_data(fmt::format("{} has an array without a name", element.name()));
        if (find_array(section.arrays, (*array)->name))
            return invalid_data(fmt::format("{} has two arrays {}", element.name(), in_quotes((*array)->name)));
        section.arrays.push_back(std::move(**array));
    }
    return section;
}

Result<void> announce_fields(Document& document, const Progress& progress, FileInfo& info) {
    const pugi::xml_node piece = pieces_of(document).front();
    // Steps are numbered; what their times are, the file does not say.
    TextScanner times(document.primary().attribute("TimeValues").value());
    while (!times.word().empty()) info.times.push_back(static_cast<double>(info.times.size()));
    for (const auto& [element, association] :
         {std::pair("PointData", Association::point), std::pair("CellData", Association::cell)}) {
        const auto section = describe_section(document, piece.child(element), 0);
        if (!section) return section.error();
        for (const DataArray& array : section->arrays)
            if (!is_ghost_array(array.name)) announce(info, {array.name, association, array.type, array.components});
    }
    for (const auto& element : document.primary().child("FieldData").children()) {
        if (std::string_view(element.attribute("Name").value()) != "TimeValue" || !info.times.empty()) continue;
        const auto array = describe_array(document, element);
        if (!array) return array.error();
        if (!*array) continue;
        const auto time = load_array(document, **array, 1, progress);
        if (!time) return time.error();
        info.times.push_back(time->at(0));
    }
    return {};
}

Result<Column> find_column(Document& document, const std::vector<DataArray>& arrays, const Layout& layout,
                           const Progress& progress) {
    Column column{arrays.front(), {}};
    for (std::size_t piece = 0; piece < arrays.size(); ++piece) {
        const DataArray& array = arrays[piece];
        if (array.type != column.array.type || array.components != column.array.components ||
            array.bits != column.array.bits)
            return invalid_data(fmt::format("the array {} is {} of {} in one piece and {} of {} in another",
                                            in_quotes(array.name), column.array.components,
                                            isotet::name_of(column.array.type), array.components,
                                            isotet::name_of(array.type)));
        const std::uint64_t tuples = layout.tuples[piece];
        if (tuples > std::numeric_limits<std::uint64_t>::max() / array.components)
            return invalid_data(fmt::format("the array {} should have {} tuples", in_quotes(array.name), tuples));
        auto stored = StoredArray::find(document, array, tuples * array.components, progress);
        if (!stored) return stored.error();
        column.parts.push_back(std::move(*stored));
    }
    return column;
}

Result<Array> load_column(const Column& column, const Layout& layout) {
    const std::size_t components = column.array.components, tuple = components * size_of(column.array.type);
    return filled_array(column.array.type, static_cast<std::size_t>(layout.total), components,
                        [&](std::byte* to) -> Result<void> {
                            for (std::size_t piece = 0; piece < column.parts.size(); ++piece) {
                                const auto bytes = static_cast<std::size_t>(layout.tuples[piece] * tuple);
                                core::Buffer<std::byte> apart(layout.place ? bytes : 0);
                                if (auto done = column.parts[piece].decode(layout.place ? apart.data() : to); !done)
                                    return done;
                                if (layout.place) layout.place(piece, apart.data(), to, tuple);
                                else to += bytes;
                            }
                            return {};
                        });
}

Result<Array> load_points(Document& document, const std::vector<pugi::xml_node>& pieces, const Layout& layout,
                          std::size_t step, const Progress& progress) {
    if (layout.total == 0) return Array(ScalarType::float32, nullptr, 0, 3, nullptr);
    std::vector<DataArray> arrays;
    for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
        std::vector<DataArray> found;
        for (const auto& element : pieces[piece].child("Points").children()) {
            if (element.type() != pugi::node_element || !is_of_step(element, step)) continue;
            auto array = describe_array(document, element);
            if (!array) return array.error();
            if (*array) found.push_back(std::move(**array));
        }
        if (found.empty() && layout.tuples[piece] == 0 && !arrays.empty()) found.push_back(arrays.front());
        if (found.size() != 1)
            return invalid_data(fmt::format("a piece of {} points has {} arrays of points, not one",
                                            layout.tuples[piece], found.size()));
        arrays.push_back(std::move(found.front()));
    }
    const DataArray& first = arrays.front();
    if (first.components != 3 || !is_floating(first.type))
        return invalid_data(fmt::format("the points are {} of {}, not 3 of float32 or float64", first.components,
                                        isotet::name_of(first.type)));
    const auto column = find_column(document, arrays, layout, progress);
    if (!column) return column.error();
    return load_column(*column, layout);
}

Result<void> load_fields(Document& document, const Layout& points, const Layout& cells, const Wanted& wanted,
                         const Progress& progress, Piece& piece) {
    struct Job {
        Column column;
        const Layout* layout;
        Array values;
    };
    std::vector<Job> jobs;
    const auto of_points = select(document, "PointData", Association::point, wanted);
    if (!of_points) return of_points.error();
    const auto of_cells = select(document, "CellData", Association::cell, wanted);
    if (!of_cells) return of_cells.error();
    for (const auto& [selection, layout] : {std::pair(&*of_points, &points), std::pair(&*of_cells, &cells)})
        for (const auto& arrays : selection->columns) {
            auto column = find_column(document, arrays, *layout, progress);
            if (!column) return column.error();
            jobs.push_back({std::move(*column), layout, {}});
        }
    FirstError failed;
    core::parallel_each(jobs.size(), 1, [&](std::size_t i) {
        auto values = load_column(jobs[i].column, *jobs[i].layout);
        if (values) jobs[i].values = std::move(*values);
        else failed.add(i, values.error());
    });
    if (auto loaded = failed.result(); !loaded) return loaded;

    std::size_t next = 0;
    for (const Selection* selection : {&*of_points, &*of_cells}) {
        const bool points_now = selection == &*of_points;
        for (std::size_t i = 0; i < selection->columns.size(); ++i, ++next) {
            const std::string& name = jobs[next].column.array.name;
            const Array& values = jobs[next].values;
            if (selection->ids == i) (points_now ? piece.point_ids : piece.cell_ids) = values;
            if (selection->is_ghost[i]) mark_left_out(values, name, piece.left_out);
            if (selection->is_field[i])
                (points_now ? piece.grid.point_fields : piece.grid.cell_fields).push_back({name, values});
        }
    }
    return {};
}

} // namespace isotet::io::vtk_xml
