// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cells.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/pieces.hpp>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVersionMacros.h>

namespace isotet_vtk {

namespace {

vtkDataArray* types_of(vtkUnstructuredGrid* grid) {
#if VTK_MAJOR_VERSION > 9 || (VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION >= 6)
    return grid->GetCellTypes();
#else
    return grid->GetCellTypesArray();
#endif
}

std::bitset<256> kinds_of(const isotet::Array& types) {
    std::bitset<256> kinds;
    bool seen[256] = {};
    for (const std::uint8_t type : types.as<std::uint8_t>()) seen[type] = true;
    for (std::size_t i = 0; i < 256; ++i) kinds[i] = seen[i];
    return kinds;
}

constexpr std::uint8_t polyhedron = 42, empty_cell = 0;

std::bitset<256> tetrahedra() {
    return std::bitset<256>().set(static_cast<std::size_t>(isotet::CellType::tetrahedron));
}

bool has_mark(const isotet::Array& marks, std::uint8_t bits) {
    return std::ranges::any_of(marks.as<std::uint8_t>(), [bits](std::uint8_t mark) { return (mark & bits) != 0; });
}

#if VTK_MAJOR_VERSION > 9 || (VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION >= 4)
/// The faces as isotet and older versions of VTK have them, one polyhedron after another.
void write_faces(vtkUnstructuredGrid* grid, std::vector<std::int64_t>& faces, std::vector<std::int64_t>& first) {
    vtkNew<vtkIdList> stream;
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell) {
        if (grid->GetCellType(cell) == polyhedron) {
            grid->GetFaceStream(cell, stream);
            faces.insert(faces.end(), stream->begin(), stream->end());
        }
        first.push_back(static_cast<std::int64_t>(faces.size()));
    }
}
#endif

} // namespace

bool SharedCells::is_refined(std::uint8_t type) const {
    return refines_ && isotet::is_curved(type) && type != VTK_BEZIER_PYRAMID;
}

bool SharedCells::is_contoured(std::uint8_t type) const { return isotet::Contour::contours(type) || is_refined(type); }

/// Without the types that VTK contours: of some of them (quadratic cells) isotet would make surfaces, too.
isotet::Array SharedCells::contoured_types(const isotet::Array& types) const {
    std::vector<std::uint8_t> out;
    out.reserve(types.tuples());
    for (const std::uint8_t type : types.as<std::uint8_t>()) out.push_back(is_contoured(type) ? type : empty_cell);
    return isotet::Array::own(std::move(out));
}

isotet::Result<void> SharedCells::take(vtkUnstructuredGrid* grid, const isotet::Array& points, bool refines) {
    vtkCellArray* const cells = grid->GetCells();
    const isotet::Array connectivity = connectivity_.of(cells ? cells->GetConnectivityArray() : nullptr);
    const isotet::Array offsets = offsets_.of(cells ? cells->GetOffsetsArray() : nullptr);
    const isotet::Array types = types_.of(types_of(grid));
    marks_ = ghosts_.of(grid->GetCellGhostArray());
    changed_ =
        connectivity_.changed() || offsets_.changed() || types_.changed() || ghosts_.changed() || refines != refines_;
    refines_ = refines;
    if (!changed_) return {};
    all_ = {connectivity, offsets, types};
    kinds_ = kinds_of(types);
    if (kinds_[polyhedron]) share_faces(grid);
    own_ = all_;
    has_ghosts_ = has_mark(marks_, ghost_bits);
    has_others_cells_ = has_mark(marks_, duplicate_bit);
    if (has_ghosts_)
        if (auto ok = leave_out_ghosts(points); !ok) return ok;
    if (has_others()) {
        all_.types = contoured_types(all_.types);
        own_.types = contoured_types(own_.types);
    }
    if (types.tuples() > 0 && kinds_of(types) == tetrahedra()) {
        all_.offsets = {}; // four corners a cell
        all_.types = {};
        if (!has_ghosts_) own_ = all_;
    }
    return {};
}

void SharedCells::share_faces(vtkUnstructuredGrid* grid) {
    std::vector<std::int64_t> first;
    first.reserve(static_cast<std::size_t>(grid->GetNumberOfCells()) + 1);
#if VTK_MAJOR_VERSION > 9 || (VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION >= 4)
    std::vector<std::int64_t> faces;
    first.push_back(0);
    write_faces(grid, faces, first);
    all_.faces = isotet::Array::own(std::move(faces));
#else
    all_.faces = faces_.of(grid->GetFaces());
    const isotet::Array places = face_places_.of(grid->GetFaceLocations()); // -1 for cells that are no polyhedra
    if (all_.faces.empty() || places.empty()) {
        all_.faces = {};
        return;
    }
    first.resize(places.tuples() + 1, static_cast<std::int64_t>(all_.faces.tuples()));
    const vtkIdType* const place = static_cast<const vtkIdType*>(places.data());
    for (std::size_t cell = places.tuples(); cell-- > 0;) first[cell] = place[cell] < 0 ? first[cell + 1] : place[cell];
    first[0] = 0;
#endif
    all_.face_offsets = isotet::Array::own(std::move(first));
}

isotet::Result<void> SharedCells::leave_out_ghosts(const isotet::Array& points) {
    isotet::Grid grid;
    grid.points = points;
    grid.cells = all_;
    const isotet::Result<isotet::Grid> without = isotet::leave_out_cells(grid, marks_);
    if (!without) {
        *this = {}; // so that the next call looks again
        return without.error();
    }
    own_ = without->cells;
    if (!own_.types.empty()) kinds_ = kinds_of(own_.types);
    kinds_[empty_cell] = false; // that is what left-out cells become
    return {};
}

void SharedCells::release() {
    for (SharedArray* array : {&connectivity_, &offsets_, &types_, &faces_, &face_places_, &ghosts_}) array->release();
}

bool SharedCells::has_contoured() const {
    for (int type = 0; type < 256; ++type)
        if (kinds_[static_cast<std::size_t>(type)] && is_contoured(static_cast<std::uint8_t>(type))) return true;
    return false;
}

bool SharedCells::has_others() const { return !other_types().empty(); }

std::vector<std::uint8_t> SharedCells::other_types() const {
    std::vector<std::uint8_t> others;
    for (int type = 1; type < 256; ++type) // 0: no cell at all
        if (kinds_[static_cast<std::size_t>(type)] && !is_contoured(static_cast<std::uint8_t>(type)))
            others.push_back(static_cast<std::uint8_t>(type));
    return others;
}

} // namespace isotet_vtk
