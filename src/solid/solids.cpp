// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/solid.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <isotet/linear_cells.hpp>
#include <isotet/pieces.hpp>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/guard.hpp"
#include "base/system/memory.hpp"
#include "grid/renumber.hpp"
#include "session/linear_input.hpp"
#include "solid/assemble.hpp"
#include "solid/boundary_faces.hpp"
#include "solid/cap.hpp"
#include "solid/double_sheets.hpp"
#include "solid/patches.hpp"
#include "solid/rim.hpp"
#include "solid/solid_input.hpp"

namespace isotet {

struct Solids::Data {
    ContourInput input;     ///< with linear cells
    ContourOptions options; ///< as the user gave them
    std::shared_ptr<const LinearGrid> linear;
    std::optional<Contour> contour; ///< of the linear cells, with edge ends
    solid::BoundaryFaces boundary;
    solid::BoundaryPoints points;
    std::vector<Field> user_cell_fields; ///< of the user's cells
    Array cell_numbers;                  ///< SolidInput::cell_numbers
    std::vector<PatchName> patch_names;
    double grid_volume = 0;
    std::vector<std::string> notes;              ///< of making cells linear, told once
    std::optional<std::array<double, 3>> origin; ///< of volumes of a piece
    std::uint64_t ghosts = 0;                    ///< cells of other pieces
    std::optional<Contour> of_ghosts;            ///< of these alone

    double volume_of(const Surface& surface) const {
        return origin ? solid::enclosed_volume(surface, *origin) : solid::enclosed_volume(surface);
    }
};

namespace {

template <class Real>
solid::Cap cap_of(const solid::BoundaryFaces& boundary, const solid::BoundaryPoints& points, const ContourInput& input,
                  const FieldReport& field, const SolidRange& range, std::span<const solid::Shell> shells) {
    solid::Cuts<Real> cuts;
    cuts.storage = {field.offset, field.scale, field.unchanged};
    for (const solid::Shell& shell : shells) {
        std::optional<solid::Cut<Real>>& cut = shell.mirrored ? cuts.lower : cuts.upper;
        const double isovalue = shell.mirrored ? range.lower : range.upper;
        cut = solid::Cut<Real>{core::store_isovalue<Real>(isovalue, cuts.storage), solid::Rim(shell.surface, points),
                               shell.surface.positions, cuts.vertices};
        cuts.vertices += static_cast<std::uint32_t>(shell.surface.vertex_count());
    }
    return solid::make_cap<Real>(boundary, input.grid.points, input.field.values, cuts);
}

/// At most: triangles of the boundary twice, and what each of `vertices` has.
std::uint64_t bytes_to_close(const ContourInput& input, const solid::BoundaryFaces& boundary, std::uint64_t vertices) {
    std::uint64_t a_vertex = 3 * sizeof(double), a_triangle = 3 * sizeof(std::uint32_t);
    for (const Field& field : input.point_fields) a_vertex += sizeof(double) * field.values.components();
    for (const Field& field : input.cell_fields) a_triangle += sizeof(double) * field.values.components();
    constexpr std::uint64_t triangles_per_face = 4, while_working = 60;
    return vertices * a_vertex + boundary.faces.size() * triangles_per_face * (a_triangle + while_working);
}

/// Of the triangles of the boundary, which follow those of the isosurfaces.
std::vector<SolidPatch> patches_of(const solid::Cap& cap, const Solid& solid, const std::vector<PatchName>& names) {
    std::map<std::int64_t, SolidPatch> found;
    for (const PatchName& name : names) found[name.number] = {name.number, name.name, 0, 0};
    const std::size_t first = solid.isosurface_triangles;
    const std::vector<double> areas = solid::areas_of(solid.surface, first, first + cap.marks.size());
    for (std::size_t i = 0; i < cap.marks.size(); ++i) {
        const std::int64_t number = cap.marks[i].patch;
        if (number < 0) continue;
        SolidPatch& patch = found[number];
        patch.number = number;
        ++patch.triangles;
        patch.area += areas[i];
    }
    std::vector<SolidPatch> out;
    for (auto& [number, patch] : found) out.push_back(std::move(patch));
    return out;
}

Result<void> add_normals(Normals kind, Surface& surface, const Run& run) {
    if (kind == Normals::none) return {};
    Result<Array> made = kind == Normals::face ? face_normals(surface, run) : vertex_normals(surface, run);
    if (!made) return made.error();
    surface.normals = *std::move(made);
    surface.normals_kind = kind;
    return {};
}

} // namespace

Solids::Solids(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Solids::Solids(Solids&&) noexcept = default;
Solids& Solids::operator=(Solids&&) noexcept = default;
Solids::~Solids() = default;

namespace {

/// Of linear cells.
Result<Array> marks_of_linear_cells(const Array& ghosts, const ContourInput& given, const solid::SolidInput& taken,
                                    const Run& run) {
    if (ghosts.tuples() != given.grid.cells.count() || ghosts.components() != 1)
        return invalid_argument(fmt::format("there are {} marks of {} cells, but must be one a cell", ghosts.tuples(),
                                            given.grid.cells.count()));
    return taken.linear ? taken.linear->of_cells(ghosts, run) : Result<Array>(ghosts);
}

void drop_faces_of_ghosts(const Array& ghosts, solid::BoundaryFaces& boundary) {
    std::vector<solid::BoundaryFace> faces;
    std::vector<solid::Wall> walls;
    for (std::size_t i = 0; i < boundary.faces.size(); ++i) {
        if (ghosts.at(boundary.faces[i].cell) != 0) continue;
        faces.push_back(boundary.faces[i]);
        if (!boundary.walls.empty()) walls.push_back(boundary.walls[i]);
    }
    boundary.faces = std::move(faces);
    boundary.walls = std::move(walls);
}

/// Their isosurfaces, without anything that is carried.
Result<Contour> contour_of_ghosts(const ContourInput& all, const Array& marks, const ContourOptions& options,
                                  const Run& run) {
    std::vector<std::uint8_t> own(marks.tuples());
    for (std::size_t cell = 0; cell < own.size(); ++cell) own[cell] = marks.at(cell) == 0;
    ContourInput bare = all;
    Result<Grid> others = leave_out_cells(all.grid, Array::own(std::move(own)), 1, run);
    if (!others) return others.error();
    bare.grid = *std::move(others);
    bare.point_fields = {};
    bare.cell_fields = {};
    ContourOptions same_triangles;
    same_triangles.method = options.method;
    same_triangles.precision = options.precision;
    same_triangles.split_cells = options.split_cells;
    same_triangles.frame = options.frame;
    return solid::contour_of(std::move(bare), same_triangles, {});
}

std::vector<solid::Shell> shells_of(std::vector<Extraction>& surfaces, const SolidRange& range) {
    std::vector<solid::Shell> shells;
    for (Extraction& one : surfaces)
        shells.push_back({std::exchange(one.surface, {}), shells.empty() && std::isfinite(range.lower)});
    return shells;
}

bool has_tied_points(const ContourResult& result) {
    return std::ranges::any_of(result.surfaces, [](const Extraction& one) { return one.report.tied_points > 0; });
}

/// Also of the marks of the cap.
Result<void> leave_out_double_sheets(std::span<const solid::Shell> shells, std::span<const solid::Shell> others,
                                     const Array& points, const Progress& progress, Solid& out, solid::Cap& cap) {
    const auto left_out = solid::leave_out_double_sheets(out.surface, shells, cap, others, points, progress);
    if (!left_out) return left_out.error();
    const auto first_of_cap = std::ranges::lower_bound(*left_out, out.isosurface_triangles);
    std::vector<solid::FaceMark> marks;
    auto next = first_of_cap;
    for (std::size_t i = 0; i < cap.marks.size(); ++i)
        if (next != left_out->end() && *next == out.isosurface_triangles + i) ++next;
        else marks.push_back(cap.marks[i]);
    cap.marks = std::move(marks);
    out.isosurface_triangles -= static_cast<std::uint64_t>(first_of_cap - left_out->begin());
    return {};
}

} // namespace

Result<Solids> Solids::create(ContourInput given, const ContourOptions& options, const Run& run) {
    return make(std::move(given), nullptr, options, run);
}

Result<Solids> Solids::create_piece(ContourInput piece, const Array& ghosts, const ContourOptions& options,
                                    const Run& run) {
    return make(std::move(piece), &ghosts, options, run);
}

Result<Solids> Solids::make(ContourInput given, const Array* ghosts, const ContourOptions& options, const Run& run) {
    return core::carry_out("starting to make solids", run, [&](const Progress& progress) -> Result<Solids> {
        const Run inside{.progress = progress};
        const ContourInput user = ghosts ? given : ContourInput{};
        Result<solid::SolidInput> taken = solid::take_input(std::move(given), options, inside, ghosts != nullptr);
        if (!taken) return taken.error();
        Array marks;
        if (ghosts) {
            Result<Array> found = marks_of_linear_cells(*ghosts, user, *taken, inside);
            if (!found) return found.error();
            marks = *std::move(found);
        }
        auto data = std::make_unique<Data>();
        data->linear = std::move(taken->linear);
        data->input = std::move(taken->input);
        data->cell_numbers = std::move(taken->cell_numbers);
        data->notes = std::move(taken->notes);
        data->options = options;
        if (ghosts) data->origin = options.frame->whole.lower;
        auto boundary = solid::find_boundary_faces(
            data->input.grid, data->input.field.values,
            options.split_cells ? solid::CellMode::split : solid::CellMode::native, progress);
        if (!boundary) return boundary.error();
        data->boundary = *std::move(boundary);
        if (auto found = solid::find_walls(data->input.grid, data->boundary, progress); !found) return found.error();
        if (ghosts) {
            drop_faces_of_ghosts(marks, data->boundary);
            for (std::size_t cell = 0; cell < marks.tuples(); ++cell) data->ghosts += marks.at(cell) != 0;
            if (data->ghosts > 0) {
                Result<Contour> of_ghosts = contour_of_ghosts(data->input, marks, options, inside);
                if (!of_ghosts) return of_ghosts.error();
                data->of_ghosts = *std::move(of_ghosts);
            }
            Result<Grid> own = leave_out_cells(data->input.grid, marks, ~std::uint64_t{0}, inside);
            if (!own) return own.error();
            data->input.grid = *std::move(own);
        }
        Result<Contour> contour = solid::contour_of(data->input, options, {});
        if (!contour) return contour.error();
        data->contour = *std::move(contour);
        const auto patches = solid::PatchFaces::of(taken->user_grid);
        if (!patches) return patches.error();
        patches->match(data->linear.get(), data->boundary);
        data->user_cell_fields = std::move(taken->user_grid.cell_fields);
        data->patch_names = std::move(taken->user_grid.patches.names);
        data->points = solid::BoundaryPoints(data->boundary, data->input.grid.points.tuples());
        ContourInput bare = data->input;
        bare.point_fields = {};
        bare.cell_fields = {};
        const solid::Cap all = solid::make_cap<double>(data->boundary, bare.grid.points, bare.field.values, {});
        data->grid_volume = data->volume_of(solid::assemble({}, all, bare, {}, {.precision = Precision::float64}));
        return Solids(std::move(data));
    });
}

Result<Solid> Solids::extract(const SolidRange& range, const Run& run) {
    if (!data_) return moved_from("the maker of solids");
    return core::carry_out("making a solid", run, [&](const Progress& progress) -> Result<Solid> {
        Data& data = *data_;
        if (auto ok = solid::check_range(range); !ok) return ok.error();
        const std::vector<double> isovalues = solid::ends_of_range(range);
        Solid out;
        const Run inside{.progress = progress};
        Result<ContourResult> result = data.contour->extract(isovalues, inside);
        if (!result) return result.error();
        out.contour = *std::move(result);
        out.contour.cells_left_out -= std::min(out.contour.cells_left_out, data.ghosts);
        const std::vector<solid::Shell> shells = shells_of(out.contour.surfaces, range);
        std::uint64_t vertices = data.boundary.points.size() + 2 * data.boundary.faces.size(); // with apexes
        for (const solid::Shell& shell : shells) vertices += shell.surface.vertex_count();
        if (vertices > std::numeric_limits<std::uint32_t>::max())
            return invalid_data(
                fmt::format("the solid has up to {} vertices, but must have fewer than 2^32", vertices));
        if (auto ok =
                core::require_memory("closing the isosurface", bytes_to_close(data.input, data.boundary, vertices));
            !ok)
            return ok.error();
        solid::Cap cap = data.options.precision == Precision::float32
                             ? cap_of<float>(data.boundary, data.points, data.input, out.contour.field, range, shells)
                             : cap_of<double>(data.boundary, data.points, data.input, out.contour.field, range, shells);
        out.surface = solid::assemble(shells, cap, data.input, data.user_cell_fields, data.options);
        out.isosurface_triangles = out.surface.triangle_count() - cap.triangles.size();
        if (!data.origin) // what is open where pieces meet is closed by the others
            out.open_edges = solid::count_open_edges(
                cap, out.surface.triangles.as<std::uint32_t>().first(3 * out.isosurface_triangles),
                static_cast<std::uint32_t>(out.surface.vertex_count()));
        if (has_tied_points(out.contour)) {
            std::vector<solid::Shell> others;
            if (data.of_ghosts) {
                Result<ContourResult> found = data.of_ghosts->extract(isovalues, inside);
                if (!found) return found.error();
                others = shells_of(found->surfaces, range);
            }
            if (auto done = leave_out_double_sheets(shells, others, data.input.grid.points, progress, out, cap); !done)
                return done.error();
        }
        if (auto made = add_normals(data.options.normals, out.surface, inside); !made) return made.error();
        out.seam_edges = cap.seam_edges;
        out.unfit_edges = cap.unfit_edges;
        out.patches = patches_of(cap, out, data.patch_names);
        out.volume = data.volume_of(out.surface);
        out.isosurface_area = solid::area_of(out.surface, 0, out.isosurface_triangles);
        out.boundary_area = solid::area_of(out.surface, out.isosurface_triangles, out.surface.triangle_count());
        if (data.linear) {
            out.surface.source_cells = core::source_cells_by(out.surface.source_cells, data.linear->source_cells);
            out.contour.refinement = data.linear->refinement;
            out.contour.cells_left_out += data.linear->refinement.left_out;
        }
        out.surface.source_cells = core::source_cells_by(out.surface.source_cells, data.cell_numbers);
        out.contour.notes.insert(out.contour.notes.begin(), data.notes.begin(), data.notes.end());
        data.notes.clear();
        return out;
    });
}

Result<FieldReport> Solids::field(const Run& run) {
    if (!data_) return moved_from("the maker of solids");
    return data_->contour->field(run);
}

Method Solids::method() const { return data_ ? data_->contour->method() : Method::direct; }

std::shared_ptr<const LinearGrid> Solids::linear_grid() const { return data_ ? data_->linear : nullptr; }
double Solids::grid_volume() const { return data_ ? data_->grid_volume : 0; }

} // namespace isotet
