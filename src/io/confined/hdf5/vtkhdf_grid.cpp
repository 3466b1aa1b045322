// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/hdf5/vtkhdf_grid.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "grid/cell_faces.hpp"
#include "grid/fixed_corners.hpp"
#include "io/confined/hdf5/hdf5_array.hpp"
#include "io/confined/hdf5/hdf5_cells.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/join/shared_faces.hpp"
#include "io/pieces/survey_unread.hpp"
#include "io/vtk_xml/columns.hpp"

namespace isotet::io::confined {
namespace {

const char* data_group_of(Association association) {
    return association == Association::point ? "PointData" : "CellData";
}

/// Whether offset `first` + i is where the corners of that cell begin, and the last one where they end.
template <class Offset>
bool are_begins_of(const CellPlaces& places, std::uint64_t first, std::span<const Offset> offsets) {
    if constexpr (!std::is_integral_v<Offset>) return false;
    else {
        std::uint64_t next = places.begin(first), wrong = 0;
        for (std::size_t i = 0; i < offsets.size(); ++i) {
            wrong |= core::widened(offsets[i]) ^ next;
            if (first + i < places.cells()) next += core::fixed_corners_of(places.type(first + i));
        }
        return wrong == 0;
    }
}

/// Types of cells, which the format has as bytes; h5py makes int64 of a list. Nothing where one is no byte.
std::optional<Array> as_bytes(Array types) {
    if (types.type() == ScalarType::uint8) return types;
    return types.visit([](auto values) -> std::optional<Array> {
        if (!std::ranges::all_of(values,
                                 [](auto type) { return type >= 0 && type <= 255 && type == std::trunc(type); }))
            return std::nullopt;
        core::Buffer<std::uint8_t> bytes(values.size());
        std::ranges::transform(values, bytes.data(), [](auto type) { return static_cast<std::uint8_t>(type); });
        return std::move(bytes).to_array();
    });
}

} // namespace

Result<void> HdfGrid::announce_all(FileInfo& info) const {
    for (const auto association : {Association::point, Association::cell})
        for (const std::string& name : data_sets_of(path_, group_ + data_group_of(association))) {
            const auto shape = rows_.shape(group_ + data_group_of(association) + "/" + name);
            if (vtk_xml::is_ghost_array(name)) continue;
            if (shape && !shape->is_single) announce(info, {name, association, shape->type, shape->columns});
            else leave_out(info, {kind_of_field(association), name, no_table_of_numbers});
        }
    if (steps_.missing) leave_out(info, *steps_.missing);
    if (has_steps()) info.times = steps_.times;
    return {};
}

/// Counts or places: integers of a data set.
Result<std::vector<std::uint64_t>> HdfGrid::counts(const std::string& name, std::uint64_t first,
                                                   std::uint64_t rows) const {
    const auto values = rows_.read(group_ + name, first, rows);
    if (!values) return values.error();
    std::vector<std::uint64_t> numbers(rows);
    for (std::uint64_t i = 0; i < rows; ++i) {
        const double value = values->at(i, 0);
        if (is_floating(values->type()) || value < 0 || value > 0x1p52)
            return wrong(fmt::format("\"{}\" has {} at place {}, which is no count", name, value, first + i));
        numbers[i] = static_cast<std::uint64_t>(value);
    }
    return numbers;
}

Result<std::uint64_t> HdfGrid::number_or(const std::string& name, std::uint64_t place, std::uint64_t otherwise) const {
    if (!has(name)) return otherwise;
    const auto found = counts(name, place, 1);
    if (!found) return found.error();
    return found->front();
}

Result<HdfStepPlace> HdfGrid::find_step(std::size_t step) const {
    HdfStepPlace place;
    const auto parts = rows_.shape(group_ + "NumberOfPoints");
    if (!parts) return wrong("\"NumberOfPoints\" is not there, or holds no numbers");
    for (const char* other : {"NumberOfCells", "NumberOfConnectivityIds"})
        if (const auto shape = rows_.shape(group_ + other); shape && shape->rows != parts->rows)
            return wrong(fmt::format("\"NumberOfPoints\" has {} entries, but \"{}\" has {}: each has one a part",
                                     parts->rows, other, shape->rows));
    place.parts = parts->rows;
    if (!has_steps()) return place;
    const auto take = [&](const char* name, std::uint64_t& to) -> Result<void> {
        const auto found = number_or(std::string("Steps/") + name, step, to);
        if (!found) return found.error();
        to = *found;
        return {};
    };
    if (auto done = take("PartOffsets", place.first_part); !done) return done.error();
    if (auto done = take("NumberOfParts", place.parts); !done) return done.error();
    if (auto done = take("PointOffsets", place.first_point); !done) return done.error();
    if (auto done = take("CellOffsets", place.first_cell); !done) return done.error();
    if (auto done = take("ConnectivityIdOffsets", place.first_corner); !done) return done.error();
    if (place.first_part > parts->rows || place.parts > parts->rows - place.first_part)
        return wrong(fmt::format("step {} has the parts {} to {}, but there are {}", step, place.first_part,
                                 place.first_part + place.parts, parts->rows));
    return place;
}

Result<std::vector<HdfPartition>> HdfGrid::find_partitions(const HdfStepPlace& place) const {
    const auto points = counts("NumberOfPoints", place.first_part, place.parts);
    if (!points) return points.error();
    const auto cells = counts("NumberOfCells", place.first_part, place.parts);
    if (!cells) return cells.error();
    const auto corners = counts("NumberOfConnectivityIds", place.first_part, place.parts);
    if (!corners) return corners.error();
    // Some writers give parts without cells no offset, others one.
    const auto offsets = rows_.shape(group_ + "Offsets");
    const auto all = std::accumulate(cells->begin(), cells->end(), std::uint64_t{0});
    const auto filled = place.parts - static_cast<std::uint64_t>(std::ranges::count(*cells, std::uint64_t{0}));
    const bool skips_empty = !has_steps() && offsets && filled < place.parts && offsets->rows == all + filled;
    std::vector<HdfPartition> out;
    HdfPartition next;
    next.first_point = place.first_point;
    next.first_cell = place.first_cell;
    next.first_corner = place.first_corner;
    next.first_offset = place.first_cell + place.first_part;
    for (std::size_t part = 0; part < place.parts; ++part) {
        next.points = (*points)[part];
        next.cells = (*cells)[part];
        next.corners = (*corners)[part];
        out.push_back(next);
        next.first_point += next.points; // below 2^52 each, and there are fewer parts than values in the file
        next.first_cell += next.cells;
        next.first_corner += next.corners;
        next.first_offset += next.cells + (next.cells == 0 && skips_empty ? 0 : 1);
    }
    return out;
}

/// Without steps every row is that of a part.
void HdfGrid::note_rows_left_over(const std::vector<HdfPartition>& parts, std::vector<std::string>& notes) const {
    if (has_steps() || parts.empty()) return;
    const HdfPartition& last = parts.back();
    std::vector<std::pair<std::string, std::uint64_t>> expected{{"Points", last.first_point + last.points},
                                                                {"Types", last.first_cell + last.cells},
                                                                {"Connectivity", last.first_corner + last.corners},
                                                                {"Offsets", last.first_offset + last.cells + 1}};
    for (const auto association : {Association::point, Association::cell})
        for (const std::string& name : data_sets_of(path_, group_ + data_group_of(association)))
            expected.emplace_back(std::string(data_group_of(association)) + "/" + name,
                                  association == Association::point ? expected[0].second : expected[1].second);
    std::vector<std::string> more;
    for (const auto& [name, rows] : expected)
        if (const auto shape = rows_.shape(group_ + name); shape && shape->rows > rows)
            more.push_back(fmt::format("\"{}\" has {} rows for {}", escaped(name), shape->rows, rows));
    if (!more.empty())
        notes.push_back(fmt::format("rows that belong to no part were not read: {}", fmt::join(more, ", ")));
}

Result<Array> HdfGrid::read_points(const HdfPartition& part) const {
    auto points = rows_.read(group_ + "Points", part.first_point, part.points);
    return points ? as_coordinates(*std::move(points)) : points;
}

/// The faces of a step begin behind those of the parts before it. Steps has tables of it, too; VTK's writer gives them
/// entries for parts, not steps, and they count only where they have as many rows as there are steps.
Result<void> HdfGrid::find_faces(const HdfStepPlace& place, std::size_t step, std::vector<HdfPartition>& parts) const {
    if (!has("FaceConnectivity") || !has("PolyhedronToFaces")) return {};
    const auto fill = [&](const char* number, const char* table, std::uint64_t HdfPartition::* size,
                          std::uint64_t HdfPartition::* first) -> Result<void> {
        const auto sizes = counts(number, 0, place.first_part + place.parts);
        if (!sizes) return sizes.error();
        const auto own = sizes->begin() + static_cast<std::ptrdiff_t>(place.first_part);
        std::uint64_t at = std::accumulate(sizes->begin(), own, std::uint64_t{0});
        const auto listed = rows_.shape(group_ + "Steps/" + table);
        if (has_steps() && listed && listed->rows == steps_.times.size()) {
            const auto told = counts(std::string("Steps/") + table, step, 1);
            if (!told) return told.error();
            at = told->front();
        }
        for (std::size_t part = 0; part < parts.size(); ++part) {
            parts[part].*size = own[static_cast<std::ptrdiff_t>(part)];
            parts[part].*first = at;
            at += parts[part].*size;
        }
        return {};
    };
    if (auto done = fill("NumberOfFaces", "FaceOffsetsOffsets", &HdfPartition::faces, &HdfPartition::first_face); !done)
        return done;
    if (auto done = fill("NumberOfFaceConnectivityIds", "FaceConnectivityOffsets", &HdfPartition::face_points,
                         &HdfPartition::first_face_point);
        !done)
        return done;
    if (auto done = fill("NumberOfPolyhedronToFaceIds", "PolyhedronToFaceIdOffsets", &HdfPartition::cell_faces,
                         &HdfPartition::first_cell_face);
        !done)
        return done;
    for (std::size_t part = 0; part < parts.size(); ++part)
        parts[part].first_face_offset = parts[part].first_face + place.first_part + part;
    return {};
}

/// Offsets are not read where the types tell as much, nor types kept where all cells are of one.
Result<void> HdfGrid::load_types(const HdfPartition& part, HdfCells& cells) const {
    if (part.cells == 0) return {};
    if (auto there = rows_.check(group_ + "Offsets", part.first_offset, part.cells + 1); !there) return there;
    auto types = rows_.read(group_ + "Types", part.first_cell, part.cells);
    if (!types) return types.error();
    auto bytes = as_bytes(*types);
    if (!bytes)
        return wrong(fmt::format("\"Types\" are {}, and not all whole numbers from 0 to 255", name_of(types->type())));
    cells.types = *std::move(bytes);
    if (auto places = CellPlaces::make(cells.types.as<std::uint8_t>())) {
        const auto told = are_offsets_told(part, *places);
        if (!told) return told.error();
        if (*told) {
            if (places->are_uniform()) cells.types = Array();
            cells.places = std::move(places);
            return {};
        }
    }
    auto offsets = rows_.read_indices(group_ + "Offsets", part.first_offset, part.cells + 1);
    if (!offsets) return offsets.error();
    cells.offsets = *std::move(offsets);
    return {};
}

Result<bool> HdfGrid::are_offsets_told(const HdfPartition& part, const CellPlaces& places) const {
    std::atomic<bool> same = true;
    const auto done = rows_.each_block(
        group_ + "Offsets", part.first_offset, part.cells + 1, [&](std::uint64_t first, const Array& offsets) {
            if (!offsets.visit([&](auto values) { return are_begins_of(places, first, values); })) same = false;
        });
    if (!done) return done.error();
    return same.load();
}

/// Whether the corners may wait until points and fields are there.
bool HdfGrid::may_be_left(const HdfPartition& part, const ReadOptions& options, const HdfCells& cells) const {
    const auto shape = rows_.shape(group_ + "Connectivity");
    return options.active_cells && part.cells > 0 && cells.places && cells.places->corners() == part.corners && shape &&
           shape->columns == 1 && !is_floating(shape->type) && size_of(shape->type) >= 4 &&
           part.first_corner <= shape->rows && part.corners <= shape->rows - part.first_corner;
}

Result<void> HdfGrid::load_corners(const HdfPartition& part, const ReadOptions& options, HdfCells cells,
                                   Piece& piece) const {
    const std::string name = group_ + "Connectivity";
    if (part.cells == 0) {
        piece.grid.cells.connectivity = Array(ScalarType::int32, nullptr, 0, 1, nullptr);
        return {};
    }
    if (may_be_left(part, options, cells)) {
        piece.unread = std::make_shared<const Hdf5Cells>(*std::move(cells.places), std::move(cells.types), rows_, name,
                                                         part.first_corner);
        return {};
    }
    auto connectivity = rows_.read_indices(name, part.first_corner, part.corners);
    if (!connectivity) return connectivity.error();
    if (cells.places) {
        piece.grid.cells = cells_at(*cells.places, cells.types, *std::move(connectivity));
        return {};
    }
    piece.grid.cells.connectivity = *std::move(connectivity);
    piece.grid.cells.types = std::move(cells.types);
    piece.grid.cells.offsets = std::move(cells.offsets);
    return load_faces(part, piece.grid.cells);
}

Result<void> HdfGrid::load_faces(const HdfPartition& part, Cells& cells) const {
    if (cells.types.empty() || !has("FaceConnectivity") || !has("PolyhedronToFaces")) return {};
    if (std::ranges::find(cells.types.as<std::uint8_t>(), core::polyhedron_type) ==
        cells.types.as<std::uint8_t>().end())
        return {};
    SharedFaces shared;
    const auto take = [&](const char* name, std::uint64_t first, std::uint64_t rows, Array& to) -> Result<void> {
        auto values = rows_.read_indices(group_ + name, first, rows);
        if (!values) return values.error();
        to = *std::move(values);
        return {};
    };
    if (auto done = take("FaceConnectivity", part.first_face_point, part.face_points, shared.points); !done)
        return done;
    if (auto done = take("FaceOffsets", part.first_face_offset, part.faces + 1, shared.face_offsets); !done)
        return done;
    if (auto done = take("PolyhedronToFaces", part.first_cell_face, part.cell_faces, shared.faces); !done) return done;
    if (auto done = take("PolyhedronOffsets", part.first_offset, part.cells + 1, shared.cell_offsets); !done)
        return done;
    if (auto done = write_out_faces(shared, cells); !done) return wrong(done.error().message);
    return {};
}

Result<void> HdfGrid::load_fields(const HdfPartition& part, const HdfStepPlace& place, std::size_t step,
                                  Association association, const ReadOptions& options, bool later, Piece& piece,
                                  FileInfo& info) const {
    const bool of_points = association == Association::point;
    const std::string group = data_group_of(association);
    for (const std::string& name : data_sets_of(path_, group_ + group)) {
        const bool ghost = vtk_xml::is_ghost_array(name);
        const bool is_field = !ghost && wanted(options, association, name);
        const bool marks = !of_points && (ghost || name == vtk_xml::ghost_rank_name);
        if (!is_field && !marks) continue;
        const auto shape = rows_.shape(group_ + group + "/" + name);
        if (!shape || shape->is_single) continue;
        const auto first = first_row(part, place, step, association, name);
        if (later && is_field && !marks && first && rows_.check(group_ + group + "/" + name, *first, part.cells)) {
            piece.unread_fields.push_back(
                {name, shape->type, shape->columns,
                 std::make_shared<const Hdf5Values>(rows_, group_ + group + "/" + name, *first, part.cells)});
            continue;
        }
        auto values = first ? rows_.read(group_ + group + "/" + name, *first, of_points ? part.points : part.cells)
                            : Result<Array>(first.error());
        if (!values && (ghost || values.error().code != ErrorCode::invalid_data)) return values.error();
        if (!values) leave_out(info, {kind_of_field(association), name, values.error().message});
        else if (marks) vtk_xml::mark_left_out(*values, name, piece.left_out);
        if (!values || !is_field) continue;
        if (later)
            piece.unread_fields.push_back({name, values->type(), values->components(),
                                           std::make_shared<const FieldInMemory>(*std::move(values))});
        else (of_points ? piece.grid.point_fields : piece.grid.cell_fields).push_back({name, *std::move(values)});
    }
    return {};
}

/// Of the values of a field.
Result<std::uint64_t> HdfGrid::first_row(const HdfPartition& part, const HdfStepPlace& place, std::size_t step,
                                         Association association, const std::string& name) const {
    const bool of_points = association == Association::point;
    const std::string group = data_group_of(association);
    const std::uint64_t in_step = of_points ? part.first_point - place.first_point : part.first_cell - place.first_cell;
    const std::uint64_t otherwise = of_points ? place.first_point : place.first_cell;
    const std::string offsets = "Steps/" + group + "Offsets/" + name;
    const auto first = has_steps() ? number_or(offsets, step, otherwise) : Result<std::uint64_t>(otherwise);
    return first ? Result<std::uint64_t>(*first + in_step) : first.error();
}

Result<std::uint64_t> HdfGrid::count_cells(std::size_t step) const {
    const auto place = find_step(step);
    if (!place) return place.error();
    const auto cells = counts("NumberOfCells", place->first_part, place->parts);
    if (!cells) return cells.error();
    return std::accumulate(cells->begin(), cells->end(), std::uint64_t{0});
}

LeastCounts HdfGrid::least(std::size_t step) const {
    const auto place = find_step(step);
    const auto parts = place ? find_partitions(*place) : Result<std::vector<HdfPartition>>(place.error());
    const auto points = rows_.shape(group_ + "Points"), corners = rows_.shape(group_ + "Connectivity"),
               types = rows_.shape(group_ + "Types");
    LeastCounts all;
    if (!parts || !points || !corners || !types) return all;
    for (const HdfPartition& part : *parts) {
        all.points += part.points;
        all.cells += part.cells;
        all.corners += part.corners;
    }
    if (all.points > points->rows || all.cells > types->rows || all.corners > corners->rows) return {}; // it is broken
    if (points->type != ScalarType::float32) all.coordinates = ScalarType::float64;
    return all;
}

Result<void> HdfGrid::load(const ReadOptions& options, std::size_t step, const std::string& name,
                           Loaded& loaded) const {
    const auto place = find_step(step);
    if (!place) return place.error();
    auto parts = find_partitions(*place);
    if (!parts) return parts.error();
    if (auto done = find_faces(*place, step, *parts); !done) return done;
    note_rows_left_over(*parts, loaded.notes);
    std::size_t number = 0;
    for (const HdfPartition& part : *parts) {
        Piece& piece = loaded.pieces.emplace_back();
        piece.name = fmt::format("{}part {}", name, ++number);
        auto points = read_points(part);
        if (!points) return points.error();
        piece.grid.points = *std::move(points);
        HdfCells cells;
        if (auto done = load_types(part, cells); !done) return done;
        const bool later = !are_counted(options) && may_be_left(part, options, cells);
        for (const auto association : {Association::point, Association::cell})
            if (auto done = load_fields(part, *place, step, association, options,
                                        later && association == Association::cell, piece, loaded.info);
                !done)
                return done;
        if (auto done = load_corners(part, options, std::move(cells), piece); !done) return done;
    }
    return {};
}

} // namespace isotet::io::confined
