// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// CGNS in ADF or HDF5; zones are pieces. VTK glues VelocityX, VelocityY and VelocityZ into Velocity; here they come
// apart again, so that fields have the names of the file.
#include <algorithm>
#include <array>

#include <fmt/core.h>
#include <vtkCGNSReader.h>
#include <vtkNew.h>

#include "io/own/block_choice.hpp"
#include "io/own/escape.hpp"
#include "io/vtk/cgns_faces.hpp"
#include "io/vtk/hdf5_walk.hpp"
#include "io/vtk/length_check.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/unset_memory.hpp"
#include "io/vtk/vtk_load.hpp"
#include "io/vtk/vtk_log.hpp"

namespace isotet::io::vtk {
namespace {

constexpr std::array<char, 3> axes = {'X', 'Y', 'Z'};

/// Arrays in CGNS are scalar: whatever has components was glued.
bool is_glued(std::size_t components) { return components == 2 || components == 3; }

/// With every name its names with an axis, and without: what VTK has to read so that the wanted names can be had.
ReadOptions with_glued_names(ReadOptions options) {
    for (auto* names : {&options.point_fields, &options.cell_fields}) {
        if (!*names) continue;
        const std::vector<std::string> asked = **names;
        for (const std::string& name : asked)
            for (const char axis : axes)
                if (name.size() > 1 && name.back() == axis) (*names)->push_back(name.substr(0, name.size() - 1));
    }
    return options;
}

Array component(const Array& values, std::size_t which) {
    return values.visit([&](auto from) {
        std::vector<std::remove_const_t<typename decltype(from)::value_type>> to(values.tuples());
        for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[i * values.components() + which];
        return Array::own(std::move(to));
    });
}

std::vector<Field> unglued(std::vector<Field> fields, const ReadOptions& options, Association association) {
    std::vector<Field> result;
    for (Field& field : fields) {
        if (!is_glued(field.values.components())) {
            if (wanted(options, association, field.name)) result.push_back(std::move(field));
            continue;
        }
        for (std::size_t i = 0; i < field.values.components(); ++i)
            if (const std::string name = field.name + axes[i]; wanted(options, association, name))
                result.push_back({name, component(field.values, i)});
    }
    return result;
}

std::vector<FieldInfo> unglued(const std::vector<FieldInfo>& fields) {
    std::vector<FieldInfo> result;
    for (const FieldInfo& field : fields) {
        if (!is_glued(field.components)) result.push_back(field);
        else
            for (std::size_t i = 0; i < field.components; ++i)
                result.push_back({field.name + axes[i], field.association, field.type, 1});
    }
    return result;
}

/// Bases are grids of their own, often in the same place: without a choice only the first is read.
void choose_bases(vtkCGNSReader& reader, const ReadOptions& options, Depth depth, std::vector<std::string>& notes) {
    reader.EnableAllBases();
    const int count = reader.GetNumberOfBaseArrays();
    if (count < 2 || depth == Depth::description || !options.blocks.empty()) return;
    for (int i = 1; i < count; ++i) reader.SetBaseArrayStatus(reader.GetBaseArrayName(i), 0);
    std::string others;
    for (int i = 1; i < count; ++i) others += (i > 1 ? ", '" : "'") + escaped(reader.GetBaseArrayName(i)) + "'";
    notes.push_back(fmt::format("only the first of {} bases is read, '{}': --block NAME (ReadOptions::blocks) reads {}",
                                count, escaped(reader.GetBaseArrayName(0)), others));
}

/// VTK takes PYRA_14 for its pyramid of 13 nodes, and does not know PYRA_13, the only element of so many nodes. With the node
/// in the base it is a Lagrange pyramid.
void name_pyramids(Cells& cells) {
    constexpr std::uint8_t empty = 0, pyramid_13 = 27, lagrange_pyramid = 74;
    if (cells.types.empty()) return;
    const auto types = cells.types.as<std::uint8_t>();
    const auto may_be_pyramid = [&](std::uint8_t type) { return type == empty || type == pyramid_13; };
    if (std::ranges::none_of(types, may_be_pyramid)) return;
    std::vector<std::uint8_t> named(types.begin(), types.end());
    for (std::size_t cell = 0; cell < named.size(); ++cell) {
        if (!may_be_pyramid(named[cell])) continue;
        const double nodes = cells.offsets.at(cell + 1) - cells.offsets.at(cell);
        if (nodes == 13) named[cell] = pyramid_13;
        else if (nodes == 14 && named[cell] == pyramid_13) named[cell] = lagrange_pyramid;
    }
    cells.types = Array::own(std::move(named));
}

bool has_polygons(const std::vector<CgnsFaceZone>& zones) {
    return std::ranges::any_of(zones, [](const CgnsFaceZone& zone) { return !zone.cells.types.empty(); });
}

/// Switches a cell array off.
void leave_to_us(vtkCGNSReader& reader, int array, FileInfo& info) {
    const std::string name = reader.GetCellArrayName(array);
    reader.SetCellArrayStatus(name.c_str(), 0);
    announce(info, {name, Association::cell, ScalarType::float64, 1});
}

/// VTK makes polygons of cells that only their faces tell of, and refuses fields on these cells: both are put in here.
Result<void> replace_polygons(const std::string& path, const std::vector<CgnsFaceZone>& zones,
                              const ReadOptions& options, Loaded& loaded) {
    if (!has_polygons(zones)) return {};
    const auto chosen = chosen_blocks(loaded.info.blocks, options);
    if (!chosen) return chosen.error();
    std::size_t next = 0;
    for (std::size_t block = 0; block < loaded.info.blocks.size(); ++block) {
        BlockInfo& info = loaded.info.blocks[block];
        const auto zone = std::ranges::find(zones, info.name, &CgnsFaceZone::name);
        const bool replaced = zone != zones.end() && !zone->cells.types.empty();
        if (replaced) info.cells = zone->cells.count();
        if (!(*chosen)[block] || next >= loaded.pieces.size()) continue;
        Piece& piece = loaded.pieces[next++];
        if (replaced) piece.grid.cells = zone->cells;
        auto fields = cgns_cell_fields(path, info.name, loaded.step, loaded.info.times.size());
        if (!fields) return fields.error();
        std::erase_if(*fields, [&](const Field& field) { return !wanted(options, Association::cell, field.name); });
        piece.grid.cell_fields = *std::move(fields);
    }
    return {};
}

} // namespace

Result<Loaded> load_cgns(const std::string& path, const ReadOptions& options, Depth depth) {
    if (auto complete = check_hdf5_length(path); !complete) return complete.error();
    if (auto complete = check_adf_length(path); !complete) return complete.error();
    if (auto names = check_hdf5_names(path, options.allow_outside); !names) return names.error();
    const auto face_zones = check_cgns_faces(path);
    if (!face_zones) return face_zones.error();
    const MarkedMemory marked;
    const ExpectedVtkError expected(has_polygons(*face_zones) ? "Mismatch in number of cells" : "");
    vtkNew<vtkCGNSReader> reader;
    reader->SetFileName(path.c_str());
    reader->SetUse3DVector(false); // no third component where the file has two
    reader->SetLoadBndPatch(false);
    reader->SetDoublePrecisionMesh(1); // exact for coordinates of either precision
    std::vector<std::string> notes;
    auto loaded = load_with(
        *reader, path, with_glued_names(options), depth,
        [&](const ReadOptions& chosen, FileInfo& info) {
            choose_bases(*reader, options, depth, notes);
            choose_arrays_by_name(*reader, chosen, info);
            for (int i = 0; i < reader->GetNumberOfCellArrays() && has_polygons(*face_zones); ++i)
                leave_to_us(*reader, i, info);
        },
        "zone");
    if (!loaded) return loaded;
    loaded->notes.insert(loaded->notes.begin(), notes.begin(), notes.end());
    if (auto set = MarkedMemory::check(path, *loaded); !set) return set.error();
    loaded->info.fields = unglued(loaded->info.fields);
    for (Piece& piece : loaded->pieces) {
        name_pyramids(piece.grid.cells);
        piece.grid.point_fields = unglued(std::move(piece.grid.point_fields), options, Association::point);
        piece.grid.cell_fields = unglued(std::move(piece.grid.cell_fields), options, Association::cell);
    }
    if (auto done = replace_polygons(path, *face_zones, options, *loaded); !done) return done.error();
    return loaded;
}

} // namespace isotet::io::vtk
