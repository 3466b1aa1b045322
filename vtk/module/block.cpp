// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "block.hpp"

#include <algorithm>
#include <utility>

#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <isotet/solid.hpp>

#include "polydata.hpp"
#include "unstructured.hpp"

namespace isotet_vtk {

namespace {

/// Whether an array of numbers is carried onto the surface: all that have a name, ids and ghost marks aside.
bool is_carried(vtkDataSetAttributes* attributes, vtkDataArray* array) {
    if (!array || !array->GetName() || !scalar_type(array)) return false; // null: strings
    if (array == attributes->GetGlobalIds() || array == attributes->GetPedigreeIds()) return false;
    return array->GetName() != std::string(vtkDataSetAttributes::GhostArrayName());
}

/// The carried arrays of `attributes`, by name. Those that were there before keep their SharedArray.
void share_carried(vtkDataSetAttributes* attributes, vtkDataArray* but, std::map<std::string, SharedArray>& carried) {
    std::map<std::string, SharedArray> before = std::exchange(carried, {});
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i) {
        vtkDataArray* const array = attributes->GetArray(i);
        if (array == but || !is_carried(attributes, array)) continue;
        if (auto kept = before.extract(array->GetName())) carried.insert(std::move(kept));
        carried[array->GetName()].of(array);
    }
}

std::vector<isotet::Field> fields_of(std::map<std::string, SharedArray>& carried) {
    std::vector<isotet::Field> fields;
    for (auto& [name, array] : carried) fields.push_back({name, array.last()});
    return fields;
}

std::vector<isotet::SolidRange> ranges_of(const Wishes& wishes) {
    std::vector<isotet::SolidRange> ranges;
    if (wishes.solid == SolidWish::between) {
        const auto [least, most] = std::ranges::minmax(wishes.isovalues);
        return {{least, most}};
    }
    for (const double isovalue : wishes.isovalues)
        ranges.push_back(wishes.solid == SolidWish::above ? isotet::SolidRange::above(isovalue)
                                                          : isotet::SolidRange::below(isovalue));
    return ranges;
}

/// What a user should know of refined cells; the same for every isovalue, so that it is said once.
std::vector<std::string> notes_of(const isotet::RefinementReport& report) {
    std::vector<std::string> notes;
    if (!report.refined) return notes;
    if (report.unknown_cells > 0)
        notes.push_back("curved cells above degree 10 are left out: " + std::to_string(report.unknown_cells));
    if (report.not_finite > 0)
        notes.push_back("parts of curved cells with a node that has no finite value are left out");
    if (report.too_fine || report.too_bent)
        notes.push_back("some curved cells fold or are too small to be refined to the Tolerance: GetFieldBound() tells "
                        "what was reached");
    return notes;
}

std::vector<std::string> notes_of(const isotet::Solid& solid) {
    std::vector<std::string> notes = notes_of(solid.contour.refinement);
    if (solid.open_edges > 0)
        notes.push_back("the solid has " + std::to_string(solid.open_edges) +
                        " open edges: the grid has repeated cells");
    if (solid.seam_edges > 0)
        notes.push_back(
            "the isosurface of the solid has " + std::to_string(solid.seam_edges) +
            " open edges inside the grid, where points are doubled: vtkStaticCleanUnstructuredGrid joins them");
    if (solid.unfit_edges > 0)
        notes.push_back("the isosurface of the solid has " + std::to_string(solid.unfit_edges) +
                        " open edges inside the grid, where cells of different sizes do not fit together");
    return notes;
}

} // namespace

isotet::Result<void> Block::take(vtkUnstructuredGrid* grid, vtkDataArray* scalars, const Wishes& wishes) {
    grid_ = grid;
    scalars_ = scalars;
    wishes_ = wishes;
    input_ = {};
    input_.points = points_.of(grid->GetPoints() ? grid->GetPoints()->GetData() : nullptr);
    if (auto ok = cells_.take(grid, input_.points, wishes.tolerance > 0); !ok) return ok;
    input_.cells = cells_.own();
    contoured_.name = scalars->GetName() ? scalars->GetName() : "scalars";
    contoured_.values = field_.of(scalars);
    numbers_ = global_ids_.of(grid->GetPointData()->GetGlobalIds());
    const std::size_t carried_before = carried_.size();
    vtkPointData* const point_data = grid->GetPointData();
    share_carried(point_data, scalars, carried_);
    // isotet's own normals have the name that those of the input mostly have.
    if (wishes.normals) carried_.erase("Normals");
    share_carried(grid->GetCellData(), nullptr, carried_cells_);
    point_fields_ = fields_of(carried_);
    cell_fields_ = fields_of(carried_cells_);
    is_renumbered_ = cells_.changed() || global_ids_.changed() || !survey_;
    is_new_ = is_renumbered_ || points_.changed() || field_.changed() || carried_before != carried_.size();
    for (const auto& [name, array] : carried_) is_new_ |= array.changed();
    if (is_new_) survey_.reset();
    return {};
}

isotet::ContourInput Block::contour_input(bool with_numbers) const {
    isotet::ContourInput input;
    input.grid = input_;
    if (with_numbers) input.grid.point_numbers = numbers_;
    input.field = contoured_;
    input.point_fields = point_fields_;
    input.cell_fields = cell_fields_;
    return input;
}

/// Of a piece where there is a frame: then ghost cells are the other pieces'. The boundary has other values than the
/// isovalue: the contoured array is carried.
isotet::Result<isotet::Solids> Block::solids(const std::optional<isotet::Frame>& frame, bool with_numbers,
                                             const isotet::Run& run) const {
    isotet::ContourInput input = contour_input(with_numbers);
    if (wishes_.scalars) input.point_fields.push_back({contoured_.name, contoured_.values});
    isotet::ContourOptions options;
    options.method = isotet::Method::direct;
    options.frame = frame;
    if (wishes_.tolerance > 0) options.refine = isotet::RefineOptions{.relative_tolerance = wishes_.tolerance};
    if (wishes_.points == isotet::Precision::float64) options.precision = isotet::Precision::float64;
    if (!frame) return isotet::Solids::create(std::move(input), options, run);
    std::vector<std::uint8_t> ghosts(cells_.all().count(), 0);
    if (cells_.has_ghosts()) {
        const auto marks = cells_.ghosts().as<std::uint8_t>();
        std::ranges::transform(marks, ghosts.begin(), [](std::uint8_t mark) { return mark & duplicate_bit; });
        input.grid.cells = cells_.all();
        const auto shown = isotet::leave_out_cells(input.grid, cells_.ghosts(), ghost_bits & ~duplicate_bit, run);
        if (!shown) return shown.error();
        input.grid.cells = shown->cells;
    }
    return isotet::Solids::create_piece(std::move(input), isotet::Array::own(std::move(ghosts)), options, run);
}

/// Nothing is kept for the next execution: solids would hold arrays of VTK.
isotet::Result<void> Block::extract_solids(const std::optional<isotet::Frame>& frame, bool with_numbers,
                                           const isotet::Run& run, vtkPolyData* out) {
    update_ = isotet::ContourUpdate::grid;
    session_.reset();
    isotet::Result<isotet::Solids> solids = this->solids(frame, with_numbers, run);
    if (!solids) return solids.error();
    extract_seconds_ = field_bound_ = 0;
    notes_.clear();
    std::vector<isotet::Surface> surfaces;
    for (const isotet::SolidRange& range : ranges_of(wishes_)) {
        isotet::Result<isotet::Solid> solid = solids->extract(range, run);
        if (!solid) return solid.error();
        method_ = solid->contour.method;
        extract_seconds_ += solid->contour.extract_seconds;
        if (solid->contour.refinement.refined) field_bound_ = solid->contour.refinement.field_bound;
        for (std::string& note : notes_of(*solid))
            if (std::ranges::find(notes_, note) == notes_.end()) notes_.push_back(std::move(note));
        surfaces.push_back(std::move(solid->surface));
    }
    Wishes plain = wishes_;
    plain.normals = plain.scalars = false;
    write_polydata(surfaces, plain, scalars_, grid_, out);
    if (wishes_.scalars) out->GetPointData()->SetActiveScalars(contoured_.name.c_str());
    return {};
}

isotet::Result<void> Block::clip(bool polyhedra, const isotet::Run& run, vtkUnstructuredGrid* out) {
    isotet::ContourInput input = contour_input(false);
    const bool is_of_grid = grid_->GetPointData()->GetArray(contoured_.name.c_str()) == scalars_;
    if (is_of_grid) input.point_fields.push_back({contoured_.name, contoured_.values});
    isotet::ContourOptions options;
    options.method = isotet::Method::direct;
    if (wishes_.tolerance > 0) options.refine = isotet::RefineOptions{.relative_tolerance = wishes_.tolerance};
    const bool is_single =
        input_.points.type() == isotet::ScalarType::float32 && contoured_.values.type() == isotet::ScalarType::float32;
    if (wishes_.points == isotet::Precision::float64 || !is_single) // as every piece of the grid, without a frame
        options.precision = isotet::Precision::float64;
    isotet::Result<isotet::Clipper> clipper = isotet::Clipper::create(std::move(input), options, run);
    if (!clipper) return clipper.error();
    auto clipped = clipper->clip(ranges_of(wishes_).front(), {.polyhedra = polyhedra}, run);
    if (!clipped) return clipped.error();
    notes_ = notes_of(clipped->contour.refinement);
    if (clipped->folded_pieces > 0)
        notes_.push_back("pieces with cells inside out, as no point sees all of them: " +
                         std::to_string(clipped->folded_pieces) + "; Polyhedra avoids them");
    clipped->grid.points = in_precision(clipped->grid.points, wishes_);
    write_cells(clipped->grid, out);
    write_fields(clipped->grid.point_fields, clipped->grid.cell_fields, grid_, out);
    return {};
}

isotet::Result<isotet::Survey> Block::survey(const isotet::Run& run) {
    if (survey_) return *survey_;
    std::vector<isotet::Field> fields = {{contoured_.name, contoured_.values}};
    for (const isotet::Field& field : point_fields_)
        if (fields.size() < isotet::Survey::max_fields) fields.push_back(field);
    isotet::Result<isotet::Survey> survey = isotet::survey_piece(input_, fields, {}, run);
    if (survey) survey_ = *survey;
    return survey;
}

isotet::Result<void> Block::set(const std::optional<isotet::Frame>& frame, bool with_numbers, const isotet::Run& run) {
    isotet::ContourInput input = contour_input(with_numbers);
    // Gradients are sums over the cells around a point, ghost cells among them.
    const bool needs_ghosts = wishes_.normals && cells_.has_ghosts();
    if (needs_ghosts) input.grid.cells = cells_.all();
    isotet::ContourOptions options;
    options.surfaces = wishes_.expected_surfaces;
    options.normals = wishes_.normals ? isotet::Normals::gradient : isotet::Normals::none;
    options.source_cells = needs_ghosts;
    options.frame = frame;
    if (wishes_.tolerance > 0) {
        options.refine = isotet::RefineOptions{.relative_tolerance = wishes_.tolerance};
        if (wishes_.refines_carried) options.refine->carried = point_fields_;
    }
    if (wishes_.points == isotet::Precision::float64) options.precision = isotet::Precision::float64;
    if (session_) {
        const isotet::Result<isotet::ContourUpdate> update = session_->set(std::move(input), options, run);
        if (!update) return update.error();
        update_ = *update;
        return {};
    }
    isotet::Result<isotet::Contour> session = isotet::Contour::create(std::move(input), options, run);
    if (!session) return session.error();
    session_.emplace(*std::move(session));
    update_ = isotet::ContourUpdate::grid;
    return {};
}

isotet::Result<void> Block::extract(const std::optional<isotet::Frame>& frame, bool with_numbers,
                                    const isotet::Run& run, vtkPolyData* out) {
    if (wishes_.solid != SolidWish::none) return extract_solids(frame, with_numbers, run, out);
    if (auto ok = set(frame, with_numbers, run); !ok) return ok;
    isotet::Result<isotet::ContourResult> result = session_->extract(wishes_.isovalues, run);
    if (!result) return result.error();
    method_ = result->method;
    extract_seconds_ = result->extract_seconds;
    field_bound_ = result->refinement.refined ? result->refinement.field_bound : 0;
    notes_ = notes_of(result->refinement);
    std::vector<isotet::Surface> surfaces;
    for (isotet::Extraction& extraction : result->surfaces) {
        surfaces.push_back(std::move(extraction.surface));
        if (surfaces.back().source_cells.empty()) continue;
        auto own = isotet::leave_out_triangles(surfaces.back(), cells_.ghosts(), ghost_bits, run);
        if (!own) return own.error();
        surfaces.back() = *std::move(own);
    }
    write_polydata(surfaces, wishes_, scalars_, grid_, out);
    return {};
}

void Block::release() {
    cells_.release();
    for (SharedArray* array : {&points_, &field_, &global_ids_}) array->release();
    for (auto* carried : {&carried_, &carried_cells_})
        for (auto& [name, array] : *carried) array.release();
    grid_ = nullptr;
    scalars_ = nullptr;
    input_ = {};
    contoured_ = {};
    point_fields_.clear();
    cell_fields_.clear();
    numbers_ = {};
}

std::uint64_t Block::packed_bytes() const {
    const auto packed = session_ ? session_->packed() : std::nullopt;
    return packed ? packed->report().bytes : 0;
}

} // namespace isotet_vtk
