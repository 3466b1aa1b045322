// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTKHDF: unstructured grids, versions 1 and 2, partitions and time steps by ourselves; image data by VTK's reader.
#include <limits>
#include <optional>

#include <fmt/core.h>
#include <vtkHDFReader.h>
#include <vtkNew.h>

#include "io/own/escape.hpp"
#include "io/own/vtk_xml/columns.hpp"
#include "io/own/vtk_xml/load.hpp"
#include "io/vtk/hdf5_array.hpp"
#include "io/vtk/hdf5_rows.hpp"
#include "io/vtk/hdf5_walk.hpp"
#include "io/vtk/length_check.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/vtk_load.hpp"

namespace isotet::io::vtk {
namespace {

const std::string root = "/VTKHDF/";

/// What a partition has, and where it begins in the data sets.
struct Partition {
    std::uint64_t points = 0, cells = 0, corners = 0;
    std::uint64_t first_point = 0, first_cell = 0, first_corner = 0;
    std::uint64_t first_offset = 0; ///< each partition has one more than cells
};

/// Where the tuples of fields begin that do not say so themselves.
struct StepPlace {
    std::uint64_t first_part = 0, parts = 0;
    std::uint64_t first_point = 0, first_cell = 0, first_corner = 0;
};

/// An unstructured grid in an open file.
class GridFile {
public:
    GridFile(const std::string& path, Hdf5Rows rows) : path_(path), rows_(std::move(rows)) {}

    Result<Loaded> load(const ReadOptions& options, Depth depth);

private:
    Error wrong(const std::string& what) const { return broken(path_, what); }
    bool has(const std::string& name) const { return rows_.shape(root + name).has_value(); }

    Result<void> announce_all(FileInfo& info);
    Result<std::uint64_t> number(const std::string& name, std::uint64_t place) const;
    Result<std::uint64_t> number_or(const std::string& name, std::uint64_t place, std::uint64_t otherwise) const;
    Result<StepPlace> find_step(std::size_t step, bool has_steps) const;
    Result<std::vector<Partition>> find_partitions(const StepPlace& place) const;
    Result<void> load_cells(const Partition& part, Grid& grid) const;
    Result<void> load_fields(const Partition& part, const StepPlace& place, Association association,
                             const ReadOptions& options, Piece& piece) const;

    std::string path_;
    Hdf5Rows rows_;
    std::size_t step_ = 0;
    bool has_steps_ = false;
};

const char* group_of(Association association) { return association == Association::point ? "PointData" : "CellData"; }

Result<void> GridFile::announce_all(FileInfo& info) {
    for (const auto association : {Association::point, Association::cell})
        for (const std::string& name : data_sets_of(path_, root + group_of(association))) {
            const auto shape = rows_.shape(root + group_of(association) + "/" + name);
            if (!shape || is_ghost_array(name)) continue; // texts, and tensors of higher rank
            announce(info, {name, association, shape->type, shape->columns});
        }
    if (!has("Steps/Values")) return {};
    const auto times = rows_.read(root + "Steps/Values");
    if (!times) return times.error();
    for (std::size_t i = 0; i < times->size(); ++i) info.times.push_back(times->at(i));
    return {};
}

/// A count or a place: an integer of a data set.
Result<std::uint64_t> GridFile::number(const std::string& name, std::uint64_t place) const {
    const auto value = rows_.read(root + name, place, 1);
    if (!value) return value.error();
    if (is_floating(value->type()) || value->at(0, 0) < 0 || value->at(0, 0) > 0x1p52)
        return wrong(fmt::format("\"{}\" has {} at place {}, which is no count", name, value->at(0, 0), place));
    return static_cast<std::uint64_t>(value->at(0, 0));
}

Result<std::uint64_t> GridFile::number_or(const std::string& name, std::uint64_t place, std::uint64_t otherwise) const {
    if (!has(name)) return otherwise;
    return number(name, place);
}

Result<StepPlace> GridFile::find_step(std::size_t step, bool has_steps) const {
    StepPlace place;
    const auto parts = rows_.shape(root + "NumberOfPoints");
    if (!parts) return wrong("\"NumberOfPoints\" is not there, or holds no numbers");
    place.parts = parts->rows;
    if (!has_steps) return place;
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

Result<std::vector<Partition>> GridFile::find_partitions(const StepPlace& place) const {
    std::vector<Partition> out;
    Partition next;
    next.first_point = place.first_point;
    next.first_cell = place.first_cell;
    next.first_corner = place.first_corner;
    next.first_offset = place.first_cell + place.first_part;
    for (std::uint64_t part = place.first_part; part < place.first_part + place.parts; ++part) {
        const auto points = number("NumberOfPoints", part);
        if (!points) return points.error();
        const auto cells = number("NumberOfCells", part);
        if (!cells) return cells.error();
        const auto corners = number("NumberOfConnectivityIds", part);
        if (!corners) return corners.error();
        next.points = *points;
        next.cells = *cells;
        next.corners = *corners;
        out.push_back(next);
        next.first_point += *points; // below 2^52 each, and there are fewer parts than values in the file
        next.first_cell += *cells;
        next.first_corner += *corners;
        next.first_offset += *cells + 1;
    }
    return out;
}

Result<void> GridFile::load_cells(const Partition& part, Grid& grid) const {
    auto points = rows_.read(root + "Points", part.first_point, part.points);
    if (!points) return points.error();
    auto connectivity = rows_.read_indices(root + "Connectivity", part.first_corner, part.corners);
    if (!connectivity) return connectivity.error();
    auto offsets = rows_.read_indices(root + "Offsets", part.first_offset, part.cells + 1);
    if (!offsets) return offsets.error();
    auto types = rows_.read(root + "Types", part.first_cell, part.cells);
    if (!types) return types.error();
    if (types->type() != ScalarType::uint8)
        return wrong(fmt::format("\"Types\" are {}, but must be uint8", name_of(types->type())));
    grid.points = *std::move(points);
    grid.cells.connectivity = *std::move(connectivity);
    grid.cells.offsets = *std::move(offsets);
    grid.cells.types = *std::move(types);
    vtk_xml::simplify(grid.cells);
    return {};
}

Result<void> GridFile::load_fields(const Partition& part, const StepPlace& place, Association association,
                                   const ReadOptions& options, Piece& piece) const {
    const bool of_points = association == Association::point;
    const std::string group = group_of(association);
    for (const std::string& name : data_sets_of(path_, root + group)) {
        const bool ghost = is_ghost_array(name);
        if ((!wanted(options, association, name) && !(ghost && !of_points)) || (ghost && of_points)) continue;
        if (!has(group + "/" + name)) continue;
        const std::uint64_t in_step =
            of_points ? part.first_point - place.first_point : part.first_cell - place.first_cell;
        const std::uint64_t otherwise = of_points ? place.first_point : place.first_cell;
        const std::string offsets = "Steps/" + group + "Offsets/" + name;
        const auto first = has_steps_ ? number_or(offsets, step_, otherwise) : Result<std::uint64_t>(otherwise);
        if (!first) return first.error();
        auto values = rows_.read(root + group + "/" + name, *first + in_step, of_points ? part.points : part.cells);
        if (!values) return values.error();
        if (ghost) vtk_xml::mark_left_out(*values, name, piece.left_out);
        else (of_points ? piece.grid.point_fields : piece.grid.cell_fields).push_back({name, *std::move(values)});
    }
    return {};
}

Result<Loaded> GridFile::load(const ReadOptions& options, Depth depth) {
    Loaded loaded;
    if (auto done = announce_all(loaded.info); !done) return done.error();
    if (depth == Depth::description) return loaded;
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = step_ = *step;
    has_steps_ = !loaded.info.times.empty();
    const auto place = find_step(step_, has_steps_);
    if (!place) return place.error();
    const auto parts = find_partitions(*place);
    if (!parts) return parts.error();
    for (const Partition& part : *parts) {
        Piece& piece = loaded.pieces.emplace_back();
        piece.name = fmt::format("part {}", loaded.pieces.size());
        if (auto done = load_cells(part, piece.grid); !done) return done.error();
        for (const auto association : {Association::point, Association::cell})
            if (auto done = load_fields(part, *place, association, options, piece); !done) return done.error();
    }
    if (loaded.pieces.empty()) return wrong("it has no part");
    return loaded;
}

Result<Loaded> load_by_vtk(const std::string& path, const ReadOptions& options, Depth depth) {
    vtkNew<vtkHDFReader> reader;
    reader->SetFileName(path.c_str());
    return load_with(*reader, path, options, depth, [&](const ReadOptions& chosen, FileInfo& info) {
        for (int i = 0; i < reader->GetNumberOfPointArrays(); ++i)
            if (!wanted(chosen, Association::point, reader->GetPointArrayName(i)))
                announce(info, {reader->GetPointArrayName(i), Association::point, ScalarType::float64, 1});
        for (int i = 0; i < reader->GetNumberOfCellArrays(); ++i)
            if (!wanted(chosen, Association::cell, reader->GetCellArrayName(i)))
                announce(info, {reader->GetCellArrayName(i), Association::cell, ScalarType::float64, 1});
        choose_arrays(reader->GetPointDataArraySelection(), chosen, Association::point);
        choose_arrays(reader->GetCellDataArraySelection(), chosen, Association::cell);
    });
}

} // namespace

Result<Loaded> load_vtkhdf(const std::string& path, const ReadOptions& options, Depth depth) {
    if (auto complete = check_hdf5_length(path); !complete) return complete.error();
    if (auto names = check_hdf5_names(path, options.allow_outside); !names) return names.error();
    if (text_attribute(path, "/VTKHDF", "Type") != "UnstructuredGrid") return load_by_vtk(path, options, depth);
    auto rows = Hdf5Rows::open(path);
    if (!rows) return rows.error();
    return GridFile(path, *std::move(rows)).load(options, depth);
}

} // namespace isotet::io::vtk
